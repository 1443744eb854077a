"""A seat in a match: its contestant, robot and drive, and the state of its keys."""

from dataclasses import dataclass

from lacoc_server.match.drive import Drive, DriveState, make_drive
from lacoc_server.match.entry import Entry
from lacoc_shared.gait.tables import Level
from lacoc_shared.inputs import JoinSeat, KeySeat
from lacoc_shared.messages import SeatFrame, SheetSeat
from lacoc_shared.seat import RESTART_KEY, No, SeatFlag

# Plain numbers: adding up an IntFlag takes longer than making the rest of a frame.
_JOINED, _READY, _SILENT, _FROZEN = (
    int(flag) for flag in (SeatFlag.JOINED, SeatFlag.READY, SeatFlag.SILENT, SeatFlag.FROZEN)
)


@dataclass
class Seat:
    """One seat of a match."""

    index: int
    id: str
    colour: str
    pattern: str
    assigned_team: str = ""
    """The team that the office seated; "": anybody may join."""
    join: JoinSeat | None = None
    entry: Entry | None = None
    coming: JoinSeat | None = None
    """The newest join that came after READY; the next match begins with it. None: none came."""
    ready: bool = False
    silent: bool = False
    left: bool = False
    """True if the contestant left after READY and did not come back: then the seat is free in the
    next match.
    """
    idle: bool = True
    """True from when the robot is put on a start place until a digit is pressed; meanwhile nothing
    that happens to it scores (rules 4).
    """
    drive: Drive | None = None
    """The drive; None before READY."""
    state: DriveState | None = None
    locked_until: int = 0
    """Tick of PLAYING from which keys are taken again, after an [x]."""
    frozen_until: int = 0
    """Tick of PLAYING from which keys are taken again, after a referee's freeze."""
    applied: tuple[int, int] = (0, 0)
    """Newest applied command: sequence number, beat."""
    refused: tuple[int, No] = (0, No.NONE)
    """Newest refused command: sequence number, reason."""
    restarting: bool = False
    """True until the robot is put back at a start place, in this beat or the next one."""
    strays: int = 0
    """How many times the robot left its start place in this READY phase."""

    @property
    def team(self) -> str:
        """Name of the team that joined, else of the one the office seated, else the seat's id."""
        return self.join.team if self.join else self.assigned_team or self.id

    def begin(self, repeat: bool, level: Level) -> None:
        """Make a new drive, with which the robot stands; do nothing if nobody has the seat."""
        if self.entry is None:
            return
        self.strays = 0
        self.idle = True
        self.drive = make_drive(self.entry.robot, self.entry.gait, repeat)
        self.state = self.drive.begin(level)

    def stand(self) -> None:
        """Let the robot stand in the first posture of key 0, as it does when silent or frozen.

        The level does not change.
        """
        if self.drive and self.state:
            self.state = self.drive.stand(self.state)

    def restart(self) -> None:
        """Mark the robot to be put back at a start place and to stand there (rules 3)."""
        self.restarting = self.idle = True
        if self.drive and self.state:
            self.state = self.drive.begin(self.state.level)

    def why_not(self, key: KeySeat, ticks: int, levels: tuple[Level, ...]) -> No:
        """Return why a command is refused during play; `No.NONE`: it is accepted."""
        if ticks < self.frozen_until:
            return No.FROZEN
        if ticks < self.locked_until:
            return No.RESTARTED
        if key.key == RESTART_KEY:
            return No.NONE
        if key.level not in levels:
            return No.LEVEL_CLOSED
        if not (self.drive and self.drive.has(Level(key.level), key.key)):
            return No.NO_SUCH_KEY
        return No.NONE

    def frame(self, score: int, ticks: int) -> SeatFrame:
        """Return the seat as frames carry it."""
        flags = (
            (self.join is not None) * _JOINED
            + self.ready * _READY
            + self.silent * _SILENT
            + (ticks < self.frozen_until) * _FROZEN
        )
        level, digit, posture = (
            (self.state.level, self.state.digit, self.state.posture) if self.state else (0, 0, 0)
        )
        return SeatFrame(
            flags,
            score,
            int(level),
            digit,
            posture,
            max(0, self.locked_until - ticks, self.frozen_until - ticks),
            *self.applied,
            self.refused[0],
            int(self.refused[1]),
        )

    def sheet(self) -> SheetSeat:
        """Return the seat as the sheet describes it."""
        if self.join is None or self.entry is None:
            return SheetSeat(
                id=self.id, team=self.assigned_team, colour=self.colour, pattern=self.pattern
            )
        gait = self.entry.gait
        return SheetSeat(
            id=self.id,
            team=self.join.team,
            colour=self.colour,
            pattern=self.pattern,
            robot=self.entry.robot.name,
            legs=tuple(self.entry.robot.labels),
            keys=(gait.keys(Level.POSTURE), gait.keys(Level.LOCOMOTION)),
            postures=tuple(len(s) for s in gait.locomotion.sequences) if gait.locomotion else (),
        )
