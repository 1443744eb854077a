"""Checks a published contest: whether its standings follow from its entries, facts and records.

Nothing that was computed is believed. The sheet and the tables are computed again from the facts;
each result is compared with its record; the records are proven by playing them again.
"""

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from random import Random
from typing import NamedTuple

import msgspec

from lacoc_arenas import arena as arenas
from lacoc_server.contest import sheet as sheets
from lacoc_server.contest.entries import Entry, EntryFolder
from lacoc_server.contest.folder import file_hash
from lacoc_server.contest.headless import outcome
from lacoc_server.contest.league import facts as league_facts
from lacoc_server.contest.league.facts import (
    AnyFact,
    Closed,
    Drawn,
    Entered,
    FilesChanged,
    Planned,
    Played,
)
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.publish import ENTRIES, FACTS, RECORDS, SHEET, tables
from lacoc_server.journal.replay import verify as prove
from lacoc_server.journal.verdict import Verdict
from lacoc_shared.inputs import JoinSeat
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.words import Phrase, say

CONFIDENCE = 0.95


class Published(NamedTuple):
    """A published folder, as far as it could be read."""

    folder: Path
    facts: tuple[AnyFact, ...]
    games: tuple[Played, ...]
    """The games with a record, in the order of their facts."""


def read(folder: Path) -> Published:
    """Read the facts of a published folder.

    Raises:
        UserError: if there are none, or they can't be read.
    """
    try:
        data = (folder / FACTS).read_bytes()
    except OSError as error:
        why = error.strerror or str(error)
        path = str(folder / FACTS)
        raise UserError(say("command.cannot-read", path=path, why=why)) from None
    facts = league_facts.decode(data)
    played = tuple(fact for fact in facts if isinstance(fact, Played) and fact.outcome != "void")
    return Published(folder, facts, played)


def check_facts(published: Published) -> Iterator[Phrase]:
    """Compute the contest again; yield what does not follow from the facts.

    Raises:
        UserError: if the facts contradict each other, or name a format that is not installed.
    """
    yield from _order(published.facts)
    try:
        stored = (published.folder / SHEET).read_bytes()
        name = sheets.decode(stored).name
    except (OSError, msgspec.MsgspecError) as error:
        yield say("verify.no-file", file=SHEET, why=str(error))
        return
    sheet = sheets.sheet_of(name, published.facts, FORMATS)
    if sheets.encode(sheet) != stored:
        yield say("verify.other-sheet", file=SHEET)
    for file, content in tables(sheet).items():
        try:
            if (published.folder / file).read_bytes() != content:
                yield say("verify.other-sheet", file=file)
        except OSError as error:
            yield say("verify.no-file", file=file, why=error.strerror or str(error))
    used = Counter(game.record for game in published.games if game.record)
    yield from (
        say("verify.record-twice", record=name) for name, times in used.items() if times > 1
    )
    for unused in sheet.unused:
        yield from _about_unused(published, unused.fact, unused.why)
    entries = EntryFolder(published.folder / ENTRIES)
    for entry in sorted({fact.files for fact in published.facts if isinstance(fact, _FILES)}):
        try:
            entries.load(entry)
        except UserError as error:
            yield error.phrase


def check_game(published: Published, game: Played) -> list[Phrase]:
    """Compare a result with its record, and prove the record; return what is wrong."""
    return [*_faults(published, game)]


def _faults(published: Published, game: Played) -> Iterator[Phrase]:
    pairing, number = game.pairing, game.game
    path = published.folder / RECORDS / Path(game.record).name
    try:
        if game.record_hash and file_hash(path) != game.record_hash:
            yield say("verify.record-changed", record=game.record, pairing=pairing, game=number)
        record = Record.read(path)
    except OSError as error:
        yield say("verify.no-file", file=game.record, why=error.strerror or str(error))
        return
    except UserError as error:
        yield say(
            "verify.bad-record", record=game.record, why=error.phrase, pairing=pairing, game=number
        )
        return
    said = [*_differences(published, game, record)]
    yield from (
        say("verify.other-game", record=game.record, what=what, pairing=pairing, game=number)
        for what in said
    )
    try:
        verdict = next(step for step in prove(record, processes=1) if isinstance(step, Verdict))
    except UserError as error:
        yield say(
            "verify.bad-record", record=game.record, why=error.phrase, pairing=pairing, game=number
        )
        return
    if not verdict.same or record.lost:
        yield say(
            "verify.not-proven", record=game.record, why=verdict.said, pairing=pairing, game=number
        )


def sample(games: Sequence[Played], number: int, seed: int) -> list[Played]:
    """Choose games to check by chance; the same seed chooses the same games."""
    return Random(seed).sample(sorted(games, key=lambda game: game.id), min(number, len(games)))


def least_share(games: int, checked: int) -> float:
    """Return the smallest share of forged games that a sample finds with `CONFIDENCE`."""
    for forged in range(1, games + 1):
        missed = math.comb(games - forged, checked) / math.comb(games, checked)
        if missed <= 1 - CONFIDENCE:
            return forged / games
    return 1.0


_FILES = Entered | FilesChanged


def _order(facts: Sequence[AnyFact]) -> Iterator[Phrase]:
    """Say which facts came when they could not."""
    newest_ms, closed_ms = 0, None
    drawn = False
    for fact in facts:
        if fact.at_ms < newest_ms:
            yield say("verify.time-back", fact=fact.id)
        newest_ms = max(newest_ms, fact.at_ms)
        if isinstance(fact, Closed):
            closed_ms = fact.at_ms
        elif isinstance(fact, Entered) and closed_ms is not None:
            yield say("verify.entered-late", team=fact.team)
        elif isinstance(fact, FilesChanged) and closed_ms is not None and not fact.reason:
            yield say("verify.no-reason", team=fact.team)
        drawn = drawn or isinstance(fact, Drawn)
        if drawn and closed_ms is None:
            yield say("verify.never-closed")
            closed_ms = fact.at_ms


def _about_unused(published: Published, fact_id: str, why: Phrase) -> Iterator[Phrase]:
    """Yield the reason why a fact changes nothing, if an honest contest has no such fact."""
    fact = next(fact for fact in published.facts if fact.id == fact_id)
    if why.code not in ("league.result-replaced", "league.result-unneeded", "league.other-teams"):
        yield say("verify.unused", fact=fact.id, why=why)


def _differences(published: Published, game: Played, record: Record) -> Iterator[Phrase]:
    """Yield what in a record is not what the facts say about the game."""
    setup, result = record.header.setup, record.result
    plan = _plan(published.facts, game)
    if plan is None:
        yield say("verify.of-arena")
    else:
        arena = arenas.load(plan.arena, plan.arena_settings)
        if (setup.arena, setup.settings) != (arena.name, arena.settings):
            yield say("verify.of-arena")
        if setup.limits != plan.limits:
            yield say("verify.of-limits")
    if Path(game.record).stem != record.header.match_id:
        yield say("verify.of-name")
    if result is None or result.teams != game.teams:
        yield say("verify.of-teams")
        return
    seats = tuple(seat["id"] for seat in setup.settings["seat"])
    if result.scores != game.scores or outcome(seats, result.official) != game.outcome:
        yield say("verify.of-result")
    entries = EntryFolder(published.folder / ENTRIES)
    for seat, team in enumerate(game.teams):
        joins = [
            one
            for beat in record.inputs.values()
            for one in beat
            if isinstance(one, JoinSeat) and one.seat == seat
        ]
        allowed = [_load(entries, one) for one in _allowed(published.facts, game, team)]
        wanted = [_content(entry.join(seat, team)) for entry in allowed if entry is not None]
        if not joins or any(_content(join) not in wanted for join in joins):
            yield say("verify.of-files", team=team)


def _plan(facts: Sequence[AnyFact], game: Played) -> Planned | None:
    """Return the plan by which the stage of a game was drawn."""
    stage = game.pairing.partition(":")[0]
    plan = None
    for fact in facts:
        if isinstance(fact, Planned) and fact.stage == stage:
            plan = fact
        elif isinstance(fact, Drawn) and fact.stage == stage:
            return plan
    return None


def _allowed(facts: Sequence[AnyFact], game: Played, team: str) -> list[str]:
    """Return the hashes of the files with which a team may have played.

    A game goes on with the files that it began with, so of two changes the one before counts too.
    """
    hashes = [
        fact.files
        for fact in facts
        if isinstance(fact, _FILES) and fact.team == team and fact.number < game.number
    ]
    return hashes[-2:] if len(hashes) > 1 else hashes


def _content(join: JoinSeat) -> tuple[bytes | None, ...]:
    files = (join.robot, join.postures, join.locomotion)
    return tuple(None if file is None else file.data for file in files)


def _load(entries: EntryFolder, entry: str) -> Entry | None:
    try:
        return entries.load(entry)
    except UserError:
        return None
