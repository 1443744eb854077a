"""The teams and stages of a contest, computed from its facts."""

import hashlib
from collections.abc import Callable, Iterable, Mapping, Sequence

import msgspec

from lacoc_server.contest.league.facts import (
    AnyFact,
    Called,
    Closed,
    Disqualified,
    Drawn,
    Entered,
    FilesChanged,
    OfMatch,
    Planned,
    Played,
    Recalled,
    RoundDrawn,
    Substituted,
    Undrawn,
    Unplanned,
    Withdrawn,
    stage_of,
)
from lacoc_server.contest.league.formats.format import Format, Stage
from lacoc_server.contest.league.matches import counting, match_teams
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, say


class Team(msgspec.Struct, frozen=True, kw_only=True):
    """A team of the contest."""

    name: str
    files: str
    """Hash of the files with which it plays."""
    bot: str = ""
    """Name of the bot that plays for it; "": none, so people play, or without a network the bot
    that steers teams without one."""
    club: str = ""
    """The team's school or club; "": none."""
    picture: bool = False
    """Whether a picture of the team is among its files."""
    withdrawn: bool = False
    """Whether it has left the contest, by its own wish or for a substitute."""
    substitute: str = ""
    """The team that takes its place; "": none does."""
    disqualified: bool = False

    @property
    def gone(self) -> bool:
        """Whether the team plays no more."""
        return self.withdrawn or self.disqualified

    @property
    def may_return(self) -> bool:
        """Whether the team has left in a way that lets it enter again.

        Whoever asks checks that entries are open.
        """
        return self.withdrawn and not self.disqualified


def entered_teams(facts: Sequence[AnyFact], unused: dict[str, Phrase]) -> dict[str, Team]:
    """Return the teams by name, in the order in which they first entered.

    Args:
        facts: in their order.
        unused: facts that change nothing are added here, by id, each with the reason.
    """
    teams: dict[str, Team] = {}
    closed = False
    for fact in facts:
        if isinstance(fact, Closed):
            closed = True
        elif isinstance(fact, Entered):
            if closed and (fact.team in teams or not fact.reason.strip()):
                unused[fact.id] = say("league.closed", team=fact.team)
            elif fact.team in teams and not teams[fact.team].may_return:
                unused[fact.id] = say("league.entered-twice", team=fact.team)
            else:
                teams[fact.team] = Team(
                    name=fact.team,
                    files=fact.files,
                    bot=fact.bot,
                    club=fact.club,
                    picture=fact.picture,
                )
        elif isinstance(fact, Withdrawn | Disqualified | Substituted | FilesChanged):
            if fact.team not in teams:
                unused[fact.id] = say("league.unknown-team", team=fact.team)
                continue
            if isinstance(fact, Substituted):
                other = teams.get(fact.substitute)
                if other is None or other.gone or other.name == fact.team:
                    unused[fact.id] = say("league.no-substitute", team=fact.substitute)
                    continue
            team = teams[fact.team]
            if isinstance(fact, FilesChanged):
                club = team.club if fact.club is None else fact.club
                used = {"files": fact.files, "bot": fact.bot, "picture": fact.picture, "club": club}
                team = msgspec.structs.replace(team, **used)
            elif isinstance(fact, Substituted):
                team = msgspec.structs.replace(team, withdrawn=True, substitute=fact.substitute)
            elif isinstance(fact, Withdrawn):
                team = msgspec.structs.replace(team, withdrawn=True)
            else:
                team = msgspec.structs.replace(team, disqualified=True)
            teams[fact.team] = team
    return teams


def drawn_stages(
    facts: Sequence[AnyFact],
    teams: Mapping[str, Team],
    formats: Mapping[str, Format],
    unused: dict[str, Phrase],
) -> tuple[list[tuple[Planned, Stage]], list[Planned], dict[str, frozenset[str]]]:
    """Return what is drawn and what is not.

    Returns:
        The drawn stages, each with its plan, in the order of their draws; the plans of the stages
        that are not drawn; and, for each stage with results, the teams that have one: of a game,
        also of a void one, or by a decision. A team that did not come is not among them: a
        substitute may still come for it.
    """
    plans: dict[str, Planned] = {}
    stages: dict[str, tuple[Planned, Stage]] = {}
    called: set[tuple[str, int]] = set()
    """The games that are at a court, by pairing and number."""
    for number, fact in enumerate(facts):
        if isinstance(fact, Called):
            called.add((fact.pairing, fact.game))
        elif isinstance(fact, Recalled | Played):
            called.discard((fact.pairing, fact.game))
        if isinstance(fact, Substituted) and fact.id not in unused:
            for name, (plan, stage) in stages.items():
                if fact.team not in _with_result(stage, facts[:number]):
                    stages[name] = plan, _substituted(stage, fact)
        elif isinstance(fact, Undrawn):
            if fact.stage not in stages:
                unused[fact.id] = say("league.not-drawn", stage=fact.stage)
            elif (
                fact.stage != [*stages][-1]
                or _with_result(stages[fact.stage][1], facts[:number])
                or any(stage_of(pairing) == fact.stage for pairing, _ in called)
            ):
                unused[fact.id] = say("league.played-already", stage=fact.stage)
            else:
                del stages[fact.stage]
        elif isinstance(fact, Planned):
            if fact.stage in stages:
                unused[fact.id] = say("league.drawn-already", stage=fact.stage)
            else:
                plans[fact.stage] = fact
        elif isinstance(fact, Unplanned):
            if fact.stage in stages:
                unused[fact.id] = say("league.drawn-already", stage=fact.stage)
            else:
                plans.pop(fact.stage, None)
        elif isinstance(fact, Drawn):
            why = _cannot_draw(fact, plans, stages, teams)
            if why is not None:
                unused[fact.id] = why
                continue
            plan = plans[fact.stage]
            if plan.format not in formats:
                raise UserError(say("league.unknown-format", format=plan.format, known=[*formats]))
            stage = Stage(name=fact.stage, settings=plan.settings, entries=fact.entries)
            stages[fact.stage] = (plan, stage)
        elif isinstance(fact, RoundDrawn):
            why = _cannot_draw_round(fact, stages, formats)
            if why is not None:
                unused[fact.id] = why
                continue
            plan, stage = stages[fact.stage]
            drawn = (*stage.drawn, fact.pairs)
            stages[fact.stage] = (plan, msgspec.structs.replace(stage, drawn=drawn))
    planned = [plan for name, plan in plans.items() if name not in stages]
    with_result = {name: _with_result(stage, facts) for name, (_, stage) in stages.items()}
    return [*stages.values()], planned, {name: one for name, one in with_result.items() if one}


def _with_result(stage: Stage, facts: Iterable[AnyFact]) -> frozenset[str]:
    """Return the teams of a stage that have a result in it: see `drawn_stages`."""
    matches: dict[tuple[str, str, str], list[OfMatch]] = {}
    for fact in facts:
        if isinstance(fact, OfMatch) and stage_of(fact.pairing) == stage.name:
            one, other = sorted(match_teams(fact)) or ("", "")
            if {one, other} <= {*stage.entries}:  # else a substitute has a place now
                matches.setdefault((fact.pairing, one, other), []).append(fact)
    found: set[str] = set()
    for (_, *teams), about in matches.items():
        games, is_void, absent = counting((teams[0], teams[1]), about)
        if games or is_void or any(isinstance(fact, Played) for fact in about):
            found |= {*teams}
        elif absent:
            found |= {*teams} - absent
    return frozenset(found)


def _substituted(stage: Stage, fact: Substituted) -> Stage:
    """Replace a team of a stage by its substitute, unless the stage has the substitute already."""
    if fact.substitute in stage.entries:
        return stage

    def named(teams: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(fact.substitute if team == fact.team else team for team in teams)

    drawn = tuple(tuple(map(named, pairs)) for pairs in stage.drawn)
    return msgspec.structs.replace(stage, entries=named(stage.entries), drawn=drawn)


def by_lot(teams: Iterable[str], lot: str) -> tuple[str, ...]:
    """Return teams in the order that follows from a lot; everybody who knows the lot can check it.

    Args:
        teams: in any order.
        lot: numbers or a word that were drawn in front of everybody; nobody may know them before.
    """

    def ticket(team: str) -> bytes:
        return hashlib.sha256(f"{lot.strip()}\n{team}".encode()).digest()

    return tuple(sorted(teams, key=ticket))


def set_apart(
    entries: tuple[str, ...],
    clash: Callable[[tuple[str, ...]], Sequence[tuple[str, str]]],
) -> tuple[str, ...]:
    """Change the order of teams as little as possible, so that fewer pairs clash.

    Two teams at a time swap places, as long as that leaves fewer clashes. Swaps of teams that are
    close in the order are tried first; of equally close teams, those lower in the order. So the
    best teams keep their seeds: after two groups the second-placed teams swap, not the winners.

    Args:
        entries: the teams by their seeding.
        clash: takes an order; returns the pairs that would meet in it, and should not.
    """
    while clashing := clash(entries):
        places = sorted({entries.index(team) for pair in clashing for team in pair}, reverse=True)
        swaps = sorted(
            ((at, other) for at in places for other in range(len(entries)) if other != at),
            key=lambda swap: (abs(swap[0] - swap[1]), -min(swap)),
        )
        orders = (_swapped(entries, *swap) for swap in swaps)
        better = next((order for order in orders if len(clash(order)) < len(clashing)), None)
        if better is None:
            break
        entries = better
    return entries


def _swapped(entries: tuple[str, ...], one: int, other: int) -> tuple[str, ...]:
    order = list(entries)
    order[one], order[other] = order[other], order[one]
    return tuple(order)


def _cannot_draw(
    fact: Drawn,
    plans: Mapping[str, Planned],
    stages: Mapping[str, object],
    teams: Mapping[str, Team],
) -> Phrase | None:
    if fact.stage in stages:
        return say("league.drawn-already", stage=fact.stage)
    if fact.stage not in plans:
        return say("league.not-planned", stage=fact.stage)
    for team in fact.entries:
        if team not in teams:
            return say("league.unknown-team", team=team)
    if len({*fact.entries}) != len(fact.entries):
        return say("league.team-twice", stage=fact.stage)
    return None


def _cannot_draw_round(
    fact: RoundDrawn, stages: Mapping[str, tuple[Planned, Stage]], formats: Mapping[str, Format]
) -> Phrase | None:
    if fact.stage not in stages:
        return say("league.not-drawn", stage=fact.stage)
    plan, stage = stages[fact.stage]
    if fact.round != len(stage.drawn) + 1 or fact.round > formats[plan.format].rounds(stage):
        return say("league.other-round", stage=fact.stage, round=fact.round)
    teams = [team for pair in fact.pairs for team in pair]
    if len({*teams}) != len(teams) or not {*teams} <= {*stage.entries}:
        return say("league.wrong-pairs", stage=fact.stage, round=fact.round)
    return None
