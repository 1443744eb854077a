"""The messages of a record, except inputs, events and frames."""

from typing import Any

import msgspec

from lacoc_shared.inputs import Input
from lacoc_shared.messages import Event, Frame, HealthVerdict, Scene, Sheet
from lacoc_shared.messages.office import Assigned
from lacoc_shared.words import Phrase


class ForkSeat(msgspec.Struct, frozen=True, kw_only=True):
    """Who steers the robot of a seat in a fork: a bot, a script of keys, or the recorded keys."""

    seat: str
    """Id of the seat."""
    bot: str = ""
    """Name of the bot, as the user typed it; of a bot file only the name, without its folders."""
    script: str = ""
    """File name of the key script that steers the robot."""


class ForkChanges(msgspec.Struct, frozen=True, kw_only=True):
    """What was changed at the beat at which a fork leaves its origin."""

    seats: tuple[ForkSeat, ...]
    """All seats, in the order of the arena."""
    take_back: int | None = None
    """Number of the event that was taken back; None: no event was."""
    restart: tuple[str, ...] = ()
    """Ids of the seats whose robots were put back at a start place."""
    variant: int = 0
    """Number that decides the small delays of the fork's bots: forks with other numbers have other
    delays. 0: no delays."""

    @property
    def is_none(self) -> bool:
        """Whether nothing was changed: no bot, script, take-back or restart."""
        players = any(one.bot or one.script for one in self.seats)
        return not players and self.take_back is None and not self.restart


class Origin(msgspec.Struct, frozen=True, kw_only=True):
    """The match from which a fork goes on, and the beat at which it does so."""

    match_id: str
    """Id of that match; it may be a fork too."""
    beat: int
    """First beat that the fork plays itself; its earlier beats are those of the other match."""
    record_hash: str
    """Hash of the messages in that match's record, hexadecimal."""
    changes: ForkChanges | None = None
    """How the fork was made; None: not known, because its record is older."""


class Setup(msgspec.Struct, frozen=True, kw_only=True):
    """Everything that a match is made from; with the inputs it gives the same match again."""

    match_id: str = ""
    """Id of the match; its record has this name."""
    court: str
    match: int
    """Number of the match at its court, from 1."""
    arena: str
    settings: dict[str, Any]
    """The arena file as played, with the contest's overrides."""
    limits: dict[str, float]
    """Contest limits for robots (rules 1) that differ from the defaults."""
    assigned: Assigned | None = None
    """What was assigned: by the office, or by the court itself if it was started alone. None: not
    known, because the record is older."""
    origin: Origin | None = None
    """The origin, if the match is a fork; None: it was played from its first beat on."""


class Header(msgspec.Struct, frozen=True, kw_only=True):
    """The first message of every segment of a record."""

    format: int
    """Number of the format (`FORMAT`) in which the segment is written."""
    match_id: str
    """Id of the match; all its segments have the same, and their files are named by it."""
    segment: int
    """Index of this segment, from 0."""
    first_beat: int
    """First beat of the segment. Messages from this beat on in earlier segments are ignored: a
    court that is killed in the middle of a beat has sent no reply for it, and plays it again."""
    started: str
    """Wall time at which the segment began, ISO 8601, UTC."""
    versions: dict[str, str]
    """Versions of lacoc, protocol, mujoco, model and machine; a replay needs the same mujoco and
    model."""
    arithmetic: dict[str, str] = {}
    """Hashes that identify the arithmetic of the machine (`functions`, `model`, `path`), and where
    it comes from (`processor`, `libc`, `python`, `system`). Empty in older records."""
    setup: Setup


class Touch(msgspec.Struct, frozen=True, array_like=True):
    """What happened in a tick besides its frame: markers touched, robots put back to their start.

    It is not recorded for a tick without touches and without robots that were put back.
    """

    touched: tuple[tuple[int, ...], ...]
    """For each seat, the markers that its robot touched."""
    placed: tuple[tuple[float, float, float] | None, ...]
    """For each seat, the start place where it was put in this tick: x, y [m], heading [rad]."""


class Result(msgspec.Struct, frozen=True, kw_only=True):
    """The result of a match: the one computed by the rules, and the official one."""

    match_id: str
    court: str
    match: int
    arena: str
    teams: tuple[str, ...]
    scores: tuple[int, ...]
    """Points by seat, with the referee's adjustments."""
    computed: str
    """Id of the seat that wins by the rules, or "draw", also in a match that was aborted before
    play; "" before the end."""
    official: str
    """Id of the official winner's seat, or "draw"; "void" for a void match; "" before the phase
    OFFICIAL."""
    reason: Phrase | str
    """Why the match ended (`over.*`; a text in a record of protocol 1)."""
    clock_s: float
    beats: int
    digest: str
    """Hash chain over the states of physics up to the last beat, hexadecimal."""
    model: str
    """Hash of the compiled model, hexadecimal."""


FORMAT = 1
"""Version of the format of records."""

PROFILE = "lacoc"
"""MCAP profile of a record, by which it is told from other MCAP files."""

BEAT_NS = 20_000_000
"""Nanoseconds in a beat. The time of a message in the file is its beat number times this."""

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
"""The channels of a record: topic and type of the msgpack message; None: bytes that only the court
can read. The id of a channel is its position here, counted from 1."""
