"""A link that breaks after a request has come to the court, and is there again at once."""

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from types import SimpleNamespace

import pytest
from court_stub import TOKENS, WHISTLE, CourtStub
from slow_link import SlowLink
from waiting import LIMIT_S, until

from lacoc_client.play import asking
from lacoc_client.play.asking import NoAnswer
from lacoc_client.play.controller import Controller, Hold
from lacoc_client.play.referee import RefereeClient
from lacoc_shared.decisions import Adjust
from lacoc_shared.inputs import Decide, Input, JoinSeat, LeaveSeat
from lacoc_shared.messages import Outcome
from lacoc_shared.network.session import Session, open_client

Breaking = Callable[[type[Input]], tuple[CourtStub, Session]]


class _BreakingCourt(CourtStub):
    """Breaks the link once, when it has done a request of a kind and not answered it yet."""

    def __init__(self, kind: type[Input]) -> None:
        super().__init__()
        self._kind = kind
        self._link: SlowLink | None = None

    @contextmanager
    def link(self) -> Iterator[SlowLink]:
        with SlowLink(self.address) as link:
            self._link = link
            yield link

    def _apply(self, one: Input, beat: int) -> Outcome:
        outcome = super()._apply(one, beat)
        if isinstance(one, self._kind) and self._link is not None:
            self._link.cut()
            self._link.mend()
            self._link = None
        return outcome


@pytest.fixture
def breaking(monkeypatch: pytest.MonkeyPatch) -> Iterator[Breaking]:
    """Return a function that runs such a court, and connects to it over the link.

    Whoever has no answer is connected again before it looks at its link, as on a fast network.
    """
    with ExitStack() as stack:

        def run(kind: type[Input]) -> tuple[CourtStub, Session]:
            court = stack.enter_context(_BreakingCourt(kind))
            link = stack.enter_context(court.link())
            session = stack.enter_context(open_client([link.address]))
            first = session.links()
            quick = SimpleNamespace(
                monotonic=time.monotonic,
                sleep=lambda _: until(lambda: session.links() not in ((), first)),
            )
            monkeypatch.setattr(asking, "time", quick)
            monkeypatch.setattr(asking, "_COMING_BACK_S", LIMIT_S)
            return court, session

        yield run


def count(court: CourtStub, kind: type[Input]) -> int:
    return sum(isinstance(one, kind) for one in court.inputs)


def test_a_decision_is_made_once(breaking: Breaking) -> None:
    """The referee is told that no answer came; the decision is not sent again."""
    court, session = breaking(Decide)
    with pytest.raises(NoAnswer):
        RefereeClient(session, "main", WHISTLE).decide(Adjust("left", 5), "", "Kubota")
    assert count(court, Decide) == 1


def test_a_seat_that_was_given_up_is_not_taken_again(breaking: Breaking) -> None:
    """The court's health shows that the seat is free, and the controller does not join again."""
    court, session = breaking(LeaveSeat)
    one = Controller(session, "main", "left", TOKENS["left"], "Blue")
    one.join()
    with pytest.raises(NoAnswer):
        one.leave()
    until(lambda: one.wait_frame(0.1) and one.hold is Hold.LEFT)
    assert (count(court, JoinSeat), count(court, LeaveSeat)) == (1, 1)


def test_a_join_is_sent_again(breaking: Breaking) -> None:
    """To take a seat twice does no harm, so whoever joins does not notice the break."""
    court, session = breaking(JoinSeat)
    one = Controller(session, "main", "left", TOKENS["left"], "Blue")
    one.join()
    assert one.hold is Hold.HELD
    assert count(court, JoinSeat) == 2
