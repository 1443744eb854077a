"""Every match that is still to come, also those whose teams or draws are not known yet; pure.

A stage that is not drawn is shown with the bracket or rounds that it would have with the present
teams. Ids of pairings follow from the plan and the number of teams. So a match can be moved before
its stage is drawn.
"""

from collections.abc import Collection, Iterator, Mapping

import msgspec

from lacoc_server.contest.league.contest import Contest, StageView
from lacoc_server.contest.league.facts import Planned, stage_of
from lacoc_server.contest.league.fixture import match_fixture
from lacoc_server.contest.league.formats.format import Format, Stage
from lacoc_server.contest.league.matches import NOBODY, ContestMatch, StageRules, resolve
from lacoc_server.contest.league.pairing import AnySource, Entrant, LoserOf, Pairing, WinnerOf
from lacoc_server.contest.league.timetable.schedule import is_final, playable
from lacoc_shared.words import Phrase, say

_TO_BE_DRAWN = Entrant("")


class Foreseen(msgspec.Struct, frozen=True, kw_only=True):
    """A match that is still to come."""

    match: ContestMatch
    fixture: Phrase
    """Name of the match: "Semi-final 1"."""
    who: tuple[Phrase, Phrase]
    """The left and the right side: a team, "winner of Semi-final 1", "seed 3" or "to be drawn"."""

    @property
    def pairing(self) -> Pairing:
        """The pairing of the match."""
        return self.match.pairing


def foreseen(contest: Contest, formats: Mapping[str, Format]) -> tuple[Foreseen, ...]:
    """Return the matches that are still to come, in the order in which they are played.

    First come those that can be played now, in the order of `playable`. Matches on a court are left
    out. The second final of a double knockout is left out, too, because it is rarely needed.
    """
    whole = msgspec.structs.replace(contest, stages=tuple(_all_stages(contest, formats)))
    drawn = {view.name for view in contest.stages}
    ready = playable(contest)
    there = {match.pairing.id for match in ready} | {call.pairing for call in contest.running}
    views = {view.name: view for view in whole.stages}
    later = [
        match
        for view in whole.stages
        for match in sorted(view.matches, key=is_final)
        if match.pairing.id not in there and _is_to_come(match)
    ]
    return tuple(
        _foreseen(whole, views[stage_of(m.pairing.id)], m, drawn) for m in (*ready, *later)
    )


def _foreseen(
    whole: Contest, view: StageView, match: ContestMatch, drawn: Collection[str]
) -> Foreseen:
    is_drawn = view.name in drawn
    who = _who(whole, view, match, drawn=is_drawn)
    fixture = match_fixture(whole, view, match)
    if not is_drawn:  # places in the seeding are no teams
        match = ContestMatch(pairing=match.pairing, teams=(None, None), state="waits")
    return Foreseen(match=match, fixture=fixture, who=who)


def _is_to_come(match: ContestMatch) -> bool:
    """Return whether a match will be played, as far as is known: not decided, without a bye."""
    conditional = match.pairing.only_if_second_won
    return not (match.decided or conditional or NOBODY in match.teams)


def _all_stages(contest: Contest, formats: Mapping[str, Format]) -> Iterator[StageView]:
    """Yield the drawn stages with all their rounds, then the planned stages as they will be."""
    teams = contest.here
    places: dict[str, int] = {}
    for view in contest.stages:
        here = len(view.stage.entries)
        places[view.name] = here
        rounds = range(len(view.stage.drawn) + 1, len(view.stage.drawn) + view.rounds_to_draw + 1)
        more = tuple(_rounds(view.stage, rounds, here))
        yield msgspec.structs.replace(view, matches=(*view.matches, *more))
    for plan in contest.planned:
        here = places.get(plan.after, teams) if plan.after else teams
        here = min(plan.teams or here, here)
        places[plan.stage] = here
        if plan.format in formats and here >= 2:
            yield _planned(plan, here, formats[plan.format])


def _planned(plan: Planned, teams: int, how: Format) -> StageView:
    """Return a planned stage as it will be; its teams are named "1", "2" and so on, by seeding."""
    entries = tuple(str(number) for number in range(1, teams + 1))
    stage = Stage(name=plan.stage, settings=plan.settings, entries=entries)
    rules = StageRules(
        settings=stage.settings, entries=entries, decisive=how.decisive, balanced=how.balanced
    )
    matches = [*resolve(how.pairings(stage), {}, (), rules).values()]
    matches += _rounds(stage, range(1, how.rounds(stage) + 1), teams)
    return StageView(plan=plan, stage=stage, matches=tuple(matches), tables=(), rounds_to_draw=0)


def _rounds(stage: Stage, rounds: range, teams: int) -> Iterator[ContestMatch]:
    """Yield the matches of rounds that are not drawn yet; their teams are not known."""
    for number in rounds:
        for order in range(1, teams // 2 + 1):
            pairing = Pairing(
                id=stage.id("r", number, order),
                section="r",
                round=number,
                sources=(_TO_BE_DRAWN, _TO_BE_DRAWN),
            )
            yield ContestMatch(pairing=pairing, teams=(None, None), state="waits")


def _who(
    whole: Contest, view: StageView, match: ContestMatch, *, drawn: bool
) -> tuple[Phrase, Phrase]:
    first, second = (
        _from(whole, view, source)
        if team is None
        else say("who.team", team=team)
        if drawn
        else say("who.seed", seed=int(team))
        for team, source in zip(match.teams, match.pairing.sources, strict=True)
    )
    return (first, second) if match.seated == match.teams else (second, first)


def _from(whole: Contest, view: StageView, source: AnySource) -> Phrase:
    """Say where the team of a place will come from, for example "winner of Semi-final 1"."""
    if not isinstance(source, WinnerOf | LoserOf):
        return say("who.drawn")
    before = next(match for match in view.matches if match.pairing.id == source.pairing)
    fixture = match_fixture(whole, view, before)
    if isinstance(source, WinnerOf):
        return say("who.winner", match=fixture)
    return say("who.loser", match=fixture)
