"""`lacoc watch`: show a match on a page or in the terminal, or print it as JSON."""

import time
from collections.abc import Callable
from contextlib import nullcontext
from typing import Annotated

import typer
from rich.live import Live
from rich.text import Text

from lacoc_client.commands import entrance, pages
from lacoc_client.play.spectator import Spectator
from lacoc_client.play.stopping import stop_signals
from lacoc_client.play.terminal.board_view import BoardView
from lacoc_client.play.terminal.line_view import LineView, event_columns
from lacoc_client.play.terminal.plain import event_dict, frame_dict
from lacoc_client.web.gateway.home import Home
from lacoc_shared.command import options, screen
from lacoc_shared.messages import Event
from lacoc_shared.network.session import open_client
from lacoc_shared.seat import SILENT_AFTER_S, Phase

app = typer.Typer()

_DRAW_HZ = 10.0
_LAST_WORD_S = 2.0
"""After the frame that shows the end of a match, wait at most this long for the event of the end
[s]."""
_ENDED = (Phase.OFFICIAL, Phase.VOID)


@app.command(name="watch")
def watch_command(
    link: options.Link = None,
    court: options.CourtName = None,
    connect: options.Connect = None,
    terminal: pages.Terminal = False,
    board: Annotated[
        bool, typer.Option("--board", help="Use this terminal, and show the field from above too.")
    ] = False,
    json: Annotated[
        bool,
        typer.Option(
            "--json",
            help="Print events and frames as JSON for a program, one on each line. A robot's "
            "heading is counter-clockwise from +x.",
        ),
    ] = False,
    hz: Annotated[
        float,
        typer.Option(
            min=0, max=50, help="With --json: how many frames to print in a second; 0 prints none."
        ),
    ] = 2.0,
    forever: Annotated[
        bool,
        typer.Option("--forever", help="Without a page: go on with the next match, until Ctrl-C."),
    ] = False,
    browser: pages.Browser = True,
) -> None:
    """Watch a match: clock, score and events as they come.

    A page opens in your browser. In the terminal and with --json the command ends when the result
    is official or the match is void. Anybody may watch without a token.
    """
    if not (terminal or board or json):
        courts = entrance.courts(link, court, connect)
        pages.show_page(
            Home({name: at.watching() for name, at in courts.items()}, "player"), "/watch", browser
        )
        return
    access = entrance.one_court(link, court, connect)
    with (
        open_client(access.addresses, authority=access.authority) as session,
        stop_signals() as stopping,
    ):
        view = Spectator(session, access.court)
        end = _End(view, forever, stopping)
        if json:
            _print_json(view, hz, end)
        else:
            _draw(view, BoardView() if board else LineView(), end)


class _End:
    """Decides when a command that shows a match may end."""

    def __init__(self, view: Spectator, forever: bool, stopping: Callable[[], bool]) -> None:
        self._view = view
        self._forever = forever
        self._stopping = stopping
        self._ended_s: float | None = None

    def __call__(self) -> bool:
        """Return whether to end: if somebody asked for it; without --forever also after a match.

        A match has ended when its last event has come, or is missing 2 s after a frame of the end.
        """
        if self._stopping():
            return True
        frame = self._view.frame
        if self._forever or frame is None or frame.phase not in _ENDED:
            return False
        now_s = time.monotonic()
        self._ended_s = self._ended_s or now_s
        last = {event.data.get("after") for event in self._view.events[-8:]}
        return Phase(frame.phase).name in last or now_s - self._ended_s > _LAST_WORD_S


def _print_json(view: Spectator, hz: float, end: _End) -> None:
    """Print as JSON each event, `hz` frames a second, and a line for each second without frames."""
    frame_s = silent_s = 0.0
    while True:
        frame = view.wait_frame(0.1)
        for event in view.take_events():
            screen.print_json({"type": "event", **event_dict(event, view.sheet)})
        ended = end()
        now_s = time.monotonic()
        if view.silent_s(now_s) > SILENT_AFTER_S and now_s - silent_s > SILENT_AFTER_S:
            silent_s = now_s
            screen.print_json({"type": "link", "silent_s": round(view.silent_s(now_s), 1)})
        if frame is not None and hz and (ended or now_s - frame_s >= 1 / hz):
            frame_s = now_s
            screen.print_json({"type": "frame", **frame_dict(frame, view.sheet)})
        if ended:
            return


def _draw(view: Spectator, terminal: LineView | BoardView, end: _End) -> None:
    """Draw the match again and again on a terminal.

    If the output is a pipe, print the events as lines, and one picture at the end.
    """
    console = screen.stdout
    in_place = console.is_terminal
    drawn_s = 0.0
    events: list[Event] = []
    live = Live(console=console, auto_refresh=False, vertical_overflow="crop")
    with live if in_place else nullcontext():
        while True:
            view.wait_frame(0.1)
            new = view.take_events()
            if terminal.events_above or not in_place:
                for event in new:
                    console.print(Text.assemble(*event_columns(event, view.sheet)))
            events += new
            ended = end()
            now_s = time.monotonic()
            if ended or (in_place and now_s - drawn_s >= 1 / _DRAW_HZ):
                drawn_s = now_s
                drawn = terminal.draw(view, events, view.silent_s(now_s))
                events = []
                if in_place:
                    live.update(drawn, refresh=True)
                else:
                    console.print(drawn)
            if ended:
                return
