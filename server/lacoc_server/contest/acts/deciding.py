"""An organiser's decisions about a match: makes the fact of one, and says what it would change."""

from collections import Counter
from collections.abc import Container, Iterable, Iterator, Sequence
from typing import Literal, NamedTuple

import msgspec

from lacoc_server.contest.league.contest import Changes, Contest, changes, compute
from lacoc_server.contest.league.draws import Team
from lacoc_server.contest.league.facts import (
    AnyFact,
    Drawn,
    NoShow,
    Outcome,
    Played,
    Replaced,
    Replay,
    Voided,
    new,
    stage_of,
)
from lacoc_server.contest.league.fixture import named, standing
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.matches import ContestMatch
from lacoc_server.contest.league.standings import DRAW
from lacoc_server.contest.league.timetable.calling import in_vain, needed
from lacoc_server.contest.league.timetable.foreseen import foreseen
from lacoc_server.contest.league.timetable.schedule import due, waits_for_organiser
from lacoc_server.contest.league.timetable.seeding import moved_apart
from lacoc_server.contest.league.timetable.whereabouts import may_come
from lacoc_server.contest.league.titles import title
from lacoc_shared.contest.names import read_name
from lacoc_shared.messages.desk import TEAM_NAME_MAX
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, say

POINTS_MOST = 1_000_000
"""Most points that a decision can give a team."""
Kind = Literal["replay", "result", "void", "no-show"]
"""replay: the game is played again. result: the game counts with a result that the organiser gives.
void: the match counts for nobody. no-show: a team did not come, and its opponent wins if the match
is not decided yet."""


class WantedDecision(NamedTuple):
    """A decision that an organiser wants to make."""

    kind: Kind
    pairing: str
    game: int
    """Number of the game in its match; the kinds "void" and "no-show" do not use it."""
    team: str
    """The team that did not come; only the kind "no-show" uses it."""
    scores: tuple[int, int] | None
    """Points of the left and of the right seat; only the kind "result" uses them."""
    reason: str


def effect(facts: Sequence[AnyFact], more: Iterable[AnyFact]) -> tuple[Phrase, ...]:
    """Say what would change if more facts were appended: teams, matches, ranks, the next draw.

    Args:
        facts: the facts of a contest, in their order.
        more: the facts to try; they are not appended here.
    """
    last = facts[-1].number if facts else 0
    placed = [
        msgspec.structs.replace(fact, id=f"preview-{number}", number=number)
        for number, fact in enumerate(more, last + 1)
    ]
    then = compute((*facts, *placed), FORMATS)
    was = compute(facts, FORMATS)
    found = changes(was, then)
    here = then.here
    lines = [
        *(say("decide.leaves", team=team, left=here) for team in found.leaving),
        *_matches(found, was, then),
        *_at_courts(was, then, {fact.pairing for fact in placed if isinstance(fact, Played)}),
        *(
            line
            for fact in placed
            if isinstance(fact, Played | Replaced)
            for line in _meaning(was, then, fact)
        ),
        *_ranks(found, then),
        *_follows(was, then),
    ]
    return (*lines,) or (say("decide.nothing"),)


def _matches(found: Changes, was: Contest, then: Contest) -> Iterator[Phrase]:
    """Say how each changed match would stand, and how many matches of each stage would be gone."""
    gone: Counter[str] = Counter()
    for before, match in found.matches:
        if match is not None:
            played = len(before.games) if before is not None else 0
            if played > len(match.games):
                yield say("decide.played-in-vain", match=named(then, match.pairing.id))
            yield say(
                "decide.match",
                match=named(then, match.pairing.id),
                teams=[team or "?" for team in match.seated],
                state=match.state,
                winner=match.winner or None,
            )
        elif before is not None:
            gone[stage_of(before.pairing.id)] += 1
    for stage, count in gone.items():
        yield say("decide.gone", stage=title(was, stage), matches=count)


def _at_courts(was: Contest, then: Contest, ended: Container[str]) -> Iterator[Phrase]:
    """Name the games that would be taken back from courts, because they are not needed any more."""
    stay = {call.id for call in needed(then)}
    for call in was.running:
        if call.id not in stay and call.pairing not in ended:
            court, match, teams = call.court, named(was, call.pairing), call.teams
            if in_vain(then, call):
                yield say("decide.taken-back", court=court, match=match, teams=teams)
            else:
                yield say("decide.taken-back-before", court=court, match=match, teams=teams)


def _ranks(found: Changes, then: Contest) -> Iterator[Phrase]:
    """Say which ranks would change.

    Also name the stages that were drawn by the old ranks: they keep their teams.
    """
    for stage, team, old, now in found.ranks:
        name = title(then, stage)
        if then.stage(stage).over:
            yield say("decide.rank", stage=name, team=team, before=old, after=now)
        else:
            yield say("decide.rank-so-far", stage=name, team=team, before=old, after=now)
    changed = {stage for stage, *_ in found.ranks}
    for view in then.stages:
        if view.plan.after in changed:
            yield say("decide.drawn", stage=title(then, view.name))


def _follows(was: Contest, then: Contest) -> Iterator[Phrase]:
    """Say which stages a decision would end, and which draw would follow or wait for a person."""
    ended = {view.name for view in was.stages if view.over}
    for view in then.stages:
        if view.over and view.name not in ended:
            yield say("decide.ends", stage=title(then, view.name))
    drawable = {view.name for view in was.stages if view.may_draw}
    for view in then.stages:
        if view.may_draw:  # then no stage is drawn yet
            if view.name not in drawable:
                number = len(view.stage.drawn) + 1
                yield say("decide.draws-round", stage=title(then, view.name), round=number)
            return
    draw = due(then, FORMATS)
    if not isinstance(draw, Drawn) or (not drawable and draw == due(was, FORMATS)):
        return
    stage = title(then, draw.stage)
    if waits_for_organiser(then, FORMATS) is not None:
        yield say("decide.waits-for-draw", stage=stage, teams=draw.entries)
    else:
        yield say("decide.draws", stage=stage, teams=draw.entries)
    yield from seeds_moved(then, draw)


def seeds_moved(contest: Contest, draw: Drawn) -> Iterator[Phrase]:
    """Say why the seed of a team in the next draw differs from its rank, for each such team."""
    plan = contest.planned[0]
    how = FORMATS[plan.format]
    for team, why in moved_apart(contest, plan, how, draw.entries).items():
        yield say("contest.seed-moved", team=team, why=why)


def _meaning(was: Contest, then: Contest, result: Played | Replaced) -> Iterator[Phrase]:
    """Say what a result would mean: how its match would stand, and what both teams would play next.

    If the result counts already, nothing is said.
    """
    if _counts(was, result):
        return
    matches = [match for view in then.stages for match in view.matches]
    match = next((match for match in matches if match.pairing.id == result.pairing), None)
    if match is None or {*match.teams} != {*result.teams}:
        return
    about = named(then, result.pairing)
    stands = standing(match)
    if not match.decided:
        yield say("decide.goes-on", match=about, standing=stands, game=match.next_game)
        return
    if not match.winner:
        yield say("decide.level", match=about, teams=result.teams, points=DRAW)
    if match.how in ("difference", "seed"):
        yield say("decide.goes-to", match=about, team=match.winner, tie=match.how)
    called = {call.pairing for call in then.running}
    at_courts = [match for match in matches if match.pairing.id in called]
    coming = foreseen(then, FORMATS)
    for team in result.teams:
        now = next((match for match in at_courts if team in match.teams), None)
        one = next((one for one in coming if team in one.match.teams), None)
        if now is not None and now.pairing.id != result.pairing:
            yield say("decide.then", team=team, match=named(then, now.pairing.id))
        elif one is not None:
            yield say("decide.then", team=team, match=one.fixture)
        elif may_come(then, team):
            yield say("decide.awaits-draw", team=team)
        else:
            yield say("decide.plays-no-more", team=team)


def _counts(contest: Contest, result: Played | Replaced) -> bool:
    """Return whether this result of a game counts already."""
    return any(
        (game.number, game.teams, game.scores, game.outcome)
        == (result.game, result.teams, result.scores, result.outcome)
        for view in contest.stages
        for match in view.matches
        if match.pairing.id == result.pairing
        for game in match.games
    )


def decision(contest: Contest, wanted: WantedDecision) -> AnyFact:
    """Return the fact that records an organiser's decision.

    Raises:
        UserError: if there is no such match or team, the game is neither played nor the next one of
            its match, or the reason or the points are missing.
    """
    if not wanted.reason.strip():
        raise UserError(say("decide.needs-reason"))
    match = match_of(contest, wanted.pairing)
    first, second = match.seated
    if not first or not second:
        raise UserError(say("decide.no-teams", pairing=wanted.pairing))
    about = {"pairing": wanted.pairing, "reason": wanted.reason}
    if wanted.kind == "no-show":
        team = team_named(contest, wanted.team)
        if team not in match.teams:
            teams = [first, second]
            raise UserError(say("decide.which-team", pairing=wanted.pairing, teams=teams))
        opponent = second if team == first else first
        return new(NoShow, team=team, opponent=opponent, **about)
    if wanted.kind == "void":
        return new(Voided, teams=(first, second), **about)
    if (
        wanted.kind == "replay"
        and match.how in ("void", "walkover")
        and wanted.game == len(match.games) + 1
    ):  # it was void, or somebody did not come: the match is open again
        return new(Replay, game=wanted.game, teams=(first, second), **about)
    seats = _seats(match, wanted.game)
    if wanted.kind == "replay":
        return new(Replay, game=wanted.game, teams=seats, **about)
    if wanted.scores is None:
        raise UserError(say("decide.needs-score"))
    if not all(0 <= points <= POINTS_MOST for points in wanted.scores):
        raise UserError(say("decide.large-score", most=POINTS_MOST))
    left, right = wanted.scores
    outcome: Outcome = "left" if left > right else "right" if right > left else "draw"
    given = {"game": wanted.game, "teams": seats, "scores": wanted.scores, "outcome": outcome}
    return new(Replaced, **given, **about)


def match_of(contest: Contest, pairing: str) -> ContestMatch:
    """Return the match of a pairing.

    Raises:
        UserError: if the contest has no match of this pairing.
    """
    matches = contest.matches
    if pairing not in matches:
        known = [*matches][:20]
        raise UserError(say("decide.no-match", pairing=pairing, known=known or None))
    return matches[pairing]


def team_of(contest: Contest, text: str) -> Team:
    """Return the team that a text names.

    Raises:
        UserError: if no such team has entered.
    """
    teams = {team.name: team for team in contest.teams}
    found = teams.get(team_named(contest, text))
    if found is None:
        raise UserError(say("contest.not-in", team=text, teams=[*teams] or None))
    return found


def team_named(contest: Contest, text: str) -> str:
    """Return the name of the team that a text means: spaces and accents as `enter` reads them.

    If there is no such team, return the text.
    """
    names = [team.name for team in contest.teams]
    read = read_name(text, TEAM_NAME_MAX)
    return read if read in names and text not in names else text


def teams_named(contest: Contest, texts: Iterable[str]) -> Iterator[str]:
    """Yield the teams that texts name; each text is the name of a team, or names with commas."""
    names = [team.name for team in contest.teams]
    for text in texts:
        alone = team_named(contest, text) in names
        for part in [text] if alone else text.split(","):
            yield team_named(contest, part.strip())


def _seats(match: ContestMatch, game: int) -> tuple[str, str]:
    """Return the left and the right team of a game that was played, or of the next one."""
    played = {one.number: one.teams for one in match.games}
    if game in played:
        return played[game]
    if game == match.next_game and match.next_seats is not None:
        return match.next_seats
    numbers = [*played, *([match.next_game] if match.next_game else [])]
    if not numbers:
        raise UserError(say("decide.not-played", pairing=match.pairing.id))
    raise UserError(say("decide.no-game", pairing=match.pairing.id, game=game, known=numbers))
