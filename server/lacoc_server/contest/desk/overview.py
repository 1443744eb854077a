"""Everything that the organiser's page shows, from the facts and what the office knows."""

from collections.abc import Iterator
from typing import Literal

import msgspec

from lacoc_server.contest.desk.book import Book
from lacoc_server.contest.league import facts
from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.draws import Team
from lacoc_server.contest.league.fixture import fixture, match_fixture
from lacoc_server.contest.league.timetable.calling import LOST_MS
from lacoc_server.contest.league.timetable.schedule import waits_for_organiser
from lacoc_server.contest.league.timetable.whereabouts import Known, full_minute, starts
from lacoc_server.contest.league.titles import title
from lacoc_shared import codec
from lacoc_shared.messages.desk import CourtRow, Moved, OfficeView, Slot, TeamRow, ToDraw


def view(book: Book, known: Known) -> OfficeView:
    """Make the view of the organiser's page.

    Args:
        book: the contest.
        known: what the office knows besides the facts.

    Raises:
        UserError: if the facts can't be read.
    """
    contest = book.contest
    made = OfficeView(
        version="",
        event=book.event,
        code=book.code.value,
        drawn=bool(contest.stages),
        to_draw=_to_draw(contest),
        teams=tuple(_teams(book)),
        courts=tuple(
            CourtRow(court=court, here=known.pace.now_ms - seen.heard_ms < LOST_MS)
            for court, seen in known.seen.items()
        ),
        slots=tuple(sorted(slots(contest, known), key=lambda slot: (slot.court, slot.at_ms))),
    )
    version = codec.message_hash(codec.encode(made)).hex()
    return msgspec.structs.replace(made, version=version)


def _to_draw(contest: Contest) -> ToDraw | None:
    draw = waits_for_organiser(contest)
    if draw is None:
        return None
    return ToDraw(stage=draw.stage, title=title(contest, draw.stage), entries=draw.entries)


def _teams(book: Book) -> Iterator[TeamRow]:
    """Yield the teams; those that wait or were refused come first."""
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
            at_ms=there.at_ms,
            mistakes=mistakes,
        )
    for name, one in known.items():
        if name in waiting:
            continue
        mistakes = book.refused.get(name, ())
        yield TeamRow(team=name, state=_state(one), files=one.files, bot=one.bot, mistakes=mistakes)


def _state(team: Team) -> Literal["in", "withdrawn", "disqualified"]:
    if team.disqualified:
        return "disqualified"
    return "withdrawn" if team.withdrawn else "in"


def slots(contest: Contest, known: Known) -> Iterator[Slot]:
    """Yield the matches that are at a court, then those that can be played."""
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
            begun=seen is not None and seen.call == call.id and seen.begun,
            moved=_moved(moves.get(call.pairing)),
        )
    for pairing, start in starts(contest, known.seen, known.pace):
        stage, match = places[pairing]
        if match.next_seats is not None:
            yield Slot(
                pairing=pairing,
                fixture=match_fixture(contest, stage, match),
                teams=match.next_seats,
                court=start.court,
                at_ms=full_minute(start.at_ms),
                held=known.held.get((pairing, match.next_game)),
                moved=_moved(moves.get(pairing)),
            )


def _moved(move: facts.Moved | None) -> Moved | None:
    return None if move is None else Moved(move.court, move.before, move.not_before_ms)
