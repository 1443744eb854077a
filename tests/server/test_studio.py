"""Tests of a studio in a process of its own, over a real network connection."""

import math
import os
import signal
import subprocess
import threading
from collections.abc import Collection, Iterator
from contextlib import suppress

import msgspec
import numpy as np
import psutil
import pytest
from lacoc_process import Running
from sample_walks import entry_of
from waiting import LIMIT_S, until

from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_robots.robot_file import read_robot
from lacoc_server.match.entry import weigh_in
from lacoc_server.simulate.workers import Workers
from lacoc_server.studio.answers import answer, read_files, try_gait
from lacoc_server.studio.coach.coach import coach, reply_of, task_of
from lacoc_server.studio.coach.improve import Size
from lacoc_server.studio.coach.trials import Trials
from lacoc_server.trial.course import LONGEST_TICKS
from lacoc_server.trial.reasons.goal import Goal
from lacoc_server.trial.support import margins_m
from lacoc_server.world.sensed import make_course
from lacoc_shared.codec import decode, encode
from lacoc_shared.gait.tables import Gait, Level, LocomotionTable, PostureTable
from lacoc_shared.gait.text import write_gait
from lacoc_shared.messages import PROTOCOL, Done, Refusal, SentFile
from lacoc_shared.mistakes import FileRefused
from lacoc_shared.network.session import Question, Refused, Session, open_client
from lacoc_shared.studio import (
    STUDIO_MAX_BYTES,
    TRIAL_REPLY_MAX_BYTES,
    CancelRequest,
    CellPlace,
    CoachReply,
    CoachRequest,
    GaitFiles,
    MapReply,
    MapRequest,
    Progress,
    RobotReply,
    RobotRequest,
    StudioKeys,
    TrialReply,
    TrialRequest,
    VariantsReply,
    VariantsRequest,
)
from lacoc_shared.words import say

pytestmark = pytest.mark.slow
KEYS = StudioKeys("test")
QUADRUPED = SentFile(*find_robot("quadruped"))


class Asker:
    """Sends requests to the studio and decodes its answers."""

    def __init__(self, session: Session, process: subprocess.Popen[str]) -> None:
        self.session = session
        self.process = process

    def begin(self, what: str, request: object) -> Question:
        """Send a request (bytes as they are); return a question whose `wait` gives the reply."""
        payload = request if isinstance(request, bytes) else encode(request)
        return self.session.question(KEYS.request(what), payload, LIMIT_S)

    def robot(self, robot: SentFile | None = None) -> RobotReply:
        """Ask what a robot file describes; return the studio's reply."""
        payload = self.begin("robot", RobotRequest(protocol=PROTOCOL, robot=robot)).wait()
        return decode(payload, RobotReply, TRIAL_REPLY_MAX_BYTES)

    def trial(self, files: GaitFiles, keys: str = "", seconds: float | None = None) -> TrialReply:
        """Ask for a trial; return the studio's reply."""
        request = TrialRequest(protocol=PROTOCOL, files=files, keys=keys, seconds=seconds)
        return decode(self.begin("trial", request).wait(), TrialReply, TRIAL_REPLY_MAX_BYTES)

    def refusal(self, what: str, request: object) -> Refusal:
        """Send a request that must be refused, and return the refusal."""
        with pytest.raises(Refused) as refused:
            self.begin(what, request).wait()
        return decode(refused.value.payload, Refusal)

    def workers(self) -> list[psutil.Process]:
        """Return the child processes of the studio that run trials."""
        found = []
        for one in psutil.Process(self.process.pid).children():
            with suppress(psutil.NoSuchProcess):  # it was killed, and ends at this moment
                if "spawn_main" in " ".join(one.cmdline()):
                    found.append(one)
        return found


@pytest.fixture(scope="module")
def asker() -> Iterator[Asker]:
    """Give an `Asker` that is connected to a studio with two processes for trials."""
    words = ("studio", "--json", "--name", "test", "--jobs", "2", "--listen", "tcp/127.0.0.1:0")
    studio = Running(*words)
    try:
        assert studio.opened["studio"] == "test"
        with open_client(studio.opened["locators"]) as session:
            yield Asker(session, studio.process)
    finally:
        children = psutil.Process(studio.process.pid).children(recursive=True)
        studio.close()
        assert studio.process.returncode == 0
        assert psutil.wait_procs(children, LIMIT_S)[1] == []


def files_of(robot: str) -> GaitFiles:
    """Return the files of a sample robot."""
    postures, locomotion = sample_gait_files(robot)
    return GaitFiles(robot=SentFile(*find_robot(robot)), postures=postures, locomotion=locomotion)


def test_a_trial_is_that_of_the_command(asker: Asker) -> None:
    """A studio's trial has the figures, arrays and last state hash of a trial in this process."""
    reply = asker.trial(GaitFiles())
    entry = entry_of("hexapod")
    trial = try_gait(make_course(entry.robot), entry.gait)
    assert reply.figures == vars(trial.figures)
    assert reply.digest == trial.walk.digests[-1]
    assert (reply.level, reply.key) == (Level.LOCOMOTION, 2)
    assert list(reply.explained) == trial.explained
    assert {one.leg for one in reply.explained} - {-1}
    walk = trial.walk
    assert (reply.first, reply.end) == walk.span[:2]
    assert reply.ticks == len(walk.down)
    arrays = {
        "poses": np.hstack([walk.body_w, walk.angles_rad]),
        "commanded_rad": walk.commanded_rad,
        "contact_w_m": walk.contact_w_m,
        "centre_w_m": walk.centre_w_m,
        "margin_m": margins_m(walk.down, walk.contact_w_m, walk.centre_w_m),
        "slip_m_s": walk.slip_m_s,
        "tip_m": walk.tip_m,
    }
    for name, values in arrays.items():
        assert getattr(reply, name) == values.astype("<f4").tobytes(), name
    legs = len(entry.robot.legs)
    down = np.frombuffer(reply.down, np.uint8)[:, None] >> np.arange(legs) & 1
    assert (down == walk.down).all()
    assert (np.frombuffer(reply.posture, np.uint8) == walk.posture).all()


def test_a_sentence_names_its_cell_and_leg(asker: Asker) -> None:
    """A sentence about a trial comes with the cell of the table, and the leg, that it explains."""
    entry = entry_of("hexapod")
    assert entry.gait.locomotion is not None
    sequences = [list(map(list, one)) for one in entry.gait.locomotion.sequences]
    sequences[2][3][7] = entry.robot.ranges_rad[7][1]
    table = LocomotionTable(tuple(tuple(map(tuple, one)) for one in sequences))
    sent = SentFile("LocoTra-data.txt", write_gait(table, entry.robot.labels))
    said = asker.trial(GaitFiles(locomotion=sent)).explained
    limit = next(one for one in said if one.said.code == "explain.limit")
    assert limit.cell is not None
    assert (limit.cell.posture, limit.cell.joint, limit.leg) == (3, 7, 1)


@pytest.mark.parametrize("name", ["quadruped", "octopod"])
def test_a_robot_is_described(asker: Asker, name: str) -> None:
    """The reply about a robot has joints, a scene, and facts that keep the limits of the rules."""
    file = SentFile(*find_robot(name))
    robot = asker.robot(file)
    legs = len(robot.legs)
    assert robot.facts["joints"] == 3 * legs == len(robot.ranges_deg) == len(robot.start_deg)
    assert sorted(one.joint for one in robot.scene.bodies if one.joint >= 0) == [*range(3 * legs)]
    assert robot.sheet.seats[0].legs == robot.legs
    spec = read_robot(file.data, name)
    assert [shape.label for shape in robot.shapes] == [*robot.legs]
    for shape, leg in zip(robot.shapes, spec.legs, strict=True):
        assert shape.position_mm == pytest.approx([1000 * one for one in leg.position_m])
        assert shape.lengths_mm == pytest.approx([1000 * one for one in leg.lengths_m])
        assert math.radians(shape.outward_deg) == pytest.approx(leg.outward_rad)
    assert robot.limits.keys() <= robot.facts.keys()
    for fact, (low, high) in robot.limits.items():
        numbers = robot.facts[fact]
        for number in numbers if isinstance(numbers, list) else [numbers]:
            assert low is None or low <= number, fact
            assert high is None or number <= high, fact
    assert asker.trial(files_of(name)).ticks > 100


def test_without_a_standing_foot_there_is_no_margin() -> None:
    """A posture of level A with all feet in the air has no margin, and no note on cycles."""
    robot = entry_of("hexapod").robot
    legs = len(robot.legs)
    start, up = robot.start_posture, math.radians(70)
    hanging = (*start[:legs], *[up] * legs, *start[2 * legs :])
    gait = Gait(PostureTable({1: hanging}), None)
    trial = try_gait(make_course(robot), gait, "A1", 3.0)
    assert (trial.figures.margin_mm, trial.figures.margin_low_mm) == (None, None)
    codes = [one.said.code for one in trial.explained]
    assert codes == ["explain.none-reaches", "explain.no-feet"]
    assert trial.explained[0].cell == CellPlace(posture=0, joint=legs)
    assert trial.notes == []


def test_a_wrong_request_gets_one_refusal(asker: Asker) -> None:
    """Each wrong request gets a refusal with its reason, and the next request is answered."""
    good = TrialRequest(protocol=PROTOCOL, files=GaitFiles())

    def code(what: str, request: object) -> str:
        return asker.refusal(what, request).why.code

    assert code("trial", b"") == "refused.bad-request"
    assert code("trial", os.urandom(1000)) == "refused.bad-request"
    assert code("trial", bytes(STUDIO_MAX_BYTES + 1)) == "refused.bad-request"
    assert code("coach", b"\xc1") == "refused.bad-request"
    assert code("dance", b"") == "studio.unknown"
    assert code("robot", {"protocol": PROTOCOL + 1}) == "studio.wrong-version"
    assert code("robot", {"protocol": PROTOCOL, "more": 1}) == "refused.bad-request"
    for keys in ("9", "x", "1:3"):
        assert code("trial", msgspec.structs.replace(good, keys=keys)).startswith("trial.")
    for seconds in (-1.0, 0.0, 61.0, 1e300, float("nan"), float("inf")):
        request = msgspec.structs.replace(good, seconds=seconds)
        assert code("trial", request) == "trial.length"
    long = ", ".join(["1:20"] * 4 + ["2"])
    assert code("trial", msgspec.structs.replace(good, keys=long)) == "trial.length"
    alone = GaitFiles(robot=QUADRUPED)
    assert code("trial", msgspec.structs.replace(good, files=alone)) == "studio.no-gait"
    for name in ("", "a" * 101, "a\nb"):
        files = GaitFiles(locomotion=SentFile(name, b""))
        assert code("trial", msgspec.structs.replace(good, files=files)) == "refused.file-name"
    assert asker.trial(GaitFiles(), seconds=0.1).ticks == 30


def test_mistakes_in_files_are_listed(asker: Asker) -> None:
    """A refusal lists the mistakes in robot and gait files, each with the name of the file."""
    request = RobotRequest(protocol=PROTOCOL, robot=SentFile("my.toml", b"name = 3"))
    refusal = asker.refusal("robot", request)
    assert refusal.why.code == "refused.mistakes"
    assert {one.file for one in refusal.mistakes} == {"my.toml"}
    heavy = QUADRUPED.data.replace(b"mass_kg = 0.", b"mass_kg = 9.", 1)
    assert heavy != QUADRUPED.data
    request = RobotRequest(protocol=PROTOCOL, robot=SentFile("my.toml", heavy))
    assert asker.refusal("robot", request).mistakes
    postures, _ = sample_gait_files("hexapod")
    assert postures is not None
    files = GaitFiles(robot=QUADRUPED, postures=postures)
    refusal = asker.refusal("trial", TrialRequest(protocol=PROTOCOL, files=files))
    assert refusal.mistakes
    assert refusal.mistakes[0].file == postures.name


@pytest.mark.parametrize("is_pair", [False, True])
def test_a_gait_file_of_the_other_kind_is_refused_as_at_a_court(is_pair: bool) -> None:
    """A Loco-data file as LocoTra-data is a mistake, also beside another Loco-data file."""
    postures, _ = sample_gait_files("hexapod")
    robot = SentFile(*find_robot("hexapod"))
    files = GaitFiles(robot=robot, postures=postures if is_pair else None, locomotion=postures)
    with pytest.raises(FileRefused) as studio:
        read_files(files)
    with pytest.raises(FileRefused) as court:
        weigh_in(robot, files.postures, files.locomotion)
    assert studio.value.mistakes == court.value.mistakes
    assert [one.found for one in studio.value.mistakes] == [say("gait.other-kind")]


@pytest.mark.long
def test_a_process_that_dies_is_replaced(asker: Asker) -> None:
    """A killed process is replaced, and its request is done by the new one.

    If that one is killed too, the request is refused, and may be sent again.
    """
    asker.trial(GaitFiles(), seconds=0.1)
    until(lambda: len(asker.workers()) == 2)
    before = {one.pid for one in asker.workers()}
    long = TrialRequest(protocol=PROTOCOL, files=GaitFiles(), seconds=60.0)
    questions = [asker.begin("trial", long) for _ in range(2)]
    until_busy(asker)
    os.kill(next(iter(before)), signal.SIGKILL)
    for question in questions:
        reply = decode(question.wait(), TrialReply, TRIAL_REPLY_MAX_BYTES)
        assert reply.ticks == LONGEST_TICKS
    until(lambda: len(asker.workers()) == 2)
    assert len({one.pid for one in asker.workers()} & before) == 1

    questions = [asker.begin("trial", long) for _ in range(2)]
    killed: set[int] = set()
    for _ in range(2):
        for one in until_busy(asker, killed):
            killed.add(one.pid)
            os.kill(one.pid, signal.SIGKILL)
    for question in questions:
        with pytest.raises(Refused) as refused:
            question.wait()
        refusal = decode(refused.value.payload, Refusal)
        assert (refusal.why.code, refusal.again) == ("studio.died", True)
    until(lambda: len(asker.workers()) == 2)
    assert asker.trial(GaitFiles(), seconds=0.1).ticks == 30


def until_busy(asker: Asker, killed: Collection[int] = ()) -> list[psutil.Process]:
    """Wait until two processes for trials compute, and return them; `killed` are none of them."""

    def found() -> list[psutil.Process]:
        return [one for one in asker.workers() if one.pid not in killed]

    until(lambda: len(found()) == 2)
    busy = found()
    used = [sum(one.cpu_times()[:2]) for one in busy]
    until(
        lambda: all(sum(one.cpu_times()[:2]) > u + 0.1 for one, u in zip(busy, used, strict=True))
    )
    return busy


def coach_request(job: str, **more: object) -> CoachRequest:
    """Make a request to improve a quadruped's gait, which has short trials."""
    entry = entry_of("quadruped")
    assert entry.gait.postures is not None
    one, other = (entry.gait.postures.postures[digit] for digit in (1, 3))
    small = tuple((9 * a + b) / 10 for a, b in zip(one, other, strict=True))
    large = tuple((a + 9 * b) / 10 for a, b in zip(one, other, strict=True))
    start = entry.robot.start_posture
    table = LocomotionTable(((start,), (start,), (small, large)))
    sent = SentFile("LocoTra-data.txt", write_gait(table, entry.robot.labels))
    files = GaitFiles(robot=QUADRUPED, locomotion=sent)
    request = CoachRequest(protocol=PROTOCOL, job=job, files=files, key=2, size="cell", seconds=0)
    return msgspec.structs.replace(request, **more)


@pytest.mark.long
def test_a_search_can_be_repeated(asker: Asker) -> None:
    """A search of one round has the same result in another process, and sends its progress."""
    progress = asker.session.mailbox(KEYS.progress("one"), 1000)
    request = coach_request("one")
    reply = decode(asker.begin("coach", request).wait(), CoachReply)
    files = read_files(request.files)
    task = task_of(files.robot, files.gait, 2, Goal.FORWARD, files.sequences)
    with Workers(2) as workers:
        trials = Trials(task, workers, threading.Event())
        again = coach(trials, Size.CELL, 0.0, 0, lambda _: None)
    assert reply == reply_of(task, 2, again)
    assert len(reply.changes) == 1
    assert reply.score_after > reply.score_before
    assert len(reply.matters) == 24
    assert not reply.cancelled
    told = []
    while (mail := progress.take()) is not None:
        told.append(decode(mail.payload, Progress))
    assert told
    assert {one.stage for one in told} <= {"matters", "search", "undo"}
    assert all(0 <= one.done <= 1 for one in told)
    counts = [one.trials for one in told]
    assert counts == sorted(counts)


@pytest.mark.long
def test_a_search_can_be_cancelled(asker: Asker) -> None:
    """A cancelled search replies with its best gait, or is refused if it has not begun."""
    progress = asker.session.mailbox(KEYS.progress("long"), 1000)
    waiting = asker.session.mailbox(KEYS.progress("next"), 1000)
    question = asker.begin("coach", coach_request("long", seconds=100.0, size="table"))
    stages = set()

    def searches() -> bool:
        while (mail := progress.take()) is not None:
            stages.add(decode(mail.payload, Progress).stage)
        return "search" in stages

    until(searches)
    following = asker.begin("coach", coach_request("next", seconds=100.0, size="table"))
    until(lambda: waiting.take() is not None)
    assert asker.refusal("coach", coach_request("long")).why.code == "studio.job-taken"
    assert asker.trial(GaitFiles(), seconds=0.1).ticks == 30
    for job in ("next", "long"):
        cancel = CancelRequest(protocol=PROTOCOL, job=job)
        assert decode(asker.begin("cancel", cancel).wait(), Done)
    with pytest.raises(Refused) as refused:
        following.wait()
    assert decode(refused.value.payload, Refusal).why.code == "studio.cancelled"
    reply = decode(question.wait(), CoachReply)
    assert reply.cancelled
    assert reply.score_after >= reply.score_before
    request = CancelRequest(protocol=PROTOCOL, job="long")
    assert asker.refusal("cancel", request).why.code == "studio.no-job"


def test_a_search_with_wrong_wishes_is_refused(asker: Asker) -> None:
    """A search with a wrong goal, size, time, key or name is refused with the reason."""
    for wrong, code in (
        ({"goal": "up"}, "studio.coach-choice"),
        ({"size": "all"}, "studio.coach-choice"),
        ({"seconds": 1e9}, "studio.coach-seconds"),
        ({"seconds": float("nan")}, "studio.coach-seconds"),
        ({"key": 9}, "trial.no-key"),
        ({"job": "*"}, "address.court-name"),
    ):
        request = coach_request(**{"job": "wrong", **wrong})
        assert asker.refusal("coach", request).why.code == code


@pytest.mark.long
def test_other_gaits_can_be_asked_for(asker: Asker) -> None:
    """A studio fills a map of gaits, and makes new variants of the tables that a user keeps.

    It refuses a request for variants with wrong tables or negative numbers.
    """
    files = files_of("quadruped")
    asked = MapRequest(protocol=PROTOCOL, job="map", files=files, seconds=0)
    found = decode(asker.begin("map", asked).wait(), MapReply, TRIAL_REPLY_MAX_BYTES)
    assert found.cells
    assert found.own is not None
    wish = VariantsRequest(protocol=PROTOCOL, job="six", files=files, seed=2)
    first = decode(asker.begin("variants", wish).wait(), VariantsReply, TRIAL_REPLY_MAX_BYTES)
    tables = tuple(one.table for one in first.variants)
    assert len(tables) == 6
    again = msgspec.structs.replace(wish, keep=tables[:2], before=tables, round=1)
    second = decode(asker.begin("variants", again).wait(), VariantsReply, TRIAL_REPLY_MAX_BYTES)
    assert not {one.table for one in second.variants} & set(tables)
    for wrong, code in (
        ({"keep": tables[:3]}, "studio.wrong-tables"),
        ({"keep": ((1, 2),)}, "studio.wrong-tables"),
        ({"before": ((999,) * len(tables[0]),)}, "studio.wrong-tables"),
        ({"round": -1}, "studio.negative"),
        ({"seed": -1}, "studio.negative"),
    ):
        request = msgspec.structs.replace(wish, **wrong)
        assert asker.refusal("variants", request).why.code == code


@pytest.mark.long
def test_a_map_can_be_cancelled(asker: Asker) -> None:
    """Progress counts the filled cells of a map; a cancelled search replies with their gaits."""
    progress = asker.session.mailbox(KEYS.progress("atlas"), 1000)
    asked = MapRequest(protocol=PROTOCOL, job="atlas", files=files_of("quadruped"), seconds=100)
    question = asker.begin("map", asked)
    told: list[Progress] = []

    def fills() -> bool:
        while (mail := progress.take()) is not None:
            told.append(decode(mail.payload, Progress))
        return bool(told and told[-1].stage == "map" and (told[-1].filled or 0) > 1)

    until(fills)
    cancel = CancelRequest(protocol=PROTOCOL, job="atlas")
    assert decode(asker.begin("cancel", cancel).wait(), Done)
    reply = decode(question.wait(), MapReply, TRIAL_REPLY_MAX_BYTES)
    assert reply.cancelled
    assert len(reply.cells) >= (told[-1].filled or 0)


def test_nobody_else_speaks_for_a_studio(asker: Asker) -> None:
    """Another client can't send progress in the studio's name, and gets none of its requests."""
    (at,) = asker.session.endpoints
    with open_client([at]) as other:
        heard = asker.session.mailbox(KEYS.progress("mine"), 10)
        desk = other.desk(KEYS.request("*"), 10)
        other.send(KEYS.progress("mine"), b"forged")
        assert asker.trial(GaitFiles(), seconds=0.1).ticks == 30
        assert desk.take() is None
        assert heard.take() is None


@pytest.mark.long
def test_the_longest_trial_of_the_largest_robot(asker: Asker) -> None:
    """An octopod's longest trial has the largest possible reply, and this reply arrives."""
    reply = asker.trial(files_of("octopod"), seconds=60.0)
    assert reply.ticks == LONGEST_TICKS


def test_a_trial_whose_physics_stops_has_a_reply() -> None:
    """If physics stops, the reply to a trial has a fault, and the explanation says so first."""
    course = make_course(entry_of("hexapod").robot)
    course._world.data.qvel[:] = 1e9  # type: ignore[attr-defined]
    course._world._keep()  # type: ignore[attr-defined]
    course._start = course._world.save()
    found = answer(
        "trial", encode(TrialRequest(protocol=PROTOCOL, files=GaitFiles())), lambda _: course
    )
    assert found.right
    reply = decode(found.payload, TrialReply)
    assert reply.fault is not None
    assert reply.explained[0].said.code == "explain.fault"
    assert (reply.ticks, reply.poses) == (0, b"")


def test_no_process_is_left_when_a_studio_is_killed() -> None:
    """When a studio is killed, its processes for trials end by themselves."""
    studio = Running("studio", "--json", "--jobs", "1", "--listen", "tcp/127.0.0.1:0")
    parent = psutil.Process(studio.process.pid)
    until(lambda: bool(parent.children()))
    children = parent.children(recursive=True)
    studio.kill()
    assert psutil.wait_procs(children, LIMIT_S)[1] == []
