"""What is drawn: the teams and stages of a contest, before anything is played."""

from collections.abc import Mapping, Sequence

import msgspec

from lacoc_server.contest.league.facts import (
    AnyFact,
    Closed,
    Disqualified,
    Drawn,
    Entered,
    FilesChanged,
    Planned,
    RoundDrawn,
    Withdrawn,
)
from lacoc_server.contest.league.formats.format import Format, Stage
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, say


class Team(msgspec.Struct, frozen=True, kw_only=True):
    """A team of the contest."""

    name: str
    files: str
    """Hash of the files that it plays with."""
    bot: str = ""
    """Name of the bot that plays for it; "": people play."""
    withdrawn: bool = False
    disqualified: bool = False

    @property
    def gone(self) -> bool:
        """Whether the team plays no more."""
        return self.withdrawn or self.disqualified

    @property
    def may_return(self) -> bool:
        """Whether the team may enter again while entries are open."""
        return self.withdrawn and not self.disqualified


def entered_teams(facts: Sequence[AnyFact], unused: dict[str, Phrase]) -> dict[str, Team]:
    """Return the teams by name, in the order in which they entered.

    Args:
        facts: in their order.
        unused: is given the facts that change nothing, each with the reason.
    """
    teams: dict[str, Team] = {}
    closed = False
    for fact in facts:
        if isinstance(fact, Closed):
            closed = True
        elif isinstance(fact, Entered):
            if closed:
                unused[fact.id] = say("league.closed", team=fact.team)
            elif fact.team in teams and not teams[fact.team].may_return:
                unused[fact.id] = say("league.entered-twice", team=fact.team)
            else:
                teams[fact.team] = Team(name=fact.team, files=fact.files, bot=fact.bot)
        elif isinstance(fact, Withdrawn | Disqualified | FilesChanged):
            if fact.team not in teams:
                unused[fact.id] = say("league.unknown-team", team=fact.team)
                continue
            team = teams[fact.team]
            if isinstance(fact, FilesChanged):
                team = msgspec.structs.replace(team, files=fact.files, bot=fact.bot)
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
) -> tuple[list[tuple[Planned, Stage]], list[Planned]]:
    """Return the drawn stages, each with its plan, and then the plans of all other stages.

    The drawn stages are in the order of their draws.
    """
    plans: dict[str, Planned] = {}
    stages: dict[str, tuple[Planned, Stage]] = {}
    for fact in facts:
        if isinstance(fact, Planned):
            if fact.stage in stages:
                unused[fact.id] = say("league.drawn-already", stage=fact.stage)
            else:
                plans[fact.stage] = fact
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
    return [*stages.values()], [plan for name, plan in plans.items() if name not in stages]


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
