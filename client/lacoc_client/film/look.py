"""How a film looks: size, camera, quality, texts."""

from dataclasses import dataclass
from enum import StrEnum


class View(StrEnum):
    """What the camera of a film shows."""

    AUTO = "auto"
    ARENA = "arena"
    LEFT = "left"
    RIGHT = "right"
    SPLIT = "split"


class Quality(StrEnum):
    """How finely the pictures of a film are drawn."""

    LOW = "low"
    """As a page draws it without a graphics card."""
    SMOOTH = "smooth"
    """As LOW, with smooth edges."""
    HIGH = "high"
    """As a page draws it with a graphics card: with shadows and reflections."""


@dataclass(frozen=True)
class Look:
    """How a film looks: everything that decides its pictures, except the match."""

    view: View = View.AUTO
    overlay: bool = False
    """Whether the film shows score, clock, events, names and cards."""
    language: str = "en"
    width: int = 1280
    height: int = 720
    quality: Quality = Quality.SMOOTH
