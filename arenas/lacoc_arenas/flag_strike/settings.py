"""The table [game] of a Flag-Strike arena file, and the checks for a fair layout (rules 6)."""

import math
from collections.abc import Iterator
from typing import Annotated, NamedTuple

import msgspec

from lacoc_arenas.game import WrongSetting
from lacoc_arenas.layout import Length, Point
from lacoc_shared.words import Phrase, say

FLAGS, COLOURS = 20, 4
"""How many flags there must be, and how many colours (workshop 5-2 rule 6)."""

Points = Annotated[int, msgspec.Meta(ge=1, le=1000)]


class FlagColour(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The flags of one colour; all are worth the same."""

    name: str
    rgb: Annotated[str, msgspec.Meta(pattern="^#[0-9a-fA-F]{6}$")]
    points: Points
    flags: tuple[Point, ...]


class Flag(NamedTuple):
    """One flag on the field: its place, colour and points."""

    name: str
    colour: FlagColour
    x_m: float
    y_m: float

    def __str__(self) -> str:
        return f"{self.name} ({self.colour.name}, [{self.x_m}, {self.y_m}])"


class Settings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The table [game] of the arena file of Flag-Strike."""

    size_m: tuple[Length, Length]
    corner_radius_m: Length
    corner_inset_m: Length
    corner_points: Points
    all_corners_win: bool
    starts: Annotated[tuple[Point, ...], msgspec.Meta(min_length=1)]
    """The left team's start places, the best first."""
    pole_radius_m: Length
    pole_height_m: Length
    clearance_m: Annotated[float, msgspec.Meta(ge=0, le=20)]
    """Least distance of a flag from the edge of each corner and from each start place [m]."""
    colour: tuple[FlagColour, ...]

    def __post_init__(self) -> None:
        reach_m = self.corner_inset_m + self.corner_radius_m
        if 2 * reach_m > min(self.size_m):
            raise WrongSetting(
                say(
                    "setting.corners-overlap",
                    inset_m=self.corner_inset_m,
                    radius_m=self.corner_radius_m,
                    width_m=str(self.size_m[0]),
                    depth_m=str(self.size_m[1]),
                )
            )
        for x_m, y_m in self.starts:
            if not self._inside(x_m, y_m):
                raise WrongSetting(say("setting.start-outside", x_m=str(x_m), y_m=str(y_m)))
        self._check_colours()
        self._check_flags()

    @property
    def corners(self) -> tuple[tuple[float, float], ...]:
        """Centres of the corners: bottom left, bottom right, top left, top right."""
        x_m, y_m = (size / 2 - self.corner_inset_m for size in self.size_m)
        return ((-x_m, -y_m), (x_m, -y_m), (-x_m, y_m), (x_m, y_m))

    @property
    def flags(self) -> tuple[Flag, ...]:
        """All flags of the game, in the order of the arena file."""
        places = [(colour, place) for colour in self.colour for place in colour.flags]
        return tuple(
            Flag(f"flag{number}", colour, x_m, y_m)
            for number, (colour, (x_m, y_m)) in enumerate(places)
        )

    def _inside(self, x_m: float, y_m: float) -> bool:
        return abs(x_m) < self.size_m[0] / 2 and abs(y_m) < self.size_m[1] / 2

    def _check_colours(self) -> None:
        if len(self.colour) != COLOURS:
            found = len(self.colour)
            raise WrongSetting(say("setting.colours", found=found, expected=COLOURS))
        if len({colour.name for colour in self.colour}) != COLOURS:
            raise WrongSetting(say("setting.same-name"))
        if len({colour.points for colour in self.colour}) != COLOURS:
            raise WrongSetting(say("setting.same-points"))
        if len(self.flags) != FLAGS:
            raise WrongSetting(say("setting.flags", found=len(self.flags), expected=FLAGS))

    def _check_flags(self) -> None:
        flags = self.flags
        standing: dict[tuple[float, float], Flag] = {}
        for flag in flags:
            other = standing.setdefault((flag.x_m, flag.y_m), flag)
            if other is not flag:
                raise WrongSetting(say("setting.same-place", flag=str(flag), other=str(other)))
        mistakes = [mistake for flag in flags for mistake in self._mistakes(flag, standing)]
        if mistakes:
            raise WrongSetting(*mistakes)

    def _mistakes(self, flag: Flag, standing: dict[tuple[float, float], Flag]) -> Iterator[Phrase]:
        name = str(flag)
        if not self._inside(flag.x_m, flag.y_m):
            yield say("setting.flag-outside", flag=name)
        partner = standing.get((-flag.x_m, -flag.y_m))
        if partner is None or partner is flag or partner.colour is not flag.colour:
            place = str([0.0 - flag.x_m, 0.0 - flag.y_m])
            yield say("setting.no-partner", flag=name, colour=flag.colour.name, place=place)
        for number, (x_m, y_m) in enumerate(self.corners):
            gap_m = math.dist((flag.x_m, flag.y_m), (x_m, y_m)) - self.corner_radius_m
            if gap_m < self.clearance_m:
                yield say(
                    "setting.near-corner",
                    flag=name,
                    gap_m=gap_m,
                    corner=number,
                    least_m=self.clearance_m,
                )
        for x_m, y_m in self.starts:
            for team, start in (("left", (x_m, y_m)), ("right", (0.0 - x_m, 0.0 - y_m))):
                gap_m = math.dist((flag.x_m, flag.y_m), start)
                if gap_m < self.clearance_m:
                    yield say(
                        "setting.near-start",
                        flag=name,
                        gap_m=gap_m,
                        seat=team,
                        place=str(list(start)),
                        least_m=self.clearance_m,
                    )
