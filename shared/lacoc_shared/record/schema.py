"""What a record holds beside inputs, events and frames."""

from typing import Any

import msgspec

from lacoc_shared.inputs import Input
from lacoc_shared.messages import Event, Frame, HealthVerdict, Scene, Sheet
from lacoc_shared.words import Phrase


class Setup(msgspec.Struct, frozen=True, kw_only=True):
    """All that a match is made from; with the inputs it gives the same match again."""

    match_id: str = ""
    """Names the match's record."""
    court: str
    match: int
    """Number of the match at its court, from 1."""
    arena: str
    settings: dict[str, Any]
    """The arena file as played, contest's overrides included."""
    limits: dict[str, float]
    """Contest limits for robots (rules 1) that differ from the defaults."""


class Header(msgspec.Struct, frozen=True, kw_only=True):
    """The first message of every segment of a record."""

    format: int
    """`FORMAT` of the software that wrote it."""
    match_id: str
    """The same for all segments of a match; names its files."""
    segment: int
    """0, or how many segments came before."""
    first_beat: int
    """Beat the segment begins with. What earlier segments hold from it on was never answered: it
    does not count (a court killed in the middle of a beat does that beat again)."""
    started: str
    """Wall time of the segment's begin, ISO 8601, UTC."""
    versions: dict[str, str]
    """lacoc, protocol, mujoco, machine: a replay is exact only where they agree."""
    arithmetic: dict[str, str] = {}
    """Fingerprint of the arithmetic that made it (`functions`, `model`, `path`: hashes) and where
    it comes from (`processor`, `libc`, `python`, `system`). Empty in records from before it."""
    setup: Setup


class Touch(msgspec.Struct, frozen=True, array_like=True):
    """What the rules saw in a tick beside the poses of its frame; only where there was any."""

    touched: tuple[tuple[int, ...], ...]
    """For each seat the markers it touched."""
    placed: tuple[tuple[float, float, float] | None, ...]
    """For each seat the start place it was put on in this tick: x, y [m], heading [rad]."""


class Result(msgspec.Struct, frozen=True, kw_only=True):
    """How a match ended. The computed result and the official one are both kept (rules 4)."""

    match_id: str
    court: str
    match: int
    arena: str
    teams: tuple[str, ...]
    scores: tuple[int, ...]
    """With the referee's adjustments."""
    computed: str
    """Seat id of the winner by the rules, "draw", or "" if play never ended."""
    official: str
    """The same after the referee's word; "" until OFFICIAL, "void" for a void match."""
    reason: Phrase | str
    """Why the match ended (`over.*`; a text in a record of protocol 1)."""
    clock_s: float
    beats: int
    digest: str
    """Chained state hash at the last beat, hexadecimal."""
    model: str
    """Hash of the compiled model, hexadecimal."""


FORMAT = 1
"""Version of the record's own layout."""

PROFILE = "lacoc"
"""MCAP profile of a record: tells it from the MCAP files of others."""

BEAT_NS = 20_000_000
"""A message's time in the file is its beat times this."""

KINDS: dict[str, Any] = {
    "/lacoc/header": Header,
    "/lacoc/input": Input,
    "/lacoc/event": Event,
    "/lacoc/frame": Frame,
    "/lacoc/touch": Touch,
    "/lacoc/snapshot": None,
    "/lacoc/sheet": Sheet,
    "/lacoc/scene": Scene,
    "/lacoc/result": Result,
    "/lacoc/health": HealthVerdict,
}
"""The channels of a record by topic, and the message of each in msgpack; None: bytes that only
the court understands. A channel's number is its place here, from 1."""
