"""Names of the stages for people: the organiser's titles, or the usual names; pure."""

from collections.abc import Callable, Collection

from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.facts import Planned
from lacoc_shared.words import Phrase, say

_USUAL: dict[str, Callable[[int | None], Phrase]] = {
    "round-robin": lambda number: say("stage.round-robin", number=number),
    "swiss": lambda number: say("stage.swiss", number=number),
    "sequential": lambda number: say("stage.sequential", number=number),
    "single-knockout": lambda number: say("stage.single-knockout", number=number),
    "double-knockout": lambda number: say("stage.double-knockout", number=number),
}


def titles(contest: Contest) -> dict[str, Phrase]:
    """Return what people call each stage, by its name in the contest file.

    A stage without a title of the organiser has the usual name of its format, with a number if
    several stages have that name.
    """
    there = (*(view.plan for view in contest.stages), *contest.planned)
    plans = {plan.stage: plan for plan in there}  # one to come can be among the stages already
    return {stage: _title(plan, plans.values()) for stage, plan in plans.items()}


def title(contest: Contest, stage: str) -> Phrase:
    """Return what people call a stage; if the contest has no such stage now, its own name."""
    return titles(contest).get(stage) or say("stage.titled", en=stage, ja=stage)


def _title(plan: Planned, plans: Collection[Planned]) -> Phrase:
    if plan.title:
        return say("stage.titled", en=plan.title["en"], ja=plan.title["ja"])
    alike = [one.stage for one in plans if not one.title and _kind(one) == _kind(plan)]
    number = alike.index(plan.stage) + 1 if len(alike) > 1 else None
    kind = _kind(plan)
    if kind == "groups":
        return say("stage.groups", number=number)
    usual = _USUAL.get(kind)
    return usual(number) if usual else say("stage.other", format=plan.format, number=number)


def _kind(plan: Planned) -> str:
    return "groups" if plan.format == "round-robin" and plan.settings.groups > 1 else plan.format
