"""Runs a court and a gateway, each in a process of its own."""

from contextlib import ExitStack
from pathlib import Path

from contest_tokens import keep_tokens
from lacoc_process import ALONE, Running, environment
from page_client import PageClient
from ports import free_port

TOKENS = {"left": "l" * 26, "right": "r" * 26}
REFEREE = "w" * 26


class Venue:
    """A contest of one court; the court and the gateway have the same ports after each start."""

    def __init__(self, folder: Path, stack: ExitStack) -> None:
        self.folder = folder
        self._stack = stack
        self.court_port, self.web_port = free_port(), free_port()
        self.url = f"http://127.0.0.1:{self.web_port}"
        self.key = ""
        self.contest = folder / "contest.toml"
        self.contest.write_text(
            f'[court.main]\narena = "othello"\nlisten = ["tcp/127.0.0.1:{self.court_port}"]\n'
            "settings.match.countdown_s = 1.0\n"
        )
        keep_tokens(self.contest, TOKENS, REFEREE)

    def court(self, *words: str) -> Running:
        """Start the court."""
        return self.started(ALONE, str(self.contest), "--json", *words, name="court")

    def web(self, *words: str) -> Running:
        """Start the gateway."""
        where = ("--contest", str(self.contest), "--listen", f"127.0.0.1:{self.web_port}")
        web = self.started("web", "--json", *where, *words, name="web")
        assert web.opened["url"] == self.url or "--pages" in words
        self.key = web.opened["key"]
        return web

    def page(self, key: str | None = None, **options: object) -> PageClient:
        """Open a page; it closes with the test."""
        page = PageClient(self.url, key, **options)
        self._stack.callback(page.close)
        return page

    def contestant(self, seat: str, name: str = "") -> PageClient:
        """Open a page that takes a seat and says ready."""
        page = self.page(token=TOKENS[seat], hz=50)
        page.ask("join", seat=seat, token=TOKENS[seat], name=name or seat.title())
        page.ask("ready", ready=True)
        return page

    def referee(self, by: str = "Kim") -> PageClient:
        """Open a page that enters as a referee."""
        page = self.page(token=REFEREE)
        page.wait(lambda: page.link.get("connected"))  # a gateway may just have been started
        page.ask("enter", token=REFEREE, by=by)
        return page

    def started(self, *words: str, name: str) -> Running:
        """Start a process with a log; it ends with the test."""
        log = self.folder / f"{name}.log"
        running = Running(*words, log=log, env=environment(), cwd=self.folder)
        return self._stack.enter_context(running)
