"""Facts with which an organiser steers the day: moves, pauses, shifts, substitutes, announcements.

A function here appends nothing. It returns the facts, so the organiser can see first what they
would change.
"""

from collections.abc import Collection

from lacoc_server.contest.acts.deciding import match_of, team_of
from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.facts import (
    Announced,
    Moved,
    Paused,
    Recalled,
    Resumed,
    Shifted,
    Substituted,
    Undrawn,
    Unshifted,
    new,
    stage_of,
)
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.timetable.foreseen import foreseen
from lacoc_server.contest.league.titles import title
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


def moving(
    contest: Contest,
    courts: Collection[str],
    pairing: str,
    court: str = "",
    before: str = "",
    not_before_ms: int = 0,
    now_ms: int = 0,
) -> Moved:
    """Return the fact that moves a match to another court or time, or before another match.

    Args:
        contest: the contest.
        courts: names of its courts.
        pairing: the match; its teams need not be known yet.
        court: the only court for it; "": any court.
        before: the match directly before which this one is played; "": its own place in the
            schedule, also if it was moved before.
        not_before_ms: when it is called at the earliest, in milliseconds since 1970, UTC; 0: at any
            time.
        now_ms: the time now, likewise.

    Raises:
        UserError: if there is no such match or court, the match is decided, it would have to be
            played before itself, or a new time is in the past.
    """
    coming = {one.pairing.id for one in foreseen(contest, FORMATS)}
    if pairing not in coming and match_of(contest, pairing).decided:
        raise UserError(say("desk.match-over", pairing=pairing))
    if before and before not in coming:
        match_of(contest, before)
    if before == pairing:
        raise UserError(say("desk.before-itself"))
    if court and court not in courts:
        raise UserError(say("desk.no-court", court=court, courts=[*courts]))
    was_ms = {move.pairing: move.not_before_ms for move in contest.moves}.get(pairing, 0)
    if not_before_ms not in (0, was_ms) and not_before_ms <= now_ms:
        raise UserError(say("day.in-the-past"))
    return new(Moved, pairing=pairing, court=court, before=before, not_before_ms=not_before_ms)


def pausing(contest: Contest, until_ms: int, reason: str, now_ms: int) -> Paused:
    """Return the fact that pauses the contest: no more games are called.

    Args:
        contest: the contest.
        until_ms: when the contest goes on by itself, in milliseconds since 1970, UTC; 0: it goes on
            only when somebody resumes it.
        reason: why; everybody can read it.
        now_ms: the time now, in milliseconds since 1970, UTC.

    Raises:
        UserError: if the contest is paused without an end already and would be so again, or
            `until_ms` is in the past.
    """
    if contest.day.paused and not until_ms:
        raise UserError(say("day.paused-already"))
    if until_ms and until_ms <= now_ms:
        raise UserError(say("day.in-the-past"))
    return new(Paused, until_ms=until_ms, reason=reason)


def resuming(contest: Contest, now_ms: int) -> Resumed:
    """Return the fact that ends a pause, or the wait after a shift (a postponement).

    Raises:
        UserError: if neither a pause nor a shift keeps games from being called.
    """
    if not contest.day.is_held(now_ms):
        raise UserError(say("day.not-paused"))
    return new(Resumed)


def shifting(by_ms: int, reason: str) -> Shifted:
    """Return the fact that postpones all matches still to come by `by_ms`, in milliseconds."""
    return new(Shifted, by_ms=by_ms, reason=reason)


def unshifting(contest: Contest, shift: str = "") -> Unshifted:
    """Return the fact that takes the newest shift back.

    Args:
        contest: the contest.
        shift: id of the shift's fact. With it, a request that is sent twice takes only one shift
            back. "": the newest one, whatever its id.

    Raises:
        UserError: if there is no shift, or `shift` is not the newest one.
    """
    newest = contest.shifted
    if newest is None or shift not in ("", newest.id):
        raise UserError(say("day.not-shifted"))
    return new(Unshifted, shift=newest.id)


def announcing(text: str) -> Announced:
    """Return the fact that shows a line on all pages; an empty text removes the line."""
    return new(Announced, text=" ".join(text.split()))


def substituting(contest: Contest, team: str, substitute: str, reason: str) -> Substituted:
    """Return the fact by which a substitute takes a team's place where it has not played yet.

    Raises:
        UserError: if a team is not in the contest, the substitute has a place of its own in each
            stage, there is no place to give up, or the reason is missing.
    """
    leaves, comes = team_of(contest, team), team_of(contest, substitute)
    team, substitute = leaves.name, comes.name
    if comes.gone or comes == leaves:
        raise UserError(say("league.no-substitute", team=substitute))
    if not [stage for stage in places(contest, team) if substitute not in stage]:
        raise UserError(say("day.no-place", team=team, substitute=substitute))
    if not reason.strip():
        raise UserError(say("decide.needs-reason"))
    return new(Substituted, team=team, substitute=substitute, reason=reason)


def places(contest: Contest, team: str) -> list[tuple[str, ...]]:
    """Return, for each stage in which a team could give up its place, the teams of the stage.

    These are the stages that are not over, and in which the team has a place but no result.
    """
    return [
        view.stage.entries
        for view in contest.stages
        if team in view.stage.entries
        and not view.over
        and team not in contest.with_result.get(view.name, ())
    ]


def undrawable(contest: Contest) -> str:
    """Return the name of the newest stage if its draw can be taken back; else "".

    It can if no match of the stage has a result.
    """
    newest = contest.stages[-1].name if contest.stages else ""
    return "" if newest in contest.with_result else newest


def undrawing(contest: Contest, stage: str, reason: str) -> list[Recalled | Undrawn]:
    """Return the facts that take the draw of a stage back; the organiser must then draw it again.

    Returns:
        First the facts that take the stage's games back from courts, then the fact about the draw.

    Raises:
        UserError: if no stage is named, it is not drawn, a game of it has a result, another stage
            was drawn since, or the reason is missing.
    """
    drawn = [view.name for view in contest.stages]
    if not stage:
        now = undrawable(contest) or None
        raise UserError(say("day.which-stage", drawn=drawn or None, now=now))
    if stage not in drawn:
        raise UserError(say("league.not-drawn", stage=stage))
    if stage != undrawable(contest):
        raise UserError(say("day.draw-stays", stage=title(contest, stage)))
    if not reason.strip():
        raise UserError(say("decide.needs-reason"))
    called = (call for call in contest.running if stage_of(call.pairing) == stage)
    return [
        *(new(Recalled, pairing=one.pairing, game=one.game, reason="undrawn") for one in called),
        new(Undrawn, stage=stage, reason=reason),
    ]
