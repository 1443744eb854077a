"""`lacoc bot`: let a bot or a ghost hold a seat."""

import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from lacoc_arenas import arena as arenas
from lacoc_arenas import brains
from lacoc_arenas.arena import Arena
from lacoc_client.commands import entrance
from lacoc_client.play.asking import NoCourt, NotNow, Patience
from lacoc_client.play.bot_player import BotPlayer
from lacoc_client.play.controller import Controller, Hold
from lacoc_client.play.stopping import stop_signals
from lacoc_client.play.team_way import TeamWay, call_is_over, is_gone
from lacoc_robots.seat_files import SeatFiles, gather
from lacoc_shared.command import options, screen
from lacoc_shared.contest.access import Access
from lacoc_shared.messages.office import Whereabouts
from lacoc_shared.mistakes import UserError, text_of
from lacoc_shared.network.session import NotConnected, open_client
from lacoc_shared.words import Phrase, say

app = typer.Typer()

_GONE_S = 120.0
"""A bot at an open seat ends when its court has been silent for this long [s], or for the time of
--wait if that is longer: such a court is not likely to come back by itself."""
_NAME_MAX = 24


@app.command(name="bot")
def bot_command(
    name: Annotated[
        str,
        typer.Argument(
            help="A bot of the arena (such as 'straight' or 'planner'), your my_bot.py, or "
            "'ghost:RECORD.mcap:left', which presses the keys of a recorded match again."
        ),
    ],
    link: options.Link = None,
    court: options.CourtName = None,
    connect: options.Connect = None,
    token: options.Token = None,
    authority: Annotated[
        Path | None,
        typer.Option(
            envvar="LACOC_AUTHORITY",
            metavar="FILE",
            help="With --connect: certificate of the private authority of an encrypted court.",
        ),
    ] = None,
    arena: Annotated[
        str | None,
        typer.Option(
            envvar="LACOC_ARENA",
            help="The arena that has the bot; by default the arena that the court plays.",
        ),
    ] = None,
    team: Annotated[
        str | None,
        typer.Option("--name", metavar="TEAM", help="The team's name; by default the bot's."),
    ] = None,
    robot: Annotated[
        str | None,
        typer.Option(help="An installed robot or a robot file; by default the contest's."),
    ] = None,
    gait: Annotated[
        list[Path] | None,
        typer.Option(
            metavar="FILE",
            help="A gait file; give it a second time for the other level. By default the "
            "robot's own gait.",
        ),
    ] = None,
    wait: options.WaitForCourt = None,
) -> None:
    """Let a bot hold a seat: it joins, says ready and plays, match after match.

    With the link of a team it goes from court to court, wherever the office of the contest calls
    the team, until the contest is over. At an open seat it plays with its own name and files.

    The bot ends with Ctrl-C. At an open seat it also ends when it loses the seat, or when the court
    has been gone for two minutes (or for the time of --wait, if that is longer). Your own bot is a
    Python file with a function bot(sheet, seat). This function returns another function, which
    takes a frame and returns a key.
    """
    access = entrance.contestant(link, court, connect, token, authority)
    bring = partial(_brings, name, robot, gait or [])
    with stop_signals() as stopping:
        patience = Patience(wait, stopping)
        with TeamWay(
            access, any_court=court is None, patience=patience, tell=screen.show, stopping=stopping
        ) as way:
            while (there := way.next()) is not None:
                if there.open:
                    _sit(name, way.access(there), arena, team, bring, patience, stopping)
                    return
                try:
                    over = _play_match(name, way, there, arena, stopping)
                except (NotConnected, NoCourt, NotNow) as error:
                    way.tell_trouble(error)
                    over = False
                if stopping():
                    return
                if over:
                    way.played(there.call)
                else:
                    way.again()


def _sit(
    name: str,
    access: Access,
    arena: str | None,
    team: str | None,
    bring: Callable[[list[Phrase]], tuple[SeatFiles, str]],
    patience: Patience,
    stopping: Callable[[], bool],
) -> None:
    """Let the bot join an open seat and play there, match after match."""
    notes: list[Phrase] = []
    files, own_team = bring(notes)
    for note in notes:
        screen.show(note)
    with open_client(access.addresses, authority=access.authority) as session:
        controller = patience.until(
            lambda: Controller(
                session,
                access.court,
                access.seat,
                access.token,
                team or own_team[:_NAME_MAX],
                **files._asdict(),
            )
        )
        player = BotPlayer(controller, _ground(controller, arena), name)
        hints = patience.until(controller.join)
        screen.show(say("bot.holds", bot=name, seat=access.seat, court=access.court))
        for hint in hints:
            screen.show(hint)
        try:
            _play(controller, player, stopping, max(_GONE_S, patience.wait_s or 0.0))
        finally:
            if controller.hold is Hold.HELD:
                _leave(controller)


def _play_match(
    name: str,
    way: TeamWay,
    there: Whereabouts,
    arena: str | None,
    stopping: Callable[[], bool],
) -> bool:
    """Let the bot play one match of a team; return whether the match is over.

    False: the seat was refused, the court is gone, or the bot is asked to stop.
    """
    access = way.access(there)
    with open_client(access.addresses, authority=access.authority) as session:
        controller = Controller(session, access.court, access.seat, access.token, there.team)
        if call_is_over(controller.view, there.call):
            return True
        player = BotPlayer(controller, _ground(controller, arena), name)
        controller.join()
        while not stopping() and not call_is_over(controller.view, there.call):
            _look(controller, player)
            if controller.hold is Hold.REPLACED:
                raise UserError(say("play.lost", why=controller.why_not_held))
            if controller.hold is Hold.REFUSED or is_gone(controller.view):
                return False
        return not stopping()


def _ground(controller: Controller, arena: str | None) -> Arena:
    """Return the arena whose bot plays: the named arena, else the one that the court plays."""
    sheet = controller.view.sheet
    return arenas.load(arena) if arena else arenas.from_settings(sheet.arena, sheet.settings)


def _brings(
    name: str, robot: str | None, gaits: list[Path], notes: list[Phrase]
) -> tuple[SeatFiles, str]:
    """Return the robot and gait files that a bot plays with, and its team name.

    A ghost has the files of its recorded match, unless the user gave others.
    """
    if not name.startswith(brains.GHOST):
        return gather(robot, gaits, notes), text_of(Path(name).stem)
    join = brains.ghost_join(*brains.open_ghost(name))
    ghost = f"{join.team}'s ghost"
    if robot or gaits:
        return gather(robot, gaits, notes), ghost
    return SeatFiles(join.robot, join.postures, join.locomotion), ghost


def _play(
    controller: Controller, player: BotPlayer, stopping: Callable[[], bool], gone_s: float
) -> None:
    well = True
    while not stopping():
        _look(controller, player)
        if controller.hold in (Hold.REPLACED, Hold.REFUSED):
            raise UserError(say("play.lost", why=controller.why_not_held))
        now_s = time.monotonic()
        link = controller.link(now_s)
        if well == bool(link):
            well = link is None
            screen.note(say("bot.court-back") if link is None else say("bot.no-court", why=link))
        if controller.view.silent_s(now_s) > gone_s:
            raise UserError(say("play.silent", seconds=gone_s))


def _look(controller: Controller, player: BotPlayer) -> None:
    """Pass the newest frame to the bot; print refused keys, new phases and the result."""
    frame = controller.wait_frame(0.1)
    if frame is not None:
        player.see(frame)
    for refused in controller.take_refused():
        screen.show(say("bot.refused", key=refused.name, why=refused.why))
    for event in controller.view.take_events():
        if event.kind in ("phase", "result"):
            screen.show(event.said)


def _leave(controller: Controller) -> None:
    try:
        controller.leave()
    except UserError as error:
        screen.show(str(error))
