"""Decide about a match, take a team out or draw a stage, after showing what that changes."""

import sys
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Annotated, Literal

import typer
from msgspec.structs import replace

from lacoc_server.commands.contest.playing import By, ContestArgument, Reason, Team
from lacoc_server.commands.contest.setting_up import FILE
from lacoc_shared.command import screen
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, render, say

if TYPE_CHECKING:
    from pathlib import Path

    from lacoc_server.contest.league.contest import Contest
    from lacoc_server.contest.league.facts import AnyFact

Yes = Annotated[bool, typer.Option("--yes", help="Do it without asking.")]


def decide(
    decision: Annotated[
        Literal["replay", "result", "void", "no-show"],
        typer.Argument(
            help="replay: the game is played again. result: the game counts with the points of "
            "--score. void: the match counts for nobody. no-show: --team did not come."
        ),
    ],
    pairing: Annotated[
        str, typer.Argument(metavar="PAIRING", help="The match, such as groups:a1.2.")
    ],
    game: Annotated[int, typer.Option(help="Number of the game in its match.", min=1)] = 1,
    team: Annotated[str, typer.Option(metavar="TEAM", help="The team that did not come.")] = "",
    score: Annotated[
        str, typer.Option(metavar="L:R", help="Points of the left and of the right seat.")
    ] = "",
    reason: Reason = "",
    yes: Yes = False,
    contest: ContestArgument = FILE,
    by: By = "",
) -> None:
    """Decide about a match: show what the decision changes, ask, then append it to the facts.

    What was played before stays in the facts. If teams of later matches change, those matches are
    played again; results that do not count any more are kept.
    """
    from lacoc_server.contest.acts import deciding

    wanted = deciding.WantedDecision(
        kind=decision,
        pairing=pairing,
        game=game,
        team=team,
        scores=_scores(score),
        reason=reason,
    )
    done = say("decide.done")
    carry_out(contest, by, lambda now: [deciding.decision(now, wanted)], done, asks=True, yes=yes)


def withdraw(
    team: Team,
    contest: ContestArgument = FILE,
    reason: Reason = "",
    disqualify: Annotated[
        bool, typer.Option("--disqualify", help="Expel the team: it is ranked last.")
    ] = False,
    yes: Yes = False,
    by: By = "",
) -> None:
    """Take a team out of the contest: show what that changes, ask, then do it.

    What the team has played counts, and opponents win the rest.
    """
    from lacoc_server.contest.acts import deciding, organiser
    from lacoc_server.contest.kept.folder import ContestFolder
    from lacoc_server.contest.kept.store import FactStore
    from lacoc_server.contest.league.contest import compute
    from lacoc_server.contest.league.formats.installed import FORMATS

    with FactStore(ContestFolder(contest).facts) as store:
        facts = store.facts()
    more = organiser.leaving(compute(facts, FORMATS), team, reason, disqualified=disqualify)
    if more and not wanted_so(deciding.effect(facts, more), yes):
        return
    screen.show(organiser.take_out(contest, team, reason, disqualified=disqualify, by=by))
    organiser.renew_sheet(contest)


def draw(
    contest: ContestArgument = FILE,
    yes: Yes = False,
    lot: Annotated[
        str,
        typer.Option(
            metavar="TEXT",
            help="Draw by lot: what was drawn in front of everybody, such as '4 2 6' of dice.",
        ),
    ] = "",
    order: Annotated[
        list[str] | None,
        typer.Option(
            metavar="TEAM,TEAM,...",
            help="The teams in the order that you want, the best first; it needs a reason. Can be "
            "given more than once: a name with a comma needs an --order of its own.",
        ),
    ] = None,
    reason: Reason = "",
    by: By = "",
) -> None:
    """Draw the stage that waits for you: show its teams, ask, then draw it.

    A stage with draw = "organiser" in the contest file waits when the stage before it is over.
    Until you draw it, results before it can still be corrected. The order of the teams follows from
    the ranking before, or from a lot: everybody who knows the lot can draw again.
    """
    from lacoc_server.contest.acts import deciding, organiser
    from lacoc_server.contest.kept.folder import ContestFolder
    from lacoc_server.contest.kept.store import FactStore
    from lacoc_server.contest.league.contest import compute
    from lacoc_server.contest.league.draws import by_lot
    from lacoc_server.contest.league.formats.installed import FORMATS
    from lacoc_server.contest.league.timetable.seeding import meets_again
    from lacoc_server.contest.league.titles import title

    if lot and order:
        raise UserError(say("contest.lot-or-order"))
    with FactStore(ContestFolder(contest).facts, by) as store:
        now = compute(store.facts(), FORMATS)
        shown = organiser.drawing(now)
        if lot:
            shown = replace(shown, how="lot", lot=lot, entries=by_lot(shown.entries, lot))
        elif order:
            teams = tuple(deciding.teams_named(now, order))
            if sorted(teams) != sorted(shown.entries):
                raise UserError(say("contest.other-teams", teams=shown.entries))
            shown = replace(shown, how="hand", reason=reason, entries=teams)
        stage = title(now, shown.stage)
        effect = [say("contest.to-draw", stage=stage, teams=shown.entries)]
        plan = now.planned[0]
        if plan.after:
            effect.append(say("contest.draw-stays"))
        if not shown.how:
            effect += deciding.seeds_moved(now, shown)
        if again := meets_again(now, plan, FORMATS[plan.format], shown.entries):
            effect.append(say("contest.meet-again", pairs=[" – ".join(pair) for pair in again]))
        if wanted_so(effect, yes):
            screen.show(organiser.draw(store, shown))
            organiser.renew_sheet(contest)


def carry_out(
    file: "Path",
    by: str,
    act: "Callable[[Contest], Sequence[AnyFact]]",
    done: Phrase | None = None,
    *,
    asks: bool = False,
    yes: bool = False,
) -> None:
    """Append the facts that `act` returns to the contest's facts, and print what was done.

    Args:
        file: the contest file.
        by: who of the staff decides; "": the organiser.
        act: returns the new facts for a given state of the contest.
        done: what was done; None: it follows from the last of the facts.
        asks: whether to show what the new facts change, and to ask before they are appended.
        yes: do not ask.

    Raises:
        UserError: if `act` refuses, the facts can't be written, or they would change something else
            by now than was shown.
    """
    from lacoc_server.contest.acts import deciding, organiser
    from lacoc_server.contest.kept.folder import ContestFolder
    from lacoc_server.contest.kept.store import FactStore
    from lacoc_server.contest.league.contest import compute
    from lacoc_server.contest.league.formats.installed import FORMATS
    from lacoc_server.contest.league.timetable.steered import steered

    with FactStore(ContestFolder(file).facts, by) as store:
        facts = store.facts()
        now = compute(facts, FORMATS)
        more = act(now)
        shown = deciding.effect(facts, more) if asks else ()
        if asks and not wanted_so(shown, yes):
            return

        def decision(newest: "tuple[AnyFact, ...]") -> "Sequence[AnyFact]":
            nonlocal now, more
            if newest != facts:
                now = compute(newest, FORMATS)
                more = act(now)
                if asks and deciding.effect(newest, more) != shown:
                    raise UserError(say("decide.meanwhile"))
            return more

        store.decide(decision)
    screen.show(done or steered(now, more[-1]))
    organiser.renew_sheet(file)


def wanted_so(effect: Iterable[Phrase], yes: bool) -> bool:
    """Show what a decision changes, and return whether the person at the terminal confirms it.

    Without a terminal the answer is no, unless `yes` is given.

    Args:
        effect: what the decision changes, a line each.
        yes: do not ask; the answer is yes.
    """
    for line in effect:
        screen.show(line)
    if yes or (sys.stdin.isatty() and typer.confirm(render(say("decide.sure")))):
        return True
    screen.note(say("decide.not-done"))
    return False


def _scores(score: str) -> tuple[int, int] | None:
    if not score:
        return None
    left, colon, right = score.partition(":")
    if not (colon and left.strip().isdecimal() and right.strip().isdecimal()):
        raise UserError(say("decide.bad-score", score=score))
    return int(left), int(right)
