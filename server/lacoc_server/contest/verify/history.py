"""Checks the order of facts: what must come before what, and whether each draw follows; pure."""

from collections.abc import Iterable, Iterator, Sequence

from lacoc_server.contest.league.contest import Contest, compute
from lacoc_server.contest.league.decided import decided
from lacoc_server.contest.league.draws import by_lot
from lacoc_server.contest.league.facts import (
    AnyFact,
    Called,
    Closed,
    Drawn,
    Entered,
    FilesChanged,
    Played,
    Recalled,
    RoundDrawn,
)
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.timetable.schedule import due
from lacoc_shared.words import Phrase, say

OfFiles = Entered | FilesChanged
"""Facts that give a team its files or change them."""
_HARMLESS = (
    "league.match-void",
    "league.other-teams",
    "league.result-again",
    "league.result-early",
    "league.result-replaced",
    "league.result-unneeded",
    "league.result-void",
)
"""Codes of reasons why a fact may have no effect in an honest contest, too, for example after a
later decision."""


def check_history(facts: Sequence[AnyFact], contest: Contest) -> Iterator[Phrase]:
    """Yield each thing in the facts that an honest contest can't have.

    Times are not compared, because a clock may have been corrected: numbers give the order.

    Args:
        facts: all facts in their order.
        contest: the contest that follows from them.
    """
    yield from _gaps(facts)
    yield from _entries(facts)
    yield from _draws(facts)
    for unused in contest.unused:
        if unused.why.code not in _HARMLESS:
            yield say("verify.unused", fact=unused.fact, why=unused.why)


def decisions(facts: Iterable[AnyFact]) -> Iterator[Phrase]:
    """Yield the decisions of people, in words; no check can prove that they are real or right.

    Raises:
        UserError: if the facts name a format or a tie-break that is not known here.
    """
    for one in decided(compute(facts, FORMATS)):
        yield say(
            "verify.decision",
            fact=one.fact,
            what=one.what,
            reason=one.reason or None,
        )


def check_earlier(earlier: Sequence[AnyFact], facts: Sequence[AnyFact]) -> Iterator[Phrase]:
    """Yield the first fact of an earlier publication that is missing or different now, if any."""
    for before, now in zip(earlier, (*facts, *(None,) * len(earlier)), strict=False):
        if before != now:
            yield say("verify.rewritten", fact=before.id)
            return


def call_of(facts: Sequence[AnyFact], played: Played) -> Called | None:
    """Return the call by which a court got a game; None: it was played without a network.

    A call does not count if it was taken back, or if an earlier result ended it.
    """
    call: Called | None = None
    for fact in facts[: facts.index(played)]:
        if isinstance(fact, Called | Recalled | Played) and _game(fact) == _game(played):
            call = fact if isinstance(fact, Called) else None
    return call


def _game(fact: Called | Recalled | Played) -> tuple[str, int]:
    return fact.pairing, fact.game


def files_of(
    facts: Sequence[AnyFact], call: Called | None, played: Played, team: str
) -> tuple[str, ...]:
    """Return the hashes of the files with which a team may have played a game.

    Without a network these are its newest files before the result. At a court they are its newest
    files before the call, or any that it handed in between call and result: a court that lost its
    machine may have been given the game again with newer files.
    """
    began, ended = facts.index(call or played), facts.index(played)
    hashes: list[str] = []
    for at, fact in enumerate(facts[:ended]):
        if isinstance(fact, OfFiles) and fact.team == team:
            hashes = [*hashes, fact.files] if at > began else [fact.files]
    return tuple(hashes)


def _gaps(facts: Sequence[AnyFact]) -> Iterator[Phrase]:
    for number, fact in enumerate(facts, 1):
        if fact.number != number:
            yield say("verify.gap", fact=fact.id, number=number)
            return


def _entries(facts: Sequence[AnyFact]) -> Iterator[Phrase]:
    closed = False
    for fact in facts:
        if isinstance(fact, Closed):
            closed = True
        elif isinstance(fact, Drawn) and not closed:
            yield say("verify.never-closed")
            closed = True
        elif isinstance(fact, Entered) and closed and not fact.reason.strip():
            yield say("verify.entered-late", team=fact.team)
        elif isinstance(fact, FilesChanged) and closed and not fact.reason.strip():
            yield say("verify.no-reason", team=fact.team)


def _draws(facts: Sequence[AnyFact]) -> Iterator[Phrase]:
    """Compute each draw again from the facts before it; yield a phrase for each that differs."""
    for at, fact in enumerate(facts):
        if isinstance(fact, Drawn | RoundDrawn):
            again = due(compute(facts[:at], FORMATS), FORMATS)
            if again is None or not _is_same(again, fact):
                yield say("verify.other-draw", fact=fact.id, stage=fact.stage)


def _is_same(due: Closed | Drawn | RoundDrawn, drawn: Drawn | RoundDrawn) -> bool:
    """Return whether a draw is the one that was due, or has the same teams in another order.

    Another order is right if it follows from the lot, or if the organiser gave a reason for it.
    """
    if isinstance(due, RoundDrawn) and isinstance(drawn, RoundDrawn):
        return (due.stage, due.round, due.pairs) == (drawn.stage, drawn.round, drawn.pairs)
    if not (isinstance(due, Drawn) and isinstance(drawn, Drawn) and due.stage == drawn.stage):
        return False
    match drawn.how:
        case "lot":
            return bool(drawn.lot.strip()) and drawn.entries == by_lot(due.entries, drawn.lot)
        case "hand":
            return bool(drawn.reason.strip()) and sorted(due.entries) == sorted(drawn.entries)
    return due.entries == drawn.entries
