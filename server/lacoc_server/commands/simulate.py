"""`lacoc simulate`: play matches without a network, as fast as the machine can."""

import itertools
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from functools import cache
from pathlib import Path
from typing import Annotated, Any

import typer
from msgspec.structs import replace
from rich.table import Table

from lacoc_arenas import arena as arenas
from lacoc_robots.stand_test import try_standing
from lacoc_server.contest.headless.pool import (
    Job,
    PlayedAlone,
    first_number,
    interrupted_by_signals,
    match_id,
    play_all,
)
from lacoc_server.contest.league.formats.round_robin import circle_round
from lacoc_server.contest.league.standings import Counted, Standing, standings
from lacoc_server.match.entry import weigh_in
from lacoc_server.simulate import player, seated
from lacoc_server.simulate.headless import Seated
from lacoc_server.simulate.inputs import BotFailed
from lacoc_shared.command import options, screen
from lacoc_shared.contest.names import same_name, told_apart
from lacoc_shared.mistakes import FileRefused, Mistake, UserError, text_of
from lacoc_shared.record.schema import Result
from lacoc_shared.words import Phrase, render, say

_LONGEST_NAME = 100
app = typer.Typer()

_LATE_TICKS = 7
"""Ticks by which bots start later in each further match of the same players in the same seats."""
_ORDER = ("wins", "fewest-lost", "scored")
"""Codes of the tie-breaks that rank the players."""


@app.command(name="simulate")
def simulate_command(
    players: Annotated[
        list[str],
        typer.Argument(
            help="Who plays: bots of the arena (such as 'straight' and 'planner'), your_bot.py, or "
            "'ghost:RECORD.mcap:left'. 'planner@FOLDER' steers the gait of that folder. Two "
            "players play one match; of more, each plays every other, or as --rounds says."
        ),
    ],
    arena: Annotated[
        str, typer.Option(envvar="LACOC_ARENA", help="The game, or the path of an arena's folder.")
    ] = "othello",
    robot: Annotated[
        str,
        typer.Option(
            help="Robot of the bots: an installed one, or a robot file with LocoTra-data.txt "
            "beside it."
        ),
    ] = "hexapod",
    seconds: Annotated[
        float | None,
        typer.Option(help="Length of a match in seconds; by default the arena's.", min=0.1),
    ] = None,
    both_sides: Annotated[
        bool, typer.Option("--both-sides", help="Play every pair a second time with seats swapped.")
    ] = False,
    rounds: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            help="Each player meets N others instead of all of them, in both seats as evenly as "
            "possible. If both numbers are odd, each meets one more.",
            min=1,
        ),
    ] = None,
    repeat: Annotated[
        int,
        typer.Option(
            help="How many times each pair plays; the bots start a little later each time.", min=1
        ),
    ] = 1,
    jobs: options.Jobs = None,
    leave_out: Annotated[
        bool,
        typer.Option(
            "--leave-out",
            help="Leave out and name those who can't play: their files have mistakes, or their "
            "robot does not stand. Without this option, no match begins if there is such a player.",
        ),
    ] = False,
    record: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER", help="Folder for a record of each match.", resolve_path=True
        ),
    ] = None,
    json: options.Json = False,
) -> None:
    """Play matches of bots or ghosts without a picture, and print the results.

    'planner@anna' lets the bot planner steer a robot with the files in the folder anna:
    LocoTra-data.txt, and robot.toml if there is one. Bots use key 0 to stand, 1 to turn left, 2 to
    go forward, 3 to turn right.

    Physics and rules are those of a court: with the same keys, a court would play the same match,
    bit for bit. Of many matches, as many as the machine has cores are played at a time; they give
    way to all other programs.

    With --json each match is printed as a line when it has ended, and after it the standings.
    """
    overrides = {"match": {"duration_s": seconds}} if seconds else {}
    loaded = arenas.load(arena, overrides)
    seats = [seat.id for seat in loaded.seats]
    _check_number(players, len(seats), rounds)
    with screen.results_only():
        out = _cannot_play(loaded, players, robot)
    fit = [name for name in players if name not in out]
    if out and json and leave_out:
        for name, why in out.items():
            screen.print_json(_left_out_line(name, why))
    if out and (not leave_out or len(fit) < len(seats)):
        raise _all_of(out)
    if out and not json:
        _show_left_out(out)
    matches = dict(
        enumerate(_matches(fit, len(seats), both_sides, rounds, repeat), first_number(record))
    )
    sit = cache(lambda seat, name: seated(loaded, seat, name, robot))
    teams = _teams({name: sit(0, name).join.team for name in fit})
    names = {match_id(number): who for number, (who, _) in matches.items()}
    work = [
        Job(
            match_id=match_id(number),
            arena=arena,
            overrides=overrides,
            players=_seated(
                [(sit(seat, name), teams[name]) for seat, name in enumerate(who)], seats
            ),
            late_ticks=late_ticks,
            folder=_text(record),
        )
        for number, (who, late_ticks) in matches.items()
    ]
    if json:
        screen.print_json({"kind": "begin", "players": fit, "matches": len(work)})
    results: dict[str, Result] = {}
    failed: list[Phrase] = []
    refused: Counter[str] = Counter()
    table: Sequence[Standing] = ()
    with interrupted_by_signals(), closing(play_all(work, jobs)) as playing:
        for job, found in playing:
            who = names[job.match_id]
            if isinstance(found, BotFailed):
                failed.append(found.phrase)
                if json:
                    screen.print_json(_failed_line(who, found))
                continue
            results[job.match_id] = found.result
            for name, keys in zip(who, found.refused_keys, strict=True):
                refused[name] += keys
            table = _standings(fit, names, results, seats)
            if json:
                screen.print_json(_match_line(job, who, found, seats))
                screen.print_json(_standings_line(len(results), table, teams))
    if not json and results:
        shown = [results[job.match_id] for job in work if job.match_id in results]
        screen.show(_results_table(shown, seats))
        if len(work) > 1 and len(seats) > 1:
            screen.show(_standings_table(table, teams))
    for name, keys in refused.items():
        if keys:
            screen.warn(say("simulate.refused-keys", team=teams[name], keys=keys))
    if failed:
        count = say("simulate.failed", count=len(failed), matches=len(work))
        raise UserError(*dict.fromkeys(failed), *([count] if len(work) > 1 else []))


def _teams(names: Mapping[str, str]) -> dict[str, str]:
    """Return the name under which each player plays and is listed.

    It is the name of the player's team. If two players have the same, it is what the command line
    has for the player.

    Args:
        names: the team's name of each player, by what the command line has for the player.
    """
    often = Counter(map(same_name, names.values()))
    return {
        player: team if often[same_name(team)] == 1 else text_of(player)[:_LONGEST_NAME]
        for player, team in names.items()
    }


def _seated(players: Sequence[tuple[Seated, str]], seats: Sequence[str]) -> tuple[Seated, ...]:
    """Return the players of a match; those with the same team's name get different names."""
    found: list[Seated] = []
    for (one, name), seat in zip(players, seats, strict=True):
        others = [other.join.team for other in found]
        team = told_apart(name, others, seat, most=_LONGEST_NAME)
        found.append(replace(one, join=replace(one.join, team=team)))
    return tuple(found)


def _check_number(players: Sequence[str], seats: int, rounds: int | None) -> None:
    if len(players) < seats:
        raise UserError(say("simulate.players", seats=seats))
    if rounds is not None and seats != 2:
        raise UserError(say("simulate.rounds-of-two", seats=seats))


def _cannot_play(
    arena: arenas.Arena, players: Sequence[str], robot: str
) -> dict[str, FileRefused | UserError]:
    """Return the players who can't play, each with the reason.

    The reason is a wrong name, mistakes in files, or a robot that does not stand.
    """
    levels = arena.match.open_levels
    out: dict[str, FileRefused | UserError] = {}
    for name in dict.fromkeys(players):
        try:
            join = player(arena, 0, name, robot).join
            entry = weigh_in(join.robot, join.postures, join.locomotion, levels=levels)
            if falls := try_standing(entry.robot, entry.gait, levels, join.robot.name):
                raise FileRefused(falls)
        except (FileRefused, UserError) as error:
            out[name] = error
    return out


def _all_of(out: Mapping[str, FileRefused | UserError]) -> FileRefused | UserError:
    """Return one error for all players: the first wrong name, or else all mistakes in files."""
    mistakes: list[Mistake] = []
    for why in out.values():
        if isinstance(why, UserError):
            return why
        mistakes += why.mistakes
    return FileRefused(mistakes)


def _left_out_line(name: str, why: FileRefused | UserError) -> dict[str, Any]:
    return {
        "kind": "left-out",
        "player": name,
        "mistakes": why.mistakes if isinstance(why, FileRefused) else [],
        "why": why.phrase if isinstance(why, UserError) else None,
        "text": str(why),
    }


def _show_left_out(out: Mapping[str, FileRefused | UserError]) -> None:
    screen.warn(say("simulate.left-out", players=[*out]))
    mistakes = [m for why in out.values() if isinstance(why, FileRefused) for m in why.mistakes]
    for why in out.values():
        if isinstance(why, UserError):
            screen.note(why.phrase)
    if mistakes:
        screen.show(screen.mistakes_table(mistakes), screen.stderr)


def _text(path: Path | None) -> str | None:
    return None if path is None else str(path)


def _matches(
    players: Sequence[str], seats: int, both_sides: bool, rounds: int | None, repeat: int
) -> Iterator[tuple[tuple[str, ...], int]]:
    """Yield for each match its players by seat, and how many ticks late its bots start."""
    met: Counter[tuple[int, ...]] = Counter()
    for _, pair in itertools.product(
        range(repeat), _pairs(len(players), seats, both_sides, rounds)
    ):
        yield tuple(players[index] for index in pair), met[pair] * _LATE_TICKS
        met[pair] += 1


def _pairs(
    players: int, seats: int, both_sides: bool, rounds: int | None
) -> Sequence[tuple[int, ...]]:
    pairs: Sequence[tuple[int, ...]]
    if rounds is not None and players % 2 and rounds < players:
        # Each plays one to the right and one to the left of it, so nobody rests more than others.
        pairs = [
            (index, (index + apart) % players)
            for apart in range(1, (rounds + 1) // 2 + 1)
            for index in range(players)
        ]
    elif rounds is not None:
        pairs = [pair for number in range(rounds) for pair in circle_round(players, number)]
    elif seats == 1:
        return [(index,) for index in range(players)]
    elif players > seats:
        return [*itertools.permutations(range(players), seats)]
    else:
        pairs = [tuple(range(players))]
    return [seated for pair in pairs for seated in (pair, pair[::-1])] if both_sides else pairs


def _match_line(
    job: Job, names: Sequence[str], found: PlayedAlone, seats: Sequence[str]
) -> dict[str, Any]:
    return {
        "kind": "match",
        "players": names,
        "winner": _winner(found.result, seats),
        "record": job.record and job.record.name,
        "refused_keys": found.refused_keys,
        "result": found.result,
    }


def _failed_line(names: Sequence[str], error: BotFailed) -> dict[str, Any]:
    return {"kind": "failed", "players": names, "why": error.phrase, "text": str(error)}


def _winner(result: Result, seats: Sequence[str]) -> int | None:
    return seats.index(result.official) if result.official in seats else None


def _standings(
    players: Sequence[str],
    names: Mapping[str, tuple[str, ...]],
    results: Mapping[str, Result],
    seats: Sequence[str],
) -> Sequence[Standing]:
    """Rank the players; those who are equal stay in the order in which they were named."""
    counted = [
        Counted(names[match_id], result.scores, _winner(result, seats))
        for match_id, result in results.items()
        if result.official != "void"
    ]
    return standings([*dict.fromkeys(players)], counted, _ORDER).rows


def _standings_line(
    done: int, table: Sequence[Standing], teams: Mapping[str, str]
) -> dict[str, Any]:
    rows = [
        {
            "name": row.team,
            "team": teams[row.team],
            "rank": row.rank,
            "won": row.won,
            "drawn": row.drawn,
            "lost": row.lost,
        }
        | {"points": row.scored}
        for row in table
    ]
    return {"kind": "standings", "done": done, "standings": rows}


def _results_table(results: Sequence[Result], seats: Sequence[str]) -> Table:
    table = screen.table(
        *(say("fact.of-seat", seat=seat) for seat in seats),
        say("fact.score"),
        say("fact.winner"),
        say("fact.why-ended"),
        say("fact.clock-s"),
    )
    for result in results:
        if result.official in seats:
            winner = result.teams[seats.index(result.official)]
        else:
            is_void = result.official == "void"
            winner = render(say("phase.void") if is_void else say("simulate.draw"))
        score = " : ".join(map(str, result.scores))
        table.add_row(*result.teams, score, winner, render(result.reason), f"{result.clock_s:.1f}")
    return table


def _standings_table(rows: Sequence[Standing], teams: Mapping[str, str]) -> Table:
    table = screen.table(
        say("fact.player"),
        say("fact.won"),
        say("fact.drawn"),
        say("fact.lost"),
        say("fact.points"),
    )
    for one in rows:
        table.add_row(teams[one.team], *map(str, (one.won, one.drawn, one.lost, one.scored)))
    return table
