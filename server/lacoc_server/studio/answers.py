"""Computes the answers to a studio's requests; pure: the same request has the same answer."""

import math
from collections.abc import Callable
from dataclasses import asdict
from typing import Any, NamedTuple, TypeVar

import msgspec
import numpy as np
import numpy.typing as npt

from lacoc_robots.library import WORKSHOPS_ROBOT, find_robot, sample_gait_files
from lacoc_robots.limits import Limits
from lacoc_robots.robot import RobotSpec
from lacoc_robots.robot_file import read_robot
from lacoc_server.doors.inbox import FILE_NAME_MAX
from lacoc_server.match.entry import read_gaits
from lacoc_server.studio.facts import bounds, facts, leg_shape
from lacoc_server.trial.course import LONGEST_TICKS, SETTLE_TICKS, Course
from lacoc_server.trial.figures import Figures, measure
from lacoc_server.trial.keys import forward_key, parse_keys
from lacoc_server.trial.reasons.explain import explain
from lacoc_server.trial.support import margins_m
from lacoc_server.trial.told import told
from lacoc_server.trial.walk import Floats, Press, Walk
from lacoc_shared import __version__
from lacoc_shared.codec import BadMessage, decode, encode, message_hash, protocol_of
from lacoc_shared.gait.joining import join_postures, sample_sequences
from lacoc_shared.gait.tables import SAMPLE_KEYS, Gait, Level
from lacoc_shared.messages import PROTOCOL, Refusal, SentFile, Sheet, SheetSeat
from lacoc_shared.mistakes import FileRefused, Mistake, UserError
from lacoc_shared.seat import BEAT_S, BEATS_PER_S
from lacoc_shared.studio import (
    STUDIO_MAX_BYTES,
    GaitFiles,
    RobotReply,
    RobotRequest,
    Sentence,
    TrialReply,
    TrialRequest,
)
from lacoc_shared.words import Phrase, render, say

_MISTAKES_TOLD = 20
"""Most mistakes that one refusal lists, so that the message stays small."""

CourseOf = Callable[[RobotSpec], Course]
"""Returns the floor for a robot's trials."""
_Request = TypeVar("_Request", bound=msgspec.Struct)


class Busy(UserError):
    """Too many requests wait at the studio; the same request may be sent again later."""


class Answer(NamedTuple):
    """An encoded reply, or an encoded `Refusal`."""

    right: bool
    """Whether this is a reply; False: a refusal."""
    payload: bytes


class RobotWithGait(NamedTuple):
    """The robot and the gait that were read from a request's files."""

    robot: RobotSpec
    gait: Gait
    sequences: tuple[tuple[int, ...], ...] | None
    """For each key of level B the digits of its postures in the Loco-data file; None if the gait
    has a LocoTra-data file."""
    notes: list[Phrase]
    """Remarks on what is allowed in the files, but probably not intended."""


class Trial(NamedTuple):
    """A trial with its figures and explanation."""

    press: Press
    """The last key, which was measured."""
    walk: Walk
    figures: Figures
    explained: list[Sentence]
    notes: list[Phrase]
    """Remarks for a reader of the figures, such as that the trial ended early."""

    def __str__(self) -> str:
        """Return the figures and then the explaining sentences, a line each."""
        rows = [(render(what), value) for what, value in told(self.figures)]
        width = max(len(what) for what, _ in rows)
        lines = [f"{what:{width}}  {value}" for what, value in rows]
        return "\n".join([*lines, *(render(one.said) for one in self.explained)])


def answer(what: str, payload: bytes, course_of: CourseOf) -> Answer:
    """Answer a request.

    Args:
        what: name of the request: robot or trial.
        payload: the encoded request.
        course_of: returns the floor for a robot.
    """
    try:
        match what:
            case "robot":
                reply: Any = _robot(read(payload, RobotRequest), course_of)
            case "trial":
                reply = _trial(read(payload, TrialRequest), course_of)
            case _:
                raise UserError(say("studio.unknown", what=what[:40]))
    except (BadMessage, FileRefused, UserError) as error:
        return Answer(False, encode(refusal(error)))
    return Answer(True, encode(reply))


def read(payload: bytes, kind: type[_Request]) -> _Request:
    """Decode a request.

    Raises:
        BadMessage: if the bytes are not a request of this kind, or are too many.
        UserError: if the request uses another version of the protocol.
    """
    protocol = protocol_of(payload, STUDIO_MAX_BYTES)
    if protocol != PROTOCOL:
        raise UserError(say("studio.wrong-version", studio=PROTOCOL, program=protocol))
    return decode(payload, kind, STUDIO_MAX_BYTES)


def refusal(error: BadMessage | FileRefused | UserError) -> Refusal:
    """Make the message that says why a request is refused.

    For wrong files, the message has the number of mistakes and lists the first `_MISTAKES_TOLD`.
    `Refusal.again` is true only for `Busy`: the same request may be sent again later.
    """
    match error:
        case FileRefused():
            count = len(error.mistakes)
            first = _MISTAKES_TOLD if count > _MISTAKES_TOLD else None
            why = say("refused.mistakes", count=count, first=first)
            return Refusal(why, tuple(error.mistakes[:_MISTAKES_TOLD]))
        case UserError():
            return Refusal(error.phrase, again=isinstance(error, Busy))
    return Refusal(say("refused.bad-request", error=str(error)))


def read_files(files: GaitFiles) -> RobotWithGait:
    """Read a robot and its gait.

    Without a robot file, the robot is the workshop's. Without any file, the gait is the workshop's
    sample. If there are postures but no locomotion file, the request's sequences become the keys of
    level B; without these, the sample's sequences do.

    Raises:
        FileRefused: with the mistakes of the robot file; if it has none, of both gait files.
        UserError: if a file's name is wrong, if a robot file comes without a gait file, or if the
            postures can't be joined into the request's sequences.
    """
    robot = _robot_of(files.robot)
    for one in (files.postures, files.locomotion):
        _check_name(one)
    sent = files.postures, files.locomotion
    if sent == (None, None) and files.robot is None:
        sent = sample_gait_files(WORKSHOPS_ROBOT)
    mistakes: list[Mistake] = []
    notes: list[Phrase] = []
    gait = read_gaits(*sent, robot, mistakes, notes)
    if mistakes:
        raise FileRefused(mistakes)
    postures = gait.postures
    if postures is None and gait.locomotion is None:
        raise UserError(say("studio.no-gait"))
    if postures is None or gait.locomotion is not None:
        return RobotWithGait(robot, gait, None, notes)
    if files.sequences is None:
        return RobotWithGait(robot, Gait(postures, sample_sequences(postures)), SAMPLE_KEYS, notes)
    assert sent[0] is not None
    joined = join_postures(postures, sent[0].name, files.sequences)
    return RobotWithGait(robot, Gait(postures, joined), files.sequences, notes)


def try_gait(course: Course, gait: Gait, keys: str = "", seconds: float | None = None) -> Trial:
    """Let a robot walk, measure how it walks, and explain it.

    Args:
        course: the floor with the robot.
        gait: the robot's gait, for as many joints as the robot has.
        keys: keys as a person types them (`trial.keys`); "": the key for forward.
        seconds: how long the last key is pressed [s]; None: whole cycles.

    Raises:
        UserError: if the keys or the time are wrong.
    """
    presses = (
        parse_keys(keys, gait, SETTLE_TICKS) if keys else [Press(SETTLE_TICKS, *forward_key(gait))]
    )
    last = presses[-1]
    _check_time(last.tick, seconds)
    walk = course.walk(gait, presses, seconds)
    figures = measure(walk)
    sequence = gait.sequence(last.level, last.digit) or ()
    before = (
        presses[-2] if presses[1:] and presses[-2].level is Level.POSTURE is last.level else None
    )
    posture = gait.sequence(before.level, before.digit) if before else None
    notes = []
    if walk.fault is not None:
        notes.append(say("trial.fault", why=walk.fault))
    if not figures.cycles and last.level is Level.LOCOMOTION:
        notes.append(say("trial.no-cycle", seconds=figures.seconds))
    came = (before.digit, posture[-1]) if before and posture else None
    explained = explain(course.robot, walk, figures, last, sequence, came)
    return Trial(last, walk, figures, explained, notes)


def _check_name(file: SentFile | None) -> None:
    """Check the name of a file, because messages about mistakes quote it.

    Raises:
        UserError: if the name is empty, too long, or has letters that can't be shown.
    """
    if file is not None and not (0 < len(file.name) <= FILE_NAME_MAX and file.name.isprintable()):
        raise UserError(say("refused.file-name", most=FILE_NAME_MAX))


def _robot_of(file: SentFile | None) -> RobotSpec:
    _check_name(file)
    name, data = find_robot(WORKSHOPS_ROBOT) if file is None else (file.name, file.data)
    return read_robot(data, name)


def _check_time(tick: int, seconds: float | None) -> None:
    """Check the length of a trial.

    Args:
        tick: tick in which the last key is pressed.
        seconds: how long the last key is pressed [s]; None: whole cycles.

    Raises:
        UserError: if the trial is too long, or `seconds` is shorter than a tick.
    """
    before_s = (tick - SETTLE_TICKS) / BEATS_PER_S
    last_s = BEAT_S if seconds is None else seconds
    most_s = (LONGEST_TICKS - SETTLE_TICKS) / BEATS_PER_S
    if not (math.isfinite(last_s) and last_s >= BEAT_S and before_s + last_s <= most_s):
        raise UserError(say("trial.length", seconds=before_s + last_s, most_s=most_s))


def _robot(request: RobotRequest, course_of: CourseOf) -> RobotReply:
    robot = _robot_of(request.robot)
    course = course_of(robot)
    scene = course.scene
    return RobotReply(
        name=robot.name,
        legs=robot.labels,
        shapes=tuple(map(leg_shape, robot.legs)),
        ranges_deg=robot.ranges_deg,
        start_deg=tuple(round(math.degrees(angle), 9) for angle in robot.start_posture),
        start_z_m=robot.start_z_m,
        facts=facts(robot),
        limits=bounds(robot, Limits()),
        sheet=_sheet(course, message_hash(encode(scene))),
        scene=scene,
    )


def _sheet(course: Course, scene_hash: bytes) -> Sheet:
    arena, robot = course.arena, course.robot
    (seat,) = arena.seats
    shown = SheetSeat(
        id=seat.id,
        team=robot.name,
        colour=seat.colour,
        pattern=seat.pattern,
        robot=robot.name,
        legs=robot.labels,
    )
    return Sheet(
        protocol=PROTOCOL,
        version=__version__,
        court="studio",
        match=0,
        arena=arena.name,
        title=arena.title,
        duration_s=0.0,
        levels=tuple(int(level) for level in arena.match.open_levels),
        settings=arena.settings,
        seats=(shown,),
        markers=arena.game.markers,
        scene=scene_hash,
    )


def _trial(request: TrialRequest, course_of: CourseOf) -> TrialReply:
    files = read_files(request.files)
    trial = try_gait(course_of(files.robot), files.gait, request.keys, request.seconds)
    walk = trial.walk
    ticks, legs = walk.down.shape
    return TrialReply(
        level=int(trial.press.level),
        key=trial.press.digit,
        figures=asdict(trial.figures),
        explained=tuple(trial.explained),
        notes=(*files.notes, *trial.notes),
        fault=walk.fault,
        ticks=ticks,
        first=walk.span.first,
        end=walk.span.end,
        starts=walk.starts,
        posture=walk.posture.astype(np.uint8).tobytes(),
        down=(walk.down << np.arange(legs)).sum(axis=1).astype(np.uint8).tobytes(),
        poses=_float32(np.hstack([walk.body_w, walk.angles_rad])),
        commanded_rad=_float32(walk.commanded_rad),
        contact_w_m=_float32(walk.contact_w_m),
        centre_w_m=_float32(walk.centre_w_m),
        margin_m=_float32(margins_m(walk.down, walk.contact_w_m, walk.centre_w_m)),
        slip_m_s=_float32(walk.slip_m_s),
        tip_m=_float32(walk.tip_m),
        digest=walk.digests[-1] if walk.digests else bytes(8),
    )


def _float32(values: Floats | npt.NDArray[Any]) -> bytes:
    return values.astype("<f4").tobytes()
