"""A whole class at a real gateway with a real studio: students, teacher, and kill -9."""

import csv
import io
import json
import os
import signal
import sys
import urllib.request
import zipfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, nullcontext, suppress
from pathlib import Path
from typing import Any

import psutil
import pytest
from aside import aside
from class_room import ClassRoom, StudentPage, TeacherPage, until_kept
from lacoc_process import run_lacoc
from openpyxl import Workbook
from page_connection import Refused
from typer.testing import CliRunner
from waiting import LIMIT_S

from lacoc_client.commands import class_
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_robots.library import find_robot
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

pytestmark = pytest.mark.slow

SEQUENCES = [[0], [4, 3, 2, 1], [1, 2, 3, 4]]


@pytest.fixture(scope="module")
def room(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ClassRoom]:
    """Give a class that all tests of this file share, each with students of its own."""
    room = ClassRoom(tmp_path_factory.mktemp("class"))
    yield room
    room.close()


@pytest.fixture
def closing() -> Iterator[ExitStack]:
    """Give a stack that closes pages at the end of a test."""
    with ExitStack() as stack:
        yield stack


@pytest.fixture
def teacher(room: ClassRoom, closing: ExitStack) -> TeacherPage:
    page = room.teacher()
    closing.callback(page.close)
    return page


def comes(closing: ExitStack, room: ClassRoom, name: str, token: str | None = None) -> StudentPage:
    """Let a student in; the page closes with the test."""
    page = room.student(name, token)
    closing.callback(page.close)
    return page


def code_of(refusal: pytest.ExceptionInfo[Refused]) -> str:
    return str(refusal.value.reply["error"]["code"])


def edit(page: StudentPage, table: dict[str, Any], angle_deg: float) -> dict[str, Any]:
    """Tell the gateway that a student changed a table's first number by hand; return the table."""
    first, *others = table["rows"]
    row = {**first, "angles_deg": [angle_deg, *first["angles_deg"][1:]]}
    changed = {**table, "rows": [row, *others]}
    page.edits(changed, sequences=SEQUENCES)
    return changed


def test_students_come_in_with_code_and_name(room: ClassRoom, closing: ExitStack) -> None:
    """A wrong code and a bad or taken name are refused; a token lets its student in again."""
    stranger = StudentPage(room.url)
    closing.callback(stranger.close)
    for fields, code in (
        ({}, "class.enter"),
        ({"code": "AAAAAA", "name": "Ada"}, "class.wrong-code"),
        ({"code": room.code, "name": " "}, "class.bad-name"),
        ({"token": "x", "name": "Ada"}, "class.unknown-token"),
    ):
        with pytest.raises(Refused) as refusal:
            stranger.enter(**fields)
        assert code_of(refusal) == code
    stranger.enter(code=f" {room.code.lower()}", name="  Ada  ")
    assert (stranger.hello["student"], stranger.shared.table) == ("Ada", None)
    with pytest.raises(Refused) as refusal:
        comes(closing, room, "ADA")
    assert code_of(refusal) == "class.name-taken"

    again = comes(closing, room, "Ada", stranger.hello["token"])
    table = edit(again, stranger.sample(), 3.5)
    stranger.until(lambda: stranger.told[MessageKind.TABLE])
    stranger.shared.take(stranger.last(MessageKind.TABLE)["update"])
    assert stranger.shared.table == table


def test_a_nickname_without_work_is_free_again(
    room: ClassRoom, teacher: TeacherPage, closing: ExitStack
) -> None:
    """A browser that never got its token enters again; a nickname with work stays its owner's."""
    ola = comes(closing, room, "Ola")
    teacher.until(lambda: teacher.card("Ola").get("online"))
    ola.close()
    teacher.until(lambda: not teacher.card("Ola")["online"])
    ola = comes(closing, room, "ola")
    assert ola.hello["student"] == "ola"
    teacher.until(lambda: teacher.card("ola").get("online"))
    edit(ola, ola.sample(), 3.5)
    ola.close()
    teacher.until(lambda: not teacher.card("ola")["online"])
    with pytest.raises(Refused) as refusal:
        comes(closing, room, "Ola")
    assert code_of(refusal) == "class.name-taken"


def test_whoever_guesses_codes_disturbs_nobody(room: ClassRoom, closing: ExitStack) -> None:
    """Wrong class codes are refused; other students of the same machine still enter and work."""
    student = comes(closing, room, "Bea")
    guesser = StudentPage(room.url)
    closing.callback(guesser.close)
    asks = [guesser.send("hello", code=f"G{number:05}", name="X") for number in range(100)]
    for ask in asks[:20]:
        with pytest.raises(Refused) as refusal:
            guesser.reply(ask)
        assert code_of(refusal) == "class.wrong-code"
    assert comes(closing, room, "Bob").sample()["legs"] == 6
    student.until(lambda: student.last(MessageKind.STUDIO).get("present"))
    assert student.ask("trial", table=student.sample())["ticks"] > 100


@pytest.mark.long
def test_whoever_has_many_workbooks_read_holds_nobody_up(
    room: ClassRoom, closing: ExitStack
) -> None:
    """While the files of one student wait, another student is answered at once."""
    book, data = Workbook(), io.BytesIO()
    for _ in range(600):
        book.active.append(["=1+1"] * 25)
    book.save(data)
    greta, otto = comes(closing, room, "Greta"), comes(closing, room, "Otto")
    pages = [greta, comes(closing, room, "Greta", greta.hello["token"])]
    first, *_ = [
        page.send("parse", name="a.xlsx", data=data.getvalue()) for page in pages for _ in range(8)
    ]
    with pytest.raises(Refused):  # all of them are at the gateway now
        greta.reply(first)
    assert otto.sample()
    for page in pages:
        with suppress(TimeoutError):
            while True:
                page._receive(page.socket.recv(0))
    assert sum(len(page._replies) for page in pages) < 10


def test_the_teacher_sees_what_students_do(
    room: ClassRoom, teacher: TeacherPage, closing: ExitStack
) -> None:
    """A student's trial, raised hand, phase and closed page change the student's card."""
    student = comes(closing, room, "Cem")
    teacher.until(lambda: teacher.card("Cem").get("online"))
    assert (teacher.card("Cem")["feet"], teacher.card("Cem")["tries"]) == (None, 0)
    student.until(lambda: student.last(MessageKind.STUDIO).get("present"))
    student.ask("trial", table=student.sample(), sequences=SEQUENCES, keys="2")
    teacher.until(lambda: teacher.card("Cem")["tries"] == 1)
    card = teacher.card("Cem")
    assert card["last_mm_s"] > 30
    assert card["best_mm_s"] is None  # the sample is nobody's own
    assert len(card["feet"]) == len(card["legs"]) == 6
    assert card["said"]["code"].startswith("explain.")

    student.ask("hand", up=True)
    teacher.until(lambda: teacher.card("Cem")["need"] == "hand")
    assert teacher.card("Cem")["hand_up_s"] > 0
    teacher.ask("lower", student="cem")
    student.until(lambda: not student.phases["hand_up"])
    assert teacher.card("Cem")["hand_up_s"] is None
    student.ask("phase", number=3)
    teacher.until(lambda: teacher.card("Cem")["phase"] == 3)
    student.close()
    teacher.until(lambda: not teacher.card("Cem")["online"])


def test_the_teacher_closes_phases_and_the_coach(
    room: ClassRoom, teacher: TeacherPage, closing: ExitStack
) -> None:
    """Students are told that a phase or the coach is closed, and are refused until it is open."""
    student = comes(closing, room, "Dan")
    table = student.sample()
    rules = {"closed": [4, 5, 6], "coach": "matters", "explain_first": True}
    teacher.ask("rules", rules=rules)
    student.until(lambda: student.phases["rules"] == rules)
    with pytest.raises(Refused) as refusal:
        student.ask("phase", number=4)
    assert code_of(refusal) == "class.phase-closed"
    for do, fields in (
        ("coach", {"size": "cell", "seconds": 1.0}),
        ("map", {"seconds": 1.0}),
        ("variants", {}),
    ):
        with pytest.raises(Refused) as refusal:
            student.ask(do, job="a", table=table, **fields)
        assert code_of(refusal) == "class.coach-closed"
    assert teacher.group["rules"] == rules

    teacher.ask("rules", rules={"closed": [], "coach": "table", "explain_first": False})
    assert student.ask("phase", number=4) == {}
    student.until(lambda: student.last(MessageKind.STUDIO).get("present"))
    for seconds in (float("nan"), float("inf"), 1e308):
        with pytest.raises(Refused) as refusal:
            student.ask("coach", job="a", table=table, size="cell", seconds=seconds)
        assert code_of(refusal) == "studio.coach-seconds"


def test_the_teacher_hands_out_a_table(
    room: ClassRoom, teacher: TeacherPage, closing: ExitStack
) -> None:
    """The sample table or a student's table reaches all students, also one who enters later."""
    student = comes(closing, room, "Eva")
    with pytest.raises(Refused) as refusal:
        teacher.ask("hand_out", title="Eva's", student="Eva")
    assert code_of(refusal) == "class.no-table"
    table = edit(student, student.sample(), 0.0)
    table = edit(student, table, 7.0)
    teacher.ask("hand_out", title="The sample")
    teacher.ask("hand_out", title="Eva's", student="Eva")
    student.until(lambda: student.last(MessageKind.HANDED).get("title") == "Eva's")
    first, second = student.told[MessageKind.HANDED][-2:]
    assert second["number"] == first["number"] + 1
    assert second["table"] == table
    assert second["sequences"] == SEQUENCES
    later = comes(closing, room, "Eve")
    later.until(lambda: later.last(MessageKind.HANDED) == second)
    assert teacher.group["handed"]["title"] == "Eva's"


def test_the_big_screen_and_the_exports(
    room: ClassRoom, teacher: TeacherPage, closing: ExitStack
) -> None:
    """The big screen gets a trial of a student's newest table; evidence and tables are exported."""
    student = comes(closing, room, "=Finn/..")
    table = edit(student, student.sample(), 3.0)
    table = edit(student, table, 4.0)
    shown = teacher.ask("show", student="=Finn/..")
    assert shown["trial"]["ticks"] > 100
    assert len(shown["robot"]["legs"]) == 6
    assert shown["table"] == table

    evidence = teacher.ask("export", what="evidence")
    rows = list(csv.DictReader(io.StringIO(evidence["data"].decode("utf-8-sig"))))
    kinds = [row["kind"] for row in rows if row["student"] == "'=Finn/.."]
    assert kinds[0] == "joined"
    assert "edited" in kinds
    tables = teacher.ask("export", what="tables")
    with zipfile.ZipFile(io.BytesIO(tables["data"])) as archive:
        names = [name for name in archive.namelist() if "Finn" in name]
        assert sorted(name.rpartition("/")[2] for name in names) == [
            "Loco-data.txt",
            "LocoTra-data.txt",
        ]


def test_the_class_plays_a_tournament(
    room: ClassRoom, teacher: TeacherPage, closing: ExitStack
) -> None:
    """The gaits of the class play matches; a gait that does not fit its robot is left out."""
    for name in ("Uma", "りく"):
        page = comes(closing, room, name)
        edit(page, page.sample(), 3.0)
    page = comes(closing, room, "Vik")
    other = {"name": "mine.toml", "data": find_robot("quadruped")[1]}
    page.edits(page.sample(), sequences=SEQUENCES, robot=other)
    teacher.ask("play", arena="othello", rounds=1, seconds=1)
    teacher.until(lambda: teacher.last(MessageKind.TOURNAMENT)["state"] in ("done", "stopped"))
    played = teacher.last(MessageKind.TOURNAMENT)
    assert (played["state"], played["trouble"]) == ("done", None)
    assert played["done"] == played["of"] == len(played["matches"]) >= 1
    assert {"Uma", "りく"} <= {one["name"] for one in played["standings"]}
    (vik,) = (one for one in played["left_out"] if one["name"] == "Vik")
    assert vik["mistakes"][0]["file"] == "Loco-data.txt"
    with urllib.request.urlopen(f"{room.url}/recordings") as listed:
        names = json.load(listed)
    assert all(one["record"] in str(names) for one in played["matches"])


def test_a_class_says_which_pages_it_has(room: ClassRoom) -> None:
    """Without a code: the lesson of one leg is open, and learns here that there is a /design."""
    with urllib.request.urlopen(f"{room.url}/healthz", timeout=LIMIT_S) as answer:
        assert json.load(answer)["pages"] == ["/design", "/class", "/leg", "/replay"]


def test_a_student_is_let_in_again_and_forgotten(
    room: ClassRoom, teacher: TeacherPage, closing: ExitStack
) -> None:
    """A student's second device needs the teacher's permission; a forgotten student is deleted."""
    student = comes(closing, room, "Gil")
    teacher.ask("admit", student="Gil")
    tablet = comes(closing, room, "Gil")
    assert tablet.hello["token"] != student.hello["token"]
    assert comes(closing, room, "Gil", student.hello["token"]).hello["student"] == "Gil"
    with pytest.raises(Refused) as refusal:
        comes(closing, room, "Gil")
    assert code_of(refusal) == "class.name-taken"

    teacher.ask("forget", student="Gil")
    for page in (student, tablet):
        page.until(lambda page=page: page.told[MessageKind.FORGOTTEN])
    assert "Gil" not in teacher.cards
    assert b"Gil" not in teacher.ask("export", what="evidence")["data"]
    with pytest.raises(Refused) as refusal:
        teacher.ask("show", student="Gil")
    assert code_of(refusal) == "class.no-student"


def test_only_the_teacher_opens_the_teachers_page(room: ClassRoom, closing: ExitStack) -> None:
    """Without the page key /class refuses everything and closes the connection."""
    for do, fields in (("hello", {"key": room.code}), ("export", {"what": "evidence"})):
        page = TeacherPage(room.url)
        closing.callback(page.close)
        with pytest.raises(Refused) as refusal:
            page.ask(do, **fields)
        assert code_of(refusal) == "class.wrong-key"
        assert page.code() == 1008
        assert page.group == {}


def test_a_new_code_keeps_everybody_in(
    room: ClassRoom, teacher: TeacherPage, closing: ExitStack
) -> None:
    """After a new class code, tokens still let students in; new students use the new code."""
    student = comes(closing, room, "Hal")
    old = room.code
    teacher.ask("new_code")
    room.code = teacher.group["code"]
    assert room.code != old
    assert comes(closing, room, "Hal", student.hello["token"]).hello["student"] == "Hal"
    assert comes(closing, room, "Ida").hello["student"] == "Ida"


def test_kill_9_loses_nothing(tmp_path: Path, closing: ExitStack) -> None:
    """A killed gateway opens again with its students, tables, settings and evidence."""
    room = ClassRoom(tmp_path)
    student, teacher = room.student("Jo"), room.teacher()
    token = student.hello["token"]
    table = edit(student, student.sample(), 1.0)
    table = edit(student, table, 20.375)
    student.ask("hand", up=True)
    teacher.ask("rules", rules={"closed": [6], "coach": "three"})
    teacher.ask("hand_out", title="The sample")
    children = psutil.Process(room.process.pid).children(recursive=True)
    os.kill(room.process.pid, signal.SIGKILL)
    room.process.communicate()
    _, left = psutil.wait_procs(children, LIMIT_S)
    assert left == []  # the studio has ended with it

    again = ClassRoom(tmp_path, room.listen)
    closing.callback(again.close)
    assert (again.code, again.key) == (room.code, room.key)
    back = comes(closing, again, "Jo", token)
    assert back.shared.table == table
    assert back.phases["rules"] == {"closed": [6], "coach": "three", "explain_first": False}
    back.until(lambda: back.told[MessageKind.HANDED])
    desk = again.teacher()
    closing.callback(desk.close)
    assert desk.card("Jo")["need"] == "hand"
    assert desk.card("Jo")["hand_up_s"] > 1e9


@pytest.mark.skipif(sys.platform != "linux", reason="needs prlimit")
def test_a_full_disk_is_told_to_every_student(tmp_path: Path, closing: ExitStack) -> None:
    """While the disk is full each student reads that nothing is kept; with room, that all is."""
    import resource

    room = ClassRoom(tmp_path)
    closing.callback(room.close)
    ada, bob = comes(closing, room, "Ada"), comes(closing, room, "Bob")
    _, most = resource.prlimit(room.process.pid, resource.RLIMIT_FSIZE)
    resource.prlimit(room.process.pid, resource.RLIMIT_FSIZE, (0, most))
    edit(ada, edit(ada, ada.sample(), 1.0), 11.5)
    for page in (ada, bob):
        page.until(lambda page=page: page.phases["trouble"])
    resource.prlimit(room.process.pid, resource.RLIMIT_FSIZE, (most, most))
    for page in (ada, bob):
        page.until(lambda page=page: page.phases["trouble"] is None)
    until_kept(tmp_path, 11.5)


@pytest.mark.parametrize("missing", ["the studio", "the robot"])
def test_a_class_that_can_not_be_opened_leaves_no_folder(
    missing: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without the server's packages (no studio) or without its robot, a class makes no folder."""

    @contextmanager
    def studio() -> Iterator[str]:
        if missing == "the studio":
            raise UserError(say("doctor.no-server-todo", install="pip"))
        yield "tcp/127.0.0.1:1"

    monkeypatch.setattr(class_, "own_studio", studio)
    folder = tmp_path / "class"
    words = [str(folder), "--no-open", "--listen", "127.0.0.1:0", "--robot", "nobody"]
    done = CliRunner().invoke(class_.app, words)
    assert isinstance(done.exception, UserError)
    assert not folder.exists()
    folder.write_text("")
    monkeypatch.setattr(class_, "own_studio", lambda: nullcontext("tcp/127.0.0.1:1"))
    done = CliRunner().invoke(class_.app, words[:-2])
    assert "Cannot make the folder" in str(done.exception)


@pytest.mark.parametrize("alone", [True, False])
def test_a_robot_without_a_sample_gait_is_told(
    alone: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Phase 5 compares with the sample: the teacher learns before the lesson that there is none."""
    monkeypatch.setattr(class_, "own_studio", lambda: nullcontext("tcp/127.0.0.1:1"))
    monkeypatch.setattr(class_.server, "run", lambda site, opened, ready, most: ready())
    name, data = find_robot("hexapod")
    (tmp_path / name).write_bytes(data)
    robot = str(tmp_path / name) if alone else "hexapod"
    words = [str(tmp_path / "class"), "--no-open", "--listen", "127.0.0.1:0", "--robot", robot]
    done = aside(lambda: CliRunner().invoke(class_.app, words))  # it begins an event loop
    assert done.exit_code == 0
    assert ("no sample gait" in " ".join(done.output.split())) == alone


@pytest.mark.long
def test_the_commands_export_and_forget(tmp_path: Path) -> None:
    """An open class can't be exported or forgotten. Once it is closed, forget leaves no file.

    An export keeps the files of an earlier one.
    """
    room = ClassRoom(tmp_path)
    student = room.student("Kim")
    edit(student, edit(student, student.sample(), 1.0), 2.0)
    for words in (("export",), ("forget", "--yes")):
        done = run_lacoc("class", words[0], str(tmp_path), *words[1:])
        assert done.returncode == 2
        assert "lacoc-class.sqlite" in done.stderr
    room.close()
    (tmp_path / "evidence.csv").write_text("what the teacher wrote into an earlier export")
    done = run_lacoc("class", "export", str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert "teacher" in (tmp_path / "evidence.1.csv").read_text()
    assert b"Kim" in (tmp_path / "evidence.csv").read_bytes()
    assert zipfile.is_zipfile(tmp_path / "tables.zip")
    for name in ("evidence.csv", "evidence.1.csv", "tables.zip"):
        (tmp_path / name).unlink()
    assert run_lacoc("class", "forget", str(tmp_path), "--yes").returncode == 0
    assert list(tmp_path.iterdir()) == []
