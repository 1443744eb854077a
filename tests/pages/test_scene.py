"""Tests of the drawing core of the pages (client/web/src/core, scene) in a real browser."""

import math
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec
import mujoco
import numpy as np
import pytest
from chromium import OpenPage, build_stand
from debian import locked
from every_third import every_third
from match_file import match_file
from playwright.sync_api import Page
from stand import Stand, served, share_of

from lacoc_arenas import arena as arenas
from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_server.match.entry import Entry, weigh_in
from lacoc_server.world.world import World
from lacoc_shared.codec import decode, encode, unpack_states
from lacoc_shared.messages import Frame, SentFile, Sheet

pytestmark = pytest.mark.slow

BLUE, ORANGE = "#0072b2", "#e69f00"


@pytest.fixture(scope="session")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the folder with the built test page and two match files; all test processes share it."""
    own = tmp_path_factory.getbasetemp()
    folder = (own.parent if "PYTEST_XDIST_WORKER" in os.environ else own) / "stand"
    with locked("stand"):
        if not folder.exists():
            making = tmp_path_factory.mktemp("making")
            build_stand(making)
            for arena in ("othello", "flag-strike"):
                (making / f"{arena}.bin").write_bytes(match_file(arena, 24.0))
            making.rename(folder)
    return folder


@pytest.fixture(scope="session")
def address(site: Path) -> Iterator[str]:
    with served(site) as address:
        yield address


@pytest.fixture
def slow_screen() -> bool:
    """Give False: pages draw as often as the browser can."""
    return False


@pytest.fixture
def stand(page: Page, address: str) -> Stand:
    return Stand(page, address)


class Recorded:
    """The sheet and frames of a match file that the test page `stand` shows."""

    def __init__(self, site: Path, arena: str) -> None:
        data = msgspec.msgpack.decode((site / f"{arena}.bin").read_bytes())
        self.sheet = decode(data["sheet"], Sheet)
        self.frames = [decode(frame, Frame) for frame in data["frames"]]

    def states(self, frame: Frame) -> tuple[int, ...]:
        return unpack_states(frame.markers, len(self.sheet.markers))

    def change(self) -> tuple[Frame, Frame, int]:
        """Return the frames just before and after a seat takes a marker, and the marker's index."""
        for before, after in zip(self.frames, self.frames[1:], strict=False):
            was, now = self.states(before), self.states(after)
            for marker, (one, other) in enumerate(zip(was, now, strict=True)):
                if one != other and other in (1, 2):
                    return before, after, marker
        raise AssertionError("nothing happened in this match")


def entry(robot: str) -> Entry:
    return weigh_in(SentFile(*find_robot(robot)), *sample_gait_files(robot))


@pytest.mark.parametrize("arena", ["flag-strike", pytest.param("othello", marks=pytest.mark.long)])
@pytest.mark.parametrize(
    "robots",
    [("hexapod", "quadruped"), pytest.param(("octopod", "long-legs"), marks=pytest.mark.long)],
)
def test_the_page_has_every_body_where_mujoco_has_it(
    stand: Stand, site: Path, arena: str, robots: tuple[str, str]
) -> None:
    """Forward kinematics in the browser agrees with MuJoCo to 1e-6 m."""
    entries = [entry(robot) for robot in robots]
    world = World(arenas.load(arena), entries)
    seats = [
        {
            "id": name,
            "team": "",
            "colour": BLUE,
            "pattern": "plain",
            "legs": [""] * len(e.robot.legs),
        }
        for name, e in zip(("left", "right"), entries, strict=True)
    ]
    sheet = {"seats": seats, "markers": [], "scene": world.scene_hash}
    name = f"{arena}-{robots[0]}.bin"
    data = {"sheet": encode(sheet), "scene": encode(world.scene), "frames": []}
    (site / name).write_bytes(encode(data))
    stand.open(name, frames=0, camera="map")
    rng = np.random.default_rng(7)
    for _ in range(8):
        for robot in world.robots:
            at = robot.root_qpos
            quat = rng.normal(size=4)
            world.data.qpos[at : at + 3] = rng.uniform(-1.2, 1.2, 3)
            world.data.qpos[at + 3 : at + 7] = quat / np.linalg.norm(quat)
            world.data.qpos[robot.joint_qpos] = rng.uniform(-2.6, 2.6, len(robot.joint_qpos))
        mujoco.mj_kinematics(world.model, world.data)
        numbers = np.frombuffer(world.poses(), "<f4").tolist()
        found = stand.page.evaluate("(numbers) => stand.bodies(numbers)", numbers)
        pos, quat = np.reshape(found["pos"], (-1, 3)), np.reshape(found["quat"], (-1, 4))
        assert np.abs(pos - world.data.xpos).max() < 1e-6
        # q and -q are the same rotation.
        assert np.abs(np.abs((quat * world.data.xquat).sum(axis=1)) - 1).max() < 1e-6


def test_the_picture_shows_the_frame(stand: Stand, site: Path) -> None:
    """A robot is drawn at its place in a frame; between two frames it is drawn half-way."""
    frames = Recorded(site, "othello").frames
    one, other = frames[600], frames[601]
    stand.open("othello.bin", speed=0, beat=one.beat, q="low")
    starts = {"left/body": 0, "right/body": 25}
    for part in (0, 0.5):
        stand.seek(one.beat + part)
        for name, at in starts.items():
            a, b = (np.frombuffer(frame.poses, "<f4")[at : at + 3] for frame in (one, other))
            assert np.allclose(stand.view(f"bodyPos('{name}')"), a + part * (b - a), atol=1e-6)


def test_a_robot_that_was_put_elsewhere_does_not_fly_there(stand: Stand) -> None:
    """A robot that jumps within one beat is not drawn in between, but the other robot is."""
    stand.open("", frames=0)
    mixed = stand.page.evaluate(
        """() => {
          const bytes = (x) => new Uint8Array(
            Float32Array.from([x, 0, 0, 1, 0, 0, 0, 0.2, x / 10, 0, 0, -1, 0, 0, 0, 0.4]).buffer);
          const mixer = new stand.PoseMixer([1, 1]);
          const before = { beat: 5, poses: bytes(0) }, after = { beat: 6, poses: bytes(0.5) };
          mixer.mix({ before, after, part: 0.5, beat: 5.5 });
          return [...mixer.mixed];
        }"""
    )
    assert mixed[0] == 0
    assert mixed[8] == pytest.approx(0.025)


def test_quaternions_go_the_short_way(stand: Stand) -> None:
    """A robot does not spin when its quaternion changes sign, because q and -q are one rotation."""
    stand.open("", frames=0)
    mixed = stand.page.evaluate(
        """() => {
          const bytes = (w, z) => new Uint8Array(Float32Array.from([0, 0, 0, w, 0, 0, z]).buffer);
          const mixer = new stand.PoseMixer([0]);
          const before = { beat: 0, poses: bytes(1, 0) };
          const after = { beat: 1, poses: bytes(-Math.cos(0.1), -Math.sin(0.1)) };
          mixer.mix({ before, after, part: 0.5, beat: 0.5 });
          return [...mixer.mixed];
        }"""
    )
    assert 2 * math.atan2(mixed[6], mixed[3]) == pytest.approx(0.1, abs=1e-3)


@pytest.mark.parametrize("arena", ["flag-strike", pytest.param("othello", marks=pytest.mark.long)])
def test_a_marker_that_changes_moves_and_ends_in_its_new_state(
    stand: Stand, site: Path, arena: str
) -> None:
    """A marker that changes is drawn in motion, and then in its new state."""
    recorded = Recorded(site, arena)
    before, after, index = recorded.change()
    stand.open(f"{arena}.bin", speed=0, beat=before.beat, q="low", camera="top", labels=0)
    assert stand.view(f"marker({index})") == recorded.states(before)[index]
    stand.page.evaluate("(beat) => stand.seek(beat)", after.beat)
    # Asked every 10 ms: on a busy machine the next picture may be drawn after the movement.
    stand.page.wait_for_function("__lacoc.view.moving", polling=10)
    stand.page.wait_for_function("!__lacoc.view.moving")
    assert stand.view(f"marker({index})") == recorded.states(after)[index]
    stand.next_frames()
    if arena == "othello":
        marker = recorded.sheet.markers[index]
        seat = recorded.states(after)[index] - 1
        # Beside the middle, because the robot that turned the disc over may stand on the middle.
        found = [
            stand.pixel(marker.x_m + 0.09 * math.cos(turn), marker.y_m + 0.09 * math.sin(turn))
            for turn in np.arange(0, 6.2, 0.7)
        ]
        wanted = np.array(
            [int(recorded.sheet.seats[seat].colour[i : i + 2], 16) for i in (1, 3, 5)]
        )
        assert min(np.abs(pixel.astype(int) - wanted).max() for pixel in found) < 40


@pytest.mark.long
def test_after_a_leap_in_time_nothing_moves(stand: Stand, site: Path) -> None:
    """After a seek the board is drawn at once as it was at that beat, without motion."""
    recorded = Recorded(site, "othello")
    first, last = recorded.frames[0], recorded.frames[-1]
    assert recorded.states(first) != recorded.states(last)
    stand.open("othello.bin", speed=0, beat=first.beat, q="low")
    stand.seek(last.beat)
    assert not stand.view("moving")
    assert [stand.view(f"marker({i})") for i in range(36)] == list(recorded.states(last))


def test_without_webgl_the_field_is_drawn_from_above(stand: Stand, site: Path) -> None:
    """Without WebGL a page draws the same frames as a flat map."""
    stand.page.add_init_script(
        """const get = HTMLCanvasElement.prototype.getContext;
        HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
          return kind.startsWith("webgl") ? null : get.call(this, kind, ...more);
        };"""
    )
    last = Recorded(site, "othello").frames[-1]
    stand.open("othello.bin", speed=0, beat=last.beat)
    assert stand.view("quality") == "map"
    picture = stand.pixels()
    assert share_of(picture, BLUE) > 0.03
    assert share_of(picture, ORANGE) > 0.03


@pytest.mark.parametrize("arena", every_third(["flag-strike", "othello"]))
def test_the_picture_is_there(stand: Stand, site: Path, arena: str) -> None:
    """At 800 x 450 and low quality the picture is not black, and each robot has its colour."""
    last = Recorded(site, arena).frames[-1]
    stand.open(f"{arena}.bin", speed=0, beat=last.beat, q="low", labels=0)
    picture = stand.pixels()
    assert picture.shape == (450, 800, 3)
    assert np.median(picture) > 20
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 100
    if arena == "othello":
        assert share_of(picture, BLUE, 45) > 0.03
        assert share_of(picture, ORANGE, 45) > 0.03
    places = np.frombuffer(last.poses, "<f4")[[0, 1, 25, 26]].reshape(2, 2)
    for (x_m, y_m), colour in zip(places.tolist(), (BLUE, ORANGE), strict=True):
        x, y = map(round, stand.view(f"screen({x_m}, {y_m}, 0.05)"))
        robot = picture[y - 30 : y + 30, x - 45 : x + 45]
        # The far robot of Flag-Strike has 349 of 5,400 pixels in its colour, the others more.
        assert share_of(robot, colour, 45) > 0.06


@pytest.mark.parametrize(
    "size",
    [
        (390, 844),
        pytest.param((1366, 768), marks=pytest.mark.long),
        pytest.param((600, 200), marks=pytest.mark.long),
    ],
)
@pytest.mark.parametrize("camera", ["arena", "top", "side", "map"])
def test_the_whole_field_fits(
    open_page: OpenPage, address: str, size: tuple[int, int], camera: str
) -> None:
    """The whole field fits each window below a bar of 40 pixels, and takes up much of it."""
    width, height = size
    stand = Stand(open_page(viewport={"width": width, "height": height}), address)
    stand.open("flag-strike.bin", speed=0, q="low", camera=camera, top=40)
    stand.next_frames()
    places = [stand.view(f"screen({x}, {y}, 0)") for x in (-1, 1) for y in (-1, 1)]
    assert all(0 <= x <= width and 40 <= y <= height for x, y in places)
    wide = max(x for x, _ in places) - min(x for x, _ in places)
    high = max(y for _, y in places) - min(y for _, y in places)
    least = 0.45 if camera == "side" else 0.7
    assert wide > least * width or high > least * (height - 40)


def test_clicks_say_what_was_clicked(stand: Stand, site: Path) -> None:
    """A click reports which disc or which robot was clicked."""
    recorded = Recorded(site, "othello")
    frame = recorded.frames[-1]
    stand.open("othello.bin", speed=0, beat=frame.beat, q="low", labels=0)
    robots = np.frombuffer(frame.poses, "<f4")[[0, 1, 25, 26]].reshape(2, 2)
    free = next(
        index
        for index, marker in enumerate(recorded.sheet.markers)
        if min(math.dist((marker.x_m, marker.y_m), robot) for robot in robots) > 0.45
    )
    marker = recorded.sheet.markers[free]
    stand.page.mouse.click(*stand.view(f"screen({marker.x_m}, {marker.y_m}, 0.003)"))
    hit: dict[str, Any] = stand.page.evaluate("stand.picked.value")
    assert hit["marker"] == free
    assert (hit["x_m"], hit["y_m"]) == pytest.approx((marker.x_m, marker.y_m), abs=0.02)
    for seat, (x_m, y_m) in enumerate(robots.tolist()):
        stand.page.mouse.click(*stand.view(f"screen({x_m}, {y_m}, 0.05)"))
        assert stand.page.evaluate("stand.picked.value")["seat"] == seat


@pytest.mark.long
def test_a_flag_can_be_clicked_at_its_pole(stand: Stand, site: Path) -> None:
    """A click on the thin pole of a flag reports the flag."""
    recorded = Recorded(site, "flag-strike")
    frame = recorded.frames[0]
    stand.open("flag-strike.bin", speed=0, beat=frame.beat, q="low", labels=0)
    index = next(i for i, marker in enumerate(recorded.sheet.markers) if marker.kind == "flag")
    marker = recorded.sheet.markers[index]
    stand.page.mouse.click(*stand.view(f"screen({marker.x_m}, {marker.y_m}, 0.18)"))
    assert stand.page.evaluate("stand.picked.value")["marker"] == index


def test_dragging_turns_the_camera_and_is_no_click(stand: Stand) -> None:
    """Drag and wheel move the camera and click nothing; a double click undoes both."""
    stand.open("othello.bin", speed=0, q="low")
    eye = np.array(stand.view("eye"))
    stand.page.mouse.move(400, 225)
    stand.page.mouse.down()
    stand.page.mouse.move(500, 235, steps=4)
    stand.page.mouse.up()
    stand.page.mouse.wheel(0, -300)
    stand.next_frames()
    assert np.linalg.norm(np.array(stand.view("eye")) - eye) > 0.3
    assert stand.page.evaluate("stand.picked.value") is None
    stand.page.mouse.dblclick(400, 225)
    stand.next_frames()
    assert np.allclose(stand.view("eye"), eye, atol=1e-6)


@pytest.mark.long
def test_only_the_left_button_turns_the_camera(stand: Stand) -> None:
    """The right button, and a left button whose release was lost, do not turn the camera."""
    stand.open("othello.bin", speed=0, q="low")
    eye = stand.view("eye")
    stand.page.mouse.move(400, 225)
    stand.page.mouse.down(button="right")
    stand.page.mouse.move(500, 235, steps=4)
    stand.page.mouse.up(button="right")
    stand.next_frames()
    assert stand.view("eye") == eye

    held = {"pointerId": 1, "button": 0, "buttons": 1, "clientX": 500, "clientY": 235}
    mouse = {"pointerType": "mouse", "bubbles": True}
    stand.page.dispatch_event(".view", "pointerdown", held | mouse)  # its release is lost
    stand.page.mouse.move(400, 225, steps=4)
    stand.next_frames()
    assert stand.view("eye") == eye


@pytest.mark.long
def test_a_lost_context_comes_back(stand: Stand) -> None:
    """The picture comes back after the graphics driver has restarted."""
    stand.open("othello.bin", speed=0, q="low")
    stand.page.evaluate(
        """() => {
          window.lost = document.querySelector("canvas");
          window.lost.getContext("webgl2").getExtension("WEBGL_lose_context").loseContext();
        }"""
    )
    stand.page.wait_for_function(
        "document.querySelector('canvas') && document.querySelector('canvas') !== window.lost"
    )
    stand.next_frames()
    assert share_of(stand.pixels(), BLUE) > 0.03


@pytest.mark.long
def test_a_driver_that_restarts_slowly_leaves_the_map(stand: Stand) -> None:
    """While the graphics driver gives no new context the map is drawn, and then the field again."""
    stand.open("othello.bin", speed=0, q="low")
    stand.page.evaluate(
        """() => {
          const get = HTMLCanvasElement.prototype.getContext;
          const lost = document.querySelector("canvas").getContext("webgl2");
          HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
            return kind.startsWith("webgl") ? null : get.call(this, kind, ...more);
          };
          window.driverIsBack = () => { HTMLCanvasElement.prototype.getContext = get; };
          lost.getExtension("WEBGL_lose_context").loseContext();
        }"""
    )
    stand.page.wait_for_function("__lacoc.view.quality === 'map'")
    stand.page.evaluate("driverIsBack()")
    stand.page.wait_for_function("__lacoc.view.quality === 'low'")
    stand.next_frames()
    assert share_of(stand.pixels(), BLUE) > 0.03


@pytest.mark.long
def test_who_cannot_be_steered_is_grey(stand: Stand, site: Path) -> None:
    """The robot of a silent seat is drawn grey."""
    frame = Recorded(site, "flag-strike").frames[0]
    stand.open("flag-strike.bin", speed=0, beat=frame.beat, q="low", labels=0, camera="top")
    before = share_of(stand.pixels(), BLUE)
    stand.page.evaluate(
        """() => stand.change((frame) => ({
          ...frame, seats: frame.seats.map((seat) => ({ ...seat, flags: seat.flags | 4 })) }))"""
    )
    stand.next_frames()
    assert share_of(stand.pixels(), BLUE) < 0.5 * before


AS_A_CARD = """
const own = WebGL2RenderingContext.prototype.getParameter;
WebGL2RenderingContext.prototype.getParameter = function (name) {
  return name === 0x9246 ? "A graphics card" : own.call(this, name);
};
"""
"""Lets the browser's software say that it is a graphics card."""


@pytest.mark.long(minutes=1)
def test_a_graphics_card_draws_light_and_shadows(stand: Stand, console: Any) -> None:
    """All shaders of the fine picture compile, and each robot has its colour and a shadow."""
    stand.page.add_init_script(AS_A_CARD)
    stand.open("othello.bin", speed=0, q="high", labels=0)
    assert stand.view("quality") == "high"
    picture = stand.pixels()
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 2000
    assert share_of(picture, BLUE, 60) > 0.02
    assert share_of(picture, ORANGE, 60) > 0.02
    assert console.errors == []


@pytest.mark.long
def test_in_software_it_begins_coarse(stand: Stand) -> None:
    """Without a graphics card low quality is chosen automatically, and a person can change it."""
    stand.open("othello.bin", speed=0, q="auto")
    assert stand.view("quality") == "low"
    stand.page.evaluate("stand.quality.value = 'high'")
    stand.page.wait_for_function("__lacoc.view.quality === 'high'")


def test_two_views_side_by_side(stand: Stand) -> None:
    """Two views are drawn side by side, with different cameras (workshop Fig. 5-11)."""
    stand.open("othello.bin", speed=0, q="low", views=2, beat=500)
    stand.page.wait_for_function("__lacoc.views.length === 2 && __lacoc.views[1].drawnFrames > 2")
    eyes = stand.page.evaluate("__lacoc.views.map((view) => view.eye)")
    assert math.dist(*eyes) > 0.3


@pytest.mark.long
def test_cameras_glide(stand: Stand) -> None:
    """When another camera is chosen, the picture's viewpoint moves to another place."""
    stand.open("othello.bin", speed=0, q="low", beat=500)
    for name in ("top", "chase", "arena"):
        before = np.array(stand.view("eye"))
        stand.page.evaluate("(name) => { stand.camera.value = name; }", name)
        stand.page.wait_for_function("(name) => __lacoc.view.camera === name", arg=name)
        stand.page.wait_for_function(
            "(eye) => Math.hypot(...eye.map((m, i) => m - __lacoc.view.eye[i])) > 0.3",
            arg=[float(m) for m in before],
        )
