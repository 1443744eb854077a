"""Tests of a gateway that knows nothing but the address of other pages."""

import json
import urllib.request

import pytest
from page_client import PageClient
from venue import TOKENS, Process, Venue
from waiting import LIMIT_S, until

pytestmark = pytest.mark.slow


def test_a_gateway_without_secrets_shows_all_courts_and_the_contest(venue: Venue) -> None:
    """With a link, a second gateway serves the same courts and the newest sheet of the contest."""
    sheet = venue.contest.with_suffix(".json")
    sheet.write_text('{"stages": []}')
    venue.court()
    venue.web()
    second = Process(venue.folder, "web", venue.url, "--json", name="second")
    try:
        url = second.opened["url"]

        def contest() -> object:
            with urllib.request.urlopen(f"{url}/contest.json", timeout=LIMIT_S) as answer:
                return json.load(answer)

        until(lambda: contest() == {"stages": []})
        sheet.write_text('{"stages": [1]}')
        until(lambda: contest() == {"stages": [1]})
        with PageClient(url, token=TOKENS["left"]) as page:
            assert page.welcome["courts"] == ["main"]
            page.ask("join", seat="left", token=TOKENS["left"], name="Ants")
            page.wait(lambda: page.frame is not None)
    finally:
        second.close()
