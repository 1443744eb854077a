"""Runs a court and a gateway, each in a process of its own."""

import json
import os
import signal
import subprocess
from contextlib import ExitStack
from pathlib import Path

from contest_tokens import keep_tokens
from court_process import environment
from lacoc_process import ALONE, Lacoc
from page_client import PageClient
from ports import free_port
from waiting import LIMIT_S

TOKENS = {"left": "l" * 26, "right": "r" * 26}
REFEREE = "w" * 26


class Process:
    """A process that prints one line of JSON when it is ready."""

    def __init__(self, folder: Path, *words: str, name: str = "process") -> None:
        with (folder / f"{name}.log").open("ab") as log:
            self.process = Lacoc(
                *words,
                stdout=subprocess.PIPE,
                stderr=log,
                stdin=subprocess.DEVNULL,
                text=True,
                env=environment(),
                cwd=folder,
            )
        assert self.process.stdout is not None
        self.said = self.process.stdout.readline()
        """The standard output: its first line, and after `close` all of it."""
        self.opened = json.loads(self.said)

    def kill(self) -> None:
        """Kill the process, as a power cut does."""
        self.process.kill()
        self.process.wait(LIMIT_S)

    def signal(self, number: signal.Signals) -> None:
        os.kill(self.process.pid, number)

    def close(self) -> None:
        assert self.process.stdout is not None
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGCONT)
            self.process.terminate()
        if not self.process.stdout.closed:
            self.said += self.process.communicate(timeout=LIMIT_S)[0]


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
        )
        keep_tokens(self.contest, TOKENS, REFEREE)

    def court(self, *words: str) -> Process:
        """Start the court."""
        return self.started(ALONE, str(self.contest), "--json", *words, name="court")

    def web(self, *words: str) -> Process:
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

    def started(self, *words: str, name: str) -> Process:
        """Start a process; it ends with the test."""
        process = Process(self.folder, *words, name=name)
        self._stack.callback(process.close)
        return process
