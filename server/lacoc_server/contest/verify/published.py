"""A published folder: its facts are read, and all in it that follows from them is checked."""

from collections.abc import Iterator
from pathlib import Path

import msgspec

from lacoc_server.contest import sheet as sheets
from lacoc_server.contest.kept.entries import EntryFolder
from lacoc_server.contest.league import facts as league_facts
from lacoc_server.contest.league.contest import Contest, compute
from lacoc_server.contest.league.facts import AnyFact, Played
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.publish import ENTRIES, FACTS, SHEET, tables
from lacoc_server.contest.verify.history import OfFiles, check_history
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, say


def read(path: Path) -> tuple[AnyFact, ...]:
    """Read the facts of a published folder, or a file of facts.

    Raises:
        UserError: if there are none, or they can't be read.
    """
    file = path / FACTS if path.is_dir() else path
    try:
        return league_facts.decode(file.read_bytes())
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("command.cannot-read", path=str(file), why=why)) from None


def check_published(folder: Path, facts: tuple[AnyFact, ...]) -> Iterator[Phrase]:
    """Compute the contest again; yield what does not follow from the facts.

    Records are not looked at: see `verify.games`.

    Args:
        folder: the published folder.
        facts: its facts in their order.

    Raises:
        UserError: if the facts name a format or a tie-break that is not known here.
    """
    contest = compute(facts, FORMATS)
    yield from check_history(facts, contest)
    yield from _check_tables(folder, contest)
    yield from _records_used_twice(facts)
    if contest.closed:  # until then the files of a team are nobody else's business
        yield from _check_entries(folder, facts)


def _check_tables(folder: Path, contest: Contest) -> Iterator[Phrase]:
    try:
        stored = (folder / SHEET).read_bytes()
        name = sheets.decode(stored).name
    except (OSError, msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        yield say("verify.no-file", file=SHEET, why=str(error))
        return
    sheet = sheets.sheet(name, contest)
    for file, content in {SHEET: sheets.encode(sheet), **tables(sheet)}.items():
        try:
            if (folder / file).read_bytes() != content:
                yield say("verify.other-sheet", file=file)
        except OSError as error:
            yield say("verify.no-file", file=file, why=error.strerror or str(error))


def _records_used_twice(facts: tuple[AnyFact, ...]) -> Iterator[Phrase]:
    used: dict[str, tuple[str, int]] = {}
    for fact in facts:
        if isinstance(fact, Played) and fact.record:
            game = (fact.pairing, fact.game)
            if used.setdefault(fact.record, game) != game:
                yield say("verify.record-twice", record=fact.record)


def _check_entries(folder: Path, facts: tuple[AnyFact, ...]) -> Iterator[Phrase]:
    entries = EntryFolder(folder / ENTRIES)
    bots: dict[str, str | None] = {}
    for fact in facts:
        if not isinstance(fact, OfFiles):
            continue
        if fact.files not in bots:
            try:
                bots[fact.files] = entries.load(fact.files).bot
            except UserError as error:
                bots[fact.files] = None
                yield error.phrase
        if bots[fact.files] not in (None, fact.bot):
            yield say("verify.other-bot", team=fact.team)
