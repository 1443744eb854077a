"""`lacoc simulate`: play matches without a network, as fast as the machine can."""

import itertools
import os
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path
from typing import Annotated, Any

import msgspec
import typer
from rich.table import Table

from lacoc_arenas import arena as arenas
from lacoc_robots.stand_test import try_standing
from lacoc_server.match.entry import weigh_in
from lacoc_server.simulate import player, simulate
from lacoc_shared.command import options, screen
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import FileRefused, Mistake, UserError
from lacoc_shared.record.schema import Result, Setup
from lacoc_shared.seat import BEATS_PER_S
from lacoc_shared.words import render, say

app = typer.Typer()

_LATE_TICKS = 7
"""Ticks by which each repetition starts the bots later than the one before."""


class _Job(msgspec.Struct, frozen=True):
    """One match for a worker process."""

    match_id: str
    arena: str
    overrides: dict[str, Any]
    robot: str
    players: tuple[str, ...]
    late_ticks: int
    folder: str | None


@app.command(name="simulate")
def simulate_command(
    players: Annotated[
        list[str],
        typer.Argument(
            help="Who plays: bots of the arena (such as 'straight' and 'planner'), your_bot.py, or "
            "'ghost:RECORD.mcap:left'. 'planner@FOLDER' steers the gait of that folder. Two play "
            "one match; more play everybody against everybody."
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
    repeat: Annotated[
        int,
        typer.Option(
            help="How many times each pair plays; the bots start a little later each time.", min=1
        ),
    ] = 1,
    jobs: Annotated[
        int | None, typer.Option(help="Processes at a time; by default one for each core.", min=1)
    ] = None,
    record: Annotated[
        Path | None, typer.Option(metavar="FOLDER", help="Folder for a record of each match.")
    ] = None,
    json: options.Json = False,
) -> None:
    """Play matches of bots or ghosts without a picture, and print the results.

    'planner@anna' lets the bot planner steer a robot with the files in the folder anna:
    LocoTra-data.txt, and robot.toml if there is one. Bots use key 0 to stand, 1 to turn left, 2 to
    go forward, 3 to turn right.

    Physics and rules are those of a court: a simulated match is bit for bit the match that a court
    would play.
    """
    overrides = {"match": {"duration_s": seconds}} if seconds else {}
    loaded = arenas.load(arena, overrides)
    pairs = _pairs(players, len(loaded.seats), both_sides)
    _weigh_in(loaded, players, robot)
    work = [
        _Job(
            f"simulated-{number:03d}",
            arena,
            overrides,
            robot,
            pair,
            repetition * _LATE_TICKS,
            str(record) if record else None,
        )
        for number, (repetition, pair) in enumerate(
            itertools.product(range(repeat), pairs), _first_number(record)
        )
    ]
    results = _run_one(work[0]) if len(work) == 1 else _run_many(work, jobs)
    if json:
        screen.print_json(results)
    else:
        screen.show(_table(results, [seat.id for seat in loaded.seats]))
        if len(work) > 1 and len(loaded.seats) > 1:
            screen.show(_standings(results, work))


def _weigh_in(arena: arenas.Arena, players: Sequence[str], robot: str) -> None:
    """Check that everybody can play, before anything begins.

    Raises:
        UserError: if a bot, robot or folder does not exist.
        FileRefused: with every mistake in every player's files.
    """
    levels = arena.match.open_levels
    mistakes: list[Mistake] = []
    for name in dict.fromkeys(players):
        join = player(arena, 0, name, robot).join
        try:
            entry = weigh_in(join.robot, join.postures, join.locomotion, levels=levels)
            mistakes += try_standing(entry.robot, entry.gait, levels, join.robot.name)
        except FileRefused as refused:
            mistakes += refused.mistakes
    if mistakes:
        raise FileRefused(mistakes)


def _first_number(record: Path | None) -> int:
    """Return the first number after the records in the folder, so that none is overwritten."""
    known = [] if record is None else record.glob("simulated-[0-9]*.mcap")
    return 1 + max((int(path.name.split("-")[1].split(".")[0]) for path in known), default=0)


def _pairs(players: list[str], seats: int, both_sides: bool) -> list[tuple[str, ...]]:
    if seats == 1:
        return [(name,) for name in players]
    if len(players) < seats:
        raise UserError(say("simulate.players", seats=seats))
    if len(players) == seats:
        pair = tuple(players)
        return [pair, pair[::-1]] if both_sides else [pair]
    return list(itertools.permutations(players, seats))


def _play(job: _Job, watch: Any = None) -> Result:
    arena = arenas.load(job.arena, job.overrides)
    setup = Setup(
        match_id=job.match_id,
        court="simulation",
        match=1,
        arena=arena.name,
        settings=arena.settings,
        limits={},
    )
    seated = [
        player(arena, seat, name, job.robot, late_ticks=job.late_ticks)
        for seat, name in enumerate(job.players)
    ]
    return simulate(setup, seated, Path(job.folder) if job.folder else None, watch, arena.folder)


def _run_one(job: _Job) -> list[Result]:
    duration_s = arenas.load(job.arena, job.overrides).match.duration_s
    with screen.progress() as progress:
        task = progress.add_task(" : ".join(job.players), total=round(duration_s))

        def watch(frame: Frame) -> None:
            if frame.beat % BEATS_PER_S == 0:
                progress.update(task, completed=max(0, frame.clock_ticks) // BEATS_PER_S)

        return [_play(job, watch)]


def _run_many(work: Sequence[_Job], jobs: int | None) -> list[Result]:
    results: dict[str, Result] = {}
    # Each worker is a fresh interpreter: a forked one would inherit the parent's state.
    pool = ProcessPoolExecutor(jobs or os.cpu_count(), mp_context=get_context("spawn"))
    with screen.progress() as progress, pool:
        task = progress.add_task(render(say("simulate.matches")), total=len(work))
        futures = [pool.submit(_play, job) for job in work]
        for future in as_completed(futures):
            result = future.result()
            results[result.match_id] = result
            progress.advance(task)
    return [results[job.match_id] for job in work]


def _table(results: Sequence[Result], seats: Sequence[str]) -> Table:
    table = screen.table(
        *(say("fact.of-seat", seat=seat) for seat in seats),
        say("fact.score"),
        say("fact.winner"),
        say("fact.why-ended"),
        say("fact.clock-s"),
    )
    for result in results:
        drawn = result.official not in seats
        winner = (
            render(say("simulate.draw")) if drawn else result.teams[seats.index(result.official)]
        )
        score = " : ".join(map(str, result.scores))
        table.add_row(*result.teams, score, winner, render(result.reason), f"{result.clock_s:.1f}")
    return table


def _standings(results: Sequence[Result], work: Sequence[_Job]) -> Table:
    names = list(dict.fromkeys(name for job in work for name in job.players))
    won = dict.fromkeys(names, 0)
    lost, drawn = dict(won), dict(won)
    for result, job in zip(results, work, strict=True):
        best = max(result.scores)
        for name, score in zip(job.players, result.scores, strict=True):
            if result.official == "draw":
                drawn[name] += 1
            elif score == best:
                won[name] += 1
            else:
                lost[name] += 1
    table = screen.table(say("fact.player"), say("fact.won"), say("fact.drawn"), say("fact.lost"))
    for name in sorted(names, key=lambda name: (-won[name], lost[name])):
        table.add_row(name, str(won[name]), str(drawn[name]), str(lost[name]))
    return table
