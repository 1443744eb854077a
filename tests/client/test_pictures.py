"""Tests of frames that are put into words and pictures for the terminal."""

import io
import math
import struct
from typing import Any

import pytest
from rich.console import Console

from lacoc_arenas import arena as arenas
from lacoc_client.play.terminal import words
from lacoc_client.play.terminal.board_picture import BoardPicture, Field, PixelGrid, seat_letters
from lacoc_client.play.terminal.plain import event_dict, frame_dict
from lacoc_shared.codec import pack_states
from lacoc_shared.messages import Event, Frame, Scene, SceneGeom, SeatFrame, Sheet, SheetSeat
from lacoc_shared.messages.office import WAITING
from lacoc_shared.mistakes import Mistake
from lacoc_shared.seat import Phase, SeatFlag
from lacoc_shared.words import say, use

LABELS = ("R,F", "R,C", "R,B", "L,B", "L,C", "L,F")
SCENE = bytes(range(8))
BOTH = int(SeatFlag.JOINED | SeatFlag.READY)


def make_sheet(arena: str, **changes: Any) -> Sheet:
    loaded = arenas.load(arena)
    seats = tuple(
        SheetSeat(
            id=seat.id,
            team=f"Team {seat.id}",
            colour=seat.colour,
            pattern=seat.pattern,
            legs=LABELS,
            keys=((), (0, 1, 2, 3)),
            postures=(1, 4, 4, 4),
        )
        for seat in loaded.seats
    )
    fields: dict[str, Any] = {
        "protocol": 1,
        "version": "0",
        "court": "main",
        "match": 1,
        "arena": arena,
        "title": loaded.title,
        "duration_s": loaded.match.duration_s,
        "levels": (1,),
        "settings": {},
        "seats": seats,
        "markers": loaded.game.markers,
        "scene": SCENE,
    }
    return Sheet(**(fields | changes))


def seat_frame(**changes: int) -> SeatFrame:
    fields = {"flags": BOTH, "score": 0, "level": 1, "key": 2, "posture": 1, "locked_ticks": 0}
    answers = {"applied_seq": 0, "applied_beat": 0, "refused_seq": 0, "refused_why": 0}
    return SeatFrame(**(fields | answers | changes))


def pose(x_m: float, y_m: float, heading_deg: float) -> bytes:
    """Return the pose of a standing robot whose body's +y axis points to the heading."""
    half = math.radians(heading_deg - 90) / 2
    numbers = (x_m, y_m, 0.07, math.cos(half), 0.0, 0.0, math.sin(half), *([0.0] * 18))
    return struct.pack("<25f", *numbers)


def make_frame(sheet: Sheet, states: tuple[int, ...] = (), **changes: Any) -> Frame:
    fields: dict[str, Any] = {
        "match": 1,
        "beat": 7,
        "phase": int(Phase.PLAYING),
        "countdown_beats": 0,
        "clock_ticks": 1500,
        "seats": tuple(seat_frame() for _ in sheet.seats),
        "markers": pack_states(states or (0,) * len(sheet.markers)),
        "poses": b"",
        "scene": SCENE,
        "digest": bytes(8),
    }
    return Frame(**(fields | changes))


@pytest.mark.parametrize("heading_deg", [0.0, 90.0, 179.0, -45.0])
def test_a_frame_in_words(heading_deg: float) -> None:
    """A frame in words names seats, markers and phases, and is in metres, seconds and degrees."""
    sheet = make_sheet("othello")
    seats = (seat_frame(score=19, flags=BOTH | SeatFlag.FROZEN, locked_ticks=25), seat_frame())
    poses = pose(0.5, -0.25, heading_deg) + pose(0.0, 0.0, 180.0)
    frame = make_frame(sheet, (1, 2) + (0,) * 34, seats=seats, poses=poses)
    plain = frame_dict(frame, sheet)

    assert (plain["phase"], plain["clock_s"], plain["left_s"]) == ("PLAYING", 30.0, 150.0)
    left = plain["seats"][0]
    assert (left["id"], left["team"], left["score"]) == ("left", "Team left", 19)
    assert (left["level"], left["key"], left["frozen"], left["silent"]) == ("B", 2, True, False)
    assert left["locked_s"] == 0.5
    assert list(plain["markers"].items())[:3] == [
        ("c0r0", "left"),
        ("c1r0", "right"),
        ("c2r0", "neutral"),
    ]
    there = plain["poses"]["left"]
    assert (there["x_m"], there["y_m"]) == (0.5, -0.25)
    assert there["heading_deg"] == pytest.approx(heading_deg, abs=1e-3)


@pytest.mark.parametrize(
    ("heading_deg", "shown"), [(90.0, "0°"), (0.0, "-90°"), (179.0, "89°"), (-90.0, "180°")]
)
def test_the_terminal_shows_the_yaw_of_pos_data(heading_deg: float, shown: str) -> None:
    """The heading in the terminal is 0 where a robot looks along the field's +y (rules 2)."""
    sheet = make_sheet("othello")
    frame = make_frame(sheet, poses=pose(0.5, -0.25, heading_deg) * 2)
    assert words.place(frame, sheet, "left") == f"  x 0.50 m  y -0.25 m  heading {shown}"


@pytest.mark.parametrize(
    ("changes", "empty"),
    [({"poses": b""}, "poses"), ({"scene": bytes(8)}, "poses"), ({"markers": b""}, "markers")],
)
def test_a_frame_of_another_scene_is_put_into_words_too(
    changes: dict[str, bytes], empty: str
) -> None:
    """In words, `poses` is empty if a frame has none or another scene; `markers` if it has none."""
    sheet = make_sheet("othello")
    poses = pose(0.0, 0.0, 0.0) * 2
    plain = frame_dict(make_frame(sheet, **({"poses": poses} | changes)), sheet)

    assert [name for name in ("poses", "markers") if not plain[name]] == [empty]


def test_an_event_in_words() -> None:
    """An event in words has the name of its seat, and its clock in seconds."""
    event = Event(
        number=3,
        match=1,
        beat=9,
        clock_ticks=75,
        kind="flip",
        said=say("plain.text", text="x"),
        seat=1,
    )
    plain = event_dict(event, make_sheet("othello"))

    assert (plain["seat"], plain["clock_s"], plain["number"]) == ("right", 1.5, 3)


@pytest.mark.parametrize(
    ("ticks", "expected"), [(0, "3:00"), (1, "3:00"), (50, "2:59"), (9000, "0:00"), (9001, "0:00")]
)
def test_the_clock_counts_down(ticks: int, expected: str) -> None:
    """The clock rounds the time left up to whole seconds, so 0:00 is shown only at the end."""
    sheet = make_sheet("othello")
    assert words.match_clock(make_frame(sheet, clock_ticks=ticks), sheet) == expected


def test_the_lobby_says_who_is_missing() -> None:
    """In the lobby, a hint names the empty seats and the teams that have not said ready."""
    sheet = make_sheet("othello")
    seats = (seat_frame(flags=0), seat_frame(flags=int(SeatFlag.JOINED)))
    frame = make_frame(sheet, phase=int(Phase.LOBBY), seats=seats)

    assert words.phase_hint(frame, sheet) == (
        "waiting for the left seat to join; Team right has not said ready"
    )
    use("ja")
    try:
        assert "; " not in words.phase_hint(frame, sheet)
    finally:
        use("en")


def test_before_ready_no_robot_does_anything() -> None:
    """Without robots on the field no key is shown; with robots, each seat's key is shown."""
    sheet = make_sheet("othello")
    assert words.standing_key(make_frame(sheet), sheet, 0) == ""
    on_field = make_frame(sheet, poses=pose(0.0, 0.0, 0.0) * 2)
    assert "key" in words.standing_key(on_field, sheet, 0)


def test_lists_are_joined_in_the_language() -> None:
    """Lists of refusals and of places have the language's own comma."""
    refused = {"wrong-token": 1, "flood": 2}
    mistake = Mistake(file="a.txt", found="1", expected="2", row=3, column=4)
    assert words.refusals(refused) == "1 (wrong token), 2 (too many at once)"
    assert mistake.place == "row 3, column 4"
    use("ja")
    try:
        assert ", " not in words.refusals(refused) + mistake.place
        assert "、" in words.refusals(refused)
        assert "、" in mistake.place
    finally:
        use("en")


def draw(frame: Frame, sheet: Sheet, field: Field, rows: int, **options: Any) -> list[str]:
    text = io.StringIO()
    console = Console(file=text, width=200, **options)
    console.print(BoardPicture(PixelGrid(field, rows), frame, sheet))
    return text.getvalue().splitlines()


OTHELLO = Field(0.0, 0.0, 1.02, 1.02)


def test_a_board_needs_no_colours() -> None:
    """Without colours, letters and shades show each disc's owner; the top row is north."""
    sheet = make_sheet("othello")
    states = (1,) * 6 + (0,) * 24 + (2,) * 6  # the southern row is left's, the northern right's
    lines = draw(make_frame(sheet, states), sheet, OTHELLO, 20)

    assert len(lines) == 20
    assert {len(line) for line in lines} == {40}
    assert [line.count("R") for line in lines if "R" in line] == [6]
    assert [line.count("L") for line in lines if "L" in line] == [6]
    rows = ["R" in line for line in lines], ["L" in line for line in lines]
    assert rows[0].index(True) < rows[1].index(True)
    assert any("░" in line for line in lines)
    assert any("▒" in line for line in lines)


def test_robots_are_arrows_with_their_letters() -> None:
    """An arrow with the robot's letter shows where the robot is and which way it faces."""
    sheet = make_sheet("othello")
    poses = pose(0.75, 0.75, 45.0) + pose(-0.75, -0.75, 180.0)
    lines = draw(make_frame(sheet, poses=poses), sheet, OTHELLO, 20)

    assert any("L↗" in line for line in lines[:6])
    assert any("R←" in line for line in lines[-6:])


def test_flags_show_their_points_and_then_who_struck_them() -> None:
    """A standing flag shows its points, and a struck one the letter of the robot that struck it."""
    sheet = make_sheet("flag-strike")
    field = Field(0.0, 0.0, 1.0, 1.0)
    standing = "\n".join(draw(make_frame(sheet), sheet, field, 24))
    states = (0,) * 4 + (1,) * 10 + (2,) * 9 + (3,)
    struck = "\n".join(draw(make_frame(sheet, states), sheet, field, 24))

    assert [standing.count(points) for points in "1235"] == [8, 6, 4, 2 + 4]  # corners: 5 points
    assert [struck.count(letter) for letter in "LRx5"] == [10, 9, 1, 4]


def test_a_colour_terminal_shows_two_pixels_in_a_character() -> None:
    """On a colour terminal the board is drawn in colours, with two pixels in a character."""
    sheet = make_sheet("othello")
    options = {"force_terminal": True, "color_system": "truecolor", "legacy_windows": False}
    text = "\n".join(draw(make_frame(sheet, (1,) * 36), sheet, OTHELLO, 20, **options))

    assert "▀" in text
    assert "\x1b[38;2;" in text


@pytest.mark.parametrize("rows", [3, 10, 34])
@pytest.mark.parametrize("arena", ["othello", "flag-strike", "practice"])
def test_every_size_can_be_drawn(arena: str, rows: int) -> None:
    """The board can be drawn in any number of rows, also with robots off the field."""
    sheet = make_sheet(arena)
    poses = b"".join(pose(9.0, -9.0, 10.0) for _ in sheet.seats)
    lines = draw(make_frame(sheet, poses=poses), sheet, Field(0.0, 0.0, 1.5, 1.0), rows)

    assert len(lines) == rows


def test_a_field_is_the_scene_s_floor() -> None:
    """The drawn field is the scene's floor, or the area around the markers if there is no floor."""
    floor = SceneGeom(
        body=0,
        type="plane",
        size=(1.2, 0.8, 0.05),
        pos=(0.1, 0.0, 0.0),
        quat=(1.0, 0.0, 0.0, 0.0),
        rgba=(1.0, 1.0, 1.0, 1.0),
    )
    sheet = make_sheet("othello")

    assert Field.of(Scene(bodies=(), geoms=(floor,)), sheet) == (0.1, 0.0, 1.2, 0.8)
    around = Field.of(Scene(bodies=(), geoms=()), sheet)
    assert around.half_x_m == around.half_y_m == pytest.approx(0.75 + 0.12 + 0.15)


@pytest.mark.parametrize(
    ("ids", "letters"),
    [(["left", "right"], ["L", "R"]), (["solo"], ["S"]), (["a1", "a2"], ["1", "2"])],
)
def test_every_seat_has_its_letter(ids: list[str], letters: list[str]) -> None:
    """Seats are shown by their first letters, or as 1, 2, ... if two seats begin alike."""
    assert seat_letters(ids) == letters


def test_what_an_office_assigned_is_named_beside_the_game() -> None:
    """Terminals name the fixture with the game, and say that a court waits for the office."""
    sheet = make_sheet("othello")
    frame = Frame(1, 0, Phase.LOBBY, 0, 0, (), b"", b"", SCENE, bytes(8))
    assert words.played(sheet) == sheet.title
    final = make_sheet("othello", call="c1", fixture=say("fixture.final", stage=None))
    assert words.played(final) == f"Final · {sheet.title}"
    waiting = make_sheet("othello", fixture=WAITING.fixture)
    assert words.played(waiting) == sheet.title
    assert words.phase_hint(frame, waiting) == "Waiting for the next match"
