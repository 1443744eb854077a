"""Tests of the file of a contest's facts: appended, never changed, whole after a kill."""

import resource
import signal
import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest
from waiting import LIMIT_S

from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.facts import Announced, Closed, Entered, Shifted, Withdrawn, new
from lacoc_shared.mistakes import UserError

APPEND = """
import sys
from pathlib import Path
from lacoc_server.contest.league.facts import Entered, new
from lacoc_server.contest.kept.store import FactStore

name, count = sys.argv[2], int(sys.argv[3])
with FactStore(Path(sys.argv[1])) as store:
    print("open", flush=True)
    for number in range(count):
        store.append(*(new(Entered, team=f"{name}{number}-{part}") for part in "ab"))
        print(number, flush=True)
"""


def appending(path: Path, name: str, count: int) -> subprocess.Popen[str]:
    """Start a program that appends pairs of facts, and wait until it has the file open."""
    words = [sys.executable, "-c", APPEND, str(path), name, str(count)]
    program = subprocess.Popen(words, stdout=subprocess.PIPE, text=True)
    assert program.stdout is not None
    assert program.stdout.readline() == "open\n"
    return program


def test_a_fact_that_could_not_be_read_again_is_not_kept(tmp_path: Path) -> None:
    """A text that is too long is refused with its limit; all facts can still be read."""
    with FactStore(tmp_path / "facts.db") as store:
        store.append(new(Entered, team="Ann"))
        with pytest.raises(UserError, match=r'"text" is too long: at most 200'):
            store.append(new(Entered, team="Bob"), new(Announced, text="x" * 201))
        with pytest.raises(UserError, match="can't be kept"):
            store.append(new(Shifted, by_ms=-1))
    with FactStore(tmp_path / "facts.db", by="x" * 65) as store:
        with pytest.raises(UserError, match=r'"by" is too long: at most 64'):
            store.append(new(Closed))
        assert [type(fact) for fact in store.facts()] == [Entered]


@pytest.mark.slow
def test_two_programs_append_and_one_is_killed(tmp_path: Path) -> None:
    """Two programs append pairs of facts; after one is killed, no pair is lost or broken."""
    path = tmp_path / "facts.db"
    first, second = appending(path, "x", 50), appending(path, "y", 100_000)
    assert second.stdout is not None
    seen = [int(second.stdout.readline()) for _ in range(30)]
    second.send_signal(signal.SIGKILL)
    assert first.wait(LIMIT_S) == 0
    second.wait(LIMIT_S)
    with FactStore(path) as store:
        store.append(new(Closed))
        facts = store.facts()
    assert [fact.number for fact in facts] == [*range(1, len(facts) + 1)]
    assert [fact.id for fact in facts] == [f"f{fact.number}" for fact in facts]
    teams = [fact.team for fact in facts if isinstance(fact, Entered)]
    wanted = {f"x{number}-{part}" for number in range(50) for part in "ab"}
    wanted |= {f"y{number}-{part}" for number in seen for part in "ab"}
    assert wanted <= {*teams}
    assert teams[0::2] == [team.replace("-b", "-a") for team in teams[1::2]]


def test_a_decision_sees_all_facts_and_appends_all_or_nothing(tmp_path: Path) -> None:
    """`decide` sees facts that another store appended; after an error it appends nothing."""
    path = tmp_path / "facts.db"
    with FactStore(path) as store, FactStore(path) as other:
        other.append(new(Entered, team="Ann"))
        store.decide(lambda facts: [new(Withdrawn, team=fact.team) for fact in facts])
        with pytest.raises(ZeroDivisionError):
            store.decide(lambda facts: [new(Closed), 1 / 0])
        assert [fact.id for fact in store.facts()] == ["f1", "f2"]
        assert store.facts() == other.facts()
        assert isinstance(store.facts()[1], Withdrawn)


def test_facts_stay_as_they_are(tmp_path: Path) -> None:
    """The database refuses to change or delete a fact."""
    path = tmp_path / "facts.db"
    with FactStore(path) as store:
        store.append(new(Entered, team="Ann"))
    db = sqlite3.connect(path)
    for change in ("UPDATE facts SET body = '{}'", "DELETE FROM facts"):
        with pytest.raises(sqlite3.IntegrityError, match="facts stay"):
            db.execute(change)
    db.close()


def test_a_full_disk_appends_nothing(tmp_path: Path) -> None:
    """If the file can't grow, nothing is appended and the error names the file.

    When there is room again, facts can be appended. A limit for this process's files acts as the
    full disk.
    """
    path = tmp_path / "facts.db"
    with FactStore(path) as store:
        store.append(new(Entered, team="Ann"))
        _, most = resource.getrlimit(resource.RLIMIT_FSIZE)
        handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        size = max(one.stat().st_size for one in tmp_path.iterdir())
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, most))
        try:
            with pytest.raises(UserError, match=r"facts\.db"):
                store.append(*(new(Entered, team=f"{number:060}") for number in range(2000)))
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
            signal.signal(signal.SIGXFSZ, handler)
        assert len(store.facts()) == 1
        store.append(new(Closed))
        assert [fact.id for fact in store.facts()] == ["f1", "f2"]


@pytest.mark.parametrize(
    ("part", "said"),
    [
        (b"SQLite", r"facts\.db, which keeps the facts .* is damaged"),
        (b'{"fact":', "facts .* can't be read"),
    ],
)
def test_a_damaged_file_is_told(tmp_path: Path, part: bytes, said: str) -> None:
    """A damaged file is reported and not changed; a database of something else is refused."""
    path = tmp_path / "facts.db"
    with FactStore(path) as store:
        store.append(*(new(Entered, team=f"{number:060}") for number in range(300)))
    data = bytearray(path.read_bytes())
    at = data.index(part)
    data[at : at + 6] = b"UUUUUU"
    path.write_bytes(data)
    with pytest.raises(UserError, match=said), FactStore(path) as store:
        store.facts()
    assert path.read_bytes() == bytes(data)
    other = tmp_path / "other.db"
    sqlite3.connect(other).executescript("CREATE TABLE other (number INTEGER)").connection.close()
    with pytest.raises(UserError, match=r"other\.db"):
        FactStore(other)
