"""A page that shows a match: /watch, /overlay or /replay, as a person sees it."""

import time
from collections.abc import Callable
from typing import Any

from page_client import PageClient
from playwright.sync_api import Locator, Page, expect
from venue import Venue
from waiting import LIMIT_S

from lacoc_shared.seat import Phase

STALE = ".stale"


class Show:
    """A page that shows a match, open in a browser.

    Args:
        page: a new page.
        url: address of the gateway.
        path: the page's path with its query.
        drawn: whether to wait until there is a picture.
    """

    def __init__(self, page: Page, url: str, path: str, *, drawn: bool = True) -> None:
        self.page = page
        page.goto(url + path)
        if drawn:
            self.draws()

    def view(self, what: str, index: int = 0) -> Any:
        """Return a value that the picture's test hook gives; None before there is a picture."""
        return self.page.evaluate(f"window.__lacoc?.views?.[{index}]?.{what}")

    def until(self, condition: Callable[[], Any], otherwise: str) -> None:
        """Wait until a condition is true; after a time limit, fail with the message `otherwise`.

        Playwright's `wait_for_function` does not work here: the pages' policy forbids it.
        """
        end_s = time.monotonic() + LIMIT_S
        while not condition():
            assert time.monotonic() < end_s, otherwise
            self.page.wait_for_timeout(40)

    def find(self, selector: str, **options: Any) -> Locator:
        return self.page.locator(selector, **options)

    def sees(self, selector: str, text: str = "") -> None:
        """Wait until an element is visible and contains the text."""
        expect(self.find(selector).first).to_be_visible()
        if text:
            expect(self.find(selector).first).to_contain_text(text)

    def misses(self, selector: str) -> None:
        """Wait until no element matches the selector."""
        expect(self.find(selector)).to_have_count(0)

    def has_scores(self, *points: int) -> None:
        expect(self.find(".score-bug .points")).to_have_text([str(one) for one in points])

    def draws(self) -> None:
        """Wait until the page has drawn a picture since it was loaded."""
        self.until(lambda: self.view("drawnFrames") or 0, "no picture was drawn")

    def moves(self) -> None:
        """Wait until the picture shows another beat."""
        beat = self.view("drawnBeat")
        self.until(lambda: self.view("drawnBeat") != beat, "the picture stands still")


def violations(page: Page) -> list[tuple[str, list[str]]]:
    """Return the serious accessibility mistakes that axe-core finds, each as rule and elements."""
    import axe_core_python.sync_playwright  # type: ignore[import-not-found,import-untyped]

    # While colours change, axe-core would measure a contrast that nobody sees for long.
    page.evaluate(
        "Promise.allSettled(document.getAnimations()"
        ".filter((one) => Number.isFinite(one.effect.getComputedTiming().endTime))"
        ".map((one) => one.finished))"
    )
    # What is right is not described: on a page with a table that takes most of the time.
    only = {"resultTypes": ["violations"]}
    found = axe_core_python.sync_playwright.Axe().run(page, options=only)["violations"]
    return [
        (one["id"], [node["html"][:200] for node in one["nodes"]])
        for one in found
        if one["impact"] in ("serious", "critical")
    ]


def covered(page: Page, by: str, what: str) -> list[str]:
    """Return the texts of visible elements `what` that an element `by` covers, if only in part."""
    found: list[str] = page.evaluate(
        """([by, what]) => {
          const boxes = (selector) => [...document.querySelectorAll(selector)]
            .filter((one) => one.checkVisibility({ visibilityProperty: true }))
            .map((one) => [one, one.getBoundingClientRect()])
            .filter(([, box]) => box.width && box.height);
          const covers = boxes(by);
          return boxes(what)
            .filter(([one, box]) => covers.some(([cover, other]) => !cover.contains(one)
              && box.left < other.right - 1 && other.left < box.right - 1
              && box.top < other.bottom - 1 && other.top < box.bottom - 1))
            .map(([one]) => one.textContent);
        }""",
        [by, what],
    )
    return found


def broken_names(page: Page) -> list[str]:
    """Return the words of teams' names that are broken inside."""
    found: list[str] = page.evaluate(
        """() => [...document.querySelectorAll(".team-name")].flatMap((one) => {
          const text = one.firstChild;
          return [...text.data.matchAll(/[^\\s-]+/g)].filter(({ 0: word, index }) => {
            const range = document.createRange();
            range.setStart(text, index);
            range.setEnd(text, index + word.length);
            return new Set([...range.getClientRects()].map(({ top }) => top)).size > 1;
          }).map(([word]) => word);
        })"""
    )
    return found


def playing(venue: Venue) -> PageClient:
    """Bring a match of two teams into play, and return the referee's page."""
    venue.contestant("left", "Ants")
    venue.contestant("right", "Bees")
    referee = venue.referee()
    referee.phase(Phase.READY)
    decide(referee, type="start")
    referee.phase(Phase.PLAYING)
    return referee


def decide(referee: PageClient, reason: str = "", **decision: object) -> Any:
    """Make a decision, and return the court's reply."""
    return referee.ask("decide", decision=decision, reason=reason)
