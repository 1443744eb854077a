"""Who meets first in a stage that is to be drawn, and an order in which fewer meet again; pure."""

from collections.abc import Iterator, Mapping

from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.draws import set_apart
from lacoc_server.contest.league.facts import Planned
from lacoc_server.contest.league.formats.format import Format, Stage
from lacoc_server.contest.league.pairing import Entrant

Pairs = tuple[tuple[str, str], ...]


def first_meetings(plan: Planned, how: Format, order: tuple[str, ...]) -> Pairs:
    """Return the pairs that surely meet: in the first round of a bracket, or in a group.

    Args:
        plan: the plan of the stage.
        how: its format.
        order: its teams by their seeding.
    """
    stage = Stage(name="", settings=plan.settings, entries=order)
    sources = (pairing.sources for pairing in how.pairings(stage))
    return tuple(
        (first.team, second.team)
        for first, second in sources
        if isinstance(first, Entrant) and isinstance(second, Entrant)
    )


def met_before(contest: Contest, plan: Planned) -> frozenset[frozenset[str]]:
    """Return the pairs of teams that had a match in the stage that this one follows."""
    return frozenset(
        frozenset(team for team in match.teams if team)
        for view in contest.stages
        if view.name == plan.after
        for match in view.matches
        if all(match.teams)
    )


def meets_again(contest: Contest, plan: Planned, how: Format, order: tuple[str, ...]) -> Pairs:
    """Return the pairs that surely meet, and have met in the stage before."""
    met = met_before(contest, plan)
    return tuple(pair for pair in first_meetings(plan, how, order) if frozenset(pair) in met)


def kept_apart(
    contest: Contest, plan: Planned, how: Format, order: tuple[str, ...]
) -> tuple[str, ...]:
    """Return an order in which fewer of those meet first that the plan keeps apart.

    These are teams of one club (`apart`), and teams that have met before (`met_apart`). The order
    changes as little as possible: after groups it is the crossing A1-B2, B1-A2.
    """
    club_of = {team.name: team.club for team in contest.teams if team.club and plan.apart}
    met = met_before(contest, plan) if plan.met_apart else frozenset()

    def clash(order: tuple[str, ...]) -> Pairs:
        return tuple(_clashing(first_meetings(plan, how, order), club_of, met))

    return set_apart(order, clash)


def _clashing(
    pairs: Pairs, club_of: Mapping[str, str], met: frozenset[frozenset[str]]
) -> Iterator[tuple[str, str]]:
    """Yield each pair once for each reason why it should not meet."""
    for one, other in pairs:
        if one in club_of and club_of[one] == club_of.get(other):
            yield one, other
        if frozenset((one, other)) in met:
            yield one, other
