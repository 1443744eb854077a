"""`lacoc referee`: decide, read the log, show the state of the court.

The subcommands of the decisions are made from `lacoc_shared.decisions`: a new decision there is a
new subcommand here, with its arguments.
"""

import getpass
import inspect
import os
import re
import sys
import time
from collections.abc import Callable
from typing import Annotated, Any

import msgspec
import typer
from msgspec.structs import FieldInfo
from rich.table import Table
from rich.text import Text
from typer.core import TyperGroup

from lacoc_client.commands import entrance
from lacoc_client.play.asking import NoAnswer, Patience
from lacoc_client.play.referee import RefereeClient
from lacoc_client.play.spectator import Spectator
from lacoc_client.play.stopping import stop_signals
from lacoc_client.play.terminal import words
from lacoc_client.play.terminal.line_view import event_columns
from lacoc_client.play.terminal.plain import event_dict, frame_dict, outlook_dict, reply_dict
from lacoc_shared.command import options, screen
from lacoc_shared.decisions import (
    DECISIONS,
    NUMBER_MAX,
    OLD_FIELDS,
    Adjust,
    Clock,
    Decision,
    Restart,
    TakeBack,
)
from lacoc_shared.messages import (
    OUTLOOK_MOST_S,
    DecisionReply,
    Event,
    Frame,
    Health,
    SeatHealth,
    Sheet,
)
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import open_client
from lacoc_shared.seat import BEAT_S, Phase, SeatFlag
from lacoc_shared.words import Phrase, render, say


class _Referee(TyperGroup):
    """The command group, which takes a link before the subcommand: `lacoc referee LINK start`."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Keep a link for the subcommand; after a link alone, run the subcommand `status`."""
        if args and "://" in args[0]:
            os.environ["LACOC_LINK"] = args[0]
            args = args[1:] or ["status"]
        return super().parse_args(ctx, args)


app = typer.Typer(
    cls=_Referee,
    help="Referee a match: decide, read the log, see how well the court runs.\n\n"
    "Begin with your link, in quotes: lacoc referee LINK start. 'status' says which decisions are "
    "possible now, and why the others are not. The record keeps every decision with the referee's "
    "name and the reason.",
    no_args_is_help=True,
)

_HEALTH_S = 5.0
"""Longest wait for a court's health, which it sends twice a second."""
_HISTORY_S = 3.0
_QUIET_S = 0.3
"""The list of events counts as complete when no more events arrive for this time [s]."""

_FIELDS = {
    "seat": "The seat, such as 'left'.",
    "seconds": "How many seconds.",
    "gives_s": "How many seconds to give; -10 takes ten away.",
    "points": "How many points; -2 takes two away.",
    "marker": "The disc, corner or flag: C4 as in pictures, or its name: c2r3, corner0, flag7.",
    "state": "What it becomes: neutral, left, right or down.",
    "event": "Number of the event, as in 'lacoc referee log'.",
    "dry_run": "Only show what would change.",
    "winner": "The seat that wins, or 'draw'.",
}
_BOUNDS: dict[str, Any] = {"min": -NUMBER_MAX, "max": NUMBER_MAX}
_TYPES = {int: "A whole number.", float: "A number.", bool: "Yes or no."}

_TokenUnused = Annotated[
    str | None,
    typer.Option(
        "--token", envvar="LACOC_TOKEN", metavar="TOKEN", help="This command needs no token."
    ),
]


_FINAL = frozenset({"abort", "declare", "official", "next"})
"""Decisions that can't be undone; the referee is asked first whether to make them."""
_NOBODY = frozenset({"root", "admin", "administrator", "user", "nobody"})
"""Account names that name no person; the record gets "referee" in place of them."""


def _default_name() -> str:
    try:
        name = getpass.getuser()
    except (KeyError, OSError, ImportError):  # an account without a name
        return "referee"
    return "referee" if name in _NOBODY else name


_COMMON: dict[str, tuple[Any, Any]] = {
    "reason": (
        Annotated[
            str, typer.Option(metavar="TEXT", help="The reason; it is written into the record.")
        ],
        "",
    ),
    "by": (
        Annotated[
            str,
            typer.Option(
                metavar="NAME",
                help="The referee's name; by default your user name on this machine.",
            ),
        ],
        "",
    ),
    "yes": (
        Annotated[bool, typer.Option("--yes", help="Do it without asking.")],
        False,
    ),
    "wait": (
        Annotated[
            float | None,
            typer.Option(
                metavar="SECONDS",
                min=0,
                help="How many seconds to wait for the court, and until the decision is possible.",
            ),
        ],
        None,
    ),
    "link": (options.LinkOption, None),
    "court": (options.CourtName, None),
    "connect": (options.Connect, None),
    "token": (options.Token, None),
    "json": (options.Json, False),
}
"""Options of every decision: type and default."""


def _command(name: str, kind: type[Decision]) -> Callable[..., None]:
    """Make the function that the subcommand of a decision runs.

    Its parameters are the decision's fields.
    """
    fields = {
        field.name: field
        for field in msgspec.structs.fields(kind)
        if (kind, field.name) not in OLD_FIELDS
    }

    def run(**given: Any) -> None:
        if "marker" in fields:
            given["marker"] = _marker(given["marker"])
        decision = kind(**{field: given[field] for field in fields})
        _decide(name, decision, **{option: given[option] for option in _COMMON})

    parameters = [
        (
            field.name,
            _annotation(field),
            msgspec.NODEFAULT if _is_argument(field) else field.default,
        )
        for field in fields.values()
    ]
    parameters += [(option, *spec) for option, spec in _COMMON.items()]
    run.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
        [
            inspect.Parameter(
                parameter,
                inspect.Parameter.KEYWORD_ONLY,
                annotation=annotation,
                default=inspect.Parameter.empty if default is msgspec.NODEFAULT else default,
            )
            for parameter, annotation, default in parameters
        ]
    )
    run.__doc__ = kind.__doc__
    return run


def _annotation(field: FieldInfo) -> Any:
    """Return typer's annotation of a field: an argument if it must be given, else an option."""
    help = _FIELDS.get(field.name) or _TYPES.get(field.type, "A word.")
    if _is_argument(field):
        name = field.encode_name.removesuffix("_s").upper()
        bounds = _BOUNDS if field.type in (int, float) else {}
        return Annotated[field.type, typer.Argument(metavar=name, help=help, **bounds)]
    return Annotated[
        field.type, typer.Option(f"--{field.encode_name.replace('_', '-')}", help=help)
    ]


def _is_argument(field: FieldInfo) -> bool:
    """Return whether a field of a decision must be given on the command line.

    `gives_s` must be given too: its default is only for old records.
    """
    return field.required or field.name == "gives_s"


for _name, _kind in DECISIONS.items():
    # With unknown options ignored, a negative number can be an argument.
    app.command(
        _name, context_settings={"ignore_unknown_options": True}, rich_help_panel="Decisions"
    )(_command(_name, _kind))


@app.command(rich_help_panel="Look")
def status(
    link: options.LinkOption = None,
    court: options.CourtName = None,
    connect: options.Connect = None,
    token: _TokenUnused = None,
    json: options.Json = False,
) -> None:
    """Show phase, clock, score, connections, and which decisions are possible."""
    access = entrance.one_court(link, court, connect, None if link else token)
    with open_client(access.addresses, authority=access.authority) as session:
        view = Spectator(session, access.court)
        frame, health = _look(view)
        if json:
            found = frame_dict(frame, view.sheet)
            screen.print_json({"court": access.court, **found, "health": health})
            return
        _show_status(frame, view.sheet, health)


@app.command(rich_help_panel="Look")
def log(
    link: options.LinkOption = None,
    court: options.CourtName = None,
    connect: options.Connect = None,
    token: _TokenUnused = None,
    follow: Annotated[
        bool, typer.Option("--follow", help="Go on with new events, until Ctrl-C.")
    ] = False,
    json: options.Json = False,
) -> None:
    """List the events of the match with their numbers; with --json, one on each line."""
    access = entrance.one_court(link, court, connect, None if link else token)
    with open_client(access.addresses, authority=access.authority) as session:
        view = Spectator(session, access.court)
        events = _history(view)
        if json:
            for event in events:
                screen.print_json(event_dict(event, view.sheet))
        elif follow:
            for event in events:
                screen.show(_log_line(event, view.sheet))
        else:
            screen.show(_log_table(events, view.sheet))
        with stop_signals() as stopping:
            while follow and not stopping():
                view.wait_frame(0.1)
                for event in view.take_events():
                    if json:
                        screen.print_json(event_dict(event, view.sheet))
                    else:
                        screen.show(_log_line(event, view.sheet))


@app.command(rich_help_panel="Look")
def outlook(
    seconds: Annotated[
        float, typer.Option(help="How long play would go on.", min=0.1, max=OUTLOOK_MOST_S)
    ] = 10.0,
    take_back: Annotated[
        int | None,
        typer.Option(
            metavar="EVENT", help="Take back the event with this number before.", **_BOUNDS
        ),
    ] = None,
    restart: Annotated[
        str | None,
        typer.Option(
            metavar="SEAT", help="Put the robot of this seat back at its start place before."
        ),
    ] = None,
    link: options.LinkOption = None,
    court: options.CourtName = None,
    connect: options.Connect = None,
    token: options.Token = None,
    json: options.Json = False,
) -> None:
    """During a halt, show what would happen if play went on; the match stays as it is.

    The court lets a copy of the match go on. Each robot goes on with its last key, and nobody
    presses another one.
    """
    if take_back is not None and restart is not None:
        raise UserError(say("referee.one-decision"))
    decision: Decision | None = None
    if take_back is not None:
        decision = TakeBack(take_back)
    elif restart is not None:
        decision = Restart(restart)
    access = entrance.referee(link, court, connect, token)
    with open_client(access.addresses, authority=access.authority) as session:
        view = Spectator(session, access.court)
        found = RefereeClient(session, access.court, access.token).look_ahead(decision, seconds)
        if json:
            screen.print_json(outlook_dict(found, view.sheet))
            return
        screen.show(say("referee.outlook", seconds=found.seconds))
        for event in found.events:
            screen.show(Text.assemble("  ", *event_columns(event, view.sheet)))
        if not found.events:
            screen.show(say("referee.outlook-nothing"))
        then, before = " : ".join(map(str, found.scores)), " : ".join(map(str, found.before))
        screen.show(say("referee.outlook-score", then=then, before=before))


def _marker(name: str) -> str:
    """Return the name of a marker from what the user typed.

    A disc may be called as in pictures: C4 is c2r3.
    """
    if found := re.fullmatch("([A-Za-z])([1-9][0-9]?)", name):
        return f"c{ord(found[1].upper()) - ord('A')}r{int(found[2]) - 1}"
    return name


def _decide(
    name: str,
    decision: Decision,
    *,
    reason: str,
    by: str,
    yes: bool,
    wait: float | None,
    json: bool,
    **where: Any,
) -> None:
    access = entrance.referee(**where)
    patience = Patience(wait)
    if name in _FINAL and not yes:
        _ask(name, say("referee.sure", decision=name))
    with patience.until(
        lambda: open_client(access.addresses, authority=access.authority)
    ) as session:
        if isinstance(decision, Clock) and decision.gives_s < 0 and not yes:
            view = patience.until(lambda: Spectator(session, access.court))
            if _ends_play(decision, *_look(view), view.sheet):
                _ask(name, say("referee.ends-play"))
        if isinstance(decision, Adjust) and not yes and sys.stdin.isatty():
            view = patience.until(lambda: Spectator(session, access.court))
            if (question := _rescored(decision, _look(view)[0], view.sheet)) is not None:
                _ask(name, question)
        referee = RefereeClient(session, access.court, access.token)

        def decide() -> DecisionReply:
            return referee.decide(decision, reason, by or _default_name())

        try:
            if wait is None:
                reply = decide()
            else:
                view = patience.until(lambda: Spectator(session, access.court))
                reply = _decide_when_legal(view, wait, name, decide)
        except NoAnswer as error:
            said = say("referee.unsure", why=error.phrase, decision=name)
            raise UserError(said) from None
    if json:
        screen.print_json(reply_dict(reply))
    else:
        _show_reply(reply)


def _ends_play(decision: Clock, frame: Frame, _: Health, sheet: Sheet) -> bool:
    left_s = sheet.duration_s - frame.clock_ticks * BEAT_S
    return bool(sheet.duration_s) and left_s + decision.gives_s <= 0


def _rescored(decision: Adjust, frame: Frame, sheet: Sheet) -> Phrase | None:
    """Return the question whether to change a score, with the scores before and after the change.

    None: the match has not two seats, or not this seat.
    """
    names = [seat.id for seat in sheet.seats]
    if len(names) != 2 or decision.seat not in names:
        return None
    now = [seat.score for seat in frame.seats]
    then = list(now)
    then[names.index(decision.seat)] += decision.points
    left, right = (seat.team or seat.id for seat in sheet.seats)
    scores = [
        say("score.two", left=left, points=one, conceded=other, right=right)
        for one, other in (now, then)
    ]
    return say("referee.adjusts", now=scores[0], then=scores[1])


def _ask(name: str, question: Phrase) -> None:
    """Ask the user at the terminal whether to make a decision.

    Raises:
        UserError: if there is no terminal to ask at.
        typer.Exit: if the answer is no.
    """
    if not sys.stdin.isatty():
        raise UserError(say("referee.needs-yes", decision=name))
    if not typer.confirm(render(question)):
        screen.note(say("decide.not-done"))
        raise typer.Exit(1)


def _decide_when_legal(
    view: Spectator,
    wait_s: float,
    name: str,
    decide: Callable[[], DecisionReply],
) -> DecisionReply:
    """Make a decision as soon as the court says that it is legal.

    The court's health is up to half a second old, so a decision may be refused although health
    calls it legal. If the next health message still calls it legal, the refusal is raised.
    Otherwise this function waits and tries again.
    """
    deadline_s = time.monotonic() + wait_s
    seen: Health | None = None
    refused: UserError | None = None
    why: Phrase | None = say("why.no-health")
    while True:
        view.wait_frame(0.1)
        if view.health is not None and view.health is not seen:
            seen = view.health
            why = seen.decisions.get(name, say("why.unknown-decision"))
            if why is None and refused is not None:
                raise refused
            refused = None
            if why is None:
                try:
                    return decide()
                except NoAnswer:  # asked again, it could be done twice
                    raise
                except UserError as error:
                    refused = error
        if time.monotonic() >= deadline_s:
            said = say("referee.not-legal", decision=name, seconds=wait_s, why=why)
            raise refused or UserError(said)


def _look(view: Spectator) -> tuple[Frame, Health]:
    """Wait until a court has sent a frame and its health, and return the two.

    Raises:
        UserError: if no frame or no health comes in time.
    """
    deadline_s = time.monotonic() + _HEALTH_S
    while view.frame is None or view.health is None:
        if time.monotonic() > deadline_s:
            raise UserError(say("referee.no-health"))
        view.wait_frame(0.1)
    return view.frame, view.health


def _history(view: Spectator) -> tuple[Event, ...]:
    """Return the events of the match so far, in order; of very many the newest (`EVENTS_LISTED`).

    Wait for them, because they arrive a moment after the connection was opened.
    """
    now_s = time.monotonic()
    deadline_s, quiet_since_s = now_s + _HISTORY_S, now_s
    while (now_s := time.monotonic()) < deadline_s:
        view.wait_frame(0.05)
        if view.take_events():
            quiet_since_s = now_s
        numbers = [event.number for event in view.events]
        whole = bool(numbers) and numbers == [*range(1, len(numbers) + 1)]
        if whole and now_s - quiet_since_s > _QUIET_S:
            break
    return view.events


def _log_line(event: Event, sheet: Sheet) -> Text:
    return Text.assemble((f"{event.number:>4} ", "bold"), *event_columns(event, sheet))


def _log_table(events: tuple[Event, ...], sheet: Sheet) -> Table:
    table = screen.table(
        say("fact.number"),
        say("fact.clock"),
        say("fact.kind"),
        say("fact.seat"),
        say("fact.what-happened"),
    )
    for event in events:
        plain = event_dict(event, sheet)
        table.add_row(
            str(event.number),
            words.event_clock(event, sheet),
            event.kind,
            Text(plain["seat"] or ""),
            Text(render(event.said)),
        )
    return table


def _show_reply(reply: DecisionReply) -> None:
    score = " : ".join(map(str, reply.scores))
    said = render(reply.said)
    text = f"{said[:1].upper()}{said[1:]}"
    if reply.event is None:
        screen.show(say("referee.dry-run"))
        screen.show(f"  {text}")
        for change in reply.changes:
            screen.show(f"  {render(change)}")
        if not reply.changes:
            screen.show(say("referee.no-change"))
        screen.show(say("referee.score-then", score=score))
        return
    screen.show(say("referee.done", what=text, event=reply.event, beat=reply.beat))
    for change in reply.changes:
        screen.show(f"  {render(change)}")
    screen.show(say("referee.score", score=score))


def _show_status(frame: Frame, sheet: Sheet, health: Health) -> None:
    names = words.teams(sheet)
    clock, hint = words.match_clock(frame, sheet), words.phase_hint(frame, sheet) or None
    if sheet.duration_s:
        time_left = say("referee.left", clock=clock, hint=hint)
    else:
        time_left = say("referee.played", clock=clock, hint=hint)
    match = say("referee.match", title=words.played(sheet), court=sheet.court, match=sheet.match)
    screen.show(
        Text.assemble(
            (render(match), "bold"),
            (words.phase_name(Phase(frame.phase)), "bold cyan"),
            render(time_left),
        )
    )
    if health.record_trouble is not None:
        screen.warn(health.record_trouble)  # the court waits, so its speed says nothing
    else:
        screen.show(
            say(
                "referee.speed",
                factor=health.real_time_factor,
                slow=health.slow_beats,
                worst_ms=health.worst_late_ms,
            )
        )
    if health.verdict is not None and health.verdict.advice:
        screen.show(
            Text(render(say("event.advised", reasons=health.verdict.advice)), "bold yellow")
        )
    if health.input_delay_ms:
        screen.show(say("referee.equalised", ms=health.input_delay_ms))
    for why, count in health.dropped.items():
        screen.show(say("referee.dropped", count=count, why=why))
    seats = screen.table(
        say("fact.seat"),
        say("fact.team"),
        say("fact.score"),
        say("fact.ready"),
        say("fact.key"),
        say("fact.link"),
        say("fact.refused"),
    )
    yes, no = render(say("word.yes")), render(say("word.no"))
    for index, (seat, link) in enumerate(zip(frame.seats, health.seats, strict=True)):
        ready = yes if seat.flags & SeatFlag.READY else no
        team = Text(names[index] if sheet.seats[index].team else "-")
        row = (link.id, team, str(seat.score), ready)
        key, refused = words.standing_key(frame, sheet, index) or "-", words.refusals(link.refused)
        seats.add_row(*row, key, _link(link), refused)
    screen.show(seats)
    decisions = screen.table(say("fact.decision"), say("fact.legal"), say("fact.why-not"))
    for name, why_not in health.decisions.items():
        legal = Text(no, "dim") if why_not else Text(yes, "bold green")
        decisions.add_row(name, legal, Text(render(why_not or "")))
    screen.show(decisions)


def _link(link: SeatHealth) -> str:
    if not link.joined:
        return render(say("link.nobody"))
    if link.heard_ms is None:
        return render(say("link.not-heard"))
    heard = say(
        "link.heard",
        hz=link.commands_hz,
        ms=link.heard_ms,
        p50_ms=link.round_trip_p50_ms,
        p95_ms=link.round_trip_p95_ms,
        late=link.late or None,
    )
    return render(heard)
