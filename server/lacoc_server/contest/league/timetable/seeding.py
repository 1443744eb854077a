"""Who meets first in a stage that is to be drawn, and an order in which fewer meet again; pure."""

from collections.abc import Callable, Iterator, Mapping

from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.draws import set_apart
from lacoc_server.contest.league.facts import Planned
from lacoc_server.contest.league.formats.format import Format, Stage
from lacoc_server.contest.league.pairing import Entrant
from lacoc_shared.words import Phrase, say

Pairs = tuple[tuple[str, str], ...]


def by_rank(contest: Contest, plan: Planned) -> tuple[str, ...]:
    """Return the teams of which a stage takes its own, in the order of its seeding.

    It is the ranking of the stage that it follows, or the order in which teams entered. Teams that
    have left can be among them.
    """
    before = {view.name: view for view in contest.stages}
    if plan.after in before:
        return before[plan.after].ranking
    return tuple(team.name for team in contest.teams)


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
    return set_apart(order, _clash(contest, plan, how))


def moved_apart(
    contest: Contest, plan: Planned, how: Format, entries: tuple[str, ...]
) -> dict[str, Phrase]:
    """Say of each team with another seed than by rank for which pairs it changed its place.

    Nothing is said where the plan does not give this order: a lot or the organiser made it, or
    the ranking was corrected since.

    Args:
        contest: the contest.
        plan: the plan of the stage.
        how: its format.
        entries: its teams by their seeding.
    """
    ranked = tuple(team for team in by_rank(contest, plan) if team in entries)
    if ranked == entries or kept_apart(contest, plan, how, ranked) != entries:
        return {}
    clash = _clash(contest, plan, how)
    still = {frozenset(pair) for pair in clash(entries)}
    avoided = dict.fromkeys(pair for pair in clash(ranked) if frozenset(pair) not in still)
    pairs = [" – ".join(pair) for pair in avoided]
    return {
        team: say("advance.moved", seed=seed, instead=ranked.index(team) + 1, pairs=pairs)
        for seed, team in enumerate(entries, 1)
        if ranked.index(team) + 1 != seed
    }


def _clash(contest: Contest, plan: Planned, how: Format) -> Callable[[tuple[str, ...]], Pairs]:
    """Return what finds the pairs of an order that the plan keeps apart, and that meet first."""
    club_of = {team.name: team.club for team in contest.teams if team.club and plan.apart}
    met = met_before(contest, plan) if plan.met_apart else frozenset()

    def clash(order: tuple[str, ...]) -> Pairs:
        return tuple(_clashing(first_meetings(plan, how, order), club_of, met))

    return clash


def _clashing(
    pairs: Pairs, club_of: Mapping[str, str], met: frozenset[frozenset[str]]
) -> Iterator[tuple[str, str]]:
    """Yield each pair once for each reason why it should not meet."""
    for one, other in pairs:
        if one in club_of and club_of[one] == club_of.get(other):
            yield one, other
        if frozenset((one, other)) in met:
            yield one, other
