"""Writes a contest as a folder that anybody can read, serve as a website, and check."""

import shutil
from collections.abc import Iterable, Sequence
from pathlib import Path

from lacoc_server.contest.kept.entries import EntryFolder
from lacoc_server.contest.kept.folder import ContestFolder, file_hash
from lacoc_server.contest.league import facts as league_facts
from lacoc_server.contest.league import sheet as sheets
from lacoc_server.contest.league.contest import compute
from lacoc_server.contest.league.facts import AnyFact, Entered, FilesChanged, Played
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.sheet import ContestSheet
from lacoc_shared.command import plugins, regular
from lacoc_shared.command.csv_text import csv_text
from lacoc_shared.command.replacing import replace, write
from lacoc_shared.contest import file as contests
from lacoc_shared.mistakes import UserError, text_of
from lacoc_shared.record import pack
from lacoc_shared.record.files import segment_paths
from lacoc_shared.words import say

FACTS, SHEET, STANDINGS, GAMES = "facts.json", "contest.json", "standings.csv", "games.csv"
ENTRIES, RECORDS = contests.ENTRIES, "records"
"""Names of the files and folders in a published folder."""
_SITES = "lacoc.site"
"""Group of the entry points that add pages: each is a function that takes the published folder."""


def publish(folder: ContestFolder, facts: Sequence[AnyFact], out: Path) -> None:
    """Write a contest as a folder: facts, sheet, tables, entries, records and pages.

    The folder can be written again while the contest goes on, but not by another contest. Each file
    is replaced in one step, the sheet as the last one. The files of teams are left out until
    entries are closed. Records are written whatever the contest file says about replays, and the
    sheet names them.

    Args:
        folder: the contest.
        facts: its facts.
        out: the folder to write.

    Raises:
        UserError: if the folder has another contest, a record or an entry is missing or has
            changed, or something can't be written.
    """
    earlier = _facts_in(out)
    if earlier != tuple(facts[: len(earlier)]):
        raise UserError(say("contest.other-published", folder=text_of(out)))
    contest = compute(facts, FORMATS)
    sheet = sheets.sheet(folder.contest.name, contest)
    try:
        for name in (ENTRIES, RECORDS):
            (out / name).mkdir(parents=True, exist_ok=True)
        for name, wanted in sorted(records_of(facts).items()):
            _save_record(folder.records / name, out / RECORDS / name, wanted)
        entries = EntryFolder(out / ENTRIES)
        for entry in sorted(entries_of(facts)) if contest.closed else ():
            entries.save(folder.entries.load(entry))
        write(out / FACTS, league_facts.encode(facts))
        for name, content in tables(sheet).items():
            write(out / name, content)
        for site in plugins.installed(_SITES).values():
            site.load()(out)
        write(out / SHEET, sheets.encode(sheet))
    except OSError as error:
        why = error.strerror or str(error)
        path = str(error.filename or out)
        raise UserError(say("command.cannot-write", path=path, why=why)) from None


def _facts_in(folder: Path) -> tuple[AnyFact, ...]:
    """Return the facts in a published folder; none, if there are none that can be read."""
    try:
        return league_facts.decode((folder / FACTS).read_bytes())
    except (OSError, UserError):  # publishing again mends a damaged folder
        return ()


def tables(sheet: ContestSheet) -> dict[str, bytes]:
    """Return the tables of a contest as CSV, by file name; spreadsheets open them.

    The first line of each has the names of the columns.
    """
    return {STANDINGS: csv_text(_standings(sheet)), GAMES: csv_text(_games(sheet))}


def records_of(facts: Iterable[AnyFact]) -> dict[str, str]:
    """Return the hash of each record by its file name; "": the facts do not have this hash."""
    played = (fact for fact in facts if isinstance(fact, Played) and fact.record)
    return {Path(fact.record).name: fact.record_hash for fact in played}


def entries_of(facts: Iterable[AnyFact]) -> set[str]:
    """Return the hashes of all entries that the facts name."""
    return {fact.files for fact in facts if isinstance(fact, Entered | FilesChanged) and fact.files}


def _save_record(source: Path, to: Path, wanted: str) -> None:
    """Copy a record into one file, also if it is still in segments because its court has it open.

    Raises:
        UserError: if it is missing, or its hash is not the one in the facts.
    """
    segments = segment_paths(source.parent, source.stem)
    try:
        if segments and not regular.is_regular(source):
            replace(to, lambda part: pack.write_packed(pack.read_messages(segments), part))
            return
    except UserError:
        if not regular.is_regular(source):  # else the court has packed it meanwhile
            raise
    _copy(source, to, wanted)


def _copy(source: Path, to: Path, wanted: str) -> None:
    """Copy a record to the path `to`, unless the same record is at this path already.

    Raises:
        UserError: if it is missing, or its hash is not the one in the facts.
    """
    if not regular.is_regular(source):
        raise UserError(say("contest.no-record", file=str(source)))
    found = file_hash(source)
    if wanted not in ("", found):
        raise UserError(say("contest.record-changed", file=str(source)))
    if regular.is_regular(to) and file_hash(to) == found:
        return
    replace(to, lambda part: shutil.copyfile(source, part))


def _standings(sheet: ContestSheet) -> list[Sequence[object]]:
    header = "stage group rank team points won drawn lost scored conceded decided_by"
    found = [(view, table) for view in sheet.stages for table in view.tables]
    codes = list(dict.fromkeys(code for _, table in found for code in table.tie_breaks))
    rows: list[Sequence[object]] = [[*header.split(), *codes]]
    for view, table in found:
        for row in table.rows:
            score = (row.points, row.won, row.drawn, row.lost, row.scored, row.conceded)
            values = dict(zip(table.tie_breaks, row.tie_breaks, strict=False))
            rows.append(
                [view.name, table.section, row.rank, row.team, *score, row.decided_by]
                + [values.get(code, "") for code in codes]
            )
    return rows


def _games(sheet: ContestSheet) -> list[Sequence[object]]:
    header = "stage pairing game left right left_score right_score outcome record"
    rows: list[Sequence[object]] = [header.split()]
    for view in sheet.stages:
        for match in view.matches:
            for game in match.games:
                place = (view.name, match.pairing.id, game.number)
                rows.append([*place, *game.teams, *game.scores, game.outcome, game.record])
    return rows
