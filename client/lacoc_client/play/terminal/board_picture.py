"""The field from above, drawn with the characters of a terminal: two pixels a character.

Letters show to which seat a marker or a robot belongs, so one can read the picture without colours.
A terminal without colours shows shades of grey instead.
"""

import math
from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rich.color import Color
from rich.console import Console, ConsoleOptions, RenderResult
from rich.measure import Measurement
from rich.segment import Segment
from rich.style import Style

from lacoc_client.play.terminal.plain import poses
from lacoc_shared.codec import unpack_states
from lacoc_shared.messages import MARKER_STATES, Frame, MarkerInfo, Scene, Sheet

_Rgb = tuple[int, int, int]
_Image = NDArray[np.float64]

FLOOR: _Rgb = (38, 42, 48)
WALL: _Rgb = (104, 96, 84)
NEUTRAL: _Rgb = (92, 98, 108)
FALLEN: _Rgb = (58, 62, 68)
INK_DARK, INK_LIGHT = (16, 18, 20), (245, 245, 245)

_ROBOT_RADIUS_M = 0.12
"""Radius of the disc that is drawn for a robot with its feet; a ring one pixel wide surrounds
it."""
_ARROWS = "→↗↑↖←↙↓↘"  # counter-clockwise from +x
_SHADES = {"floor": " ", "wall": "█", "neutral": "·", "left": "░", "right": "▒", "down": " "}
_SAMPLES = 4  # samples across a pixel, for smooth edges
_MARGIN_M = 0.15  # around the markers, if the scene has no floor


class Field(NamedTuple):
    """The floor between the walls, in the world's frame."""

    x_m: float
    y_m: float
    half_x_m: float
    half_y_m: float

    @classmethod
    def of(cls, scene: Scene, sheet: Sheet) -> "Field":
        """Return the floor of a scene, or the area around the markers if the scene has no floor."""
        for geom in scene.geoms:
            if geom.type == "plane" and min(geom.size[:2]) > 0:
                return cls(geom.pos[0], geom.pos[1], geom.size[0], geom.size[1])
        reach = [abs(m.x_m) + m.radius_m for m in sheet.markers] or [1.0]
        reach_y = [abs(m.y_m) + m.radius_m for m in sheet.markers] or [1.0]
        return cls(0.0, 0.0, max(reach) + _MARGIN_M, max(reach_y) + _MARGIN_M)


class _Mark(NamedTuple):
    """A letter that is drawn over the pixels, such as that of a seat."""

    x_m: float
    y_m: float
    text: str
    ink: _Rgb
    bold: bool


class PixelGrid:
    """Maps the floor to the pixels of a picture; all pictures of a match share one.

    Args:
        field: the floor.
        rows: height of the picture in lines of text; the outermost pixels show the walls.
    """

    def __init__(self, field: Field, rows: int) -> None:
        self.field = field
        self.pixel_m = 2 * field.half_y_m / (2 * rows - 2)
        self.height = 2 * rows
        self.width = 2 + max(1, round(2 * field.half_x_m / self.pixel_m))
        steps = (np.arange(_SAMPLES) + 0.5) / _SAMPLES
        x = (np.arange(self.width)[:, None] + steps).ravel() - 1
        y = (np.arange(self.height)[:, None] + steps).ravel() - 1
        self._x_m = field.x_m - field.half_x_m + x * self.pixel_m
        self._y_m = field.y_m + field.half_y_m - y * self.pixel_m
        self._circles: dict[tuple[float, float, float], _Image] = {}

    def circle(self, x_m: float, y_m: float, radius_m: float) -> _Image:
        """Return how much of each pixel a circle covers, 0 to 1, as an array (height, width)."""
        inside = (self._x_m - x_m) ** 2 + (self._y_m[:, None] - y_m) ** 2 <= radius_m**2
        samples = inside.reshape(self.height, _SAMPLES, self.width, _SAMPLES)
        covered: _Image = samples.mean(axis=(1, 3))
        return covered

    def marker(self, marker: MarkerInfo) -> _Image:
        """Return how much of each pixel a marker covers; cached, because a marker does not move."""
        place = (marker.x_m, marker.y_m, marker.radius_m)
        if place not in self._circles:
            self._circles[place] = self.circle(*place)
        return self._circles[place]

    def cell(self, x_m: float, y_m: float) -> tuple[int, int]:
        """Return row and column of the terminal's character at a point of the field."""
        field = self.field
        column = 1 + (x_m - field.x_m + field.half_x_m) / self.pixel_m
        line = 1 + (field.y_m + field.half_y_m - y_m) / self.pixel_m
        return int(line / 2), int(column)

    def base(self) -> _Image:
        """Return an empty floor with its walls as a picture, an array (height, width, 3)."""
        image = np.empty((self.height, self.width, 3))
        image[:] = WALL
        image[1:-1, 1:-1] = FLOOR
        return image


class BoardPicture:
    """A picture of a frame, for printing with rich.

    Args:
        grid: the pixels of the picture.
        frame: the frame.
        sheet: the sheet of that frame.
    """

    def __init__(self, grid: PixelGrid, frame: Frame, sheet: Sheet) -> None:
        self._grid = grid
        self._image = grid.base()
        self._shades = np.full((grid.height, grid.width), _SHADES["floor"])
        self._shades[[0, -1], :] = self._shades[:, [0, -1]] = _SHADES["wall"]
        self._marks: list[_Mark] = []
        self._teams = [_rgb(seat.colour) for seat in sheet.seats]
        self._letters = seat_letters([seat.id for seat in sheet.seats])
        if 4 * len(frame.markers) >= len(sheet.markers):
            states = unpack_states(frame.markers, len(sheet.markers))
            for marker, state in zip(sheet.markers, states, strict=True):
                self._draw_marker(marker, state)
        for index, pose in enumerate(poses(frame, sheet).values()):
            self._draw_robot(index, pose["x_m"], pose["y_m"], pose["heading_deg"])

    def _draw_marker(self, marker: MarkerInfo, state: int) -> None:
        seat = state - 1 if 0 < state <= len(self._teams) else None
        name = MARKER_STATES[state]
        colour = NEUTRAL if name == "neutral" else FALLEN
        if seat is not None:
            colour = _mix(self._teams[seat], FLOOR, 0.25)
        if marker.radius_m > self._grid.pixel_m:
            self._fill(self._grid.marker(marker), colour, _SHADES[name])
            ink, bold = _ink(colour), False
        else:  # too small for a shape: only a letter
            ink = INK_LIGHT if name == "neutral" else _mix(colour, INK_LIGHT, 0.2)
            bold = name == "neutral"
        points = str(marker.points) if marker.points > 1 or bold else ""
        text = points if name == "neutral" else "x" if seat is None else self._letters[seat]
        if text:
            self._marks.append(_Mark(marker.x_m, marker.y_m, text[:1], ink, bold))

    def _draw_robot(self, seat: int, x_m: float, y_m: float, heading_deg: float) -> None:
        colour = _mix(self._teams[seat], INK_LIGHT, 0.4)
        inner_m = _ROBOT_RADIUS_M - self._grid.pixel_m
        self._fill(self._grid.circle(x_m, y_m, _ROBOT_RADIUS_M), INK_LIGHT, " ")
        self._fill(self._grid.circle(x_m, y_m, inner_m), colour, " ")
        # The robot hides what lies below it.
        self._marks = [
            mark
            for mark in self._marks
            if math.hypot(mark.x_m - x_m, mark.y_m - y_m) > _ROBOT_RADIUS_M
        ]
        arrow = _ARROWS[round(heading_deg / 45) % 8]
        ink = _ink(colour)
        self._marks.append(_Mark(x_m, y_m, arrow, ink, bold=True))
        beside_m = x_m - self._grid.pixel_m
        self._marks.append(_Mark(beside_m, y_m, self._letters[seat], ink, bold=True))

    def _fill(self, covered: _Image, colour: _Rgb, shade: str) -> None:
        part = covered[..., None]
        self._image = self._image * (1 - part) + np.array(colour) * part
        self._shades[covered > 0.5] = shade

    def __rich_measure__(self, console: Console, options: ConsoleOptions) -> Measurement:
        return Measurement(self._grid.width, self._grid.width)

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        plain = console.color_system is None
        pixels = self._image.round().astype(int).tolist()
        marks = {self._grid.cell(mark.x_m, mark.y_m): mark for mark in self._marks}
        for row in range(self._grid.height // 2):
            segments: list[Segment] = []
            for column in range(self._grid.width):
                mark = marks.get((row, column))
                if plain:
                    text = mark.text if mark else str(self._shades[2 * row + 1, column])
                    segments.append(Segment(text))
                    continue
                upper, lower = pixels[2 * row][column], pixels[2 * row + 1][column]
                if mark:
                    middle = tuple((a + b) // 2 for a, b in zip(upper, lower, strict=True))
                    style = _style(mark.ink, middle, mark.bold)
                    segments.append(Segment(mark.text, style))
                else:
                    segments.append(Segment("▀", _style(tuple(upper), tuple(lower))))
            yield from _joined(segments)
            yield Segment.line()


def seat_letters(ids: Sequence[str]) -> list[str]:
    """Return a letter for each seat, such as L and R; numbers if two seats begin alike."""
    letters = [name[:1].upper() for name in ids]
    if len(set(letters)) == len(letters):
        return letters
    return [str(number) for number in range(1, len(ids) + 1)]


@lru_cache(4096)
def _style(front: _Rgb, back: _Rgb, bold: bool = False) -> Style:
    return Style(color=Color.from_rgb(*front), bgcolor=Color.from_rgb(*back), bold=bold)


def _joined(segments: list[Segment]) -> Iterator[Segment]:
    """Merge neighbouring pieces of text that have the same style into one."""
    text, style = "", None
    for segment in segments:
        if segment.style is not style and text:
            yield Segment(text, style)
            text = ""
        text, style = text + segment.text, segment.style
    yield Segment(text, style)


def _rgb(colour: str) -> _Rgb:
    red, green, blue = (int(colour[at : at + 2], 16) for at in (1, 3, 5))
    return red, green, blue


def _mix(colour: _Rgb, other: _Rgb, part: float) -> _Rgb:
    red, green, blue = (round(a + (b - a) * part) for a, b in zip(colour, other, strict=True))
    return red, green, blue


def _ink(back: _Rgb) -> _Rgb:
    """Return the dark or the light ink, whichever can be read better on a colour."""
    red, green, blue = back
    return INK_DARK if 0.3 * red + 0.59 * green + 0.11 * blue > 110 else INK_LIGHT
