"""What an organiser's facts of the day have changed, in words; pure."""

from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.facts import (
    Announced,
    AnyFact,
    Moved,
    Paused,
    Resumed,
    Shifted,
    Substituted,
    Undrawn,
    Unshifted,
)
from lacoc_server.contest.league.fixture import named
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.timetable.foreseen import foreseen
from lacoc_server.contest.league.titles import title
from lacoc_shared.words import Phrase, say

MINUTE_MS = 60_000


def steered(contest: Contest, fact: AnyFact) -> Phrase:
    """Say what an organiser's fact has changed: for example a move, a pause or an announcement.

    Args:
        contest: the contest before the fact was appended.
        fact: the fact.
    """
    match fact:
        case Moved():
            return _moved(contest, fact)
        case Paused():
            return say("day.paused")
        case Resumed():
            return say("day.goes-on")
        case Shifted():
            return say("day.shifted", minutes=round(fact.by_ms / MINUTE_MS))
        case Unshifted():
            by_ms = contest.shifted.by_ms if contest.shifted is not None else 0
            return say("day.unshifted", minutes=round(by_ms / MINUTE_MS))
        case Announced():
            return say("day.announced") if fact.text else say("day.announced-nothing")
        case Substituted():
            return say("decided.substituted", team=fact.team, substitute=fact.substitute)
        case Undrawn():
            return say("day.undrawn", stage=title(contest, fact.stage))
    raise TypeError(type(fact).__name__)


def _moved(contest: Contest, fact: Moved) -> Phrase:
    """Say which match was moved. Name its teams if they are known, as a round has many matches."""
    coming = {one.pairing.id: one for one in foreseen(contest, FORMATS)}
    one = coming.get(fact.pairing)
    what = one.fixture if one is not None else named(contest, fact.pairing)
    match = one.match if one is not None else contest.matches.get(fact.pairing)
    left, right = match.seated if match is not None else (None, None)
    teams = (left, right) if left and right else (None, None)
    court = fact.court or None
    return say("desk.moved", match=what, left=teams[0], right=teams[1], court=court)
