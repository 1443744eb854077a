"""Tests of a gateway's metrics and log, with a real court and pages without a browser."""

import json
import urllib.request

import pytest
from page_client import Refused, refusal
from prometheus_client.parser import text_string_to_metric_families
from venue import REFEREE, TOKENS, Venue
from waiting import LIMIT_S

pytestmark = pytest.mark.slow


def scrape(url: str) -> dict[str, float]:
    with urllib.request.urlopen(url, timeout=LIMIT_S) as reply:
        text = reply.read().decode()
    return {
        sample.name.removeprefix("lacoc_gateway_"): sample.value
        for family in text_string_to_metric_families(text)
        for sample in family.samples
    }


def test_a_scrape_and_the_log_of_a_gateway(venue: Venue) -> None:
    """Metrics count viewers and frames; the log has joins, refusals and leaves, but no token."""
    court = venue.court()
    web = venue.web("--metrics", "127.0.0.1:0", "--viewers", "1")
    url = web.opened["metrics"]
    watching = venue.page()
    watching.wait(lambda: watching.frame is not None and watching.frame.beat > 20)
    left = venue.contestant("left", "Ants")
    referee = venue.page(venue.key)
    with pytest.raises(Refused):
        referee.ask("enter", token="not the token", by="Kim")
    referee.ask("enter", token=REFEREE, by="Kim")
    with refusal("gateway.full"):
        venue.page()
    found = scrape(url)
    assert (found["viewers"], found["connected"], found["sent_away_total"]) == (3, 1, 1)
    assert found["frames_sent_total"] > 0
    assert found["frames_dropped_total"] >= 0
    left.close()
    court.kill()
    referee.wait(lambda: not referee.link["connected"])
    after = scrape(url)
    assert (after["viewers"], after["connected"]) == (2, 0)
    assert after["frames_sent_total"] >= found["frames_sent_total"]
    web.process.terminate()
    out, _ = web.process.communicate(timeout=LIMIT_S)
    lines = [json.loads(line) for line in out.splitlines()]
    told = {line["text"]: line for line in lines}
    assert told["Court main sends frames."]["connected"] is True
    assert told["Seat left: held."]["seat"] == "left"
    assert told["Kim sits down as a referee."]["page"].startswith("127.0.0.1:")
    assert "Refused: This is not a referee's token of this court." in told
    assert "The page of seat left has gone." in told
    assert told["Court main is silent."]["connected"] is False
    assert court.opened["match_id"] in {line["match_id"] for line in lines}
    assert not any(token in out for token in (*TOKENS.values(), REFEREE, "not the token"))
