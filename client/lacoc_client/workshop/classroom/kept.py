"""Exports of a class: evidence and tables as files for a teacher."""

from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from lacoc_client.workshop.classroom.groups.group_state import group_title
from lacoc_client.workshop.classroom.groups.group_tables import OF_GROUP
from lacoc_client.workshop.classroom.state import NAME, NOBODY, read_state
from lacoc_client.workshop.phases.class_file import ClassFile, Document
from lacoc_client.workshop.phases.export import evidence_csv, tables_zip
from lacoc_client.workshop.tables.document import TableDocument
from lacoc_client.workshop.tables.draft import files_of
from lacoc_client.workshop.tables.kept_table import kept_table
from lacoc_shared.command.database import Damaged
from lacoc_shared.mistakes import UserError, text_of
from lacoc_shared.words import say

EVIDENCE, TABLES = "evidence.csv", "tables.zip"


def student_files(kept: Iterable[Document]) -> list[Document]:
    """Return the gait and robot files that the tables in a class file stand for.

    A group's files are under the group's name.
    """
    kept = list(kept)
    by_owner: dict[str, list[Document]] = {}
    for one in kept:
        by_owner.setdefault(one.student, []).append(one)
    states = [read_state(one) for one in kept if (one.student, one.name) == (NOBODY, NAME)]
    groups = [group for state in states if state for group in state.groups]
    titles = {OF_GROUP + one.id: group_title(one.name, by_owner) for one in groups}
    found = []
    for owner, documents in by_owner.items():
        table = kept_table(documents)
        if table is None:
            continue
        with suppress(UserError):  # of another version of this program
            found += [
                Document(titles.get(owner, owner), name, table.version, table.at_s, data)
                for name, data in files_of(TableDocument(table.content).entries).items()
            ]
    return found


def export(path: Path) -> dict[str, bytes]:
    """Export the evidence and tables of a class; return the files by name.

    Raises:
        UserError: if there is no such file, another program has it open, or it is damaged.
    """
    if not path.exists():
        raise UserError(say("class.none", file=text_of(path)))
    try:
        file = ClassFile(path)
    except Damaged as error:
        raise UserError(say("database.cannot-open", file=text_of(path), why=str(error))) from None
    try:
        return {
            EVIDENCE: evidence_csv(file.evidence()),
            TABLES: tables_zip(student_files(file.documents())),
        }
    finally:
        file.close()
