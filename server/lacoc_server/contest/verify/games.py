"""A game of a published contest: its result is compared with its record, and that is proven."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import msgspec

from lacoc_arenas import arena as arenas
from lacoc_server.contest.headless.play import late_ticks, outcome
from lacoc_server.contest.kept.entries import Entry, EntryFolder
from lacoc_server.contest.kept.folder import file_hash
from lacoc_server.contest.league.contest import compute
from lacoc_server.contest.league.facts import AnyFact, Planned, Played
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.publish import ENTRIES, RECORDS
from lacoc_server.contest.verify.bots import may_have_pressed
from lacoc_server.contest.verify.history import call_of, files_of, known_before
from lacoc_server.journal.replay import verify as prove
from lacoc_server.journal.verdict import Verdict
from lacoc_shared.inputs import JoinSeat
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.files import packed_path
from lacoc_shared.record.reader import Record
from lacoc_shared.words import Phrase, say


class Game(msgspec.Struct, frozen=True, kw_only=True):
    """A game to check: what the facts say about it. A process can take it."""

    played: Played
    plan: Planned | None
    """The plan of its stage; None: it was not the turn of this game."""
    call: str = ""
    """Id of the call by which a court got the game; "": it was played without a network."""
    late_ticks: int = 0
    """How many ticks later its bots start, if it was played without a network."""
    files: tuple[tuple[str, ...], ...]
    """By seat: hashes of the entries with which the team may have played."""


def games_of(facts: Sequence[AnyFact]) -> list[Game]:
    """Return all games that were played, also void ones, in the order of their facts."""
    return [_game(facts, fact) for fact in facts if isinstance(fact, Played)]


def _game(facts: Sequence[AnyFact], played: Played) -> Game:
    before = known_before(facts, played)
    contest = compute(before, FORMATS)
    files = tuple(files_of(facts, played, team) for team in played.teams)
    call = call_of(facts, played)
    for view in contest.stages:
        for match in view.matches:
            due = (match.pairing.id, match.next_game, match.next_seats)
            if due == (played.pairing, played.game, played.teams):
                late = late_ticks(contest, before, match)
                return Game(played=played, plan=view.plan, call=call, late_ticks=late, files=files)
    return Game(played=played, plan=None, call=call, files=files)


def check_game(folder: Path, game: Game, proven: bool) -> list[Phrase]:
    """Compare the result of a game with its record; return what is wrong.

    Args:
        folder: the published folder.
        game: the game.
        proven: whether to prove the record too: its inputs are played again.
    """
    return [*_faults(folder, game, proven)]


def _faults(folder: Path, game: Game, proven: bool) -> Iterator[Phrase]:
    played = game.played
    file, pairing, number = played.record, played.pairing, played.game
    if not played.record or Path(played.record).name != played.record or "\0" in played.record:
        yield say("verify.no-record", pairing=played.pairing, game=played.game)
        return
    if game.plan is None:
        yield say("verify.not-due", pairing=played.pairing, game=played.game)
        return
    path = folder / RECORDS / played.record
    try:
        if played.record_hash and file_hash(path) != played.record_hash:
            yield say("verify.record-changed", record=file, pairing=pairing, game=number)
        record = Record.read(path)
        wrong = [*_differences(folder, game, game.plan, record)]
        verdict = _verdict(record) if proven and not wrong else None
    except OSError as error:
        yield say("verify.no-file", file=played.record, why=error.strerror or str(error))
    except UserError as error:
        yield say("verify.bad-record", record=file, pairing=pairing, game=number, why=error.phrase)
    else:
        yield from (
            say("verify.other-game", record=file, pairing=pairing, game=number, what=what)
            for what in wrong
        )
        if verdict is not None and (not verdict.same or record.lost):
            yield say(
                "verify.not-proven", record=file, pairing=pairing, game=number, why=verdict.said
            )


def _verdict(record: Record) -> Verdict:
    """Prove a record.

    Raises:
        UserError: if its arena is not installed, other physics made it, or it is damaged.
    """
    return next(step for step in prove(record, processes=1) if isinstance(step, Verdict))


def _differences(folder: Path, game: Game, plan: Planned, record: Record) -> Iterator[Phrase]:
    """Yield each difference between a record and what the facts say about its game.

    Raises:
        UserError: if the arena of the plan is not installed, or its settings are wrong.
    """
    played = game.played
    setup, result = record.header.setup, record.result
    if setup.origin is not None:
        yield say("verify.of-fork", match=setup.origin.match_id, beat=setup.origin.beat)
    if packed_path(Path(), record.header.match_id).name != played.record:
        yield say("verify.of-name")
    if (setup.assigned.call if setup.assigned else "") != game.call:
        yield say("verify.of-call")
    # An installed arena alone is loaded: a folder's code must not run because the facts name it.
    arena = arenas.load_installed(plan.arena, plan.arena_settings)
    if (setup.arena, _rules(setup.settings)) != (arena.name, _rules(arena.settings)):
        yield say("verify.of-arena")
        return
    if setup.limits != plan.limits:
        yield say("verify.of-limits")
    if result is None or result.teams != played.teams:
        yield say("verify.of-teams")
        return
    seats = tuple(seat.id for seat in arena.seats)
    # A game that a referee voided in play has no score for the office, but one in its record.
    no_score = played.outcome == "void" and not any(played.scores)
    same_score = no_score or result.scores == played.scores
    if not same_score or outcome(seats, result.official) != played.outcome:
        yield say("verify.of-result")
    entries = EntryFolder(folder / ENTRIES)
    for seat, team in enumerate(played.teams):
        allowed = [found for one in game.files[seat] if (found := _load(entries, one)) is not None]
        joins = [
            one
            for inputs in record.inputs.values()
            for one in inputs
            if isinstance(one, JoinSeat) and one.seat == seat
        ]
        fits = [
            one for one in allowed if {*map(_content, joins)} == {_content(one.join(seat, team))}
        ]
        if not fits:
            yield say("verify.of-files", team=team)
        elif not any(may_have_pressed(record, arena, seat, one, game.late_ticks) for one in fits):
            yield say("verify.of-bot", team=team)


def _rules(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return settings without the looks of the robots, which every court may choose."""
    seats = [
        {name: value for name, value in seat.items() if name not in ("colour", "pattern")}
        for seat in settings.get("seat", ())
    ]
    return {**settings, "seat": seats}


def _content(join: JoinSeat) -> tuple[bytes | None, ...]:
    files = (join.robot, join.postures, join.locomotion)
    return tuple(None if file is None else file.data for file in files)


def _load(entries: EntryFolder, entry: str) -> Entry | None:
    try:
        return entries.load(entry)
    except UserError:
        return None
