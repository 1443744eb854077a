"""A match in one line of the terminal, with its events above."""

from collections.abc import Sequence

from rich.console import RenderableType
from rich.text import Text

from lacoc_client.play.spectator import Spectator
from lacoc_client.play.terminal import words
from lacoc_shared.messages import Event, Frame, Sheet
from lacoc_shared.seat import Phase
from lacoc_shared.words import render, say

PHASE_STYLES = {
    Phase.LOBBY: "black on white",
    Phase.READY: "black on cyan",
    Phase.COUNTDOWN: "black on yellow",
    Phase.PLAYING: "bold white on green",
    Phase.HALTED: "bold white on red",
    Phase.FINISHED: "black on white",
    Phase.OFFICIAL: "bold black on white",
    Phase.VOID: "bold white on red",
}


class LineView:
    """Draws the match as one line, always in the same place: phase, clock, teams, score, event."""

    events_above = True

    def __init__(self) -> None:
        self._last = ""

    def draw(self, view: Spectator, events: Sequence[Event], silent_s: float) -> RenderableType:
        """Draw how the match stands now.

        Args:
            view: the court.
            events: the new events.
            silent_s: for how long no frame has come [s].
        """
        if events:
            self._last = render(events[-1].said)
        banner = words.link(silent_s)
        if banner:
            return Text(banner, style="bold white on red", no_wrap=True)
        if view.frame is None:
            return Text(render(say("terminal.waiting-frame")), style="dim")
        line = status_line(view.frame, view.sheet)
        hint = words.phase_hint(view.frame, view.sheet) or self._last
        line.append(f"  {hint}", style="dim")
        line.no_wrap, line.overflow = True, "ellipsis"
        return line


def status_line(frame: Frame, sheet: Sheet) -> Text:
    """Return a line of phase, clock, teams and score."""
    phase = Phase(frame.phase)
    line = Text.assemble(
        (f" {words.phase_name(phase)} ", PHASE_STYLES.get(phase, "")),
        (f" {words.match_clock(frame, sheet)} ", "bold"),
    )
    names = words.teams(sheet)
    if len(frame.seats) == 1:  # practice has no points
        return line.append_text(Text.assemble(("■ ", sheet.seats[0].colour), names[0]))
    for index, (info, seat) in enumerate(zip(sheet.seats, frame.seats, strict=False)):
        if index:
            line.append(" : ", "dim")
        parts = [("■ ", info.colour), (names[index], ""), (f" {seat.score}", "bold")]
        if index == len(frame.seats) - 1 and index:  # puts both scores side by side
            parts = [(f"{seat.score} ", "bold"), (names[index], ""), (" ■", info.colour)]
        line.append_text(Text.assemble(*parts))
    return line


def event_columns(event: Event, sheet: Sheet) -> tuple[Text, Text]:
    """Return the time and the text of an event, for two columns of a list of events."""
    return Text(f"{words.event_clock(event, sheet):>7}  ", "dim"), Text(render(event.said))
