"""Gives a small match to record: two robots with four legs each, and a board of three markers."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lacoc_shared import codec
from lacoc_shared.inputs import JoinSeat, KeySeat, LeaveSeat
from lacoc_shared.messages import (
    PROTOCOL,
    Event,
    Frame,
    MarkerInfo,
    Scene,
    SceneBody,
    SceneGeom,
    SeatFrame,
    SentFile,
    Sheet,
    SheetSeat,
)
from lacoc_shared.record.recorder import Recorder
from lacoc_shared.record.schema import FORMAT, Header, Result, Setup, Touch
from lacoc_shared.record.writer import RecordWriter
from lacoc_shared.seat import Phase
from lacoc_shared.words import say

JOINTS = 12
_ONE = (1.0, 0.0, 0.0, 0.0)
_ZERO = (0.0, 0.0, 0.0)


@pytest.fixture(scope="session")
def header() -> Callable[..., Header]:
    """Give a function that makes a record's header, by default that of the first segment."""

    def make(segment: int = 0, first_beat: int = 0, match_id: str = "m") -> Header:
        return Header(
            format=FORMAT,
            match_id=match_id,
            segment=segment,
            first_beat=first_beat,
            started="2026-05-01T10:00:00+00:00",
            versions={"lacoc": "0.1.0"},
            setup=Setup(
                court="main", match=1, match_id=match_id, arena="othello", settings={}, limits={}
            ),
        )

    return make


@pytest.fixture(scope="session")
def sheet() -> Sheet:
    """Give the sheet of two teams, each with a robot of four legs."""
    seats = tuple(
        SheetSeat(id=id, team=team, colour=colour, pattern="plain", legs=("RF", "RB", "LB", "LF"))
        for id, team, colour in (("left", "Ants", "#0000ff"), ("right", "Bees, Inc", "#ff8000"))
    )
    return Sheet(
        protocol=PROTOCOL,
        version="0.1.0",
        court="main",
        match=1,
        arena="othello",
        title="Robot-Othello",
        duration_s=180.0,
        levels=(1,),
        settings={},
        seats=seats,
        markers=tuple(
            MarkerInfo(name=f"c{n}", kind="disc", x_m=n * 0.3, y_m=0.0, radius_m=0.12)
            for n in range(3)
        ),
        scene=b"12345678",
    )


@pytest.fixture(scope="session")
def scene() -> Scene:
    """Give a scene of a floor, discs in two states, and two robots drawn with one leg each."""
    bodies = [SceneBody(name="world", parent=-1, pos=_ZERO, quat=_ONE)]
    geoms = [_geom("plane", (0.0, 0.0, 0.1))]
    for marker in range(3):
        bodies.append(
            SceneBody(name=f"disc{marker}", parent=0, pos=(marker * 0.3, 0.0, 0.0), quat=_ONE)
        )
        geoms += [
            _geom("cylinder", (0.12, 0.002, 0.0), len(bodies) - 1, marker=marker, state=state)
            for state in (1, 2)
        ]
    for seat, name in enumerate(("left", "right")):
        root = len(bodies)
        bodies.append(SceneBody(name=f"{name}/body", parent=0, pos=_ZERO, quat=_ONE, seat=seat))
        bodies.append(
            SceneBody(name=f"{name}/leg", parent=root, pos=(0.05, 0.0, 0.0), quat=_ONE, joint=0)
        )
        geoms.append(_geom("box", (0.05, 0.06, 0.025), root, seat=seat))
        geoms.append(_geom("capsule", (0.015, 0.02, 0.0), root + 1))
        geoms.append(_geom("sphere", (0.015, 0.0, 0.0), root + 1))
    return Scene(bodies=tuple(bodies), geoms=tuple(geoms))


@pytest.fixture(scope="session")
def frame() -> Callable[..., Frame]:
    """Give a function that makes frames, by default in the phase PLAYING."""
    return make_frame


def make_frame(
    beat: int,
    phase: Phase = Phase.PLAYING,
    clock: int | None = None,
    roots: tuple[tuple[float, ...], ...] | None = None,
    joints: float = 0.0,
    markers: bytes = b"\x15",
) -> Frame:
    still = SeatFrame(3, 0, 1, 0, 0, 0, 0, 0, 0, 0)
    floats: list[float] = []
    if phase >= Phase.READY:
        for root in roots or ((0.01 * beat, 0.0, 0.1, *_ONE), (0.5, 0.5, 0.1, *_ONE)):
            floats += [*root, *([joints] * JOINTS)]
    return Frame(
        match=1,
        beat=beat,
        phase=phase,
        countdown_beats=0,
        clock_ticks=beat if clock is None else clock,
        seats=(still, still),
        markers=markers,
        poses=np.array(floats, "<f4").tobytes(),
        scene=b"12345678",
        digest=beat.to_bytes(8, "big"),
    )


@pytest.fixture(scope="session")
def result() -> Result:
    """Give a result: the left team has won."""
    return Result(
        match_id="m",
        court="main",
        match=1,
        arena="othello",
        teams=("Ants", "Bees, Inc"),
        scores=(20, 16),
        computed="left",
        official="left",
        reason=say("over.time"),
        clock_s=180.0,
        beats=40,
        digest="00",
        model="00",
    )


@pytest.fixture(scope="session")
def write_match(
    header: Callable[..., Header], sheet: Sheet, scene: Scene, result: Result
) -> Callable[..., Path]:
    """Give a function that writes a match of 40 beats and returns its segment's path.

    `close` says whether the segment is closed. If `gives_s` is not 0, a referee adds this time [s].
    With another `recorder` the file has another form.
    """

    def write(
        folder: Path,
        close: bool = True,
        gives_s: float = 0.0,
        recorder: Callable[[Path, Header], Recorder] = RecordWriter,
    ) -> Path:
        writer = recorder(folder, header())
        writer.sheet(0, sheet)
        writer.scene(0, scene)
        writer.input(0, JoinSeat(0, "Ants", SentFile("robot.toml", b""), None, None, "hash"))
        if gives_s:
            writer.event(
                Event(
                    number=1,
                    match=1,
                    beat=0,
                    clock_ticks=0,
                    kind="decision",
                    said=say("plain.text", text="time given"),
                    data={"decision": "clock", "arguments": {"gives_s": gives_s}},
                )
            )
        for beat in range(40):
            phase = Phase.READY if beat < 10 else Phase.PLAYING
            if beat % 10 == 3:
                writer.input(beat, KeySeat(0, beat + 1, 1, 2))
                writer.input(beat, KeySeat(1, beat + 1, 1, 3, held=beat % 7, late=beat // 20))
                writer.event(
                    Event(
                        number=beat,
                        match=1,
                        beat=beat,
                        clock_ticks=beat,
                        kind="flip",
                        said=say("plain.text", text='"Ants" flip a disc, and more'),
                        seat=0,
                    )
                )
                writer.touch(beat, Touch(((1,), ()), (None, (0.1, 0.2, 0.3))))
            markers = b"\x15" if beat < 20 else b"\x16"
            writer.frame(beat, codec.encode(make_frame(beat, phase, markers=markers)))
            if beat % 20 == 5:
                writer.snapshot(beat, bytes(range(256)) * 4)
        writer.input(39, LeaveSeat(1))
        writer.result(result)
        if close:
            writer.close()
        else:
            writer.leave()
        return writer.path

    return write


def _geom(
    type: str,
    size: tuple[float, float, float],
    body: int = 0,
    marker: int = -1,
    state: int = -1,
    seat: int = -1,
) -> SceneGeom:
    return SceneGeom(
        body=body,
        type=type,
        size=size,
        pos=_ZERO,
        quat=_ONE,
        rgba=(0.5, 0.5, 0.5, 1.0),
        marker=marker,
        state=state,
        seat=seat,
    )
