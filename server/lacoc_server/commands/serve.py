"""`lacoc serve`: run a court."""

import secrets
import signal
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Annotated, Any

import typer

from lacoc_arenas import arena as arenas
from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_robots.limits import Limits
from lacoc_server.court.assigning import Preparation
from lacoc_server.court.copying import Copying
from lacoc_server.court.court import Court, CourtSettings
from lacoc_server.court.key_trials import KeyTrials
from lacoc_server.court.outlooks import Outlooks
from lacoc_server.court.renewal import Renewal
from lacoc_server.court.try_outs import TryOuts
from lacoc_server.court.weighing import Weighing
from lacoc_server.doors.decision_desk import DecisionDesk
from lacoc_server.doors.inbox import Inbox
from lacoc_server.doors.network import CourtNetwork
from lacoc_server.doors.office_desk import OfficeDesk
from lacoc_server.doors.team_desk import TeamDesk, alone
from lacoc_server.journal.recovery import Unfinished, last_result, unfinished
from lacoc_server.match.entry import JoinCheck
from lacoc_shared.command import child, log, options, screen
from lacoc_shared.command.metrics import Exporter
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.courts import LOOPBACK, ContestCourt
from lacoc_shared.contest.file import ContestFile
from lacoc_shared.contest.secrets import Secrets
from lacoc_shared.contest.tokens import new_token, new_token_hash
from lacoc_shared.keyspace import KeySpace
from lacoc_shared.messages import SentFile
from lacoc_shared.messages.office import TOKENS_MOST, WAITING, open_match
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.address import endpoint, own_address
from lacoc_shared.words import say

app = typer.Typer()


@app.command(name="serve")
def serve_command(
    contest: options.ContestOption = None,
    court: options.CourtName = None,
    arena: Annotated[
        str | None,
        typer.Option(
            envvar="LACOC_ARENA",
            help="The game, if there is no contest file: othello, flag-strike, practice, or "
            "the path of an arena's folder.",
        ),
    ] = None,
    listen: Annotated[
        str | None,
        typer.Option(
            envvar="LACOC_LISTEN",
            metavar="ADDRESS",
            help="Address at which to listen, such as tcp/0.0.0.0:7447; port 0 takes a free port.",
        ),
    ] = None,
    recordings: Annotated[
        Path | None,
        typer.Option(
            envvar="LACOC_RECORDINGS",
            metavar="FOLDER",
            help="Folder of the records; by default the contest's, or 'recordings'.",
        ),
    ] = None,
    seconds: Annotated[
        float | None,
        typer.Option(help="Length of a match in seconds; by default the arena's.", min=0.1),
    ] = None,
    speed: Annotated[
        float, typer.Option(help="2 plays twice as fast as real time.", min=0.1, max=50)
    ] = 1.0,
    fresh: Annotated[
        bool,
        typer.Option("--fresh", help="Open a new match, even if an unfinished one was left here."),
    ] = False,
    metrics: options.Metrics = None,
    json: options.Json = False,
) -> None:
    """Run a court: it moves the robots, keeps clock and score, and records the match.

    Without a contest file the court makes its own tokens and prints the command line for each
    contestant and for the referee. Ctrl-C closes the court; the record is finished first.

    With a contest file the court plays only what the office assigns: 'lacoc contest run' starts it.

    If the court was killed in a match, start it again in the same way. The match is then halted,
    and goes on where it stopped, with its seats, clock and score. A match without a referee resumes
    by itself when a contestant is back. Without a contest file both the new tokens and the old ones
    open the seats.
    """
    if contest is None:
        plan = _alone(arena, listen, court)
    elif arena is None:
        plan = contests.load(contest)
    else:
        raise UserError(say("serve.contest-or-arena"))
    name, entry = plan.court(court)
    own_settings = _overrides(entry.settings, seconds)
    loaded = arenas.load(entry.arena, own_settings)
    seats = [seat.id for seat in loaded.seats]
    keys = KeySpace(name)
    folder = recordings or plan.recordings
    left = None if fresh else unfinished(folder, name, loaded)
    over = last_result(folder, name, loaded) if contest and not (left or fresh) else None
    levels = {*loaded.match.open_levels}
    if left is not None:
        levels |= {*left.match.rules.open_levels}  # the match that goes on keeps its own levels
        screen.note(say("serve.goes-on", match=left.match.setup.match_id))
        if not left.match.by_office and left.match.setup.settings != loaded.settings:
            screen.note(say("serve.old-settings"))
        if left.cut:
            screen.note(left.cut)
        if left.other_arithmetic:
            screen.warn(left.other_arithmetic)
    join_check = JoinCheck(
        SentFile(*find_robot(plan.robot)),
        *sample_gait_files(plan.robot),
        Limits.of(plan.limits),
        levels,
    )
    whistle = plan.secrets.referee(name) if contest else new_token()
    tokens = {} if contest else {seat: new_token() for seat in seats}
    settings = CourtSettings(
        name,
        loaded,
        plan.limits,
        folder,
        assigned=WAITING if contest else open_match(_opening(tokens, left)),
        speed=speed,
        health=plan.health,
    )
    addresses = (endpoint(listen, plan.public.protocol),) if listen else entry.own_listen
    with ExitStack() as opened:
        weighing = opened.enter_context(Weighing(join_check))
        inbox = Inbox(
            keys,
            seats,
            weighing,
            secrets.token_bytes,
            last_seqs=left.last_seqs if left else None,
            joined=left.token_hashes if left else (),
            most_delay_ms=entry.most_delay_ms,
        )
        office = None
        if contest:
            prepare = Preparation(entry.arena, own_settings, seats, join_check, weighing.aside)
            copying = Copying(folder, name, weighing.aside)
            office = OfficeDesk(new_token_hash(plan.secrets.office), seats, prepare, copying)
        exporter = opened.enter_context(Exporter(metrics)) if metrics else None
        outlooks, key_trials = Outlooks(weighing.aside), KeyTrials(weighing.aside)
        try_outs = TryOuts(weighing.aside)
        pair = plan.public.pair
        renewal = None if pair is None else opened.enter_context(Renewal(pair, name))
        network = opened.enter_context(
            CourtNetwork(
                keys,
                addresses,
                inbox,
                DecisionDesk([new_token_hash(whistle)]),
                pair,
                office,
                outlooks,
                TeamDesk(alone(name, settings.assigned)),
                try_outs,
            )
        )
        running = Court(settings, network, left or over, office, outlooks, key_trials, try_outs)
        if exporter is not None:
            exporter.registry.register(running.metrics)
        stop = _stop_on_signal()
        _open_doors(
            name,
            running.match_id,
            network.locators,
            metrics=None if exporter is None else exporter.url,
            tokens=None if contest else (tokens, whistle),
            json=json,
        )
        log.start(json)
        running.run(
            lambda: (
                bool(stop)
                or (office is not None and office.retired)
                or (renewal is not None and renewal.is_due and running.is_idle)
            )
        )
    if office is not None and office.retired:
        screen.note(say("serve.retired", court=name))
        raise typer.Exit(child.NOT_AGAIN)


def _alone(arena: str | None, listen: str | None, court: str | None) -> ContestFile:
    """Return a contest file made up for a court that is started without a contest file."""
    entry = ContestCourt(arena=arena or "othello", listen=(endpoint(listen or LOOPBACK),))
    nobody = Secrets(Path())  # nobody asks it: the tokens are of this run alone
    return ContestFile(courts={court or contests.MAIN: entry}, secrets=nobody)


def _opening(tokens: Mapping[str, str], left: Unfinished | None) -> dict[str, list[str]]:
    """Return for each seat the hashes of its new token and of its tokens before a restart."""
    found = {seat: [new_token_hash(token)] for seat, token in tokens.items()}
    if left is not None:
        for one in left.match.assigned.seats if left.match.assigned else ():
            found[one.id] += one.token_hashes
        for seat, held in left.token_hashes.items():
            found[seat] += held
    return {seat: [*dict.fromkeys(hashes)][:TOKENS_MOST] for seat, hashes in found.items()}


def _overrides(settings: dict[str, Any], seconds: float | None) -> dict[str, Any]:
    return (
        settings if seconds is None else arenas.merge(settings, {"match": {"duration_s": seconds}})
    )


def _open_doors(
    name: str,
    match_id: str,
    locators: tuple[str, ...],
    *,
    metrics: str | None,
    tokens: tuple[dict[str, str], str] | None,
    json: bool,
) -> None:
    if json:
        opened: dict[str, Any] = {"kind": "open", "court": name, "match_id": match_id}
        opened |= {"locators": locators, "metrics": metrics}
        if tokens is not None:
            opened["tokens"], opened["referee"] = tokens
        screen.print_json(opened)
        return
    screen.show(say("serve.open", court=name, at=locators, match=match_id))
    if metrics is not None:
        screen.note(say("command.metrics-at", where=metrics))
    if tokens is not None:
        address = ContestCourt(listen=locators).address(own_address())
        for who, line in _lines(name, address, *tokens).items():
            screen.show(say("serve.enter", who=who, command=line))


def _lines(court: str, address: str, seats: Mapping[str, str], referee: str) -> dict[str, str]:
    """Return the command lines that connect to a court: by seat, for "referee" and "spectators"."""
    where = f"--court {court} --connect {address}"
    return {
        **{seat: f"lacoc play {where} --token {token}" for seat, token in seats.items()},
        "referee": f"lacoc referee status {where} --token {referee}",
        "spectators": f"lacoc watch {where}",
    }


def _stop_on_signal() -> list[int]:
    """Return a list that is empty until SIGINT or SIGTERM asks the process to end."""
    asked: list[int] = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda received, _: asked.append(received))
    return asked
