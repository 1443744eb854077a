"""The schedule: what is drawn next, and which game goes to which free court."""

from collections.abc import Collection, Iterator, Mapping, Sequence

import msgspec

from lacoc_server.contest.league.contest import Contest, StageView, end_ms, next_round
from lacoc_server.contest.league.facts import Closed, Drawn, Planned, RoundDrawn, new, stage_of
from lacoc_server.contest.league.formats.format import Format
from lacoc_server.contest.league.matches import ContestMatch
from lacoc_server.contest.league.timetable.seeding import by_rank, kept_apart


class Assignment(msgspec.Struct, frozen=True, kw_only=True):
    """A game that is given to a court."""

    court: str
    pairing: str
    game: int
    teams: tuple[str, str]
    """Who sits left and who sits right."""


def playable(contest: Contest) -> list[ContestMatch]:
    """Return the matches whose next game can be played, in the order in which to play them.

    A match that has begun goes on before others begin. Earlier stages and rounds come before later
    ones. A match that was moved before another match comes directly before it. A final waits for
    all other matches of its stage: the match for third place is played before it.
    """
    running = {call.pairing for call in contest.running}
    matches = [
        match
        for view in contest.stages
        for match in view.matches
        if match.state == "open"
        and match.pairing.id not in running
        and not (is_final(match) and waits_for_others(view))
    ]
    matches.sort(key=lambda match: not match.games)
    there = {match.pairing.id: match for match in matches}
    for move in contest.moves:
        match, before = there.get(move.pairing), there.get(move.before)
        if match is not None and before is not None and match is not before:
            matches.remove(match)
            matches.insert(matches.index(before), match)
    return matches


def is_final(match: ContestMatch) -> bool:
    """Return whether a match decides who wins its stage."""
    return match.pairing.winner_place == 1


def waits_for_others(view: StageView) -> bool:
    """Return whether a stage still has undecided matches that must be played before its final."""
    return not all(match.decided or is_final(match) for match in view.matches)


def court_of(contest: Contest, match: ContestMatch) -> str:
    """Return the only court on which a match is played; "": any court."""
    moved = next((move.court for move in contest.moves if move.pairing == match.pairing.id), "")
    return moved or (_plan(contest, match).final_court if is_final(match) else "")


def not_before_ms(contest: Contest, match: ContestMatch, now_ms: int) -> int:
    """Return the earliest time of a match, in milliseconds since 1970, UTC; 0: any time.

    The break before a stage counts until a game of the stage has ended, and the break before a
    final until a game of the final has, also a void one. The rest of teams never counts here. Games
    with an end later than `now_ms` are ignored: the machine's clock was set back.
    """
    name, plan = stage_of(match.pairing.id), _plan(contest, match)
    before = [view.name for view in contest.stages]
    ended = contest.stages_ended_ms
    past = {stage: end_ms for stage, end_ms in ended.items() if end_ms <= now_ms}
    earliest = [contest.day.until_ms]
    earliest += [move.not_before_ms for move in contest.moves if move.pairing == match.pairing.id]
    before = before[: before.index(name)] if name in before else before
    if name not in ended and (ends := [past[one] for one in before if one in past]):
        earliest.append(end_ms(max(ends), round(1000 * plan.break_s)))
    newest = {contest.ended_ms.get(team, ("", 0))[0] for team in match.teams if team}
    has_begun = bool(match.games) or match.pairing.id in newest
    if is_final(match) and not has_begun and name in past:
        earliest.append(end_ms(past[name], round(1000 * plan.final_break_s)))
    return max(earliest)


def _plan(contest: Contest, match: ContestMatch) -> Planned:
    plans = [*(view.plan for view in contest.stages), *contest.planned]
    return next(plan for plan in plans if plan.stage == stage_of(match.pairing.id))


def assign(
    contest: Contest,
    courts: Sequence[str],
    now_ms: int,
    least_rest_ms: int = 0,
    without: Collection[tuple[str, int]] = (),
) -> list[Assignment]:
    """Return which of the next games goes to which free court.

    Args:
        contest: the contest.
        courts: courts that answer, in the order in which they get games. Those with a running game
            are not free.
        now_ms: the time, in milliseconds since 1970, UTC.
        least_rest_ms: shortest time between two matches of a team; games of one match follow each
            other without it.
        without: games to leave out, by pairing and number.

    Returns:
        At most one game for each free court, and for each team.
    """
    taken = {call.court for call in contest.running}
    free = [court for court in dict.fromkeys(courts) if court not in taken]
    return list(_assigned(contest, free, now_ms, least_rest_ms, without))


def _assigned(
    contest: Contest,
    free: list[str],
    now_ms: int,
    least_rest_ms: int,
    without: Collection[tuple[str, int]],
) -> Iterator[Assignment]:
    if contest.day.is_held(now_ms):
        return
    busy = {team for call in contest.running for team in call.teams}
    for match in playable(contest):
        if not free:
            return
        teams = match.next_seats
        if teams is None or busy & {*teams} or (match.pairing.id, match.next_game) in without:
            continue
        if rested_ms(contest, match, least_rest_ms, now_ms) > now_ms:
            continue
        court = court_of(contest, match) or free[0]
        if court not in free or not_before_ms(contest, match, now_ms) > now_ms:
            continue
        busy |= {*teams}
        free.remove(court)
        yield Assignment(court=court, pairing=match.pairing.id, game=match.next_game, teams=teams)


def rested_ms(contest: Contest, match: ContestMatch, least_rest_ms: int, now_ms: int) -> int:
    """Return when both teams of a match will have rested, in milliseconds since 1970, UTC.

    Games with an end later than `now_ms` are ignored: the machine's clock was set back.
    """
    ends = (contest.ended_ms.get(team, (match.pairing.id, 0)) for team in match.teams if team)
    return max(
        (
            end + least_rest_ms
            for pairing, end in ends
            if pairing != match.pairing.id and end <= now_ms
        ),
        default=0,
    )


def due(contest: Contest, formats: Mapping[str, Format]) -> Closed | Drawn | RoundDrawn | None:
    """Return the fact of the next possible draw; None: nothing can be drawn now.

    If entries must be closed before that draw, the fact that closes them is returned.

    The next round of a stage is drawn when all matches of its earlier rounds are decided. Stages
    are drawn one after another, each when all before it are over, with the teams that are left. A
    draw that waits for the organiser is returned too: see `waits_for_organiser`.
    """
    for view in contest.stages:
        if view.may_draw:
            pairs = next_round(contest, view.name, formats)
            return new(RoundDrawn, stage=view.name, round=len(view.stage.drawn) + 1, pairs=pairs)
    draw = _next_stage(contest, formats)
    return draw if draw is None or contest.closed else new(Closed)


def waits_for_organiser(contest: Contest, formats: Mapping[str, Format]) -> Drawn | None:
    """Return the draw that only the organiser can make now; None: there is none.

    A stage whose draw was taken back waits too, whatever its plan says.
    """
    if not (contest.closed and contest.planned):
        return None
    plan = contest.planned[0]
    if plan.draw != "organiser" and plan.stage not in contest.undrawn:
        return None
    return _next_stage(contest, formats)


def _next_stage(contest: Contest, formats: Mapping[str, Format]) -> Drawn | None:
    """Return the draw of the next planned stage.

    None: no stage is left, or its teams are not known yet.
    """
    if not contest.planned:
        return None
    plan = contest.planned[0]
    teams = _teams(contest, plan)
    if teams is None:
        return None
    if (plan.apart or plan.met_apart) and plan.format in formats:
        teams = kept_apart(contest, plan, formats[plan.format], teams)
    return new(Drawn, stage=plan.stage, entries=teams)


def _teams(contest: Contest, plan: Planned) -> tuple[str, ...] | None:
    """Return the teams of a planned stage by seeding; None: they are not known yet."""
    if any(not view.over for view in contest.stages):
        return None
    here = {team.name for team in contest.teams if not team.gone}
    left = [team for team in by_rank(contest, plan) if team in here]
    return tuple(left[: plan.teams or None])
