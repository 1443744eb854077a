"""Tests of what the terminal of an organiser says of a contest."""

from random import Random

from chance_event import Event
from cup import Cup

from lacoc_server.contest.league.facts import (
    Called,
    Closed,
    Drawn,
    Moved,
    NoShow,
    Paused,
    Planned,
    Played,
    Recalled,
    Shifted,
    Unshifted,
)
from lacoc_server.contest.league.timetable.calling import SeenCourt
from lacoc_server.contest.league.timetable.steered import MINUTE_MS
from lacoc_server.contest.league.timetable.ticker import Ticker
from lacoc_server.contest.league.timetable.whereabouts import ContestPace, OfficeKnowledge
from lacoc_shared.words import Phrase, render, say

PACE = ContestPace(now_ms=0, game_ms=1, least_rest_ms=0)
TEAMS = ("t001", "t002")


class Terminal:
    """The terminal of a contest's organiser."""

    def __init__(self, event: Event) -> None:
        self.event = event
        self.seen: dict[str, SeenCourt] = {}
        self.held: dict[tuple[str, int], Phrase] = {}
        self._ticker = Ticker(event.facts)

    def lines(self) -> list[str]:
        """Return the newest lines, in English."""
        known = OfficeKnowledge(self.seen, PACE, self.held)
        said = self._ticker.newest(self.event.contest, self.event.facts, known)
        return [render(one) for one in said]


def test_a_contest_is_told_line_by_line() -> None:
    """Each draw, call and result has a line, once; what was before the start has none."""
    event = Event(2, 1, Random(1))
    terminal = Terminal(event)
    event.add(Closed)
    event.begin("cup", "single-knockout", event.names, games=3)
    assert terminal.lines() == [
        "Entries are closed: 2 teams take part.",
        "Knockout is drawn: 2 teams.",
    ]
    about = {"pairing": "cup:w1.1", "game": 1, "teams": TEAMS}
    event.add(Called, court="red", **about)
    assert terminal.lines() == ["Court red: t001 – t002 is called. Final, game 1 of 3."]
    event.add(Played, scores=(0, 0), outcome="void", **about)
    event.add(Played, scores=(9, 4), outcome="left", **about)
    assert terminal.lines() == [
        "Void, to be played again: t001 – t002. Final, game 1 of 3.",
        "Result: t001 9 : 4 t002. Final, game 1 of 3.",
    ]
    late = (say("health.late-beat", late_ms=300.0, most_ms=200.0),)
    event.add(Played, **{**about, "game": 2, "scores": (9, 4), "outcome": "left", "advice": late})
    *_, result, over = terminal.lines()
    assert result.endswith("Decide on /office.")
    assert render(late[0]) in result
    assert over == "The contest is over."
    assert terminal.lines() == []


def test_a_decision_is_told_with_its_reason_and_who_made_it() -> None:
    """What somebody of the staff decides has one line; a draw by hand has that of a draw."""
    event = Event(2, 1, Random(1))
    event.add(Planned, stage="cup", format="single-knockout", draw="organiser")
    event.add(Closed)
    terminal = Terminal(event)
    terminal.lines()
    drawn = {"stage": "cup", "entries": tuple(event.names), "how": "hand", "reason": "by seeds"}
    event.add(Drawn, **drawn)
    assert terminal.lines() == ["Knockout is drawn: 2 teams."]
    event.add(NoShow, pairing="cup:w1.1", team=TEAMS[0], reason="not seen", by="Kubota")
    assert terminal.lines()[0] == ("Decided by Kubota: Final: t001 did not come. Reason: not seen")
    assert "Decided" not in "".join(terminal.lines())


def test_what_steers_the_day_is_told_once() -> None:
    """A pause, a shift and a move have a line each, with who made it; a shift back says by what."""
    cup = Cup()
    terminal = Terminal(cup)
    terminal.lines()
    cup.add(Paused, by="Kubota")
    assert terminal.lines()[0].startswith("Kubota: Paused: no game is called.")
    shift = cup.add(Shifted, by_ms=15 * MINUTE_MS)
    assert terminal.lines() == ["All that is to come is later by 15 minutes."]
    cup.add(Unshifted, shift=shift.id)
    assert terminal.lines()[0].startswith("The 15 minutes are taken back")
    cup.add(Moved, pairing="cup:a1.1", court="red")
    assert terminal.lines()[0].endswith("is moved to court red.")
    assert terminal.lines() == []


def test_a_draw_that_waits_is_told() -> None:
    """The organiser is told once which stage waits, and then that it is drawn."""
    event = Event(2, 1, Random(1))
    event.add(Planned, stage="cup", format="single-knockout", draw="organiser")
    terminal = Terminal(event)
    assert terminal.lines() == []
    event.add(Closed)
    assert "Knockout waits for you" in terminal.lines()[-1]
    assert terminal.lines() == []
    event.add(Drawn, stage="cup", entries=tuple(event.names))
    assert terminal.lines() == ["Knockout is drawn: 2 teams."]


def test_a_court_that_is_lost_and_comes_back_is_told() -> None:
    """A court that was never there is not lost; one that is back is told once."""
    terminal = Terminal(Cup())
    terminal.seen = {"red": SeenCourt(0), "blue": SeenCourt(0, there=True)}
    assert terminal.lines() == []
    terminal.seen = {"red": SeenCourt(0, there=True), "blue": SeenCourt(0)}
    assert terminal.lines() == ["Court blue does not answer any more."]
    assert terminal.lines() == []
    terminal.seen = {"red": SeenCourt(0, there=True), "blue": SeenCourt(0, there=True)}
    assert terminal.lines() == ["Court blue is back."]


def test_a_game_that_a_court_refuses_is_told() -> None:
    """The line says why; a game that is only taken back has no line."""
    cup = Cup()
    terminal = Terminal(cup)
    cup.add(Recalled, pairing="cup:a1.1", game=1, reason="moved")
    terminal.held = {("cup:a1.1", 1): say("event.void")}
    (line,) = terminal.lines()
    assert line.startswith(
        "The office holds this game back, because its court refuses it: Round robin"
    )
    assert line.endswith(render(say("event.void")))
    assert terminal.lines() == []
