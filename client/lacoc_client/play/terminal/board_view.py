"""A match in the terminal: the field from above, the score beside it, and the latest events."""

from collections import deque
from collections.abc import Sequence

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from lacoc_client.play.spectator import Spectator
from lacoc_client.play.terminal import words
from lacoc_client.play.terminal.board_picture import BoardPicture, Field, PixelGrid, seat_letters
from lacoc_client.play.terminal.line_view import PHASE_STYLES, LineView, event_columns
from lacoc_shared.command import screen
from lacoc_shared.messages import Event, Frame, Sheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.seat import Phase
from lacoc_shared.words import render, say

_ROWS = (10, 34)
_SIDE_MIN = 30
"""Least width of the text beside the board [characters]."""


class BoardView:
    """Draws the board of a match and a text beside it, again and again in the same place."""

    events_above = False

    def __init__(self) -> None:
        self._line = LineView()
        self._events: deque[Event] = deque(maxlen=_ROWS[1])
        self._scene = b""
        self._field: Field | None = None
        self._grid: PixelGrid | None = None

    def draw(self, view: Spectator, events: Sequence[Event], silent_s: float) -> RenderableType:
        """Draw the field, and beside it how the match stands now.

        Args:
            view: the court.
            events: the new events.
            silent_s: for how long no frame has come [s].
        """
        self._events.extend(events)
        line = self._line.draw(view, events, silent_s)
        grid = self._fitting_grid(view)
        if grid is None or view.frame is None:
            return line
        rows = grid.height // 2
        both = Table.grid(padding=(0, 2, 0, 0))
        both.add_column(width=grid.width, no_wrap=True)
        both.add_column(ratio=1)
        side = _side(view.frame, view.sheet, words.link(silent_s))
        width = max(1, screen.stdout.width - grid.width - 4)
        side += _latest(self._events, view.sheet, rows - len(side), width)
        both.add_row(BoardPicture(grid, view.frame, view.sheet), Group(*side))
        return both

    def _fitting_grid(self, view: Spectator) -> PixelGrid | None:
        """Return the pixels of the largest picture that fits into the terminal."""
        if view.sheet.scene != self._scene or self._field is None:
            try:
                self._field = Field.of(view.scene(), view.sheet)
            except UserError:  # the court is away; a line of the picture says so
                return self._grid
            self._scene, self._grid = view.sheet.scene, None
        field, (width, height) = self._field, screen.stdout.size
        columns = max(2, width - _SIDE_MIN - 4)
        rows = min(height - 1, int(columns * field.half_y_m / field.half_x_m / 2), _ROWS[1])
        rows = max(rows, _ROWS[0])
        if self._grid is None or self._grid.height != 2 * rows:
            self._grid = PixelGrid(field, rows)
        return self._grid


def _side(frame: Frame, sheet: Sheet, banner: str) -> list[Text]:
    """Return the text beside the board, line by line: match, phase, clock, hint and teams."""
    phase = Phase(frame.phase)
    left = render(say("terminal.left") if sheet.duration_s else say("terminal.played"))
    lines = [
        Text(
            render(say("terminal.match", title=words.played(sheet), match=sheet.match)),
            style="bold",
            no_wrap=True,
        ),
        Text.assemble(
            (f" {words.phase_name(phase)} ", PHASE_STYLES.get(phase, "")),
            (f" {words.match_clock(frame, sheet)}", "bold"),
            (f" {left}", "dim"),
        ),
        Text(banner, "bold white on red")
        if banner
        else Text(words.phase_hint(frame, sheet), "dim"),
        Text(),
    ]
    letters = seat_letters([seat.id for seat in sheet.seats])
    names = words.teams(sheet)
    for index, (info, seat) in enumerate(zip(sheet.seats, frame.seats, strict=False)):
        lines.append(
            Text.assemble(
                (f" {letters[index]} ", f"bold black on {info.colour}"),
                (f" {seat.score:>4}  ", "bold"),
                names[index],
            )
        )
        state = words.seat_state(seat) or words.standing_key(frame, sheet, index)
        lines.append(Text(f"          {state}", style="dim"))
    for line in lines:
        line.no_wrap, line.overflow = True, "ellipsis"
    return [*lines, Text()]


def _latest(events: Sequence[Event], sheet: Sheet, rows: int, width: int) -> list[Text]:
    """Return the newest events that fit beside the board completely, the newest last."""
    shown: list[Text] = []
    for event in reversed(events):
        clock, text = event_columns(event, sheet)
        wrapped = text.wrap(screen.stdout, max(1, width - len(clock)))
        indent = Text(" " * len(clock))
        lines = [Text.assemble(indent if n else clock, line) for n, line in enumerate(wrapped)]
        if len(lines) > rows - len(shown):
            break
        shown[:0] = lines
    return shown
