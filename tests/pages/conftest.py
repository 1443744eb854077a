"""Gives tests a browser and its pages."""

import re
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from chromium import SLOW_SCREEN, NoBrowser, OpenPage, build_pages, chromium
from contestant import Contestant, Sit
from playwright.sync_api import (
    Browser,
    BrowserContext,
    ConsoleMessage,
    Error,
    Page,
    expect,
)
from venue import Venue
from waiting import LIMIT_MS

expect.set_options(timeout=LIMIT_MS)


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """Give Chromium, which draws in software."""
    with ExitStack() as stack:
        try:
            browser = stack.enter_context(chromium())
        except NoBrowser as why:
            pytest.fail(str(why), pytrace=False)
        yield browser


@pytest.fixture(scope="session")
def built_pages() -> Path:
    """Give the folder of the pages, built from the current source."""
    return build_pages()


class Console:
    """Collects the errors in the pages' consoles, and knows which of them a test expects."""

    def __init__(self) -> None:
        self.errors: list[str] = []
        self._expected: list[re.Pattern[str]] = []

    def expect(self, pattern: str) -> None:
        """Expect errors that match a pattern, for instance because the test ends a gateway."""
        self._expected.append(re.compile(pattern))

    def expect_a_break(self) -> None:
        """Expect what a browser logs while a gateway is away.

        A page asks what stands in its way: a gateway that came back meanwhile answers 426.
        """
        self.expect("WebSocket|ERR_CONNECTION|ERR_INTERNET_DISCONNECTED|status of 426")

    def watch(self, page: Page) -> None:
        """Collect the errors of a page."""
        page.on("console", self._said)
        page.on("pageerror", self._raised)

    def unexpected(self) -> list[str]:
        """Return the errors that the test does not expect."""
        return [text for text in self.errors if not any(p.search(text) for p in self._expected)]

    def _said(self, message: ConsoleMessage) -> None:
        if message.type == "error":
            self.errors.append(f"{message.text} ({message.location.get('url', '')})")

    def _raised(self, error: Error) -> None:
        self.errors.append(f"{error.name}: {error.message}\n{error.stack}")


@pytest.fixture
def console() -> Iterator[Console]:
    """Give the consoles of all pages of a test; an unexpected error in one fails the test."""
    console = Console()
    yield console
    assert console.unexpected() == []


@pytest.fixture
def slow_screen() -> bool:
    """Give True, which limits pages to about two pictures a second.

    Tests of the drawing override this fixture with False.
    """
    return True


@pytest.fixture
def servers() -> Iterator[ExitStack]:
    """Give a stack for servers of pages; it ends after the pages are closed, so no page sees it."""
    with ExitStack() as stack:
        yield stack


@pytest.fixture
def open_page(
    browser: Browser, console: Console, slow_screen: bool, servers: ExitStack
) -> Iterator[OpenPage]:
    """Give a function that opens pages, each in a fresh browser context, like another person's."""
    contexts: list[BrowserContext] = []

    def opened(**options: Any) -> Page:
        options.setdefault("viewport", {"width": 800, "height": 450})
        options.setdefault("locale", "en-GB")
        context = browser.new_context(**options)
        context.set_default_timeout(LIMIT_MS)
        if slow_screen:
            context.add_init_script(SLOW_SCREEN)
        contexts.append(context)
        page = context.new_page()
        console.watch(page)
        return page

    yield opened
    for context in contexts:
        context.close()


@pytest.fixture
def page(open_page: OpenPage) -> Page:
    """Give a page of 800 x 450 pixels."""
    return open_page()


@pytest.fixture
def venue(tmp_path: Path, built_pages: Path) -> Iterator[Venue]:
    """Give a contest whose court and gateway do not run yet."""
    with ExitStack() as stack:
        yield Venue(tmp_path, stack)


@pytest.fixture
def sit(open_page: OpenPage) -> Sit:
    """Give a function that makes a contestant's page for a gateway: `sit(url, locale="ja-JP")`."""
    return lambda url, **options: Contestant(open_page, url, **options)
