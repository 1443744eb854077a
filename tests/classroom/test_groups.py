"""Tests of the groups of a class: pure ones, and some with a real gateway."""

import asyncio
import io
import os
import signal
import zipfile
from collections.abc import AsyncIterator
from contextlib import ExitStack, asynccontextmanager
from pathlib import Path
from typing import Any, cast

import msgspec
import pytest
from aside import run_async
from class_room import ClassRoom, StudentPage, TeacherPage
from page_connection import Refused
from page_table import PageTable
from test_class import SEQUENCES, closing, code_of, comes, edit, room, teacher

from lacoc_client.web.gateway.wire import MessageKind
from lacoc_client.workshop.classroom.classroom import CLASS_FILE, Classroom
from lacoc_client.workshop.classroom.groups.group_state import MEMBERS_MOST, GroupState
from lacoc_client.workshop.classroom.groups.group_tables import OF_GROUP
from lacoc_client.workshop.classroom.kept import student_files
from lacoc_client.workshop.design.requests import GroupAsk, Hello
from lacoc_client.workshop.design.table import FileTable
from lacoc_client.workshop.phases.class_file import ClassFile, Document
from lacoc_client.workshop.phases.evidence import JoinedClass
from lacoc_client.workshop.tables.document import document_of
from lacoc_client.workshop.tables.entries import Entry
from lacoc_shared.mistakes import UserError

__all__ = ["closing", "room", "teacher"]

MADE: dict[str, Entry] = {"shape": "p6", "p6/1.0": True}
MADE |= {f"p6/1.0/{joint}": float(joint) for joint in range(18)}
"""A table of postures with one row."""
FLAT = FileTable(kind="postures", legs=6, rows=())


def test_a_group_has_four_members_at_most() -> None:
    """A fifth member is refused; whoever leaves takes role and vote along."""
    group = GroupState(id="1", name="Ants")
    for name in "ABCD":
        group = group.joined(name)
    assert len(group.members) == MEMBERS_MOST
    assert group.joined("A") == group
    with pytest.raises(UserError):
        group.joined("E")
    group = group.with_role("A", "forward").voted("A", "calm").left("A")
    assert (group.members, group.roles, group.votes) == (("B", "C", "D"), {}, {})
    assert [(one.word, one.by) for one in group.words] == [("calm", "")]


def test_the_word_with_most_votes_is_the_groups() -> None:
    """Each member has one vote and may change it; of equal words the first one counts."""
    group = GroupState(id="1", name="Ants", members=("A", "B", "C"))
    assert group.word == ""
    group = group.voted("A", "calm").voted("B", "proud")
    assert group.word == "calm"
    group = group.voted("C", "proud")
    assert (group.word, group.count("proud")) == ("proud", 2)
    group = group.voted("B", "calm").voted("C", "calm")
    assert (group.word, group.count("proud")) == ("calm", 0)
    for number in range(30):
        group = group.voted("A", f"word {number}")
    assert len(group.words) <= 4, "nobody fills the list alone"


def takes(page: StudentPage) -> None:
    """Take in what the others at the table have done."""
    for news in page.told[MessageKind.TABLE]:
        if "state" in news:
            page.shared = PageTable({**news, "others": 0})
        elif news.get("update") and news["epoch"] == page.shared.opened["epoch"]:
            page.shared.take(news["update"])
            page.shared.seen = news["seq"]
    page.told[MessageKind.TABLE].clear()


def joins(page: StudentPage, name: str) -> None:
    page.ask("group", act="join", text=name)
    page.until(lambda: page.last(MessageKind.GROUP).get("group"))
    takes(page)


@pytest.mark.slow
def test_a_group_has_one_table_and_one_word(
    room: ClassRoom, teacher: TeacherPage, closing: ExitStack
) -> None:
    """Four students edit the founder's table; roles, words and a hand-out are the group's own."""
    ann = comes(closing, room, "Ann")
    table = edit(ann, ann.sample(), 3.5)
    others = [comes(closing, room, name) for name in ("Ben", "Cleo", "Dora")]
    joins(ann, "Ants")
    assert ann.shared.table == table
    for page in others:
        joins(page, "ants")
        assert page.shared.table == table
    outsider = comes(closing, room, "Otto")
    with pytest.raises(Refused) as refusal:
        outsider.ask("group", act="join", text="Ants")
    assert code_of(refusal) == "groups.full"

    for number, page in enumerate(others):
        page.ask("table", **page.shared.put({f"p6/{number + 1}.0/0": 10.0 + number}))
    ann.until(lambda: len(ann.told[MessageKind.TABLE]) >= 3)
    takes(ann)
    assert ann.shared.table is not None
    assert [row["angles_deg"][0] for row in ann.shared.table["rows"][1:4]] == [10.0, 11.0, 12.0]
    for page, word in zip((ann, *others), ("calm", "proud", "proud", "proud"), strict=True):
        page.ask("group", act="word", text=word)
    ann.ask("group", act="role", text="forward")
    others[0].until(lambda: others[0].last(MessageKind.GROUP)["group"]["word"] == "proud")
    others[0].until(
        lambda: others[0].last(MessageKind.GROUP)["group"]["members"][0]["role"] == "forward"
    )
    assert others[0].phases["word"] == "proud"
    teacher.until(lambda: teacher.group["groups"] and teacher.group["groups"][0]["word"] == "proud")
    assert teacher.group["groups"][0]["members"] == ["Ann", "Ben", "Cleo", "Dora"]

    teacher.ask("hand_out", title="For the ants", group="Ants")
    ann.until(lambda: ann.last(MessageKind.HANDED).get("title") == "For the ants")
    outsider.ask("ping", t=0)
    assert outsider.last(MessageKind.HANDED).get("title") != "For the ants"
    assert teacher.ask("show", student="Dora")["table"] == ann.shared.table

    tables = teacher.ask("export", what="tables")
    with zipfile.ZipFile(io.BytesIO(tables["data"])) as archive:
        assert "Ants/Loco-data.txt" in archive.namelist()

    others[0].ask("group", act="leave")
    others[0].until(lambda: others[0].last(MessageKind.GROUP)["group"] is None)
    takes(others[0])
    assert others[0].shared.table is None, "the own table, which is still empty"
    teacher.ask("seat", student="Otto", group="Ants")
    outsider.until(lambda: outsider.last(MessageKind.GROUP)["group"])
    takes(outsider)
    assert outsider.shared.table == ann.shared.table


@pytest.mark.slow
def test_what_a_partner_typed_is_foreign(room: ClassRoom, closing: ExitStack) -> None:
    """Evidence has for each student what this student typed, and nothing of a partner's."""
    eli, fay = comes(closing, room, "Eli"), comes(closing, room, "Fay")
    joins(eli, "Bees")
    joins(fay, "Bees")
    table: dict[str, Any] = eli.sample()
    eli.ask("table", **eli.shared.write(table, SEQUENCES))
    mine = edit(eli, table, 77.0)
    fay.until(lambda: len(fay.told[MessageKind.TABLE]) >= 2)
    takes(fay)
    assert fay.shared.table == mine
    row = {**mine["rows"][1], "angles_deg": [88.0, *mine["rows"][1]["angles_deg"][1:]]}
    fay.edits({**mine, "rows": [mine["rows"][0], row, *mine["rows"][2:]]})
    teacher = room.teacher()
    closing.callback(teacher.close)
    lines = teacher.ask("export", what="evidence")["data"].decode("utf-8-sig").splitlines()
    edits = {name: [line for line in lines if f",{name},edited" in line] for name in ("Eli", "Fay")}
    assert ["77.0" in str(edits[name]) for name in ("Eli", "Fay")] == [True, False]
    assert ["88.0" in str(edits[name]) for name in ("Eli", "Fay")] == [False, True]


@pytest.mark.slow
@pytest.mark.long
def test_kill_9_in_the_middle_of_group_work_loses_nothing(
    tmp_path: Path, closing: ExitStack
) -> None:
    """After kill -9 the group is back with every edit that was answered, also the very last one."""
    room = ClassRoom(tmp_path)
    gil, hana = room.student("Gil"), room.student("Hana")
    edit(gil, gil.sample(), 1.0)
    joins(gil, "Crabs")
    joins(hana, "Crabs")
    gil.ask("group", act="word", text="calm")
    hana.ask("group", act="role", text="turn")
    for number in range(20):
        for page, col in ((gil, 1), (hana, 2)):
            page.ask("table", **page.shared.put({f"p6/{number % 9}.0/{col}": float(number)}))
    os.kill(room.process.pid, signal.SIGKILL)
    room.process.communicate()

    again = ClassRoom(tmp_path, room.listen)
    closing.callback(again.close)
    back = comes(closing, again, "Hana", hana.hello["token"])
    back.until(lambda: back.last(MessageKind.GROUP).get("group"))
    group = back.last(MessageKind.GROUP)["group"]
    assert [one["name"] for one in group["members"]] == ["Gil", "Hana"]
    assert (group["word"], group["members"][1]["role"]) == ("calm", "turn")
    for number in range(11, 20):
        for col in (1, 2):
            assert back.shared.entries[f"p6/{number % 9}.0/{col}"] == number

    teacher = again.teacher()
    closing.callback(teacher.close)
    teacher.ask("forget", student="Hana")
    teacher.until(lambda: teacher.group["groups"][0]["members"] == ["Gil"])
    teacher.ask("forget", student="Gil")
    teacher.until(lambda: teacher.group["groups"] == [])
    assert not any(b"group\n" in file.read_bytes() for file in tmp_path.glob("lacoc-class*"))


class NoStudios:
    """Stands for the studios of a class whose robots do not walk."""

    present, why = 0, None

    def start(self) -> None:
        pass

    def close(self) -> None:
        pass


@asynccontextmanager
async def class_of(folder: Path, *names: str) -> AsyncIterator[Classroom]:
    """Run a class without a network, with these students."""
    room = Classroom(folder, cast(Any, NoStudios()))
    async with room.running():
        await room.open()
        for name in names:
            await room.enter(Hello(id=0, code=room.state.code, name=name), "")
        yield room


def test_students_who_move_at_the_same_time_are_in_one_group_each(tmp_path: Path) -> None:
    """Two who make the same group share it; one who presses twice is in the last one only."""

    async def move() -> None:
        async with class_of(tmp_path, "Ann", "Ben", "Cleo") as room:
            ann, ben, cleo = room.students.values()
            groups = room.groups
            await groups.join(ann, "Alone")
            await asyncio.gather(groups.join(ann, "Ants"), groups.join(ben, "ants"))
            assert [one.members for one in groups.states.values()] == [("Ann", "Ben")]
            await asyncio.gather(groups.join(ann, "Bees"), groups.join(ann, "Crabs"))
            assert {one.name: one.members for one in groups.states.values()} == {
                "Ants": ("Ben",),
                "Crabs": ("Ann",),
            }
            asked = GroupAsk(id=0, act="join", text="Ants")
            await asyncio.gather(room.forget(cleo), room.group(cleo, asked))
            assert groups.find("Ants").members == ("Ben",)
            assert ann.table.name == groups.find("Crabs").id

    run_async(move)


def test_what_a_group_made_stays_for_who_comes_back(tmp_path: Path) -> None:
    """Also over a restart, in the export, until the last member is forgotten."""

    async def leave() -> None:
        async with class_of(tmp_path, "Ann", "Ben") as room:
            ann, ben = room.students.values()
            for one in (ann, ben):
                await room.groups.join(one, "Ants")
            table = room.groups._tables[room.groups.find("Ants").id]
            table.replace(document_of(MADE))
            await table.keep_now()
            await room.groups.leave(ben)
            await room.groups.leave(ann)
            await room.groups.join(ann, "Bees")
            await room.groups.leave(ann)  # in Bees nothing was made
            assert [one.name for one in room.groups.states.values()] == ["Ants"]
            assert room.groups.drafts() == {}, "nobody would play with it"
        async with class_of(tmp_path) as again:
            ann, ben = (again.find(name) for name in ("Ann", "Ben"))
            assert "Ants" in {one.student for one in student_files(await again.documents())}
            await again.groups.join(ben, "ants")
            assert MADE.items() <= ben.table._document.entries.items()
            await again.groups.leave(ben)
            await again.forget(ann)
            assert again.groups.find("Ants")
            await again.forget(ben)
            assert again.groups.states == {}
            owners = {one.student[:6] for one in await again.documents()}
            assert OF_GROUP not in owners

    run_async(leave)


def test_what_one_member_took_is_offered_to_no_other(tmp_path: Path) -> None:
    """The table is all members' own; whoever comes later is not asked either."""

    async def take() -> None:
        async with class_of(tmp_path, "Ann", "Ben") as room:
            ann, ben = room.students.values()
            for one in (ann, ben):
                await room.groups.join(one, "Ants")
            await room.hand_out("A gait", FLAT, None)
            await room.group(ann, GroupAsk(id=0, act="take", number=99))
            assert room.groups.find("Ants").taken == 1
            assert b"\xa5taken\x01" in room.groups.message(ben)
            await room.hand_out("Another", FLAT, None, "Ants")
            assert room.groups.find("Ants").taken == 1

    run_async(take)


def test_a_forgotten_student_s_table_is_offered_to_nobody(tmp_path: Path) -> None:
    """Neither to the class nor to a group, and it is not in the class file."""

    async def forget() -> None:
        async with class_of(tmp_path, "Ann", "Ben", "Cleo") as room:
            ann, ben, cleo = room.students.values()
            await room.groups.join(ben, "Ants")
            await room.hand_out("Table of Ann", FLAT, None, "", ann.name)
            await room.hand_out("Table of Ann", FLAT, None, "Ants", ann.name)
            await room.forget(cleo)
            assert room.state.handed is not None
            await room.forget(ann)
            assert (room.state.handed, room.groups.find("Ants").handed) == (None, None)
            assert b"Table of Ann" not in b"".join(one.content for one in await room.documents())

    run_async(forget)


def test_a_forgotten_student_s_proposals_go_from_all_tables(tmp_path: Path) -> None:
    """Also from the table of a group that the student has left before."""

    async def forget() -> None:
        async with class_of(tmp_path, "Ann", "Ben") as room:
            ann, ben = room.students.values()
            await room.groups.join(ann, "Ants")
            await room.groups.join(ben, "Ants")
            state = room.groups.find("Ants")
            table = room.groups._tables[state.id]
            proposal = {"p1/0.0/1?": '{"by":"Ben","text":"1"}'}
            table.replace(document_of({**table._document.entries, **proposal}))
            await room.groups.leave(ben)
            assert "Ben" in str(table._document.entries)
            await room.forget(ben)
            assert "Ben" not in str(room.groups._tables[state.id]._document.entries)

    run_async(forget)


def test_one_student_does_not_use_up_what_all_may_change(tmp_path: Path) -> None:
    """Whoever changes too much is refused, and others are not."""

    async def flood() -> None:
        async with class_of(tmp_path, "Ann", "Ben") as room:
            ann, ben = room.students.values()
            for one in (ann, ben):
                await room.group(one, GroupAsk(id=0, act="join", text="Ants"))
            role = GroupAsk(id=0, act="role", text="forward")
            done = await asyncio.gather(
                *(room.group(ann, role) for _ in range(60)), return_exceptions=True
            )
            assert sum(isinstance(one, UserError) for one in done) >= 30
            await room.group(ben, GroupAsk(id=0, act="word", text="calm"))

    run_async(flood)


def test_a_program_that_ended_halfway_leaves_no_ghosts(tmp_path: Path) -> None:
    """A member who was deleted, and a table whose group has ended, are gone at the next start."""

    async def end() -> None:
        async with class_of(tmp_path, "Ann", "Ben", "Cleo") as room:
            ann, ben, cleo = room.students.values()
            for one, name in ((ann, "Ants"), (ben, "Ants"), (cleo, "Bees")):
                await room.groups.join(one, name)
        file = ClassFile(tmp_path / CLASS_FILE)
        for one in (ben, cleo):
            file.forget(one.name)
        file.write_documents([Document(OF_GROUP + "lost", "table", "", 0.0, b"")])
        file.close()
        async with class_of(tmp_path) as again:
            assert [(one.name, one.members) for one in again.state.groups] == [("Ants", ("Ann",))]
            assert again.find("Ann").table.name == again.state.groups[0].id
            owners = {one.student for one in await again.documents() if one.student[:6] == OF_GROUP}
            assert owners == {OF_GROUP + again.state.groups[0].id}

    run_async(end)


def test_settings_that_can_not_be_read_are_kept_with_all_groups_tables(tmp_path: Path) -> None:
    """The class begins with new settings; the old ones and the tables of groups stay."""
    unread = Document("", "class", "", 5.0, b'{"code":"ABC","key":"k","groups":7}')

    async def owners_of(*names: str) -> set[str]:
        async with class_of(tmp_path, *names) as room:
            for student in room.students.values():
                await room.groups.join(student, "Ants")
            kept = await room.documents()
            assert [one.content for one in kept if one.at_s == 5.0] == [unread.content]
            return {one.student for one in kept if one.student[:6] == OF_GROUP}

    async def begin() -> None:
        file = ClassFile(tmp_path / CLASS_FILE)
        file.write_documents([unread, Document(OF_GROUP + "old", "table", "", 0.0, b"")])
        file.close()
        assert await owners_of() == {OF_GROUP + "old"}
        owners = await owners_of("Ann")
        assert len(owners) == 2
        assert await owners_of() == owners

    run_async(begin)


def test_a_class_of_an_earlier_version_goes_on(tmp_path: Path) -> None:
    """Its drafts are tables, and the next table that is handed out is the newest."""
    table = {"kind": "postures", "legs": 1, "rows": [{"key": 0, "angles_deg": [1.0, 2.0, 3.0]}]}
    old = {"code": "ABC", "key": "k", "handed": {"number": 3, "title": "A", "table": table}}
    draft = msgspec.msgpack.encode({"table": table, "saved": False})
    file = ClassFile(tmp_path / CLASS_FILE)
    file.add("学生", JoinedClass(), 0.0)
    file.write_documents(
        [
            Document("", "class", "", 0.0, msgspec.json.encode(old)),
            Document("学生", "draft", "7", 0.0, draft),
        ]
    )
    assert [one.student for one in student_files(file.documents())] == ["学生"]
    file.close()

    async def go_on() -> None:
        async with class_of(tmp_path) as room:
            student = room.find("学生")
            assert student.draft is not None
            assert student.draft.table.rows[0].angles_deg == (1.0, 2.0, 3.0)
            await room.hand_out("B", student.draft.table, None)
            assert room.state.handed is not None
            assert room.state.handed.number == 4
            await room.groups.join(student, "学生")
            files = student_files(await room.documents())
            assert sorted(one.student for one in files) == ["学生", "学生 (group)"]

    run_async(go_on)


@pytest.mark.parametrize(
    ("shape", "bad", "name", "text"),
    [
        ("p1", None, "unfinished-Loco-data.txt", "Num of Posture\t1\n3 Key\t1\t\t-2.5\n"),
        ("p1", "=A1", "unfinished-Loco-data.txt", "Num of Posture\t1\n3 Key\t1\t\t-2.5\n"),
        ("p1", 500.0, "unfinished-Loco-data.txt", "Num of Posture\t1\n3 Key\t1\t500\t-2.5\n"),
        ("l1", None, "unfinished-LocoTra-data.txt", "1\n1\n1\t\t-2.5\n"),
    ],
)
def test_an_unfinished_table_is_exported_too(
    shape: str, bad: Entry | None, name: str, text: str
) -> None:
    """Its file has all its angles, and a name that says so; the student's robot is there, too."""
    entries: dict[str, Entry] = {"shape": shape, "robot": '{"name":"a.toml","text":"[body]"}'}
    entries |= {f"{shape}/3.0": True, f"{shape}/3.0/0": 1.0, f"{shape}/3.0/2": -2.5}
    if bad is not None:
        entries[f"{shape}/3.0/1"] = bad
    kept = Document("Ann", "table", "7", 5.0, document_of(entries).state)
    files = {one.name: one.content.decode() for one in student_files([kept])}
    assert files == {"robot.toml": "[body]", name: text}
