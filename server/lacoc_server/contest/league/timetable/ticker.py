"""Puts what happens in a contest into lines for the terminal of its organiser; pure."""

from collections.abc import Iterator, Mapping, Sequence

from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.decided import decided
from lacoc_server.contest.league.facts import (
    AnyFact,
    Called,
    Closed,
    Drawn,
    Moved,
    OfDay,
    Played,
    RoundDrawn,
)
from lacoc_server.contest.league.fixture import named
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.timetable.calling import SeenCourt
from lacoc_server.contest.league.timetable.schedule import waits_for_organiser
from lacoc_server.contest.league.timetable.steered import steered
from lacoc_server.contest.league.timetable.whereabouts import OfficeKnowledge
from lacoc_server.contest.league.titles import title
from lacoc_shared.words import Phrase, say


class Ticker:
    """Makes one line for each draw, game and decision, and when a court falls silent or returns.

    Args:
        facts: the facts that the contest has already; they give no lines.
    """

    def __init__(self, facts: Sequence[AnyFact]) -> None:
        self._told = len(facts)
        self._there: dict[str, bool] = {}
        """By court: whether it answered last time; a court that never answered is left out."""
        self._held: set[tuple[str, int]] = set()
        self._over = False
        self._to_draw = ""
        self._before: Contest | None = None
        """The contest of the last call; None: this is the first."""

    def newest(
        self, contest: Contest, facts: Sequence[AnyFact], known: OfficeKnowledge
    ) -> Iterator[Phrase]:
        """Yield lines for what has happened since the last call.

        Args:
            contest: the contest as it is now.
            facts: its facts, in their order.
            known: what the office knows besides the facts.
        """
        yield from self._courts(known.seen)
        if self._told < len(facts):
            decisions = {one.fact: one for one in decided(contest)}
        for fact in facts[self._told :]:
            if isinstance(fact, OfDay | Moved):
                what = steered(self._before or contest, fact)
                yield say("news.steered", what=what, by=fact.by or None)
            elif (said := _said(contest, fact)) is not None:
                yield said
            elif one := decisions.get(fact.id):
                reason, by = one.reason or None, one.by or None
                yield say("news.decided", what=one.what, reason=reason, by=by)
        self._told, self._before = len(facts), contest
        for (pairing, game), why in known.held.items():
            if (pairing, game) not in self._held:
                yield say("news.refused", match=named(contest, pairing, game), why=why)
        self._held = {*known.held}
        waiting = waits_for_organiser(contest, FORMATS)
        to_draw = "" if waiting is None else waiting.stage
        if to_draw and to_draw != self._to_draw:
            yield say("news.to-draw", stage=title(contest, to_draw))
        self._to_draw = to_draw
        if contest.over and not self._over:
            yield say("news.over")
        self._over = contest.over

    def _courts(self, seen: Mapping[str, SeenCourt]) -> Iterator[Phrase]:
        for court, one in seen.items():
            was_there = self._there.get(court)
            if one.there or was_there is not None:
                self._there[court] = one.there
            if was_there and not one.there:
                yield say("news.court-lost", court=court)
            elif was_there is False and one.there:
                yield say("news.court-back", court=court)


def _said(contest: Contest, fact: AnyFact) -> Phrase | None:
    """Put a fact into words for the organiser; None: it is a decision, or needs no line."""
    match fact:
        case Closed():
            here = contest.here
            return say("news.closed", teams=here)
        case Drawn():
            return say("news.drawn", stage=title(contest, fact.stage), teams=len(fact.entries))
        case RoundDrawn():
            return say("news.round", stage=title(contest, fact.stage), round=fact.round)
        case Called():
            left, right = fact.teams
            said = named(contest, fact.pairing, fact.game)
            return say("news.called", court=fact.court, match=said, left=left, right=right)
        case Played():
            left, right = fact.teams
            points, conceded = fact.scores
            said = named(contest, fact.pairing, fact.game)
            if fact.outcome == "void":
                return say("news.void", match=said, left=left, right=right)
            return say(
                "news.played",
                match=said,
                left=left,
                right=right,
                points=points,
                conceded=conceded,
                reasons=fact.advice or None,
            )
    return None
