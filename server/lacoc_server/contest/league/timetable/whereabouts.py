"""Where each team plays, or what it waits for; pure.

To estimate when a team plays, the matches that are still to come are dealt out to the courts in the
order of the schedule. Every game is assumed to take as long as games took so far, so the estimate
is right only on average.
"""

from bisect import bisect_left, insort
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from statistics import median
from string import ascii_lowercase
from typing import NamedTuple

from msgspec.structs import replace

from lacoc_server.contest.league.contest import Contest, StageView
from lacoc_server.contest.league.decided import in_words
from lacoc_server.contest.league.facts import (
    AnyFact,
    Called,
    Disqualified,
    NoShow,
    OfDecision,
    Planned,
    Played,
    Substituted,
    Undrawn,
    Withdrawn,
    stage_of,
)
from lacoc_server.contest.league.fixture import fixture, named
from lacoc_server.contest.league.matches import ContestMatch
from lacoc_server.contest.league.pairing import LoserOf, WinnerOf
from lacoc_server.contest.league.timetable.calling import SeenCourt, absent, present
from lacoc_server.contest.league.timetable.foreseen import Foreseen
from lacoc_server.contest.league.timetable.schedule import (
    court_of,
    is_final,
    not_before_ms,
    playable,
)
from lacoc_server.contest.league.titles import title
from lacoc_shared.messages.office import Whereabouts
from lacoc_shared.words import Phrase, say

_SEATS = ("left", "right")
_LONGEST = 20
"""A game that seems to have lasted more than this many times the length assumed before the first
game is ignored: the machine's clock was set meanwhile."""
_COUNTED = 15
"""The usual length of a game is computed from so many of the newest games."""
_STEP_S = 5
_MINUTE_MS = 60_000
_MOMENT_S = 30
"""A match that begins in less than this time is said to begin "in a moment" [s]."""


class SeenCourts(NamedTuple):
    """The courts as the office sees them, and their addresses."""

    seen: Mapping[str, SeenCourt]
    """The courts by name, in the order in which they get games."""
    addresses: Mapping[str, str]
    """The courts' addresses for contestants, by name."""


class ContestPace(NamedTuple):
    """The time now, and how long games and rests take."""

    now_ms: int
    """The time, in milliseconds since 1970, UTC."""
    game_ms: int
    """Usual time from the call of a game to its result [ms]."""
    least_rest_ms: int = 0
    """Shortest time between two matches of a team [ms]."""


class OfficeKnowledge(NamedTuple):
    """What the office knows besides the facts, as of its newest look at the courts."""

    seen: Mapping[str, SeenCourt]
    """The courts by name, in the order in which they get games."""
    pace: ContestPace
    held: Mapping[tuple[str, int], Phrase]
    """Games that a court refused, by pairing and number, with the reason."""


class ProbableStart(NamedTuple):
    """When and where a match probably begins."""

    court: str
    at_ms: int
    """Time at which it begins, in milliseconds since 1970, UTC."""
    games_before: int
    """Games that probably begin before it, on all courts."""


def game_ms(facts: Sequence[AnyFact], otherwise_ms: int) -> int:
    """Return how long a game usually takes from its call to its result.

    Games with an impossible length are ignored: the machine's clock was set during them.

    Args:
        facts: the facts of the contest, in their order.
        otherwise_ms: what to return before the first game has ended [ms].
    """
    called: dict[tuple[str, int], int] = {}
    lengths: list[int] = []
    for fact in facts:
        if isinstance(fact, Called):
            called[fact.pairing, fact.game] = fact.at_ms
        elif isinstance(fact, Played) and (fact.pairing, fact.game) in called:
            length_ms = fact.at_ms - called[fact.pairing, fact.game]
            if 0 <= length_ms <= _LONGEST * otherwise_ms:
                lengths.append(length_ms)
    return round(median(lengths[-_COUNTED:])) if lengths else otherwise_ms


def whereabouts(
    contest: Contest, courts: SeenCourts, pace: ContestPace, begins: Mapping[str, ProbableStart]
) -> dict[str, Whereabouts]:
    """Say for each team where it plays, or what it waits for.

    Args:
        contest: the contest.
        courts: its courts.
        pace: the time now, and how long games and rests take.
        begins: when and where matches probably begin, by pairing, from `starts`.
    """
    calls = {team: call for call in contest.running for team in call.teams}
    away = {
        call.court: absent(call, courts.seen.get(call.court), pace.now_ms)
        for call in contest.running
    }
    coming = _coming(contest)
    found: dict[str, Whereabouts] = {}
    for team in contest.teams:
        name = team.name
        if name in calls:
            found[name] = _called(contest, name, calls[name], courts)
        elif contest.over:
            found[name] = _ended(contest, name, over=True)
        elif not team.gone and name in coming:
            view, match = coming[name]
            start = begins.get(match.pairing.id)
            found[name] = _waits(contest, name, view, match, start, pace, away)
        elif not team.gone and may_come(contest, name):
            found[name] = Whereabouts(team=name, state="waits", said=_awaits_draw(contest))
        else:
            found[name] = _ended(contest, name, over=False)
    news = _news(contest)
    return {name: replace(there, news=news.get(name)) for name, there in found.items()}


def _news(contest: Contest) -> dict[str, Phrase]:
    """Return, by team, the newest decision about one of its matches since its last game, in words.

    A decision that has no effect is left out, for example about a team that was replaced since.
    """
    unused = {one.fact for one in contest.unused}
    absent = {fact.pairing for fact in contest.decisions if isinstance(fact, NoShow)}
    news: dict[str, Phrase] = {}
    for fact, (pairing, match) in product(contest.decisions, contest.matches.items()):
        has_left = isinstance(fact, Withdrawn | Disqualified)
        if fact.id in unused or (has_left and pairing in absent):  # the match was won before
            continue
        for team in _concerned(fact, match):
            if fact.at_ms >= contest.ended_ms.get(team, ("", 0))[1]:
                wins = say("team.wins") if team == match.winner else None
                what = _about(contest, fact, match)
                news[team] = say("team.news", what=what, reason=fact.reason or None, wins=wins)
    return news


def _concerned(fact: OfDecision, match: ContestMatch) -> list[str]:
    """Return the teams that a decision gives another match, or another result of this match.

    A team that itself has left, or has come as a substitute, is told so in other words.
    """
    teams = [team for team in match.teams if team]
    match fact:
        case Withdrawn() | Disqualified() if fact.team in teams and match.how == "walkover":
            return [team for team in teams if team == match.winner]
        case Substituted() if fact.substitute in teams and not match.decided:
            return [team for team in teams if team != fact.substitute]
    return teams if getattr(fact, "pairing", "") == match.pairing.id else []


def _about(contest: Contest, fact: OfDecision, match: ContestMatch) -> Phrase:
    """Put a decision that concerns a match into words that name the match."""
    what = in_words(contest, fact)
    if getattr(fact, "pairing", ""):
        return what
    return say("decided.changes", match=named(contest, match.pairing.id), what=what)


def _called(contest: Contest, team: str, call: Called, courts: SeenCourts) -> Whereabouts:
    """Say where a team with a called game plays.

    While the court does not have the game yet, say that the team waits for it.
    """
    view, match = _match(contest, call.pairing)
    opponent = call.teams[call.teams[0] == team]
    about = fixture(contest, view, match, call.game, stands=True)
    seen = courts.seen.get(call.court)
    if seen is None or seen.call != call.id:
        said = say("team.next", court=call.court, when=say("when.moment"), opponent=opponent)
        return Whereabouts(
            team=team,
            state="waits",
            said=said,
            court=call.court,
            opponent=opponent,
            fixture=about,
            games_before=0,
            about_s=0,
        )
    seat = _SEATS[call.teams.index(team)]
    return Whereabouts(
        team=team,
        state="court",
        said=say("team.plays", court=call.court, seat=seat, opponent=opponent, fixture=about),
        court=call.court,
        address=courts.addresses[call.court],
        seat=seat,
        call=call.id,
        opponent=opponent,
        fixture=about,
    )


def _waits(
    contest: Contest,
    team: str,
    view: StageView,
    match: ContestMatch,
    start: ProbableStart | None,
    pace: ContestPace,
    away: Mapping[str, tuple[str, ...]],
) -> Whereabouts:
    """Say what a team waits for, if its next match is known.

    Args:
        contest: the contest.
        team: the team's name.
        view: the stage of the match.
        match: the match.
        start: when it probably begins; None: nobody knows.
        pace: the time now, and how long games and rests take.
        away: by court, the teams that have not joined the game that was called there.
    """
    about = fixture(contest, view, match, max(1, match.next_game), stands=True)
    opponent = match.teams[match.teams[0] == team] or ""
    if start is None:
        said = say("team.awaits-opponent", fixture=about)
        return Whereabouts(team=team, state="waits", said=said, opponent=opponent, fixture=about)
    about_s: int | None = None
    if contest.day.paused:
        when = say("when.after-pause")
    elif teams := away.get(start.court):
        when = say("when.absent", teams=teams)
    else:
        about_s = _rounded_s(start.at_ms - pace.now_ms)
        when = _when(about_s)
    if opponent:
        said = say("team.next", court=start.court, when=when, opponent=opponent)
    else:
        said = say("team.later", fixture=about, court=start.court, when=when)
    return Whereabouts(
        team=team,
        state="waits",
        said=said,
        court=start.court,
        opponent=opponent,
        fixture=about,
        games_before=start.games_before,
        about_s=about_s,
    )


def _ended(contest: Contest, team: str, *, over: bool) -> Whereabouts:
    """Say that a team plays no more, with its place in the last stage in which it was."""
    place: Phrase | None = None
    rank, plays = 0, False
    for view in contest.stages:
        if team not in view.stage.entries:
            continue
        place, rank, plays = None, 0, True  # that of an earlier stage is not the last word
        for table in view.tables if view.over else ():
            for row in table.rows:
                if row.team == team:
                    rank = row.rank
                    equal = [one.team for one in table.rows if one.shares and one.rank == rank]
                    place = say(
                        "team.place",
                        rank=rank,
                        stage=title(contest, view.name),
                        group=table.section.upper() if len(view.tables) > 1 else None,
                        equal=[one for one in equal if one != team] or None,
                    )
    if over:
        return Whereabouts(team=team, state="over", said=say("team.over", place=place), rank=rank)
    is_gone = any(one.name == team and one.gone for one in contest.teams)  # it may have come back
    said = _why_gone(contest, team) if is_gone else None
    if said is None:
        said = say("team.out", place=place) if plays else say("team.no-place")
    return Whereabouts(team=team, state="out", said=said, rank=rank)


def _why_gone(contest: Contest, team: str) -> Phrase | None:
    """Say why a team left the contest, by the newest decision about it; None: no decision says."""
    for fact in reversed(contest.decisions):
        match fact:
            case Substituted(team=name) if name == team:
                reason = fact.reason or None
                return say("team.substituted", substitute=fact.substitute, reason=reason)
            case Withdrawn(team=name) if name == team:
                return say("team.withdrawn", reason=fact.reason or None)
            case Disqualified(team=name) if name == team:
                return say("team.disqualified", reason=fact.reason or None)
    return None


def _awaits_draw(contest: Contest) -> Phrase:
    """Say that the next stage is not drawn yet, or that its draw was taken back."""
    drawn = {view.name for view in contest.stages}
    for fact in reversed(contest.decisions):
        if isinstance(fact, Undrawn) and fact.stage not in drawn:
            stage = title(contest, fact.stage)
            return say("team.draw-taken-back", stage=stage, reason=fact.reason or None)
    return say("team.awaits-draw")


def _match(contest: Contest, pairing: str) -> tuple[StageView, ContestMatch]:
    return next(
        (view, match)
        for view in contest.stages
        for match in view.matches
        if match.pairing.id == pairing
    )


def _coming(contest: Contest) -> dict[str, tuple[StageView, ContestMatch]]:
    """Find the next match of each team: one that can be played now, else one that has to wait.

    A match waits for an opponent, or as a final for the other matches of its stage.
    """
    views = {match.pairing.id: view for view in contest.stages for match in view.matches}
    waiting = (match for view in contest.stages for match in view.matches if not match.decided)
    coming: dict[str, tuple[StageView, ContestMatch]] = {}
    for match in (*playable(contest), *waiting):
        for team in match.teams:
            if team:
                coming.setdefault(team, (views[match.pairing.id], match))
    return coming


def starts(
    contest: Contest, coming: Sequence[Foreseen], seen: Mapping[str, SeenCourt], pace: ContestPace
) -> Iterator[tuple[str, ProbableStart]]:
    """Estimate when and where each match to come begins; yield its pairing's id and its start.

    The matches are given to the courts in the order of `coming`. A court that has been silent for
    `LOST_MS` gets none; if all have, nothing is yielded. During a pause without an end, the times
    are as if it ended now; only organisers see them.

    Args:
        contest: the contest.
        coming: its matches that are still to come, from `foreseen`.
        seen: the courts, in the order in which they get games.
        pace: the time now, and how long games and rests take.
    """
    now_ms, game, rest_ms = pace
    plans = {view.name: view.plan for view in contest.stages}
    plans |= {plan.stage: plan for plan in contest.planned}
    court_ms = dict.fromkeys(present(seen, now_ms), now_ms)
    # What happened in the future did not: the machine's clock was set back since.
    team_ms = {t: end + rest_ms for t, (_, end) in contest.ended_ms.items() if end <= now_ms}
    opens = dict.fromkeys((view.name for view in contest.stages), 0)
    """Earliest time of each stage, in milliseconds since 1970, UTC; 0: it is drawn already."""
    ends: dict[str, int] = {}
    """By pairing: probable end of each match that is on a court or was yielded, also in ms."""
    for call in contest.running:
        view, match = _match(contest, call.pairing)
        end_ms = max(now_ms, min(call.at_ms, now_ms) + game)
        end_ms += (_games(view.plan, match) - 1) * game
        ends[call.pairing] = end_ms
        if call.court in court_ms:
            court_ms[call.court] = end_ms
        team_ms |= dict.fromkeys(call.teams, end_ms + rest_ms)
    begun: list[int] = []
    for one in coming:
        if not court_ms:
            return
        match, name = one.match, stage_of(one.pairing.id)
        teams = [team for team in match.teams if team]
        last = {contest.ended_ms.get(team, ("", 0))[0] for team in teams}
        rested = [] if last == {one.pairing.id} else [team_ms.get(team, 0) for team in teams]
        plan = plans[name]
        if name not in opens:  # a stage that is not drawn comes after all before it
            opens[name] = max(ends.values(), default=now_ms) + round(1000 * plan.break_s)
        before = [ends[pairing] for pairing in _needed(one, ends)]
        pause_ms = max(rest_ms, round(1000 * plan.final_break_s) if is_final(match) else 0)
        waited = max([opens[name], *(end + pause_ms for end in before)])
        court = court_of(contest, match)
        if court not in court_ms:
            court = min(court_ms, key=court_ms.__getitem__)
        appointed_ms = not_before_ms(contest, match, now_ms)
        at_ms = max(court_ms[court], waited, appointed_ms, *rested)
        yield one.pairing.id, ProbableStart(court, at_ms, bisect_left(begun, at_ms))
        count = _games(plan, match)
        for number in range(count):
            insort(begun, at_ms + number * game)
        ends[one.pairing.id] = court_ms[court] = at_ms + count * game
        team_ms |= dict.fromkeys(teams, court_ms[court] + rest_ms)


def _needed(one: Foreseen, ends: Mapping[str, int]) -> Iterator[str]:
    """Yield the pairings of the matches that must end before a match begins, if `ends` has them.

    If rounds are drawn one by one, each round waits for all earlier ones.
    """
    pairing = one.pairing
    sources = {s.pairing for s in pairing.sources if isinstance(s, WinnerOf | LoserOf)}
    waits_for_round = one.match.state == "waits" and not sources
    if not (sources or waits_for_round or is_final(one.match)):
        return
    for earlier in ends:
        if stage_of(earlier) == stage_of(pairing.id) and (
            earlier in sources
            or is_final(one.match)
            or (waits_for_round and _round(earlier) < pairing.round)
        ):
            yield earlier


def _round(pairing: str) -> int:
    """Return the round of a pairing, from its id."""
    return int(pairing.rpartition(".")[0].rpartition(":")[2].lstrip(ascii_lowercase))


def full_minute(at_ms: int) -> int:
    """Round an expected time up to a minute, so that it does not change with each estimate."""
    return -(-at_ms // _MINUTE_MS) * _MINUTE_MS


def _games(plan: Planned, match: ContestMatch) -> int:
    """Return how many games a match still takes if the team that leads wins all of them."""
    wins = [sum(game.winner == team for game in match.games) for team in match.teams]
    return max(1, plan.settings.games // 2 + 1 - max(wins))


def may_come(contest: Contest, team: str) -> bool:
    """Return whether a team without a match may still get one, by a draw that is to come."""
    drawn = {view.name: view for view in contest.stages}
    if any(view.rounds_to_draw and team in view.stage.entries for view in contest.stages):
        return True
    may: dict[str, bool] = {name: team in view.stage.entries for name, view in drawn.items()}
    for plan in contest.planned:  # each comes after the one that it follows
        may[plan.stage] = may.get(plan.after, True) if plan.after else True
    return any(may[plan.stage] for plan in contest.planned)


def _rounded_s(time_ms: int) -> int:
    """Return a time in seconds, rounded up in coarse steps; so an estimate seldom changes."""
    return max(0, -(-time_ms // (1000 * _STEP_S)) * _STEP_S)


def _when(about_s: int) -> Phrase:
    """Say in words in how many seconds or minutes a match begins."""
    if about_s <= _MOMENT_S:
        return say("when.moment")
    return say("when.minutes", minutes=max(1, round(about_s / 60)))
