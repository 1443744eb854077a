"""Lets a contestant play at a terminal: reads the keys and draws the match."""

import time
from collections import deque
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path

from rich.console import Group, RenderableType
from rich.live import Live
from rich.table import Table
from rich.text import Text

from lacoc_client.play.controller import Controller, Hold
from lacoc_client.play.terminal import words
from lacoc_client.play.terminal.keys import KeySource
from lacoc_client.play.terminal.line_view import event_columns, status_line
from lacoc_shared.command import screen
from lacoc_shared.command.keep import save
from lacoc_shared.gait.key_script import ARROWS
from lacoc_shared.gait.tables import Level
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.export.kinematics import joints_per_seat
from lacoc_shared.record.export.pos_data import PosData
from lacoc_shared.seat import BEAT_S, RESTART_KEY, Phase, SeatFlag
from lacoc_shared.words import Phrase, render, say

POS_DATA = "Pos-data.txt"

_LOOK_S = 0.01
_DRAW_S = 0.1
_SAID_S = 5.0
_GONE_S = 120.0
_LEVEL_NAMES = {Level.POSTURE: "a", Level.LOCOMOTION: "b"}
"""Names of the levels in the table of keys: the last parts of the codes `level-name.*`."""


class TerminalPlay:
    """A contestant's play at a terminal: keys are read and the match is drawn.

    Args:
        controller: holds the seat.
        keys: the source of keys.
        folder: folder of Pos-data.txt.
        is_over: returns whether this match is over, for a team that then goes on to another court.
            None: the contestant stays in the seat, match after match.
    """

    def __init__(
        self,
        controller: Controller,
        keys: KeySource,
        folder: Path,
        is_over: Callable[[], bool] | None = None,
    ) -> None:
        self._controller = controller
        self._view = controller.view
        self._keys = keys
        self._folder = folder
        self._is_over = is_over
        self._level = Level(self._view.sheet.levels[0])
        self._data: PosData | None = None
        self._data_match = 0
        self._said: deque[str] = deque()
        self._message = ""
        self._said_s = 0.0
        self._playing_s = 0.0
        self._beat = 0
        self._view_asked = False
        self._leaving = False
        self._goes_on = False
        """Whether this match is over and the team goes on to another one."""
        self._saving = False

    def run(self, stopping: Callable[[], bool]) -> bool:
        """Play until the contestant leaves, a signal comes, a script ends, or the match is over.

        Returns:
            Whether the team goes on to another match.

        Raises:
            UserError: if the seat is lost for good, or Pos-data.txt can't be written.
        """
        console = screen.stdout
        in_place = console.is_terminal
        live = Live(console=console, auto_refresh=False, transient=True)
        drawn_s = 0.0
        with live if in_place else nullcontext():
            while not (stopping() or self._leaving or self._goes_on):
                lines = self._step()
                for line in lines:
                    console.print(line)
                now_s = time.monotonic()
                if in_place and (lines or now_s - drawn_s >= _DRAW_S):
                    drawn_s = now_s
                    live.update(self._draw(now_s), refresh=True)
        if self._goes_on and not self._leaving:
            return True
        self._leave()
        return False

    def _step(self) -> list[Text]:
        """Read the keys, frames and events that came; return lines to print above the picture."""
        controller = self._controller
        frame = self._view.frame
        playing = frame is not None and frame.phase == Phase.PLAYING
        for key in self._keys.read(_LOOK_S, self._playing_s, playing):
            self._press(key)
        frame = controller.poll(time.monotonic())
        if frame is not None:
            self._see(frame)
        for refused in controller.take_refused():
            self._say(say("terminal.refused", key=refused.name, why=refused.why))
        for text in self._keys.take_said():
            self._say(text)
        lines = [
            Text.assemble(*event_columns(event, self._view.sheet))
            for event in self._view.take_events()
        ]
        while self._said:
            self._message, self._said_s = self._said.popleft(), time.monotonic()
            if not screen.stdout.is_terminal:
                lines.append(Text(self._message))
        self._check_end()
        return lines

    def _press(self, key: str) -> None:
        """Do what a key means that the contestant has pressed."""
        self._message = ""
        try:
            if key.isdecimal() and len(key) == 1:
                self._controller.press(self._level, int(key))
            elif key in ARROWS:
                self._press_arrow(key)
            elif key == "x":
                self._controller.press(self._level, RESTART_KEY)
            elif key == "tab":
                self._change_level()
            elif key == "r":
                self._toggle_ready()
            elif key == "space":
                self._tell_about_views()
            elif key in ("z", "q"):
                self._leaving, self._saving = True, key == "z"
            else:
                self._say(say("terminal.nothing", key=key))
        except UserError as error:
            self._say(error.phrase)

    def _press_arrow(self, key: str) -> None:
        if self._level is Level.LOCOMOTION:
            self._controller.press(self._level, ARROWS[key])
        else:
            self._say(say("terminal.arrows"))

    def _change_level(self) -> None:
        """Let the digits mean the next level that this match allows; send nothing to the court."""
        levels = [Level(level) for level in self._view.sheet.levels]
        if levels == [self._level]:
            self._say(say("terminal.only-level", level=_LEVEL_NAMES[self._level]))
            return
        following = levels.index(self._level) + 1 if self._level in levels else 0
        self._level = levels[following % len(levels)]
        self._say(say("terminal.level", level=_LEVEL_NAMES[self._level]))

    def _toggle_ready(self) -> None:
        frame = self._view.frame
        seat = None if frame is None else frame.seats[self._controller.index]
        is_ready = seat is not None and bool(seat.flags & SeatFlag.READY)
        self._controller.ready(not is_ready)
        self._say(say("terminal.not-ready") if is_ready else say("terminal.ready"))

    def _tell_about_views(self) -> None:
        if not self._view_asked:
            self._view_asked = True
            self._say(say("terminal.no-views"))

    def _see(self, frame: Frame) -> None:
        if frame.phase == Phase.PLAYING:
            self._playing_s += BEAT_S * max(1, min(frame.beat - self._beat, 50))
        self._beat = frame.beat
        sheet = self._view.sheet
        if not frame.poses or frame.scene != sheet.scene:
            return
        joints = joints_per_seat(sheet)
        if self._data is None or self._data_match != frame.match or self._data.joints != joints:
            self._data, self._data_match = PosData(self._controller.index, joints), frame.match
        self._data.add(frame)

    def _say(self, what: Phrase | str) -> None:
        self._said.append(render(what))

    def _check_end(self) -> None:
        """Note whether the team goes on to its next match, or leaves because the script is done.

        A script is done when it has no more keys and its match is over or has no time limit.

        Raises:
            UserError: if the seat is lost, or a script waits for a court that is gone.
        """
        controller, frame = self._controller, self._view.frame
        if self._is_over is not None and self._is_over():
            self._goes_on = True
            return
        if controller.hold in (Hold.REPLACED, Hold.REFUSED):
            raise UserError(say("play.lost", why=controller.why_not_held))
        if not self._keys.ended or frame is None or self._is_over is not None:
            return
        if self._view.silent_s(time.monotonic()) > _GONE_S:
            raise UserError(say("play.silent", seconds=_GONE_S))
        if frame.phase >= Phase.FINISHED or not self._view.sheet.duration_s:
            self._leaving = True

    def _draw(self, now_s: float) -> RenderableType:
        controller, frame, sheet = self._controller, self._view.frame, self._view.sheet
        if frame is None:
            return Text(render(say("terminal.waiting")), style="dim")
        second = Text()
        for level in map(Level, sheet.levels):
            style = "bold reverse" if level is self._level else "dim"
            second.append(
                f" {render(say('terminal.level-name', level=_LEVEL_NAMES[level]))} ", style
            )
        key = words.standing_key(frame, sheet, controller.index)
        if key:
            second.append(f"  {key}", "bold")
        if controller.round_trip_ms is not None:
            trip = say("terminal.round-trip", ms=controller.round_trip_ms)
            second.append(f"  {render(trip)}", "dim")
        health = self._view.health
        if health is not None and health.input_delay_ms:
            delay = say("terminal.equalised", ms=health.input_delay_ms)
            second.append(f"  {render(delay)}", "dim")
        if len(sheet.seats) == 1:
            second.append(words.place(frame, sheet, controller.seat))
        first = status_line(frame, sheet)
        for line in (first, second):
            line.no_wrap, line.overflow = True, "ellipsis"
        return Group(first, second, self._third(now_s))

    def _third(self, now_s: float) -> Text:
        """Return the third line of the picture: the most urgent one of several messages.

        From most to least urgent: a broken link, a seat that is not held, the answer to a key, the
        state of the seat, the phase, the list of keys.
        """
        controller, frame = self._controller, self._view.frame
        assert frame is not None
        banner = words.link(self._view.silent_s(now_s))
        if not banner and controller.hold is not Hold.HELD:
            banner = render(controller.why_not_held)
        if banner:
            return Text(f" {banner} ", "bold white on red")
        if self._message and now_s - self._said_s < _SAID_S:
            return Text(self._message, "yellow")
        seat = frame.seats[controller.index]
        state = words.seat_state(seat) or words.phase_hint(frame, self._view.sheet)
        if frame.phase == Phase.LOBBY and not seat.flags & SeatFlag.READY:
            state = render(say("terminal.press-r"))
        return Text(state, "cyan") if state else Text(render(say("terminal.help")), "dim")

    def _leave(self) -> None:
        """Give the seat up, and write the robot's motion (Pos-data.txt) if the contestant asked."""
        controller = self._controller
        if self._view.silent_s(time.monotonic()) < 1.0 and controller.hold is Hold.HELD:
            try:
                said = controller.leave()
                told = said if self._view.sheet.duration_s else None
                screen.note(say("terminal.left-seat", told=told))
            except UserError as error:
                screen.note(error.phrase)
        if not self._saving:
            return
        if self._data is None:
            screen.warn(say("terminal.no-pos-data", file=POS_DATA))
            return
        path = self._folder / POS_DATA
        kept = save(path, self._data.text().encode())
        if kept is not None:
            screen.note(say("command.kept", path=str(path), kept=str(kept)))
        screen.note(say("terminal.pos-data", path=str(path)))


def keys_table(controller: Controller) -> Table:
    """Return a table of the keys that this seat may press, and of their effects."""
    sheet = controller.view.sheet
    seat = sheet.seats[controller.index]
    table = Table(show_header=False, box=None, padding=(0, 2))
    for level in map(Level, sheet.levels):
        digits = seat.keys[level]
        shown = " ".join(map(str, digits)) or render(say("terminal.no-keys"))
        what = say("terminal.keys-a") if level is Level.POSTURE else say("terminal.keys-b")
        table.add_row(Text(shown, "bold"), render(what))
    others = [
        ("↑ ← → ↓", say("terminal.keys-arrows"), Level.LOCOMOTION in sheet.levels),
        ("Tab", say("terminal.keys-tab"), len(sheet.levels) > 1),
        ("x", say("terminal.keys-x"), True),
        ("r", say("terminal.keys-r"), True),
        ("z", say("terminal.keys-z", file=POS_DATA), True),
        ("q", say("terminal.keys-q"), True),
    ]
    for key, what, there in others:
        if there:
            table.add_row(Text(key, "bold"), render(what))
    return table
