"""Two folders of a contest for tests: an office with all that it keeps, and a second machine."""

import shutil
from contextlib import ExitStack
from pathlib import Path
from typing import TypeVar

from lacoc_robots.library import robot_folder, sample_gait_files
from lacoc_server.contest.kept.applications import Applications
from lacoc_server.contest.kept.entries import ContestEntry
from lacoc_server.contest.kept.event_code import EventCode
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.stand_ins import stand_in
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.facts import Called, Entered, Played, generation, new
from lacoc_server.contest.standby.door import StandbyDoor
from lacoc_server.contest.standby.following import Follower
from lacoc_server.contest.standby.messages import AnyAsk
from lacoc_server.contest.standby.other import NotThere, Other
from lacoc_server.contest.standby.sealing import Sealing
from lacoc_server.contest.standby.tenure import Tenure
from lacoc_shared.record.files import packed_path, segment_path

T = TypeVar("T")
FILE = """
[standby]
office = "127.0.0.1:{port}"
[stage.cup]
format = "round-robin"
[court.north]
arena = "othello"
listen = ["127.0.0.1:0"]
"""
PLAYED, OPEN = "20260501-100000-north-001", "20260501-100100-north-002"
"""Matches: one that was played and packed, and one in play."""


def contest_text(port: int = 7446) -> str:
    """Return a contest file.

    Args:
        port: where the office lets the second machine copy.
    """
    return FILE.format(port=port)


def entry(bot: str) -> ContestEntry:
    """Return an entry that is played by a bot."""
    robot = (robot_folder("hexapod") / "robot.toml").read_bytes()
    postures, locomotion = sample_gait_files("hexapod")
    return ContestEntry(
        robot=robot,
        postures=postures.data if postures else None,
        locomotion=locomotion.data if locomotion else None,
        bot=bot,
    )


class OfficeRoom:
    """A contest that an office keeps.

    Args:
        folder: its folder; it is made.
        text: the contest file.
        secrets: a file of tokens to begin with; None: it makes its own.
    """

    def __init__(self, folder: Path, text: str, secrets: Path | None = None) -> None:
        folder.mkdir()
        if secrets is not None:
            shutil.copy(secrets, folder)
        self.file = folder / "contest.toml"
        self.file.write_text(text)
        self.where = ContestFolder(self.file)
        self.where.records.mkdir()
        self.stack = ExitStack()
        self.store = self.stack.enter_context(FactStore(self.where.facts))
        self.applications = self.stack.enter_context(Applications(self.where.applications))
        assert self.where.contest.standby is not None
        self.sealing = Sealing(self.where.contest.secrets.standby)
        self.tenure = Tenure(self.where, generation(self.store.facts()))
        self.door = self.stack.enter_context(
            StandbyDoor(self.where, self.tenure, self.applications, self.sealing)
        )

    def __enter__(self) -> "OfficeRoom":
        return self

    def __exit__(self, *_: object) -> None:
        self.stack.close()

    def fill(self) -> None:
        """Keep something of everything."""
        files = {team: self.where.entries.save(entry(team)) for team in ("Ann", "Bob")}
        for team in files:
            self.where.contest.secrets.team(team)
        EventCode(self.where.event_code, "first").change()
        stand_in(self.where.stand_ins, "north")
        self.applications.put("Cat", entry("Cat"))
        self.store.append(*(new(Entered, team=name, files=one) for name, one in files.items()))
        self.call(1)
        packed_path(self.where.records, PLAYED).write_bytes(bytes(300_000))
        self.play(1, PLAYED)
        self.call(2)
        self.grow(OPEN, 200_000)

    def call(self, game: int) -> None:
        """Append that a game is called."""
        self.store.append(
            new(Called, pairing="cup:a1.1", game=game, teams=("Ann", "Bob"), court="north")
        )

    def play(self, game: int, record: str) -> None:
        """Append the result of a game."""
        self.store.append(
            new(
                Played,
                pairing="cup:a1.1",
                game=game,
                teams=("Ann", "Bob"),
                scores=(3, 1),
                outcome="left",
                record=f"{record}.mcap",
            )
        )

    def grow(self, match_id: str, size: int, segment: int = 0) -> None:
        """Write more of a segment."""
        with segment_path(self.where.records, match_id, segment).open("ab") as file:
            file.write(bytes([segment + 1]) * size)

    def pack(self, match_id: str) -> None:
        """Pack a match: its segments vanish."""
        packed_path(self.where.records, match_id).write_bytes(b"packed" * 50_000)
        for segment in self.where.records.glob(f"{match_id}.*.live.mcap"):
            segment.unlink()


class Near(Other):
    """An office that is asked without a network, and that vanishes after some answers.

    Args:
        room: the office.
        answers: how often it answers.
    """

    def __init__(self, room: OfficeRoom, answers: int = 1_000_000) -> None:
        super().__init__("tcp/127.0.0.1:7446", room.sealing)
        self.room = room
        self.answers = answers

    def ask(self, request: AnyAsk, kind: type[T]) -> T:
        """Ask the office."""
        if self.answers == 0:
            raise NotThere
        self.answers -= 1
        return self.read(self.room.door.answer(request), kind)


def second(room: OfficeRoom, folder: Path) -> ContestFolder:
    """Make the folder of the second machine, which has the contest file and its secrets."""
    folder.mkdir()
    for path in (room.file, room.where.secrets):
        shutil.copy(path, folder)
    return ContestFolder(folder / "contest.toml")


def following(where: ContestFolder, other: Other) -> Follower:
    """Begin to copy."""
    return Follower(where, other, print)


def contents(where: ContestFolder) -> dict[str, bytes]:
    """Return what the files of a contest hold, without databases, by their path in the folder."""
    folder = where.file.parent
    found = (path for path in folder.rglob("*") if path.is_file())
    left_out = (".db", ".lock", ".machine.json", "-wal", "-shm")
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in found
        if not path.name.endswith(left_out)
    }
