"""Tests that nothing of a forgotten student stays, whatever happens at the same moment."""

import asyncio
import subprocess
import sys
from pathlib import Path

import pytest
from aside import run_async

from lacoc_client.workshop.classroom.class_student import ClassStudent
from lacoc_client.workshop.classroom.classroom import CLASS_FILE, Classroom
from lacoc_client.workshop.design.learning.diary import Diary
from lacoc_client.workshop.design.learning.keeper import Keeper
from lacoc_client.workshop.design.learning.student import TABLE
from lacoc_client.workshop.design.requests import Hello
from lacoc_client.workshop.design.studios.asker import Asker
from lacoc_client.workshop.design.studios.studios import Studios
from lacoc_client.workshop.design.table import FileTable
from lacoc_client.workshop.phases.class_file import ClassFile
from lacoc_client.workshop.phases.evidence import Named, WentToPhase
from lacoc_client.workshop.tables.draft import Draft
from lacoc_shared.mistakes import UserError

WORD = "a-word-that-only-ada-has"
DRAFT = Draft(table=FileTable(kind="postures", legs=6, rows=()))


def test_what_comes_later_is_not_kept(tmp_path: Path) -> None:
    """Evidence, votes and tables that come after their student was forgotten are not kept."""
    path = tmp_path / CLASS_FILE

    async def forget() -> None:
        keeper = Keeper(path)
        diary, other = Diary(keeper, "Ada"), Diary(keeper, "Bo")
        await diary.add(Named(word=WORD))
        await diary.write(TABLE, WORD.encode())
        assert any(WORD.encode() in file.read_bytes() for file in tmp_path.iterdir())
        await asyncio.gather(diary.forget(), diary.add(WentToPhase(phase=2)))
        await diary.add(Named(word=WORD))
        await diary.vote(WORD, "A")
        await diary.write(TABLE, WORD.encode())
        await other.add(WentToPhase(phase=1))
        assert not any(WORD.encode() in file.read_bytes() for file in tmp_path.iterdir())
        await keeper.close()

    run_async(forget)
    file = ClassFile(path)
    assert [one.student for one in file.evidence()] == ["Bo"]
    assert file.documents() == []
    assert file.votes(WORD) == {}
    file.close()
    assert WORD.encode() not in path.read_bytes()


def test_whoever_is_forgotten_while_coming_in_is_not_in(tmp_path: Path) -> None:
    """A student who is forgotten while entering the class leaves no evidence and no token."""
    room = Classroom(tmp_path, Studios([Asker("tcp/127.0.0.1:1")]))

    async def forget() -> None:
        await room.open()
        hello = Hello(id=1, code=room.state.code, name="Ada")
        coming = asyncio.create_task(room.enter(hello, "10.0.0.1"))
        await asyncio.sleep(0)
        ada: ClassStudent = room.find("Ada")
        await room.forget(ada)
        await asyncio.wait({coming})  # either refused, or in before and sent away
        assert room.students == {}
        back = await room.enter(hello, "10.0.0.1")
        assert room.find("Ada") is back.student is not ada
        await room.forget(room.find("Ada"))
        await room._keeper.close()

    run_async(forget)
    file = ClassFile(tmp_path / CLASS_FILE)
    assert file.evidence() == []
    assert {table.student for table in file.documents()} == {""}
    file.close()


def test_what_counts_is_kept_though_the_page_goes(tmp_path: Path) -> None:
    """If a page closes while its evidence is being written, the evidence is kept."""
    path = tmp_path / CLASS_FILE

    async def go() -> None:
        keeper = Keeper(path)
        first = asyncio.create_task(keeper.opened())
        await asyncio.sleep(0)
        first.cancel()
        assert await keeper.opened() is not None, keeper.trouble
        diary = Diary(keeper, "Ada")
        await diary.add(WentToPhase(phase=1))
        for number in range(2, 7):
            moving = asyncio.create_task(diary.add(WentToPhase(phase=number)))
            await asyncio.sleep(0)
            moving.cancel()
        await keeper.close()

    run_async(go)
    file = ClassFile(path)
    assert [one.evidence for one in file.evidence()] == [WentToPhase(phase=n) for n in range(1, 7)]
    file.close()


def test_empty_nicknames_keep_nobody_out(tmp_path: Path) -> None:
    """In a full class a new nickname replaces one without work; students with work stay."""
    room = Classroom(tmp_path, Studios([Asker("tcp/127.0.0.1:1")]))

    async def fill() -> None:
        await room.open()

        async def comes(name: str) -> ClassStudent:
            await room.enter(Hello(id=1, code=room.state.code, name=name), "10.0.0.1")
            return room.find(name)

        ada = await comes("Ada")
        await ada.diary.add(WentToPhase(phase=2))
        crowd = [comes(f"N{number}") for number in range(150)]
        await asyncio.gather(*crowd, return_exceptions=True)  # some make room for others at once
        bo = await comes("Bo")
        assert len(room.students) == 100
        assert room.find("Ada") is ada
        assert room.find("Bo") is bo
        for student in room.students.values():
            student.table._draft, student.table.is_touched = DRAFT, True
        with pytest.raises(UserError):
            await comes("Cy")
        await room._keeper.close()

    run_async(fill)


FULL = """
import asyncio, resource, signal, sys
from pathlib import Path
from lacoc_client.workshop.design.learning.diary import Diary
from lacoc_client.workshop.design.learning.keeper import Keeper
from lacoc_client.workshop.design.learning.student import TABLE
from lacoc_client.workshop.phases.evidence import WentToPhase
from lacoc_shared.mistakes import UserError

async def forget(path):
    keeper = Keeper(path)
    diary = Diary(keeper, "Ada")
    for phase in (1, 2):
        await diary.add(WentToPhase(phase=phase))
    size = max(one.stat().st_size for one in path.parent.iterdir())
    _, most = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, most))
    try:
        await diary.forget()
        print("forgotten")
    except UserError as error:
        print(error.phrase.code)
    resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
    await diary.add(WentToPhase(phase=3))
    store = await keeper.opened()
    print(len(await asyncio.wrap_future(store.evidence())))
    await diary.forget()
    print(len(await asyncio.wrap_future(store.evidence())))
    await keeper.close()

signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
asyncio.run(forget(Path(sys.argv[1])))
"""


@pytest.mark.slow
def test_a_full_disk_forgets_later(tmp_path: Path) -> None:
    """If the disk is full, a student is not forgotten, goes on, and can be forgotten later."""
    words = [sys.executable, "-c", FULL, str(tmp_path / CLASS_FILE)]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["database.no-room", "3", "0"]
