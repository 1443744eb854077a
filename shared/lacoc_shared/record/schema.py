"""The contents of a record other than inputs, events and frames."""

from typing import Any

import msgspec

from lacoc_shared.inputs import Input
from lacoc_shared.messages import Event, Frame, HealthVerdict, Scene, Sheet
from lacoc_shared.messages.office import Assigned
from lacoc_shared.words import Phrase


class ForkSeat(msgspec.Struct, frozen=True, kw_only=True):
    """Who plays a seat in a fork's own beats; without bot and script, its recorded keys do."""

    seat: str
    """Id of the seat."""
    bot: str = ""
    """The bot that plays it, as it was named; of a file the name alone, without its folders."""
    script: str = ""
    """File name of the key script that plays it."""


class ForkChanges(msgspec.Struct, frozen=True, kw_only=True):
    """How a fork's own beats were made from the match that it goes on from."""

    seats: tuple[ForkSeat, ...]
    """All seats, in the order of the arena."""
    take_back: int | None = None
    """Number of the event that was taken back; None: none."""
    restart: tuple[str, ...] = ()
    """Ids of the seats whose robots were put back at a start place."""
    variant: int = 0
    """Which delays its bots had: forks with other numbers had other ones. 0: none."""

    @property
    def is_none(self) -> bool:
        """True if nothing was changed."""
        players = any(one.bot or one.script for one in self.seats)
        return not players and self.take_back is None and not self.restart


class Origin(msgspec.Struct, frozen=True, kw_only=True):
    """What a fork goes on from: another match, up to a beat."""

    match_id: str
    """Id of that match; it may be a fork too."""
    beat: int
    """First beat that the fork plays itself; it has all earlier beats from the other match."""
    record_hash: str
    """Hash of the messages of that match's record, hexadecimal."""
    changes: ForkChanges | None = None
    """How the fork was made; None: its record is older and does not say."""


class Setup(msgspec.Struct, frozen=True, kw_only=True):
    """Everything that a match is made from; with the inputs it gives the same match again."""

    match_id: str = ""
    """Names the match's record."""
    court: str
    match: int
    """Number of the match at its court, from 1."""
    arena: str
    settings: dict[str, Any]
    """The arena file as played, with the contest's overrides."""
    limits: dict[str, float]
    """Contest limits for robots (rules 1) that differ from the defaults."""
    assigned: Assigned | None = None
    """What the office, or a court that was started alone, assigned; None: the record is older."""
    origin: Origin | None = None
    """What the match is a fork of; None: it was played from its first beat on."""


class Header(msgspec.Struct, frozen=True, kw_only=True):
    """The first message of every segment of a record."""

    format: int
    """`FORMAT` of the software that wrote it."""
    match_id: str
    """Id of the match, equal in all its segments; names its files."""
    segment: int
    """Number of segments before this one; 0 for the first."""
    first_beat: int
    """First beat of the segment. Anything that earlier segments hold from this beat on is ignored,
    because no reply was sent yet: a court killed in the middle of a beat plays that beat again.
    """
    started: str
    """Wall time at which the segment began, ISO 8601, UTC."""
    versions: dict[str, str]
    """lacoc, protocol, mujoco, model, machine; a replay needs the same mujoco and model."""
    arithmetic: dict[str, str] = {}
    """Fingerprint of the arithmetic of the machine (`functions`, `model`, `path`: hashes) and its
    origin (`processor`, `libc`, `python`, `system`). Empty in older records."""
    setup: Setup


class Touch(msgspec.Struct, frozen=True, array_like=True):
    """What a tick's frame does not show: which markers were touched, and which robots put back.

    It is not recorded for a tick without touches and without robots that were put back.
    """

    touched: tuple[tuple[int, ...], ...]
    """For each seat, the markers that it touched."""
    placed: tuple[tuple[float, float, float] | None, ...]
    """For each seat, the start place where it was put in this tick: x, y [m], heading [rad]."""


class Result(msgspec.Struct, frozen=True, kw_only=True):
    """The end of a match. It keeps both the computed and the official result (rules 4.1)."""

    match_id: str
    court: str
    match: int
    arena: str
    teams: tuple[str, ...]
    scores: tuple[int, ...]
    """Points by seat, with the referee's adjustments."""
    computed: str
    """Seat id of the winner by the rules, "draw", or "" if play never ended."""
    official: str
    """Seat id of the official winner or "draw"; "" until OFFICIAL, "void" for a void match."""
    reason: Phrase | str
    """Why the match ended (`over.*`; a text in a record of protocol 1)."""
    clock_s: float
    beats: int
    digest: str
    """Hash chain over the state up to the last beat, hexadecimal."""
    model: str
    """Hash of the compiled model, hexadecimal."""


FORMAT = 1
"""Version of the layout of records."""

PROFILE = "lacoc"
"""MCAP profile of a record: distinguishes it from other MCAP files."""

BEAT_NS = 20_000_000
"""Nanoseconds in a beat: a message's time in the file is its beat number times this."""

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
"""The channels of a record by topic, and the msgpack message of each; None: bytes that only the
court understands. A channel's id is its position here, counted from 1."""
