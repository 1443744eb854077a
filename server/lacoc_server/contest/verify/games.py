"""Checks a game of a published contest: compares result and record, and proves the record."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import msgspec
from msgspec.structs import replace

from lacoc_arenas import arena as arenas
from lacoc_arenas.arena import Arena
from lacoc_server.contest.headless.play import late_ticks, outcome
from lacoc_server.contest.headless.pool import setup_of
from lacoc_server.contest.kept.entries import ContestEntry, EntryFolder
from lacoc_server.contest.kept.folder import hash_of
from lacoc_server.contest.kept.publish import ENTRIES, RECORDS
from lacoc_server.contest.league.advice import advice
from lacoc_server.contest.league.contest import compute
from lacoc_server.contest.league.facts import AnyFact, Called, Planned, Played
from lacoc_server.contest.league.fixture import named
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.matches import ContestMatch
from lacoc_server.contest.verify.alone import InputCheck, Side, check_inputs, ends_alike
from lacoc_server.contest.verify.history import call_of, files_of
from lacoc_server.journal.replay import verify as prove
from lacoc_server.journal.verdict import Verdict, VerdictKind
from lacoc_shared.command import regular
from lacoc_shared.inputs import JoinSeat
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.files import packed_path
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import Setup
from lacoc_shared.seat import BEAT_S
from lacoc_shared.words import Phrase, say

RECORD_BYTES = 1 << 27
"""Largest record that is read. A match of three minutes has 3 MB."""
_OTHER_PHYSICS = ("replay.other-mujoco", "replay.other-model")
"""Codes of the reasons why this software can't prove a record that may still be right."""
_ROUTINE = ("ready", "start", "official", "next")
"""Decisions that every match at a court has; they change no result, so they are not reported."""


class GameToCheck(msgspec.Struct, frozen=True, kw_only=True):
    """A game to check, with what the facts say about it; it can be sent to another process."""

    played: Played
    about: Phrase
    """The game and its teams: "Semi-final 1, game 2 of 3 (Ants – Bees)"."""
    plan: Planned | None
    """The plan of its stage; None: by the facts, this game was not to be played then."""
    why_not: Phrase | None = None
    """Why this game was not to be played then; None: it was."""
    call: Called | None = None
    """The call by which a court got the game; None: it was played without a network."""
    late_ticks: int = 0
    """For a game without a network: how many ticks after the start of play its bots begin."""
    files: tuple[tuple[str, ...], ...]
    """By seat: hashes of the entries with which the team may have played, by the facts."""


class GameCheck(msgspec.Struct, frozen=True, kw_only=True):
    """The result of the check of a game."""

    wrong: tuple[Phrase, ...] = ()
    """Contradictions between facts, entries and record."""
    unchecked: tuple[Phrase, ...] = ()
    """What could not be checked here, with the reason: keys of bots, or other physics."""
    decided: tuple[Phrase, ...] = ()
    """Decisions of referees in this game; no record proves that they were right."""
    has_bots: bool = False
    """Whether a bot played for a team: one that the team entered, or one that steered it."""


def games_of(facts: Sequence[AnyFact]) -> list[GameToCheck]:
    """Return all games that were played, also void ones, in the order of their facts."""
    return [_game(facts, fact) for fact in facts if isinstance(fact, Played)]


def _game(facts: Sequence[AnyFact], played: Played) -> GameToCheck:
    call = call_of(facts, played)
    before = facts[: facts.index(call or played)]
    contest = compute(before, FORMATS)
    unplanned = GameToCheck(
        played=played,
        about=say(
            "verify.game",
            game=named(contest, played.pairing, played.game),
            left=played.teams[0],
            right=played.teams[1],
        ),
        plan=None,
        call=call,
        files=tuple(files_of(facts, call, played, team) for team in played.teams),
    )
    for view in contest.stages:
        for match in view.matches:
            if match.pairing.id != played.pairing:
                continue
            if (why := _why_not(match, call, played)) is not None:
                return replace(unplanned, why_not=why)
            late = late_ticks(contest, before, match)
            return replace(unplanned, plan=view.plan, late_ticks=late)
    return replace(unplanned, why_not=say("due.no-pairing"))


def _why_not(match: ContestMatch, call: Called | None, played: Played) -> Phrase | None:
    """Say why a game was not the next one of its match when it was played; None: it was."""
    for game in match.games:
        if game.number == played.game:
            return say("due.has-result", fact=game.fact)
    if match.state != "open":
        return say("due.not-open")
    if match.next_game != played.game:
        return say("due.other-game", game=match.next_game)
    if match.next_seats != played.teams or (call is not None and call.teams != played.teams):
        return say("due.other-seats")
    return None


def check_game(folder: Path, game: GameToCheck, proven: bool, programs: bool = False) -> GameCheck:
    """Check a game: compare its result with its record, and prove the record if `proven`.

    Args:
        folder: the published folder.
        game: the game.
        proven: whether to prove the record, too, by simulating its inputs again.
        programs: whether to run the programs of bots that are in entries.
    """
    played = game.played
    file, about = played.record, game.about
    if not file:
        return GameCheck(wrong=(say("verify.no-record", about=about),))
    if game.why_not is not None:
        why = game.why_not
        return GameCheck(wrong=(say("verify.not-due", about=about, why=why),))
    try:
        data = regular.read(folder, RECORDS, file, most_bytes=RECORD_BYTES)
        if played.record_hash and hash_of(data) != played.record_hash:
            changed = say("verify.record-changed", record=file, about=about)
            return GameCheck(wrong=(changed,))
        if not arenas.is_installed(arena := game.plan.arena if game.plan else ""):
            why = say("unchecked.arena", arena=arena)
            return GameCheck(unchecked=(_unchecked(game, why),))
        record = Record.read([folder / RECORDS / file])
        found = _compared(folder, game, record, programs)
        if not found.wrong and proven:
            return _proven(folder, game, record, found, programs)
    except UserError as error:
        bad = say("verify.bad-record", record=file, about=about, why=error.phrase)
        return GameCheck(wrong=(bad,))
    return found


def _compared(folder: Path, game: GameToCheck, record: Record, programs: bool) -> GameCheck:
    """Compare a game with `record`, its record, without physics.

    The other arguments are those of `check_game`.

    Raises:
        UserError: if the arena of the game's stage is not installed, or its settings are wrong.
    """
    arena = _arena(game)
    wrong = [*_differences(game, arena, record)]
    sides: list[Side] = []
    if not wrong:
        sides = _sides(folder, game, record)
        teams = game.played.teams
        wrong += (say("verify.of-files", team=one) for one in teams if one not in _teams(sides))
    # `Played.steer` is told as somebody's choice, so it must not be there without a reason.
    has_bots = game.call is not None or all(one.entry.bot for one in sides)
    if not wrong and game.played.steer and has_bots:
        wrong.append(say("verify.of-steer", bot=game.played.steer))
    checked = InputCheck()
    if not wrong and game.call is None:
        checked = check_inputs(record, arena, sides, game.late_ticks, programs=programs)
    elif not wrong:
        at_court = (say("unchecked.court", team=one.team) for one in sides if one.entry.bot)
        checked = InputCheck(unchecked=tuple(at_court))
    return GameCheck(
        wrong=tuple(_other_game(game, what) for what in (*wrong, *checked.wrong)),
        unchecked=tuple(_unchecked(game, why) for why in checked.unchecked),
        decided=() if wrong or game.call is None else tuple(_decisions(record, game)),
        has_bots=game.call is None or any(one.entry.bot for one in sides),
    )


def _proven(
    folder: Path, game: GameToCheck, record: Record, found: GameCheck, programs: bool
) -> GameCheck:
    """Prove the record of a game; return `found` with what the proof adds.

    On a machine with other arithmetic, the proof must allow small deviations, and a forger could
    use them to choose the result. So a game without a network is then also played again here, and
    must have the same result.

    Raises:
        UserError: if the record is damaged.
    """
    try:
        verdict = next(step for step in prove(record, processes=1) if isinstance(step, Verdict))
    except UserError as error:
        if error.phrase.code not in _OTHER_PHYSICS:
            raise
        why = _unchecked(game, error.phrase)
        return replace(found, unchecked=(*found.unchecked, why))
    played = game.played
    if not verdict.same:
        said = say(
            "verify.not-proven",
            record=played.record,
            why=verdict.said,
            about=game.about,
        )
        return replace(found, wrong=(said,))
    if verdict.kind is VerdictKind.SAME or game.call is not None or found.unchecked:
        return found
    sides = _sides(folder, game, record)
    if ends_alike(record, _arena(game), sides, game.late_ticks, programs=programs):
        return found
    why = _unchecked(game, say("unchecked.arithmetic"))
    return replace(found, unchecked=(why,))


def _arena(game: GameToCheck) -> Arena:
    """Load the arena of a game if it is installed; facts must not be able to name code to run.

    Raises:
        UserError: if it is not installed, or its settings are wrong.
    """
    assert game.plan is not None
    return arenas.load_installed(game.plan.arena, game.plan.arena_settings)


def _sides(folder: Path, game: GameToCheck, record: Record) -> list[Side]:
    """Return team, entry and bot of each seat; leave out a team none of whose entries fits.

    An entry fits if its files are those with which the team joined in the record. In a void game
    any fits if the team did not join: perhaps it was aborted for that.
    """
    entries = EntryFolder(folder / ENTRIES)
    sides: list[Side] = []
    for seat, team in enumerate(game.played.teams):
        joins = {*map(_content, _joins(record, seat, team))}
        is_absent = not joins and game.played.outcome == "void"
        for one in game.files[seat]:
            entry = _load(entries, one)
            if entry is not None and (is_absent or joins == {_content(entry.join(seat, team))}):
                sides.append(Side(team, entry, game.played.steer))
                break
    return sides


def _teams(sides: Sequence[Side]) -> set[str]:
    return {one.team for one in sides}


def _other_game(game: GameToCheck, what: Phrase) -> Phrase:
    return say(
        "verify.other-game",
        record=game.played.record,
        what=what,
        about=game.about,
    )


def _unchecked(game: GameToCheck, why: Phrase) -> Phrase:
    return say("verify.unchecked", about=game.about, why=why)


def _differences(game: GameToCheck, arena: Arena, record: Record) -> Iterator[Phrase]:
    """Yield each difference between a record and what the facts say about its game."""
    played = game.played
    setup, result = record.header.setup, record.result
    if record.cut is not None:  # nobody answered in its last beat, so nothing proves that one
        yield say("verify.of-end", cut=record.cut)
    if setup.origin is not None:
        yield say("verify.of-fork", match=setup.origin.match_id, beat=setup.origin.beat)
    if {packed_path(Path(), one).name for one in (record.header.match_id, setup.match_id)} != {
        played.record
    }:
        yield say("verify.of-name")
    if (setup.assigned.call if setup.assigned else "") != (game.call.id if game.call else ""):
        yield say("verify.of-call")
    elif not _is_of_court(record, setup, game, arena):
        yield say("verify.of-court")
    if (setup.arena, _rules(setup.settings)) != (arena.name, _rules(arena.settings)):
        yield say("verify.of-arena")
        return
    if game.plan is None or setup.limits != game.plan.limits:
        yield say("verify.of-limits")
    if result is None or result.teams != played.teams:
        yield say("verify.of-teams")
        return
    seats = tuple(seat.id for seat in arena.seats)
    # A game that a referee voided has no score for the office, but perhaps one in its record.
    no_score = game.call is not None and played.outcome == "void" and not any(played.scores)
    same_score = no_score or result.scores == played.scores
    if not same_score or outcome(seats, result.official) != played.outcome:
        yield say("verify.of-result")
    elif played.advice and advice(record.events) != played.advice:
        yield say("verify.of-advice")


def _is_of_court(record: Record, setup: Setup, game: GameToCheck, arena: Arena) -> bool:
    """Return whether a record is of the court that had the game.

    If the game was played without a network, return whether the record is of no court.
    """
    if game.call is not None:
        return setup.court == game.call.court
    wanted = setup_of(setup.match_id, arena, setup.limits)
    same = replace(setup, settings=wanted.settings, arena=wanted.arena) == wanted
    return same and len(record.headers) == 1 and record.health is None


def _decisions(record: Record, game: GameToCheck) -> Iterator[Phrase]:
    """Yield the decisions of referees in a game, without those that every match has."""
    for event in record.events:
        if event.kind == "decision" and event.data.get("decision") not in _ROUTINE:
            yield say(
                "verify.in-play",
                about=game.about,
                at_s=event.clock_ticks * BEAT_S,
                said=event.said,
            )


def _rules(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return settings without the colours and patterns of robots, which every court may choose."""
    seats = [
        {name: value for name, value in seat.items() if name not in ("colour", "pattern")}
        for seat in settings.get("seat", ())
    ]
    return {**settings, "seat": seats}


def _joins(record: Record, seat: int, team: str) -> list[JoinSeat]:
    """Return a team's requests for a seat.

    A record also has those of other teams, which the match refuses: one may have been weighed in
    while the court opened the match.
    """
    return [
        one
        for inputs in record.inputs.values()
        for one in inputs
        if isinstance(one, JoinSeat) and (one.seat, one.team) == (seat, team)
    ]


def _content(join: JoinSeat) -> tuple[object, ...]:
    files = (join.robot, join.postures, join.locomotion)
    return (join.team, *(None if file is None else file.data for file in files))


def _load(entries: EntryFolder, entry: str) -> ContestEntry | None:
    try:
        return entries.load(entry)
    except UserError:
        return None
