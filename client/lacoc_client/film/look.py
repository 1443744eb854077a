"""How a film looks."""

from dataclasses import dataclass
from enum import StrEnum


class View(StrEnum):
    """What the camera shows."""

    AUTO = "auto"
    ARENA = "arena"
    LEFT = "left"
    RIGHT = "right"
    SPLIT = "split"


class Quality(StrEnum):
    """How finely the picture is drawn."""

    LOW = "low"
    """As a page does without a graphics card."""
    SMOOTH = "smooth"
    """The same with smooth edges."""
    HIGH = "high"
    """As a page does with a graphics card: shadows and reflections."""


@dataclass(frozen=True)
class Look:
    """How a film looks: all that a picture depends on besides the match."""

    view: View = View.AUTO
    overlay: bool = False
    """Score, clock, events, names and cards."""
    language: str = "en"
    width: int = 1280
    height: int = 720
    quality: Quality = Quality.SMOOTH
