"""Tests of a class on disk: kills, damage and a full disk lose nothing; export; deletion."""

import csv
import io
import sqlite3
import subprocess
import sys
import time
import zipfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from tests.campaigns.kill.class_file import OLDEST_S, kill_once

from lacoc_client.workshop.phases.class_file import ClassFile, Document, forget
from lacoc_client.workshop.phases.evidence import (
    Edited,
    Evidence,
    Guessed,
    Hand,
    JoinedClass,
    LegEdit,
    Named,
    Voted,
)
from lacoc_client.workshop.phases.export import evidence_csv, tables_zip
from lacoc_client.workshop.phases.store import ClassStore
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import render

GUESS = Guessed(about="foot", said="up", was=("up", "out"))
EDIT = Edited(version="2", by="hand", legs=(LegEdit(1, 0, 2, (0,), (10.0, 20.0, 30.0)),))


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """Give the path of a class file that does not exist yet."""
    return tmp_path / "class [1].sqlite"  # a name with letters that mean a pattern to `glob`


def table(student: str, version: str, name: str = "Loco-data.txt") -> Document:
    return Document(student, name, version, 1_700_000_000.0, f"{student} {version}".encode())


def names(path: Path) -> set[str]:
    return {one.name for one in path.parent.iterdir()}


def test_what_is_kept_can_be_read_again(path: Path) -> None:
    """After a store is closed and opened again, all evidence and the newest tables are there."""
    with ClassStore(path) as store:
        numbers = [store.add("Ada", one, 1.5).result() for one in (JoinedClass(), EDIT)]
        numbers.append(store.add("りく", GUESS, 2.5).result())
        for version in ("1", "2"):
            store.keep(table("Ada", version))
        store.keep(table("りく", "7"))
    with ClassStore(path) as store:
        kept = store.evidence().result()

        assert numbers == [one.number for one in kept] == [1, 2, 3]
        assert [(one.student, one.at_s) for one in kept] == [("Ada", 1.5)] * 2 + [("りく", 2.5)]
        assert [one.evidence for one in kept] == [JoinedClass(), EDIT, GUESS]
        assert [one.number for one in store.evidence("Ada", after=1).result()] == [2]
        assert store.documents() == [table("Ada", "2"), table("りく", "7")]
        assert store.documents("りく") == [table("りく", "7")]
        assert store.trouble is None
    assert names(path) == {path.name}


def test_a_table_is_on_the_disk_with_the_evidence_after_it(
    path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """When a student's evidence is acknowledged, the student's newest table is on the disk too."""
    monkeypatch.setattr("lacoc_client.workshop.phases.store.DOCUMENT_S", 1e6)
    copy = tmp_path / "copy.sqlite"
    with ClassStore(path) as store:
        store.keep(table("Ada", "1"))
        store.keep(table("Bob", "1"))
        store.add("Ada", EDIT, 1.5).result()
        for end in ("", "-wal"):  # what a killed program leaves
            Path(f"{copy}{end}").write_bytes(Path(f"{path}{end}").read_bytes())
    file = ClassFile(copy)
    assert file.documents() == [table("Ada", "1")]
    assert len(file.evidence()) == 1
    file.close()


def test_a_class_at_once(path: Path) -> None:
    """Eight threads that add evidence at the same time lose nothing and keep their own order."""
    students = [f"student {number}" for number in range(8)]

    def work(student: str) -> list[int]:
        return [store.add(student, EDIT, float(step)).result() for step in range(5)]

    with ClassStore(path) as store, ThreadPoolExecutor(len(students)) as pool:
        numbers = list(pool.map(work, students))
        kept = store.evidence().result()

    assert sorted(number for own in numbers for number in own) == list(range(1, 41))
    for student, own in zip(students, numbers, strict=True):
        mine = [one for one in kept if one.student == student]
        assert [one.number for one in mine] == own
        assert [one.at_s for one in mine] == [0, 1, 2, 3, 4]


def test_a_student_votes_once_and_nobody_sees_for_what(path: Path) -> None:
    """A student's second vote in a poll does not count; the evidence does not have the choice."""
    with ClassStore(path) as store:
        counted = [
            store.vote(who, "calm", choice, 1.0).result()
            for who, choice in (("Ada", "A"), ("Bo", "B"), ("Ada", "B"), ("Cy", "B"))
        ]
        assert counted == [True, True, False, True]
        assert store.votes("calm").result() == {"A": 1, "B": 2}
        assert store.votes("shy").result() == {}
        assert [one.student for one in store.evidence().result()] == ["Ada", "Bo", "Cy"]
    with sqlite3.connect(path) as db:
        rows = db.execute("SELECT * FROM evidence").fetchall()
    assert all('"poll":"calm"' in row[-1] and "choice" not in row[-1] for row in rows)


@pytest.mark.slow
def test_a_killed_program_loses_nothing_that_was_acknowledged(path: Path) -> None:
    """A kill loses no acknowledged evidence, and no table kept more than 2 s before the kill."""
    kills = [kill_once(path, after_s) for after_s in (0.0, 0.11, 2.6)]

    assert [kill.lost for kill in kills] == [0] * len(kills)
    assert kills[-1].acknowledged > kills[0].acknowledged
    assert all(kill.table_lost_s < OLDEST_S + kill.stalled_s for kill in kills)


def test_one_program_at_a_time_has_a_class(path: Path) -> None:
    """While a store has a file open, no other store can open it and `forget` can't delete it."""
    with ClassStore(path) as store:
        for again in (ClassStore, forget):
            with pytest.raises(UserError) as refused:
                again(path)
            assert refused.value.phrase.code == "database.in-use"
        assert store.add("Ada", GUESS, 1.0).result() == 1


def test_a_closed_store_says_so(path: Path) -> None:
    """A closed store refuses evidence and tables with an error; it may be closed twice."""
    store = ClassStore(path)
    store.close()
    store.close()

    with pytest.raises(UserError, match="closed"):
        store.add("Ada", GUESS, 1.0).result()
    with pytest.raises(UserError, match="closed"):
        store.keep(table("Ada", "1"))


@pytest.mark.parametrize("damage", ["no database", "cut in half", "zeros inside"])
def test_a_damaged_file_is_kept_and_the_class_goes_on(path: Path, damage: str) -> None:
    """A file that SQLite can't read is renamed, `trouble` names it, and a fresh file is used."""
    with ClassStore(path) as store:
        for _ in range(200):
            store.add("Ada", EDIT, 1.0)
    whole = path.read_bytes()
    bad = {
        "no database": b"These are no numbers. " * 500,
        "cut in half": whole[: len(whole) // 2],
        "zeros inside": whole[:4096] + bytes(8192) + whole[12288:],
    }[damage]
    path.write_bytes(bad)

    with ClassStore(path) as store:
        assert store.trouble is not None
        kept = path.with_name(str(store.trouble.values["kept"]))
        assert kept.read_bytes() == bad
        assert store.evidence().result() == []
        assert store.add("Ada", GUESS, 2.0).result() == 1
    with ClassStore(path) as store:
        assert store.trouble is None
        assert len(store.evidence().result()) == 1


def test_damage_while_the_class_runs_keeps_everybodys_tables(path: Path) -> None:
    """If the file is damaged while it is open, a fresh file gets new evidence and all tables."""
    large = Document(
        "Ada", "Loco-data.txt", "1", 1.0, bytes(8 << 20)
    )  # too large for SQLite's cache
    with ClassStore(path) as store:
        for _ in range(300):
            store.add("Ada", EDIT, 1.0)
        store.keep(large)
    with ClassStore(path) as store:
        with path.open("r+b") as file:
            file.seek(4096)
            file.write(b"\xff" * (path.stat().st_size - 4096))
        assert store.evidence().result() == []
        assert store.trouble is not None
        assert store.trouble.code == "class.damaged"
        assert store.add("Ada", GUESS, 2.0).result() == 1
    with ClassStore(path) as store:
        assert [one.evidence for one in store.evidence().result()] == [GUESS]
        assert store.documents() == [large]


FULL = """
import resource, sys
from pathlib import Path
from lacoc_client.workshop.phases.evidence import Hand
from lacoc_client.workshop.phases.class_file import Document
from lacoc_client.workshop.phases.store import ClassStore
from lacoc_shared.mistakes import UserError
import signal
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
path = Path(sys.argv[1])
store = ClassStore(path)
store.add("Ada", Hand(up=True), 1.0).result()
size = max(one.stat().st_size for one in path.parent.iterdir())
_, most = resource.getrlimit(resource.RLIMIT_FSIZE)
resource.setrlimit(resource.RLIMIT_FSIZE, (size, most))
try:
    store.add("Ada", Hand(up=False), 2.0).result()
    print("acknowledged")
except UserError as error:
    print(error.phrase.code, store.trouble.code)
store.keep(Document("Ada", "Loco-data.txt", "1", 3.0, b"x"))
resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
print(store.add("Ada", Hand(up=True), 4.0).result(), store.trouble)
store.close()
"""


@pytest.mark.slow
def test_a_full_disk_is_told_and_loses_nothing(path: Path) -> None:
    """New evidence fails with an error; when there is room again, it is written first."""
    done = subprocess.run(
        [sys.executable, "-c", FULL, str(path)], capture_output=True, text=True, check=True
    )

    assert done.stdout.splitlines() == ["database.no-room database.no-room", "3 None"]
    with ClassStore(path) as store:
        hands = [one.evidence for one in store.evidence().result()]
        assert hands == [Hand(up=True), Hand(up=False), Hand(up=True)]
        assert [one.version for one in store.documents()] == ["1"]


def test_the_trouble_goes_when_all_that_waited_is_written(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Not before; a student who is forgotten meanwhile leaves nothing that waits."""
    monkeypatch.setattr("lacoc_client.workshop.phases.store.DOCUMENT_S", 0.05)

    def full(*_: object) -> int:
        error = sqlite3.OperationalError("database or disk is full")
        error.sqlite_errorcode = sqlite3.SQLITE_FULL
        raise error

    with ClassStore(path) as store:
        with monkeypatch.context() as patch:
            patch.setattr(ClassFile, "_add", full)
            works = [store.add("Ada", EDIT, 1.0), store.vote("Ada", "calm", "A", 2.0)]
            works += [store.add(who, GUESS, 3.0) for who in ("Bob", "Ada")]
            assert all(isinstance(work.exception(), UserError) for work in works)
            store.write(table("Ada", "1")).result()
            store.forget("Bob").result()
            assert store.trouble is not None
        deadline_s = time.monotonic() + 10.0
        while store.trouble is not None and time.monotonic() < deadline_s:
            time.sleep(0.01)
        assert store.trouble is None
        kept = store.evidence().result()
        assert [(one.student, one.at_s) for one in kept] == [("Ada", at) for at in (1.0, 2.0, 3.0)]
        assert [one.evidence for one in kept] == [EDIT, Voted(poll="calm"), GUESS]
        assert store.votes("calm").result() == {"A": 1}


def test_another_programs_database_is_left_alone(path: Path) -> None:
    """A database of another program is refused, and stays as it is."""
    with sqlite3.connect(path) as db:
        db.execute("CREATE TABLE photos (name TEXT)")
    db.close()
    before = path.read_bytes()

    for use in (ClassStore, ClassFile, forget):
        with pytest.raises(UserError) as refused:
            use(path)
        assert refused.value.phrase.code == "database.newer"
    assert path.read_bytes() == before
    assert names(path) == {path.name}


def test_a_folder_that_is_not_there(tmp_path: Path) -> None:
    """In a folder that does not exist, a class can't be made, and none can be deleted."""
    with pytest.raises(UserError, match="can't be opened"):
        ClassStore(tmp_path / "nowhere" / "class.sqlite")
    with pytest.raises(UserError, match="There is no file"):
        forget(tmp_path / "nowhere" / "class.sqlite")


def test_forgetting_deletes_everything_of_this_class_alone(path: Path) -> None:
    """`forget` deletes the class, its damaged files and SQLite's files; another class stays."""
    path.write_bytes(b"damaged")
    ClassStore(path).close()
    beside = Path(f"{path}-wal")
    beside.write_bytes(b"left by a kill")
    other = path.with_name("class 1.sqlite")
    ClassStore(other).close()

    deleted = forget(path)

    assert {one.name for one in deleted} >= {path.name, "class [1].damaged-1.sqlite"}
    assert names(path) == {other.name}


def test_evidence_as_a_table_for_a_spreadsheet(path: Path) -> None:
    """The CSV has a line for each piece of evidence; an apostrophe stops formulas in names."""
    given: list[tuple[str, Evidence]] = [
        ("Ada", GUESS),
        ("=HYPERLINK(1)", Named(word="-calm, or so")),
        ("りく", EDIT),
    ]
    with ClassStore(path) as store:
        for student, one in given:
            store.add(student, one, 1_700_000_000.25)
        data = evidence_csv(store.evidence().result())

    assert data.startswith(b"\xef\xbb\xbf")
    lines = list(csv.DictReader(io.StringIO(data.decode("utf-8-sig"))))
    assert [line["number"] for line in lines] == ["1", "2", "3"]
    assert [line["student"] for line in lines] == ["Ada", "'=HYPERLINK(1)", "りく"]
    assert {line["time"] for line in lines} == {"2023-11-14T22:13:20.250+00:00"}
    assert (lines[0]["kind"], lines[0]["was"], lines[0]["right"]) == ("guessed", "up out", "True")
    assert lines[1]["word"] == "'-calm, or so"
    assert lines[2]["legs"] == "[1,0,2,[0],[10.0,20.0,30.0],[]]"


def test_tables_as_an_archive() -> None:
    """In the zip archive each student has a folder with a safe name that no other student has."""
    students = ("Ada", "ada", "../..", "a/b", "りく")
    data = tables_zip(table(student, "1") for student in students)

    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert archive.testzip() is None
        assert archive.namelist() == [
            f"{folder}/Loco-data.txt" for folder in ("Ada", "ada (2)", "_", "a_b", "りく")
        ]
        assert archive.read("りく/Loco-data.txt") == "りく 1".encode()
    assert zipfile.ZipFile(io.BytesIO(tables_zip([]))).namelist() == []


def test_troubles_have_words_in_both_languages(path: Path) -> None:
    """The message about a damaged file gives its new name in both languages."""
    path.write_bytes(b"damaged")
    with ClassStore(path) as store:
        assert store.trouble is not None
        said = render(store.trouble, "en"), render(store.trouble, "ja")
    assert all("class [1].damaged-1.sqlite" in one for one in said)
