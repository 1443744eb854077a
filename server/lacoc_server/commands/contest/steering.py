"""Commands for the day of a contest: what an organiser decides on the page /office."""

from collections.abc import Sequence
from datetime import datetime, time
from typing import TYPE_CHECKING, Annotated

import typer

from lacoc_server.commands.contest.deciding import Yes, carry_out
from lacoc_server.commands.contest.inviting import link
from lacoc_server.commands.contest.playing import By, ContestArgument, Reason, Team
from lacoc_server.commands.contest.setting_up import FILE
from lacoc_shared.command import screen
from lacoc_shared.contest import file as contests
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

if TYPE_CHECKING:
    from lacoc_server.contest.league.contest import Contest
    from lacoc_server.contest.league.facts import AnyFact

Clock = Annotated[
    str, typer.Option(metavar="HH:MM", help="A time of today on this machine's clock.")
]


def move(
    pairing: Annotated[
        str, typer.Argument(metavar="PAIRING", help="The match, such as finals:w2.1.")
    ],
    court: Annotated[str, typer.Option(metavar="COURT", help="The only court for it.")] = "",
    before: Annotated[
        str, typer.Option(metavar="PAIRING", help="The match directly before which it comes.")
    ] = "",
    at: Clock = "",
    contest: ContestArgument = FILE,
    by: By = "",
) -> None:
    """Move a match to another court, before another match, or to a later time.

    Its teams need not be known, and its stage need not be drawn. The newest move of a match counts.
    """
    courts = [*contests.load(contest).courts]

    def moved(now: "Contest") -> "Sequence[AnyFact]":
        from lacoc_server.contest.acts.steering import moving

        at_ms = _ms_of(at) if at else 0
        return [moving(now, courts, pairing, court, before, at_ms, _now_ms())]

    carry_out(contest, by, moved)


def pause(
    until: Annotated[
        str,
        typer.Option("--until", metavar="HH:MM", help="It goes on by itself at this time."),
    ] = "",
    contest: ContestArgument = FILE,
    reason: Reason = "",
    by: By = "",
) -> None:
    """Call no more games until the contest goes on; games that were called are played."""

    def paused(now: "Contest") -> "Sequence[AnyFact]":
        from lacoc_server.contest.acts.steering import pausing

        return [pausing(now, _ms_of(until) if until else 0, reason, _now_ms())]

    carry_out(contest, by, paused)


def resume(contest: ContestArgument = FILE, by: By = "") -> None:
    """Let a paused contest go on."""

    def resumed(now: "Contest") -> "Sequence[AnyFact]":
        from lacoc_server.contest.acts.steering import resuming

        return [resuming(now, _now_ms())]

    carry_out(contest, by, resumed)


def shift(
    minutes: Annotated[
        int, typer.Argument(metavar="MINUTES", help="By how many minutes.", min=1, max=1440)
    ],
    contest: ContestArgument = FILE,
    reason: Reason = "",
    by: By = "",
) -> None:
    """Make all that is to come later: no game is called for so long, and all set times move."""

    def shifted(_: "Contest") -> "Sequence[AnyFact]":
        from lacoc_server.contest.acts.steering import shifting
        from lacoc_server.contest.league.timetable.steered import MINUTE_MS

        return [shifting(minutes * MINUTE_MS, reason)]

    carry_out(contest, by, shifted)


def unshift(contest: ContestArgument = FILE, by: By = "") -> None:
    """Take the newest 'shift' back: all is as if it had never been."""

    def unshifted(now: "Contest") -> "Sequence[AnyFact]":
        from lacoc_server.contest.acts.steering import unshifting

        return [unshifting(now)]

    carry_out(contest, by, unshifted)


def announce(
    text: Annotated[str, typer.Argument(metavar="TEXT", help="The line; '' takes it away.")],
    contest: ContestArgument = FILE,
    by: By = "",
) -> None:
    """Show a line to all, on all pages."""

    def announced(_: "Contest") -> "Sequence[AnyFact]":
        from lacoc_server.contest.acts.steering import announcing

        return [announcing(text)]

    carry_out(contest, by, announced)


def substitute(
    team: Team,
    other: Annotated[
        str, typer.Argument(metavar="SUBSTITUTE", help="The team that comes in its place.")
    ],
    contest: ContestArgument = FILE,
    reason: Reason = "",
    yes: Yes = False,
    by: By = "",
) -> None:
    """Let a team take the place of another one that has not played: show what that changes, ask.

    The other team leaves the contest. Where it has played already, it keeps its place.
    """

    def substituted(now: "Contest") -> "Sequence[AnyFact]":
        from lacoc_server.contest.acts.steering import substituting

        return [substituting(now, team, other, reason)]

    carry_out(contest, by, substituted, asks=True, yes=yes)


def undraw(
    stage: Annotated[
        str,
        typer.Argument(metavar="STAGE", help="Name in the contest file; none: list the stages."),
    ] = "",
    contest: ContestArgument = FILE,
    reason: Reason = "",
    yes: Yes = False,
    by: By = "",
) -> None:
    """Take the draw of a stage back that nobody has played in: show what that changes, ask.

    It stays undrawn until you draw it again: then also with a team that came late.
    """

    def undrawn(now: "Contest") -> "Sequence[AnyFact]":
        from lacoc_server.contest.acts.steering import undrawing

        return undrawing(now, stage, reason)

    carry_out(contest, by, undrawn, asks=True, yes=yes)


def staff(
    name: Annotated[str, typer.Argument(metavar="NAME", help="Who it is.")],
    contest: ContestArgument = FILE,
    remove: Annotated[
        bool, typer.Option("--remove", help="Take the link away: it opens nothing any more.")
    ] = False,
) -> None:
    """Print a link to the organiser's page for somebody of the staff.

    Whoever has it can do all that you can, but make no links for the staff. Facts say who decided.
    """
    from lacoc_server.contest.acts.organiser import team_name

    plan = contests.load(contest)
    who = team_name(name)
    if remove:
        plan.secrets.forget_staff(who)
        screen.show(say("desk.staff-removed", name=who))
        return
    text = link(plan, contest, "office", plan.secrets.staff(who))
    screen.stdout.print(text, markup=False, soft_wrap=True)  # to be copied whole


def _ms_of(clock: str) -> int:
    """Return a time of today in milliseconds since 1970, UTC.

    Raises:
        UserError: if it is not written as 14:05.
    """
    try:
        when = time.fromisoformat(clock)
    except ValueError:
        raise UserError(say("day.bad-time", found=clock)) from None
    return round(1000 * datetime.combine(datetime.now(), when).astimezone().timestamp())


def _now_ms() -> int:
    return round(1000 * datetime.now().timestamp())
