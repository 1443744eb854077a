"""Answers a court's referee: the next matches at this court, and what a result would change."""

from lacoc_server.contest.acts import deciding
from lacoc_server.contest.desk import overview
from lacoc_server.contest.desk.book import Book
from lacoc_server.contest.league.facts import Played, new
from lacoc_server.contest.league.timetable.whereabouts import OfficeKnowledge
from lacoc_shared.messages.desk import CourtDay, CourtPlan
from lacoc_shared.words import Phrase

_COMING_MOST = 4


def plan(book: Book, known: OfficeKnowledge, asked: CourtDay) -> CourtPlan:
    """Return the next matches at a court, and what a result of the court's game would change.

    Args:
        book: the contest.
        known: what the office knows besides the facts.
        asked: the court, and the points of a possible result or None.

    Raises:
        UserError: if the facts can't be read.
    """
    slots = overview.slots(book.contest, known)
    coming = [slot for slot in slots if slot.court == asked.court and not slot.running]
    coming.sort(key=lambda slot: slot.at_ms)
    return CourtPlan(coming=tuple(coming[:_COMING_MOST]), changes=_changes(book, asked))


def _changes(book: Book, asked: CourtDay) -> tuple[Phrase, ...]:
    call = next((one for one in book.contest.running if one.court == asked.court), None)
    if call is None or asked.scores is None:
        return ()
    result = new(
        Played,
        pairing=call.pairing,
        game=call.game,
        teams=call.teams,
        scores=asked.scores,
        outcome=asked.outcome,
    )
    return deciding.effect(book.facts, [result])
