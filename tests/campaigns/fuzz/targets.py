"""Defines a target for each reader of foreign bytes; a target raises only undocumented errors."""

import os
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import Any

from tests.campaigns.fuzz import doors

from lacoc_arenas.arena import Arena, from_settings
from lacoc_client.web.gateway import wire
from lacoc_robots.robot_file import read_robot
from lacoc_server.match.entry import Entry
from lacoc_server.world.world import World
from lacoc_shared import codec, messages
from lacoc_shared.contest import file as contest
from lacoc_shared.contest.toml_text import BadToml, read_toml
from lacoc_shared.gait.key_script import KeyScript
from lacoc_shared.gait.tables import Gait, Posture, PostureTable
from lacoc_shared.gait.text import read_gait
from lacoc_shared.gait.workbook.file import read_workbook
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.record.commands import _lines, _made, _summary
from lacoc_shared.record.export import tables as export
from lacoc_shared.record.export.foxglove import foxglove
from lacoc_shared.record.reader import Record

CORPUS = Path(__file__).parent / "corpus"
_SCRATCH = "/dev/shm" if os.path.isdir("/dev/shm") else None
_WORLDS = 20
"""About one in this many accepted robots and arenas is also built as a world."""


@dataclass(frozen=True)
class Target:
    """A reader to which inputs are fed."""

    name: str
    group: str
    """"packets" or "files"."""
    kind: str
    """The inputs' format, which tells the mutator how to change them."""
    corpus: str
    """The folder of the seeds."""
    share: int
    """How large a part of its group's inputs it gets, relative to the other targets."""
    eat: Callable[[bytes], bool]
    """Reads an input and returns whether it was accepted; an error that it raises is a finding."""
    finish: Callable[[], None] = lambda: None

    @property
    def seeds(self) -> list[bytes]:
        """Return the committed inputs: good ones, and inputs that once caused an error."""
        return [path.read_bytes() for path in sorted((CORPUS / self.corpus).iterdir())]


def _accepts(*refusals: type[Exception]) -> Callable[[Callable[[bytes], object]], Any]:
    def wrap(eat: Callable[[bytes], object]) -> Callable[[bytes], bool]:
        def eaten(data: bytes) -> bool:
            try:
                return eat(data) is not False
            except refusals:
                return False

        return eaten

    return wrap


# Packets


@cache
def _doors(what: str) -> doors.Doors:
    return doors.Doors()


def _door(what: str, share: int, key: Callable[[bytes], str]) -> Target:
    def eat(data: bytes) -> bool:
        court = _doors(what)
        before = court.accepted
        court.feed(key(data), data)
        return court.accepted > before

    def finish() -> None:
        _doors(what).beat()

    return Target(f"court: {what}", "packets", "msgpack", what, share, eat, finish)


def _message(kind: type) -> Target:
    @_accepts(codec.BadMessage)
    def eat(data: bytes) -> None:
        codec.decode(data, kind, 1 << 20)

    name = kind.__name__.lower()
    return Target(f"client: {name}", "packets", "msgpack", f"message-{name}", 2, eat)


@_accepts(wire.Unreadable)
def _page(data: bytes) -> None:
    wire.read_id(data)
    wire.read(data)


# Files


@_accepts(FileRefused)
def _gait(data: bytes) -> None:
    legs = (None, 6, ("R,F", "R,C", "R,B", "L,B", "L,C", "L,F"))[len(data) % 3]
    read_gait(data, "gait.txt", legs=legs)


@_accepts(FileRefused)
def _workbook(data: bytes) -> None:
    read_workbook(data, "gait.xlsx", legs=(None, 6)[len(data) % 2])


@_accepts(FileRefused)
def _robot(data: bytes) -> None:
    robot = read_robot(data, "robot.toml")
    if len(data) % _WORLDS == 0:  # what is accepted can be built and can stand
        posture: Posture = (0.0,) * robot.joints
        world = World(_othello(), (Entry(robot, Gait(PostureTable({0: posture}))),))
        world.step([posture])
        world.poses()


@cache
def _othello() -> Arena:
    settings = read_toml((CORPUS / "arena" / "othello.toml").read_bytes())
    return from_settings("othello", settings)


@_accepts(UserError)
def _contest(data: bytes) -> None:
    with _file(data, ".toml") as path:
        found = contest.load(path)
    codec.encode({name: court.settings for name, court in found.courts.items()})


@_accepts(UserError, BadToml)
def _arena(data: bytes) -> None:
    name = "flag-strike" if b"pole_radius_m" in data else "othello"
    settings = read_toml(data)
    arena = from_settings(name, settings)
    codec.encode(arena.settings)
    arena.game.start()
    if len(data) % _WORLDS == 0:
        World(arena, ())


@_accepts(UserError)
def _record(data: bytes) -> None:
    with _file(data, ".mcap") as path:
        record = Record.read(path)
    _lines(record, _summary(record))


@_accepts(UserError)
def _export(data: bytes) -> None:
    with _file(data, ".mcap") as path:
        record = Record.read(path)
    made = [export.events_csv, foxglove]
    made += [partial(export.pos_data, seat=seat) for seat in export.seat_ids(record)]
    for make in made:
        _made(make, record)


@_accepts()
def _keys(data: bytes) -> None:
    script = KeyScript()
    for line in data.decode("utf-8", "replace").split("\n"):
        script.add(line)
    script.due(1e9, True)


class _file:
    """A temporary file with the given bytes, in memory where possible; it is removed on exit."""

    def __init__(self, data: bytes, suffix: str) -> None:
        self._data, self._suffix = data, suffix

    def __enter__(self) -> Path:
        descriptor, name = tempfile.mkstemp(self._suffix, "lacoc-fuzz-", _SCRATCH)
        self._path = Path(name)
        os.write(descriptor, self._data)
        os.close(descriptor)
        return self._path

    def __exit__(self, *_: object) -> None:
        self._path.unlink()


MESSAGES = (
    messages.Frame, messages.Event, messages.Sheet, messages.Scene, messages.Health,
    messages.Joined, messages.Done, messages.Refusal, messages.DecisionReply,
)  # fmt: skip

TARGETS = (
    _door("commands", 36, doors.seat_key("key")),
    _door("requests", 15, doors.request_key),
    _door("joins", 3, doors.seat_key("join")),
    _door("decisions", 15, doors.decision_key),
    *map(_message, MESSAGES),
    Target("gateway: page", "packets", "msgpack", "page", 13, _page),
    Target("gait text", "files", "text", "gait", 34, _gait),
    Target("gait workbook", "files", "zip", "workbook", 4, _workbook),
    Target("robot file", "files", "text", "robot", 22, _robot),
    Target("contest file", "files", "text", "contest", 12, _contest),
    Target("arena file", "files", "text", "arena", 10, _arena),
    Target("record, segment", "files", "mcap", "segment", 6, _record),
    Target("record, packed", "files", "mcap", "packed", 4, _record),
    Target("record, exported", "files", "mcap", "segment", 2, _export),
    Target("key script", "files", "text", "keys", 6, _keys),
)
