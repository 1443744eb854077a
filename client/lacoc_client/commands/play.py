"""`lacoc play`: play as a contestant, on a page or at the terminal."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Group
from rich.text import Text

from lacoc_client.commands import entrance, pages
from lacoc_client.play.asking import NoCourt, NotNow, Patience
from lacoc_client.play.controller import Controller
from lacoc_client.play.own_files import OwnFiles
from lacoc_client.play.stopping import stop_signals
from lacoc_client.play.team_way import TeamWay, call_is_over, is_gone
from lacoc_client.play.terminal.keys import KeySource, open_keys
from lacoc_client.play.terminal.play import TerminalPlay, keys_table
from lacoc_client.play.terminal.words import played
from lacoc_client.web.gateway.home import Prefill, player_home
from lacoc_robots.seat_files import SeatFiles, gaits_in, remarks
from lacoc_shared.command import options, screen
from lacoc_shared.contest.access import Access
from lacoc_shared.gait.tables import Level
from lacoc_shared.messages.office import Whereabouts
from lacoc_shared.network.session import NotConnected, Session, open_client
from lacoc_shared.words import render, say

app = typer.Typer()

TeamName = Annotated[
    str,
    typer.Option(
        "--name", envvar="LACOC_NAME", metavar="TEAM", help="Your team's name, 1-24 characters."
    ),
]
Robot = Annotated[
    str | None,
    typer.Option(
        metavar="FILE|NAME",
        help="Your robot file, or the name of an installed robot; by default the contest's robot.",
    ),
]
Gaits = Annotated[
    list[Path] | None,
    typer.Option(
        metavar="FILE",
        help="A gait file: Loco-data.txt, Loco-data.xlsx or LocoTra-data.txt. Give --gait "
        "twice for both levels. By default the newest file of each level in this folder.",
    ),
]

_SHEET_S = 2.0


@app.command(name="play")
def play_command(
    link: options.Link = None,
    court: options.CourtName = None,
    connect: options.Connect = None,
    token: options.Token = None,
    name: TeamName = "",
    robot: Robot = None,
    gait: Gaits = None,
    terminal: pages.Terminal = False,
    ready: Annotated[
        bool,
        typer.Option("--ready", help="With --terminal: say ready at once, without the key r."),
    ] = False,
    browser: pages.Browser = True,
    json: options.Json = False,
) -> None:
    """Hold a seat and steer your robot with the keyboard.

    Your link says who you are. In a contest you are told when and where you play next, and go from
    court to court until the contest is over. At an open seat you play with your own name and files.

    A page opens in your browser; only this machine can open it. The page already has what you give
    here, and you can enter the rest there.

    With --terminal the keys are: 0-9 move the robot. The arrows up, left, right and down are 2, 1,
    3 and 0 of level B. Tab changes the level. x restarts, r says ready, q leaves, z leaves and
    writes Pos-data.txt.

    With --terminal keys can also come from a pipe. A line holds keys, which are pressed one after
    another: '2', 'tab 1', or '1 2 3 4'. A number with a point at the start of a line is a time:
    '1.5 3' presses 3 when 1.5 seconds of play have passed since the key before. Keys that move the
    robot wait until the match is played. The last key of the pipe stays pressed until the match is
    over.
    """
    if terminal:
        access = entrance.contestant(link, court, connect, token)
        follow(access, court is None, name, lambda: own_files(robot, gait or []).files, ready=ready)
        return
    courts = entrance.courts(link, court, connect, token)
    first = next(iter(courts.values()))
    prefill = Prefill("", first.token, name, own_files(robot, gait or []))
    home = player_home(courts, prefill, "player", None)
    pages.show_page(home, f"/play#key={home.key}", browser, json)


def own_files(robot: str | None, gaits: list[Path]) -> OwnFiles:
    """Read the robot and gait files that the user named.

    If the user named no gait file, read those of the current folder and tell the user which.

    Raises:
        FileRefused: with every mistake of every gait file.
        UserError: if a file can't be read, or two are for the same level.
    """
    found = [] if gaits else gaits_in(Path())
    if found:
        screen.note(say("play.taken", files=[path.name for path in found]))
    for remark in [] if gaits else remarks(Path(), found):
        screen.warn(remark)
    files = OwnFiles(robot, gaits)
    for note in files.notes:
        screen.warn(note)
    return files


def play(
    access: Access, team: str, files: SeatFiles, *, ready: bool, greeting: Text | None = None
) -> None:
    """Join a seat, and play there at the terminal until the contestant leaves.

    Args:
        access: address, seat and token.
        team: the team's name.
        files: the team's files.
        ready: say ready at once.
        greeting: printed before the keys.

    Raises:
        FileRefused: if the court finds mistakes in the files.
        UserError: if the court refuses, does not answer, or the seat is lost.
    """
    with open_client(access.addresses, authority=access.authority) as session:
        controller = _seated(session, access, team, files, ready=ready, greeting=greeting)
        with stop_signals() as stopping, open_keys() as keys:
            TerminalPlay(controller, keys, Path()).run(stopping)


def follow(
    access: Access,
    any_court: bool,
    name: str,
    bring: Callable[[], SeatFiles],
    *,
    ready: bool,
) -> None:
    """Play at the terminal, at each court to which the team with the token is called.

    Args:
        access: how to reach any court of the event, and the token.
        any_court: whether any court of the event may be asked, because nobody named one.
        name: name of the team, for an open seat; "": a name made of the seat.
        bring: returns the files of the team, for an open seat.
        ready: say ready at once, in each match.

    Raises:
        FileRefused: if the court finds mistakes in the files.
        UserError: if the token opens nothing, or the seat is lost for good.
    """
    with stop_signals() as stopping, open_keys() as keys:
        way = TeamWay(
            access,
            any_court=any_court,
            patience=Patience(None),
            tell=screen.show,
            stopping=stopping,
        )
        with way:
            while not stopping() and (there := way.next()) is not None:
                team, files = there.team, SeatFiles()
                if there.open:
                    team = name or render(say("page.team", seat=there.seat))
                    files = bring()
                try:
                    if not _play_match(way, there, team, files, keys, stopping, ready=ready):
                        return
                except (NotConnected, NoCourt, NotNow) as error:
                    way.tell_trouble(error)
                    way.again()


def _play_match(
    way: TeamWay,
    there: Whereabouts,
    team: str,
    files: SeatFiles,
    keys: KeySource,
    stopping: Callable[[], bool],
    *,
    ready: bool,
) -> bool:
    """Play one match at the terminal, or all matches at an open seat.

    Return whether the team goes on to another match.
    """
    access = way.access(there)
    with open_client(access.addresses, authority=access.authority) as session:
        controller = _seated(session, access, team, files, ready=ready)
        view = controller.view

        def is_left() -> bool:
            return call_is_over(view, there.call) or is_gone(view)

        left = None if there.open else is_left
        goes_on = TerminalPlay(controller, keys, Path(), left).run(stopping)
        if goes_on and call_is_over(view, there.call):
            way.played(there.call)
        return goes_on


def _seated(
    session: Session,
    access: Access,
    team: str,
    files: SeatFiles,
    *,
    ready: bool,
    greeting: Text | None = None,
) -> Controller:
    """Join a seat, tell the contestant what the keys do, and return the controller.

    With `ready`, also say that the contestant is ready. The other arguments are those of `play`.
    """
    controller = Controller(
        session, access.court, access.seat, access.token, team, **files._asdict()
    )
    for note in controller.join():
        screen.note(note)
    _await_own_entry(controller, team)
    if ready:
        controller.ready()
    _greet(controller, team, greeting)
    return controller


def _await_own_entry(controller: Controller, team: str) -> None:
    """Wait for a sheet of the match in which this team has its robot, but at most two seconds.

    It comes a moment after the answer to the join.
    """
    deadline_s = time.monotonic() + _SHEET_S
    while time.monotonic() < deadline_s:
        controller.wait_frame(0.05)
        if controller.view.sheet.seats[controller.index].robot:
            return


def _greet(controller: Controller, team: str, greeting: Text | None) -> None:
    sheet = controller.view.sheet
    screen.show(
        greeting
        or Text.assemble(
            (
                render(
                    say(
                        "play.holds",
                        team=team,
                        seat=controller.seat,
                        court=sheet.court,
                        title=played(sheet),
                    )
                ),
                "bold",
            )
        )
    )
    screen.show(Group(keys_table(controller), Text()))
    keys = sheet.seats[controller.index].keys
    if not any(keys[level] for level in sheet.levels):
        levels = ["AB"[level] for level in sheet.levels]
        wanted = "Loco-data" if Level.POSTURE in sheet.levels else "LocoTra-data"
        screen.warn(say("play.no-key", levels=levels, file=wanted))
