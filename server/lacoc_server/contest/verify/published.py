"""Reads the facts of a published folder, and checks all files in it that follow from them."""

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import msgspec
from msgspec.structs import replace

from lacoc_server.contest.kept.entries import ContestEntry, EntryFolder
from lacoc_server.contest.kept.publish import (
    ENTRIES,
    FACTS,
    RECORDS,
    SHEET,
    entries_of,
    records_of,
    tables,
)
from lacoc_server.contest.league import facts as league_facts
from lacoc_server.contest.league import sheet as sheets
from lacoc_server.contest.league.contest import Contest, compute
from lacoc_server.contest.league.facts import AnyFact, Played
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.standings import Table
from lacoc_server.contest.verify.history import OfFiles, check_history
from lacoc_shared.command import regular
from lacoc_shared.mistakes import UserError, text_of
from lacoc_shared.words import Phrase, say

_MOST_BYTES = 1 << 25
"""Largest file of facts, sheet or table that is read. 10,000 games have 4 MB."""
_TIES_SINCE = 4
"""The first version of the sheet in which tied teams share a rank."""


def read(path: Path) -> tuple[AnyFact, ...]:
    """Read the facts of a published folder, or a file of facts.

    Raises:
        UserError: if the file does not exist, or has no facts that can be read; the message says
            what to give.
    """
    folder, name = (path, FACTS) if path.is_dir() else (path.resolve().parent, path.resolve().name)
    try:  # the file that the user named may be a link, one in a published folder may not
        return league_facts.decode(regular.read(folder, name, most_bytes=_MOST_BYTES))
    except UserError as error:
        raise UserError(say("verify.no-facts", path=text_of(path), why=error.said[0])) from None


def check_published(folder: Path, facts: tuple[AnyFact, ...]) -> Iterator[Phrase]:
    """Compute the contest again from its facts; yield whatever in the folder contradicts it.

    Records are not looked at: see `verify.games`.

    Args:
        folder: the published folder.
        facts: its facts in their order.

    Raises:
        UserError: if the facts name a format or a tie-break that is not known here.
    """
    contest = compute(facts, FORMATS)
    yield from _check_facts(folder, facts)
    yield from check_history(facts, contest)
    yield from _check_tables(folder, contest)
    yield from _records_used_twice(facts)
    if contest.closed:  # until then the files of a team are nobody else's business
        yield from _check_entries(folder, facts)
    yield from _check_names(folder, facts, contest)


def _check_facts(folder: Path, facts: tuple[AnyFact, ...]) -> Iterator[Phrase]:
    """Yield a phrase if the file of facts has more than the facts, such as an unknown field."""
    if regular.read(folder, FACTS, most_bytes=_MOST_BYTES) != league_facts.encode(facts):
        yield say("verify.more-in-facts", file=FACTS)


def other_sheet(folder: Path) -> Phrase | None:
    """Return why the sheet can't be compared: its layout has another version. None: it can be."""
    found = _version(folder)
    if found == sheets.VERSION:
        return None
    return say("unchecked.sheet", file=SHEET, there=found, here=sheets.VERSION)


def _version(folder: Path) -> int:
    """Return the version of the sheet's format; this software's version if it can't be read.

    A sheet that can't be read is reported later.
    """
    try:
        return msgspec.json.decode(_sheet(folder), type=_AnySheet).version
    except (UserError, msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
        return sheets.VERSION


class _AnySheet(msgspec.Struct):
    """Reads only the version of a sheet, which sheets of all versions have."""

    version: int


def _sheet(folder: Path) -> bytes:
    return regular.read(folder, SHEET, most_bytes=_MOST_BYTES)


def _check_tables(folder: Path, contest: Contest) -> Iterator[Phrase]:
    if other_sheet(folder) is None:
        yield from _check_sheet(folder, contest)
    for file, content in tables(sheets.sheet("", _as_written(folder, contest))).items():
        try:
            if regular.read(folder, file, most_bytes=_MOST_BYTES) != content:
                yield say("verify.other-sheet", file=file)
        except UserError as error:
            yield error.phrase


def _as_written(folder: Path, contest: Contest) -> Contest:
    """Return a contest with ranks as the version that wrote the folder gave them.

    Before version 4 of the sheet, no teams shared a rank.
    """
    if _version(folder) >= _TIES_SINCE:
        return contest
    return replace(
        contest,
        stages=tuple(
            replace(view, tables=tuple(map(_without_ties, view.tables))) for view in contest.stages
        ),
    )


def _without_ties(table: Table) -> Table:
    rows = enumerate(table.rows, 1)
    return replace(
        table, rows=tuple(replace(row, rank=n) if row.shares else row for n, row in rows)
    )


def _check_sheet(folder: Path, contest: Contest) -> Iterator[Phrase]:
    try:
        stored = _sheet(folder)
        name = sheets.decode(stored).name
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        yield say("verify.no-file", file=SHEET, why=str(error))
    except UserError as error:
        yield error.phrase
    else:
        if sheets.encode(sheets.sheet(name, contest)) != stored:
            yield say("verify.other-sheet", file=SHEET)


def _records_used_twice(facts: tuple[AnyFact, ...]) -> Iterator[Phrase]:
    used: dict[str, tuple[str, int]] = {}
    for fact in facts:
        if isinstance(fact, Played) and fact.record:
            game = (fact.pairing, fact.game)
            if used.setdefault(fact.record, game) != game:
                yield say("verify.record-twice", record=fact.record)


def _check_entries(folder: Path, facts: tuple[AnyFact, ...]) -> Iterator[Phrase]:
    entries = EntryFolder(folder / ENTRIES)
    known: dict[str, ContestEntry | None] = {}
    for fact in facts:
        if not isinstance(fact, OfFiles):
            continue
        if fact.files not in known:
            try:
                known[fact.files] = entries.load(fact.files)
            except UserError as error:
                known[fact.files] = None
                yield error.phrase
        entry = known[fact.files]
        if entry is not None and entry.bot != fact.bot:
            yield say("verify.other-bot", team=fact.team)
        if entry is not None and bool(entry.picture) != fact.picture:
            yield say("verify.other-picture", team=fact.team)


def _check_names(folder: Path, facts: tuple[AnyFact, ...], contest: Contest) -> Iterator[Phrase]:
    """Check that each record and each entry in the folder is one that the facts name."""
    entries = entries_of(facts) if contest.closed else set()
    for below, known in ((RECORDS, records_of(facts).keys()), (ENTRIES, entries)):
        try:
            for name in regular.names(folder, below):
                if name not in known:
                    yield say("verify.not-named", file=text_of(Path(below, name)))
        except UserError as error:
            yield error.phrase
    kept = EntryFolder(folder / ENTRIES)
    for name in entries:
        with suppress(UserError):  # an entry that can't be read was told
            for other in kept.others(name):
                yield say("verify.not-named", file=text_of(Path(ENTRIES, name, other)))
