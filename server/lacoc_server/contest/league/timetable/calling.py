"""Which game goes to which court, when a game is taken back, and how it ended; pure."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.decided import in_words
from lacoc_server.contest.league.facts import (
    COURT_LOST,
    MOVED,
    AnyFact,
    Called,
    Drawn,
    Entered,
    FilesChanged,
    OfDecision,
    Outcome,
    Played,
    Recalled,
    Undrawn,
    new,
    stage_of,
)
from lacoc_server.contest.league.timetable.schedule import assign
from lacoc_shared.words import Phrase, say

LOST_MS = 20_000
"""A court that was not heard for this long loses its game [ms]."""
_LATE_MS = 30_000
"""A team counts as absent if it has not joined for this long after the call of its game [ms]."""

OPEN_CALL = "open."
"""The ids of calls of open matches begin with this."""


def is_open_call(call: str) -> bool:
    """Return whether the id of a call is of an open match; other calls have the id of a fact."""
    return call.startswith(OPEN_CALL)


class GameEnd(NamedTuple):
    """The end of a game at a court."""

    scores: tuple[int, int]
    """Points of the left and of the right seat."""
    outcome: Outcome
    record: str
    """File name of the record."""
    advice: tuple[Phrase, ...] = ()
    """Why the court advised to play the game again; empty: it did not."""


class SeenCourt(NamedTuple):
    """The state of a court, as the office knows it now."""

    heard_ms: int
    """When the court last told what it has, in milliseconds since 1970, UTC; 0: never."""
    call: str = ""
    """Id of the call whose match the court has; "": none, or not known, as of a silent court."""
    begun: bool | None = False
    """Whether play has begun in the match of the call, or the match is over; None: not known, as of
    a silent court."""
    ended: GameEnd | None = None
    """How the match ended; None: it has no official result."""
    there: bool = False
    """Whether the court answers now."""
    missing: tuple[str, ...] = ()
    """Teams that have not joined the match of the call; none once it has begun."""


def results(contest: Contest, seen: Mapping[str, SeenCourt]) -> Iterator[AnyFact]:
    """Yield the results of the called games that courts have brought to an end."""
    for call in contest.running:
        court = seen.get(call.court)
        if court is not None and court.call == call.id and court.ended is not None:
            yield new(
                Played,
                pairing=call.pairing,
                game=call.game,
                teams=call.teams,
                scores=court.ended.scores,
                outcome=court.ended.outcome,
                record=court.ended.record,
                advice=court.ended.advice,
            )


def needed(contest: Contest) -> list[Called]:
    """Return the called games that are still the next games of their matches."""
    following = {
        (match.pairing.id, match.next_game, match.next_seats)
        for view in contest.stages
        for match in view.matches
        if match.state == "open"
    }
    return [call for call in contest.running if (call.pairing, call.game, call.teams) in following]


def in_vain(contest: Contest, call: Called) -> bool:
    """Return whether the result of a called game could not count any more.

    It could if the match is open between the same teams, and no result of this game counts.
    """
    match = contest.matches.get(call.pairing)
    return (
        match is None
        or match.state != "open"
        or {*match.teams} != {*call.teams}
        or any(game.number == call.game for game in match.games)
    )


def taken_back(
    contest: Contest, seen: Mapping[str, SeenCourt], now_ms: int, since_ms: int = 0
) -> Iterator[AnyFact]:
    """Yield the facts that take games back from their courts.

    Taken back are games that are no longer needed, for example because a team has left; games that
    were moved to another court or a later time; and games of courts that were not heard for
    `LOST_MS`. A game that has begun is taken back only if it is played in vain: it stays until its
    result is known, also with a court that was killed, which goes on with it. While nobody knows
    whether a game has begun, it stays too, until its court counts as lost.

    Args:
        contest: the contest.
        seen: the courts.
        now_ms: the time, in milliseconds since 1970, UTC.
        since_ms: since when the office has listened to its courts, in milliseconds since 1970, UTC.
    """
    stays = {call.id for call in needed(contest)}
    moves = {move.pairing: move for move in contest.moves}
    for call in contest.running:
        court = seen.get(call.court, SeenCourt(0))
        move = moves.get(call.pairing)
        begun = court.begun and court.call == call.id  # None: not known
        called_ms = call.at_ms if call.at_ms <= now_ms else 0  # else the clock was set back
        has_not_begun = begun is False
        if call.id not in stays if has_not_begun else in_vain(contest, call):
            yield new(Recalled, pairing=call.pairing, game=call.game, reason="not needed")
        elif begun:
            continue
        elif (
            has_not_begun
            and move is not None
            and (move.court not in ("", call.court) or move.not_before_ms > now_ms)
        ):
            yield new(Recalled, pairing=call.pairing, game=call.game, reason=MOVED)
        elif now_ms - max(court.heard_ms, since_ms, called_ms) > LOST_MS:
            yield new(Recalled, pairing=call.pairing, game=call.game, reason=COURT_LOST)


def why_recalled(contest: Contest, facts: Sequence[AnyFact], call: str) -> Phrase | None:
    """Say why a called game was taken away from its court; None: no reason is known.

    Args:
        contest: the contest.
        facts: its facts, in their order.
        call: id of the call.
    """
    called = next((one for one in facts if isinstance(one, Called) and one.id == call), None)
    if called is None:
        return None
    later = (fact for fact in facts if fact.number > called.number)
    game = called.pairing, called.game
    backs = (f for f in later if isinstance(f, Recalled) and (f.pairing, f.game) == game)
    reason = getattr(next(backs, None), "reason", "")
    if reason == MOVED:
        return say("recalled.moved")
    if reason == COURT_LOST:
        return say("recalled.silent", seconds=LOST_MS // 1000)
    since = (fact for fact in contest.decisions if fact.at_ms >= called.at_ms)
    about = [fact for fact in since if _is_about(fact, called)]
    if not about:
        return None
    return say(
        "recalled.decided", what=in_words(contest, about[-1]), reason=about[-1].reason or None
    )


def _is_about(fact: OfDecision, called: Called) -> bool:
    """Return whether a decision about a game's match, its stage or one of its teams may end it."""
    if isinstance(fact, Entered | FilesChanged):
        return False
    if isinstance(fact, Drawn | Undrawn):
        return fact.stage == stage_of(called.pairing)
    pairing, team = getattr(fact, "pairing", ""), getattr(fact, "team", "")
    return pairing == called.pairing or team in called.teams


def calls(
    contest: Contest,
    seen: Mapping[str, SeenCourt],
    now_ms: int,
    least_rest_ms: int,
    held: Collection[tuple[str, int]] = (),
) -> list[Called]:
    """Return the calls that give the next games to the free courts.

    A court whose open match is played is not free. A court whose open match has not begun, or is
    over, is free: the called game replaces the open match.

    Args:
        contest: the contest.
        seen: the courts, in the order in which they get games.
        now_ms: the time, in milliseconds since 1970, UTC.
        least_rest_ms: shortest time between two matches of a team.
        held: games that a court refused, by pairing and number; they are not called.
    """
    free = [name for name in present(seen, now_ms) if not _plays_open_match(seen[name])]
    return [
        new(Called, pairing=one.pairing, game=one.game, teams=one.teams, court=one.court)
        for one in assign(contest, free, now_ms, least_rest_ms, held)
    ]


def _plays_open_match(court: SeenCourt) -> bool:
    return is_open_call(court.call) and bool(court.begun) and court.ended is None


def present(seen: Mapping[str, SeenCourt], now_ms: int) -> list[str]:
    """Return the courts that were heard within the last `LOST_MS`, in the order of `seen`."""
    return [name for name, court in seen.items() if now_ms - court.heard_ms < LOST_MS]


def absent(call: Called, seen: SeenCourt | None, now_ms: int) -> tuple[str, ...]:
    """Return the teams of a called game that are late: they should have joined by now."""
    is_late = now_ms - call.at_ms >= _LATE_MS
    return seen.missing if seen is not None and seen.call == call.id and is_late else ()


def wanted(contest: Contest, seen: Mapping[str, SeenCourt]) -> Iterable[Called]:
    """Return the calls that the office must send: their courts do not have the games yet."""
    return [call for call in contest.running if seen.get(call.court, SeenCourt(0)).call != call.id]
