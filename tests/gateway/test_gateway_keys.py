"""Tests of referees' tokens in a contest with keys: its court refuses a wrong token after 2 s."""

import pytest
from page_client import PageClient, Refused
from venue import REFEREE, Venue

from lacoc_server.doors.keys.make import make_keys

pytestmark = pytest.mark.slow

WRONG = "w" * 25
START = {"decision": {"type": "start"}, "reason": ""}


@pytest.fixture
def keyed(venue: Venue) -> Venue:
    """Give a contest with keys, its court in the lobby, and a gateway that has found the court."""
    venue.contest.write_text(venue.contest.read_text().replace("tcp/", ""))
    make_keys(venue.contest, (), renew=False)
    venue.court()
    venue.web()
    page = venue.page()
    page.wait(lambda: page.frame)
    return venue


def refused(page: PageClient, number: int) -> Refused:
    with pytest.raises(Refused) as caught:
        page.reply(number)
    return caught.value


def test_a_wrong_token_is_said_in_a_field(keyed: Venue) -> None:
    """Only the refusal of a wrong token sets the field that keeps a page from asking again."""
    page = keyed.page(keyed.key)
    wrong = refused(page, page.send("enter", token=WRONG, by="Kim"))
    assert wrong.is_the_token
    assert wrong.why.code == "connect.token"
    assert not refused(page, page.send("enter", token=REFEREE, by=" ")).is_the_token
    page.ask("enter", token=REFEREE, by="Kim")


def test_wrong_tokens_delay_no_decision(keyed: Venue) -> None:
    """Checks of wrong tokens take seconds, but they delay no decision of the referee."""
    referee = keyed.referee()
    wrong = [keyed.page(keyed.key) for _ in range(12)]
    tried = {page: [page.send("enter", token=WRONG, by="x") for _ in range(8)] for page in wrong}
    for page, numbers in tried.items():  # seven of eight are refused at once, and one waits
        page.wait(lambda page=page, numbers=numbers: sum(map(page.waits_for, numbers)) <= 1)
    assert refused(referee, referee.send("decide", **START)).why.code == "refused.decision"
    referee.close()
    back = keyed.page(keyed.key)
    back.ask("enter", token=REFEREE, by="Kim")
    # The court refuses the wrong tokens one after another, and needs two seconds for each.
    waiting = sum(page.waits_for(number) for page, numbers in tried.items() for number in numbers)
    assert waiting >= len(wrong) - 2
    said = [refused(page, number).why.code for page, numbers in tried.items() for number in numbers]
    assert said.count("connect.token") == len(wrong)
    assert said.count("gateway.too-much") == len(wrong) * 7
