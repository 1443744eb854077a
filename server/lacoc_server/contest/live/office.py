"""The office of a contest: it gives courts their games, and appends their results to the facts.

It stores no state of its own: what it needs after a restart is in the facts and at the courts. So
it can be killed at any moment: started again, it reads the facts, asks the courts what they have,
and goes on.
"""

import math
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache

from lacoc_server.contest.headless.play import outcome
from lacoc_server.contest.kept.entries import EntryFolder
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.contest import TEAMS_LEAST, Contest, Newest
from lacoc_server.contest.league.facts import AnyFact, Called, Recalled, new
from lacoc_server.contest.league.fixture import fixture
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.timetable.calling import (
    GameEnd,
    SeenCourt,
    calls,
    is_open_call,
    results,
    taken_back,
    wanted,
    why_recalled,
)
from lacoc_server.contest.league.timetable.schedule import due, waits_for_organiser
from lacoc_server.contest.league.timetable.whereabouts import OfficeKnowledge
from lacoc_server.contest.live.court_link import Asked, CourtLink
from lacoc_server.contest.live.open_matches import OpenMatches
from lacoc_server.contest.live.teller import Teller
from lacoc_shared.contest.tokens import lasting_hash
from lacoc_shared.messages import Done, Refusal
from lacoc_shared.messages.office import AssignedSeat, call_is_over
from lacoc_shared.seat import Phase
from lacoc_shared.words import Phrase

_SEATS = ("left", "right")
_AGAIN_S = 1.0
_PLAYED = (Phase.COUNTDOWN, Phase.PLAYING, Phase.HALTED, Phase.FINISHED)
_BEGUN = (*_PLAYED, Phase.OFFICIAL, Phase.VOID)


class Office:
    """Runs a contest at its courts; one thread calls `step` again and again.

    Args:
        store: the facts.
        entries: the files of the teams, as they were weighed in.
        token_of: returns a team's token.
        links: the courts by name, in the order in which they get games; None: a court that is not
            connected yet.
        addresses: the courts' addresses for contestants, by name.
        least_rest_ms: shortest time between two matches of a team.
        draw_from_ms: when the office closes entries and draws the first stage, in milliseconds
            since 1970, UTC; None: it waits until somebody closes entries.
        open_matches: gives open matches to the courts that have no game; None: nobody does.
        applicants: returns the names of the teams that wait for the organiser.
    """

    def __init__(
        self,
        store: FactStore,
        entries: EntryFolder,
        token_of: Callable[[str], str],
        links: Mapping[str, CourtLink | None],
        addresses: Mapping[str, str],
        least_rest_ms: int = 0,
        draw_from_ms: int | None = 0,
        open_matches: OpenMatches | None = None,
        applicants: Callable[[], tuple[str, ...]] = tuple,
    ) -> None:
        self._store = store
        self._newest = Newest(FORMATS)
        self._entry = cache(entries.load)
        self._hash_of = cache(lambda team: lasting_hash(token_of(team)))
        self._links = dict(links)
        self._addresses = dict(addresses)
        self._open_matches = open_matches
        self._teller = Teller(
            self._links, self._addresses, token_of, least_rest_ms, open_matches, applicants
        )
        self._least_rest_ms = least_rest_ms
        self._draw_from_ms = draw_from_ms
        self._heard_s: dict[str, float] = {}
        """By court: when it last told what it has. Times in seconds are of `time.monotonic`: the
        machine's clock may be set."""
        self._since_s = time.monotonic()
        """When this office began to listen; a court that was silent before keeps its game."""
        self._asked: dict[str, Asked[Done]] = {}
        """Assignments that are not answered yet, by the id of the call."""
        self._asked_s: dict[str, float] = {}
        """By id of the call: when a court was last asked about it."""
        self.held: dict[tuple[str, int], Phrase] = {}
        """Games that a court refused for good, by pairing and number, with the reason."""
        self._held_files: dict[tuple[str, int], tuple[str, ...]] = {}
        """By game in `held`: hashes of the files with which it was refused."""
        self.contest: Contest = self._compute()
        self.known = OfficeKnowledge({name: SeenCourt(0) for name in links}, self._teller.pace, {})
        """What the office knew at the newest step; any thread may read it."""

    @property
    def facts(self) -> Sequence[AnyFact]:
        """The facts as of the newest step, in their order."""
        return self._facts

    @property
    def expected(self) -> Mapping[str, tuple[str, int]]:
        """Where and when the next matches will probably begin, by pairing; in full minutes."""
        return self._teller.expected

    @property
    def over(self) -> bool:
        """Whether nothing is left to play or to draw."""
        return self.contest.over

    @property
    def is_superseded(self) -> bool:
        """Whether the office went on at another machine, and a court has told so."""
        return any(link.is_superseded for link in self._links.values() if link is not None)

    def connect(self, court: str, link: CourtLink, address: str) -> None:
        """Use another connection to a court from now on.

        Args:
            court: the court's name.
            link: the connection.
            address: the court's address for contestants.
        """
        self._links[court] = link
        self._addresses[court] = address

    def expect(self, court: str) -> None:
        """Treat a court as heard now, because it is being opened: so its game is not taken back."""
        self._heard_s[court] = time.monotonic()

    def step(self) -> None:
        """Read the states of all courts, and do what follows.

        That is: append results and draws, take games back, and call the next ones.

        Raises:
            UserError: if the facts can't be read or written, or a team's file has changed since
                it was weighed in.
        """
        now_ms = _now_ms()
        seen = {name: self._look(name, link, now_ms) for name, link in self._links.items()}
        self.contest = self._compute()  # another program may have appended facts
        refused = self._answers()
        self._retry()
        self._append(lambda contest: [*refused, *results(contest, seen)])
        while self._may_draw(now_ms) and _draws(self.contest):
            self._append(_draws)
        since_ms = _wall_ms(self._since_s, now_ms)
        self._append(lambda contest: taken_back(contest, seen, now_ms, since_ms))
        now_ms = _now_ms()  # a result of this step ended before it, and its teams rest
        self._append(lambda contest: calls(contest, seen, now_ms, self._least_rest_ms, self.held))
        for call in wanted(self.contest, seen):
            link = self._links.get(call.court)
            if link is not None and link.call is not None and self._may_ask(call.id):
                self._asked[call.id] = self._assign(link, call)
        self._take_back()
        self._fill()
        self._teller.tell(self.contest, self._facts, seen, now_ms)
        self.known = OfficeKnowledge(seen, self._teller.pace, dict(self.held))

    def _may_draw(self, now_ms: int) -> bool:
        """Return whether the office may draw.

        It may if entries are closed, or if it is time to close them and at least two teams are in.
        """
        if self.contest.closed:
            return True
        over = self._draw_from_ms is not None and now_ms >= self._draw_from_ms
        return over and self.contest.here >= TEAMS_LEAST

    def _look(self, name: str, link: CourtLink | None, now_ms: int) -> SeenCourt:
        if link is None:
            return SeenCourt(self._heard_ms(name, now_ms), begun=None)
        link.poll()
        phase = link.phase
        if phase is not None:  # a court that can't be understood would keep its game forever
            self._heard_s[name] = time.monotonic()
        ended = None
        if (result := link.result) is not None:
            left, right = result.scores
            who = outcome(_SEATS, result.outcome)
            ended = GameEnd((left, right), who, f"{result.match_id}.mcap", result.advice)
        begun, there = None if phase is None else phase in _BEGUN, link.is_there
        heard_ms, call = self._heard_ms(name, now_ms), link.call or ""
        return SeenCourt(heard_ms, call, begun, ended, there, link.missing)

    def _heard_ms(self, name: str, now_ms: int) -> int:
        """Return when a court was heard last, in milliseconds since 1970, UTC; 0: never."""
        return _wall_ms(self._heard_s[name], now_ms) if name in self._heard_s else 0

    def _append(self, follows: Callable[[Contest], Iterable[AnyFact]]) -> None:
        """Append the facts that `follows` returns for the newest contest.

        `follows` is first called with the contest known here. Only if it returns facts, it is
        called again with the newest contest, which includes facts of other programs. Only the facts
        of the second call are appended.
        """
        if [*follows(self.contest)]:
            self._store.decide(lambda facts: follows(self._newest.of(facts)))
            self.contest = self._compute()

    def _compute(self) -> Contest:
        self._facts = self._store.facts()
        return self._newest.of(self._facts)

    def _answers(self) -> list[AnyFact]:
        """Read the courts' answers.

        Return facts that take back the games that a court refused for good. A game whose call is
        over at the court is not held back: with another call the court can play it.
        """
        running = {call.id: call for call in self.contest.running}
        back: list[AnyFact] = []
        for call_id, asked in [*self._asked.items()]:
            if (answer := asked.take()) is None:
                continue
            del self._asked[call_id]
            call = running.get(call_id)
            if call is None or not isinstance(answer, Refusal) or answer.again:
                continue
            if answer.why != call_is_over(call_id):
                self.held[call.pairing, call.game] = answer.why
                self._held_files[call.pairing, call.game] = self._files(call.pairing)
            back.append(new(Recalled, pairing=call.pairing, game=call.game, reason="court refused"))
        return back

    def _retry(self) -> None:
        """Hold back no game any more whose teams have other files than those that were refused."""
        for game, files in [*self._held_files.items()]:
            if self._files(game[0]) != files:
                del self.held[game], self._held_files[game]

    def _files(self, pairing: str) -> tuple[str, ...]:
        """Return the hashes of the present files of a match's teams."""
        files = {team.name: team.files for team in self.contest.teams}
        match = self.contest.matches.get(pairing)
        return tuple(files.get(team or "", "") for team in (match.teams if match else ()))

    def _assign(self, link: CourtLink, call: Called) -> Asked[Done]:
        view = next(
            view
            for view in self.contest.stages
            if any(match.pairing.id == call.pairing for match in view.matches)
        )
        match = next(match for match in view.matches if match.pairing.id == call.pairing)
        files = {team.name: team.files for team in self.contest.teams}
        seats = []
        for seat, (name, team) in enumerate(zip(_SEATS, call.teams, strict=True)):
            join = self._entry(files[team]).join(seat, team)
            seats.append(
                AssignedSeat(
                    id=name,
                    team=team,
                    token_hashes=(self._hash_of(team),),
                    robot=join.robot,
                    postures=join.postures,
                    locomotion=join.locomotion,
                )
            )
        return link.assign(
            call.id,
            fixture(self.contest, view, match, call.game, stands=True),
            seats,
            arena=view.plan.arena,
            arena_settings=view.plan.arena_settings,
            limits=view.plan.limits,
        )

    def _take_back(self) -> None:
        """Withdraw matches from courts that should not have them any more, also matches in play."""
        running = {call.id for call in self.contest.running}
        for link in filter(None, self._links.values()):
            call = link.call
            begun = link.phase in _PLAYED
            is_fine = call in running or (
                self._open_matches is not None and is_open_call(call or "")
            )
            is_open = begun or link.phase in (Phase.LOBBY, Phase.READY)
            if call and is_open and not is_fine and self._may_ask(call):
                why = why_recalled(self.contest, self._facts, call)
                self._asked[call] = link.withdraw(call, begun=begun, why=why)

    def _fill(self) -> None:
        """Give open matches to the courts that have no game."""
        busy = {call.court for call in self.contest.running}
        for name, link in self._links.items():
            if link is not None and name not in busy and self._open_matches is not None:
                self._open_matches.look(link, time.monotonic())

    def _may_ask(self, call: str) -> bool:
        """Return whether the office may ask a court about a call now: at most once a second."""
        now_s = time.monotonic()
        if call in self._asked or now_s - self._asked_s.get(call, -math.inf) < _AGAIN_S:
            return False
        self._asked_s[call] = now_s
        return True


def _draws(contest: Contest) -> list[AnyFact]:
    """Return the fact of the next draw if it does not wait for the organiser; else nothing."""
    draw = None if waits_for_organiser(contest, FORMATS) else due(contest, FORMATS)
    return [] if draw is None else [draw]


def _now_ms() -> int:
    return time.time_ns() // 1_000_000


def _wall_ms(at_s: float, now_ms: int) -> int:
    """Return a time of `time.monotonic` in milliseconds since 1970, by the clock as it is now."""
    return now_ms - round(1000 * (time.monotonic() - at_s))
