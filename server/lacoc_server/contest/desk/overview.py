"""Computes everything that the organiser's page shows, from facts and what the office knows."""

from collections.abc import Iterator
from typing import Literal

import msgspec

from lacoc_server.contest.acts.steering import places, undrawable
from lacoc_server.contest.desk.book import Book
from lacoc_server.contest.league import facts
from lacoc_server.contest.league.advance import reasons
from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.draws import Team
from lacoc_server.contest.league.fixture import fixture
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.timetable.calling import absent
from lacoc_server.contest.league.timetable.foreseen import foreseen
from lacoc_server.contest.league.timetable.schedule import waits_for_organiser
from lacoc_server.contest.league.timetable.seeding import (
    first_meetings,
    kept_apart,
    meets_again,
    met_before,
)
from lacoc_server.contest.league.timetable.whereabouts import OfficeKnowledge, full_minute, starts
from lacoc_server.contest.league.titles import title
from lacoc_shared import codec
from lacoc_shared.messages.desk import (
    PUBLISHED,
    CourtRow,
    DayState,
    MatchMove,
    OfficeView,
    ShiftState,
    Slot,
    TeamRow,
    ToDraw,
    Undrawable,
)


def view(book: Book, known: OfficeKnowledge, by: str) -> OfficeView:
    """Make the view of the organiser's page.

    Args:
        book: the contest.
        known: what the office knows besides the facts.
        by: who of the staff looks at it; "": the organiser.

    Raises:
        UserError: if the facts can't be read.
    """
    contest = book.contest
    is_published = book.where.published.is_dir()
    made = OfficeView(
        version="",
        event=book.event,
        code=book.code.value,
        drawn=bool(contest.stages),
        to_draw=_to_draw(contest),
        teams=tuple(_teams(book)),
        courts=tuple(CourtRow(court=court, here=seen.there) for court, seen in known.seen.items()),
        slots=tuple(sorted(slots(contest, known), key=lambda slot: (slot.court, slot.at_ms))),
        day=DayState(
            paused=contest.day.paused, until_ms=contest.day.until_ms, reason=contest.day.reason
        ),
        shift=_shift(contest, known.pace.now_ms),
        announced=contest.announced.text if contest.announced is not None else "",
        undrawable=_undrawable(contest),
        published=PUBLISHED if is_published else "",
        folder=str(book.where.published) if is_published else "",
        staff=book.secrets.staff_names,
        me=by,
    )
    version = codec.message_hash(codec.encode(made)).hex()
    return msgspec.structs.replace(made, version=version)


def _shift(contest: Contest, now_ms: int) -> ShiftState | None:
    """Return the newest shift, as long as games still wait because of it; else None.

    A shift postpones everything by some minutes. No game is called before they are over. A match
    that was moved to a time waits for that time, which the shift has postponed too.
    """
    shift = contest.shifted
    if shift is None:
        return None
    times = (shift.at_ms + shift.by_ms, *(move.not_before_ms for move in contest.moves))
    return ShiftState(shift=shift.id, by_ms=shift.by_ms) if max(times) > now_ms else None


def _undrawable(contest: Contest) -> Undrawable | None:
    stage = undrawable(contest)
    return Undrawable(stage=stage, title=title(contest, stage)) if stage else None


def _to_draw(contest: Contest) -> ToDraw | None:
    draw = waits_for_organiser(contest, FORMATS)
    if draw is None:
        return None
    plan, order = contest.planned[0], draw.entries
    how = FORMATS[plan.format]
    all_apart = msgspec.structs.replace(plan, apart=True, met_apart=True)
    apart = kept_apart(contest, all_apart, how, order)
    again = [len(meets_again(contest, plan, how, one)) for one in (order, apart)]
    met = [sorted(pair) for pair in met_before(contest, plan) if pair <= {*order}]
    meetings = first_meetings(plan, how, order) if met else ()
    return ToDraw(
        stage=draw.stage,
        title=title(contest, draw.stage),
        entries=order,
        why=reasons(contest, plan, order),
        meet=tuple((order.index(one), order.index(other)) for one, other in meetings),
        met=tuple((one, other) for one, other in sorted(met)),
        apart=apart if again[1] < again[0] else (),
    )


def _teams(book: Book) -> Iterator[TeamRow]:
    """Yield a row for each team.

    First come teams whose files were refused, then teams whose files wait for the organiser's
    approval.
    """
    contest = book.contest
    played = [view.stage.entries for view in contest.stages if not view.over]
    clubs = {team.name: team.club for team in contest.teams}
    for row in _rows(book):
        told = book.contacts.of(row.team)
        yield msgspec.structs.replace(
            row,
            contact=told.reach,
            club=clubs.get(row.team, told.club),
            substitute=bool(places(contest, row.team)),
            reserve=row.state in ("in", "late") and not any(row.team in one for one in played),
        )


def _rows(book: Book) -> Iterator[TeamRow]:
    known = {team.name: team for team in book.contest.teams}
    waiting = {
        team: there
        for team, there in book.applications.waiting.items()
        # A team that was also entered by command, with the same files, waits for nothing.
        if team not in known or known[team].files != there.entry.hash
    }
    for team, mistakes in book.refused.items():
        if team not in known and team not in waiting:
            yield TeamRow(team=team, state="refused", mistakes=mistakes)
    for team, there in waiting.items():
        mistakes = book.refused.get(team, ())
        yield TeamRow(
            team=team,
            state="late" if team in known else "waits",
            files=there.entry.hash,
            picture=there.entry.picture is not None,
            at_ms=there.at_ms,
            mistakes=mistakes,
        )
    for name, one in known.items():
        if name in waiting:
            continue
        mistakes = book.refused.get(name, ())
        yield TeamRow(
            team=name,
            state=_state(one),
            replaced_by=one.substitute,
            files=one.files,
            bot=one.bot,
            picture=one.picture,
            mistakes=mistakes,
        )


def _state(team: Team) -> Literal["in", "withdrawn", "disqualified"]:
    if team.disqualified:
        return "disqualified"
    return "withdrawn" if team.withdrawn else "in"


def slots(contest: Contest, known: OfficeKnowledge) -> Iterator[Slot]:
    """Yield the games that are at a court now, then all matches that are still to come."""
    places = {match.pairing.id: (view, match) for view in contest.stages for match in view.matches}
    moves = {move.pairing: move for move in contest.moves}
    for call in contest.running:
        stage, match = places[call.pairing]
        seen = known.seen.get(call.court)
        yield Slot(
            pairing=call.pairing,
            fixture=fixture(contest, stage, match, call.game),
            teams=call.teams,
            court=call.court,
            at_ms=call.at_ms,
            running=True,
            begun=seen is not None and seen.call == call.id and bool(seen.begun),
            absent=absent(call, seen, known.pace.now_ms),
            moved=_moved(moves.get(call.pairing)),
        )
    coming = foreseen(contest, FORMATS)
    begins = dict(starts(contest, coming, known.seen, known.pace))
    for one in coming:
        start = begins.get(one.pairing.id)
        yield Slot(
            pairing=one.pairing.id,
            fixture=one.fixture,
            teams=one.match.next_seats or ("", ""),
            who=None if one.match.next_seats else one.who,
            court=start.court if start else "",
            at_ms=full_minute(start.at_ms) if start else 0,
            held=known.held.get((one.pairing.id, one.match.next_game)),
            moved=_moved(moves.get(one.pairing.id)),
        )


def _moved(move: facts.Moved | None) -> MatchMove | None:
    return None if move is None else MatchMove(move.court, move.before, move.not_before_ms)
