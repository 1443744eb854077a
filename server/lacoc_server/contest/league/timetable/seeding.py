"""Who meets first in a stage that is to be drawn, and how to keep teams apart there; pure."""

from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from typing import NamedTuple

from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.draws import set_apart
from lacoc_server.contest.league.facts import Planned
from lacoc_server.contest.league.formats.format import Format, Stage
from lacoc_server.contest.league.pairing import Entrant
from lacoc_shared.words import Phrase, say

Pairs = tuple[tuple[str, str], ...]


class _Apart(NamedTuple):
    """Which teams of a stage should not meet first, and which places of the seeding meet first."""

    meet: tuple[tuple[int, int], ...]
    """Pairs of places in the seeding, from 0, whose teams are certain to meet."""
    clubs: frozenset[tuple[str, str]]
    """Each team that has a club, with the club; empty: clubs are not kept apart."""
    met: frozenset[frozenset[str]]
    """Pairs of teams that met in the stage before; empty: they are not kept apart."""

    def clash(self, order: tuple[str, ...]) -> Pairs:
        """Return the pairs that this order makes certain to meet, but that should be kept apart.

        They would meet in a bracket's first round, or in one group.
        """
        pairs = ((order[one], order[other]) for one, other in self.meet)
        return tuple(_clashing(pairs, dict(self.clubs), self.met))


def by_rank(contest: Contest, plan: Planned) -> tuple[str, ...]:
    """Return the teams that a stage can have, the best first.

    Their order is the ranking of the stage before. If there is none, it is the order in which they
    entered. Teams that have left can be among them. In a draw that was taken back, substitutes had
    places: they keep them.
    """
    before = {view.name: view for view in contest.stages}
    entered = tuple(team.name for team in contest.teams)
    ranked = before[plan.after].ranking if plan.after in before else entered
    if plan.stage not in contest.undrawn:
        return ranked
    instead = {team.name: team.substitute for team in contest.teams if team.substitute}

    def now(team: str) -> str:
        while team in instead:
            team = instead[team]
        return team

    return tuple(dict.fromkeys(now(team) for team in ranked))


def first_meetings(plan: Planned, how: Format, order: tuple[str, ...]) -> Pairs:
    """Return the pairs that are certain to meet: in the first round of a bracket, or in a group.

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
    """Return the pairs of teams that had a match in the stage which this stage follows."""
    return frozenset(
        frozenset(team for team in match.teams if team)
        for view in contest.stages
        if view.name == plan.after
        for match in view.matches
        if all(match.teams)
    )


def meets_again(contest: Contest, plan: Planned, how: Format, order: tuple[str, ...]) -> Pairs:
    """Return the pairs of teams that are certain to meet, and that met in the stage before."""
    met = met_before(contest, plan)
    return tuple(pair for pair in first_meetings(plan, how, order) if frozenset(pair) in met)


def kept_apart(
    contest: Contest, plan: Planned, how: Format, order: tuple[str, ...]
) -> tuple[str, ...]:
    """Reorder teams, so that fewer of them meet first whom the plan of the stage keeps apart.

    A plan may keep apart teams of one club (`apart`), and teams that met before (`met_apart`). The
    order changes as little as possible. After groups A and B, for example, the first of each meets
    the second of the other one.
    """
    return _set_apart(_apart(contest, plan, how, len(order)), order)


def moved_apart(
    contest: Contest, plan: Planned, how: Format, entries: tuple[str, ...]
) -> dict[str, Phrase]:
    """Say, for each team whose seed differs from its rank, which pairs this keeps apart.

    The phrase of a team names the pairs that it would be in. If the team only made room for others,
    the phrase names all pairs that were kept apart. The result is empty if the order is not the
    one that follows from the plan: a lot or the organiser made it, or the ranking was corrected.

    Args:
        contest: the contest.
        plan: the plan of the stage.
        how: its format.
        entries: its teams by their seeding.
    """
    ranked = tuple(team for team in by_rank(contest, plan) if team in entries)
    if ranked == entries or kept_apart(contest, plan, how, ranked) != entries:
        return {}
    clash = _apart(contest, plan, how, len(entries)).clash
    still = {frozenset(pair) for pair in clash(entries)}
    avoided = dict.fromkeys(pair for pair in clash(ranked) if frozenset(pair) not in still)
    found: dict[str, Phrase] = {}
    for seed, team in enumerate(entries, 1):
        instead = ranked.index(team) + 1
        if seed != instead:
            own = [pair for pair in avoided if team in pair]
            pairs = [" – ".join(pair) for pair in own or avoided]
            found[team] = say("advance.moved", seed=seed, instead=instead, pairs=pairs)
    return found


def _apart(contest: Contest, plan: Planned, how: Format, teams: int) -> _Apart:
    numbers = tuple(map(str, range(teams)))
    meet = tuple((int(one), int(other)) for one, other in first_meetings(plan, how, numbers))
    clubs = frozenset((one.name, one.club) for one in contest.teams if one.club and plan.apart)
    return _Apart(meet, clubs, met_before(contest, plan) if plan.met_apart else frozenset())


@lru_cache(maxsize=16)  # each sheet asks again, and with many teams it takes seconds
def _set_apart(kept: _Apart, order: tuple[str, ...]) -> tuple[str, ...]:
    return set_apart(order, kept.clash)


def _clashing(
    pairs: Iterable[tuple[str, str]], club_of: Mapping[str, str], met: frozenset[frozenset[str]]
) -> Iterator[tuple[str, str]]:
    """Yield the pairs that should not meet, once for each reason: one club, or an earlier match."""
    for one, other in pairs:
        if one in club_of and club_of[one] == club_of.get(other):
            yield one, other
        if frozenset((one, other)) in met:
            yield one, other
