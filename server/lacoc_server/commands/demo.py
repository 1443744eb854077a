"""`lacoc demo`: a whole match over the real network, with a process for each part."""

import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from queue import Empty, Queue
from typing import IO, Annotated, Any

import typer

from lacoc_server.commands.contest import demo_contest
from lacoc_shared.command import screen
from lacoc_shared.command.log import log_clock
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.files import packed_path
from lacoc_shared.words import say

app = typer.Typer()

_READY_S = 60
"""Time for the bots to join and say ready, also on a slow machine [s]."""
_DAY_S = 86_400
_LOOK_S = 0.5
"""Time between two checks that all processes are alive [s]."""
_END_S = 10
"""Time until a process that was asked to end is killed [s]."""


@app.command(name="demo")
def demo_command(
    arena: Annotated[
        str, typer.Option(envvar="LACOC_ARENA", help="The game: othello or flag-strike.")
    ] = "othello",
    left: Annotated[str, typer.Option(help="Bot in the left seat.")] = "planner",
    right: Annotated[str, typer.Option(help="Bot in the right seat.")] = "nearest",
    seconds: Annotated[
        float | None,
        typer.Option(help="Length of the match in seconds; by default the arena's.", min=0.1),
    ] = None,
    speed: Annotated[
        float, typer.Option(help="2 plays twice as fast as real time.", min=0.1, max=20)
    ] = 1.0,
    headless: Annotated[
        bool, typer.Option("--headless", help="Show only the events: no page and no picture.")
    ] = False,
    recordings: Annotated[
        Path, typer.Option(metavar="FOLDER", help="Folder for the record.")
    ] = Path("recordings"),
    contest: Annotated[
        bool,
        typer.Option(
            "--contest",
            help="Show a whole contest: eight bots, two courts, groups and a knockout.",
        ),
    ] = False,
    folder: Annotated[
        Path,
        typer.Option(
            metavar="FOLDER", help="Folder in which the contest is published, with --contest."
        ),
    ] = Path("bots-cup"),
) -> None:
    """Show a whole match: a court, two bots and a referee meet over the network.

    Every part is a process of its own, as in a contest. The match is shown on a page in your
    browser, or in the terminal if there is no browser. At the end the record is simulated again and
    must give the same match, bit for bit. In a terminal the page and its replay stay until Ctrl-C.

    With --contest, eight bots play a tournament. Add --headless to play it without courts, as fast
    as the machine can. The folder of the contest is published, and everything in it is checked.
    """
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that all started processes end too
    if contest:
        demo_contest.show(arena, seconds, speed, folder, headless=headless)
        return
    with ExitStack() as page:
        with ExitStack() as processes:
            court = processes.enter_context(_court(arena, seconds, speed, recordings))
            where = ("--court", court.name, "--connect", court.address)
            served, in_browser = (False, False) if headless else _open_page(page, where, recordings)
            show_live = not headless and not in_browser and sys.stdout.isatty()
            needed = []
            for seat, bot in (("left", left), ("right", right)):
                join = ("--arena", arena, *where)
                bot_process = _process("bot", bot, *join, token=court.tokens[seat])
                needed.append(processes.enter_context(bot_process))
            for decision, wait_s in (("start", _READY_S), ("official", _DAY_S)):
                waits = ("--wait", str(wait_s), *where)
                words = ("referee", decision, "--yes", "--by", "demo", *waits)
                needed.append(processes.enter_context(_process(*words, token=court.referee)))
            if show_live:
                watch = _process("watch", "--terminal", "--board", *where, output=None)
                processes.enter_context(watch)
            result = _follow(court, needed, quiet=show_live)
        screen.show(f"\n{result}")
        record = court.record(recordings)
        screen.show(say("demo.record", file=str(record)))
        if _lacoc("replay", "verify", str(record)).wait() != 0:
            raise UserError(say("demo.not-same"))
        # Without a browser here, somebody may have opened the address elsewhere.
        if served and sys.stdout.isatty():
            with suppress(KeyboardInterrupt):  # Ctrl-C may come as soon as the note is read
                screen.note(say("demo.page"))
                threading.Event().wait()


def _open_page(processes: ExitStack, where: Sequence[str], recordings: Path) -> tuple[bool, bool]:
    """Start a gateway; return whether it has pages, and whether a browser shows one of them.

    Raises:
        UserError: if the gateway ends at once.
    """
    words = ("web", "--json", "--recordings", str(recordings), "--open", *where)
    gateway = processes.enter_context(_process(*words, output=subprocess.PIPE))
    assert gateway.stdout is not None
    line = gateway.stdout.readline()
    if not line:
        raise UserError(say("demo.no-pages"))
    opened = json.loads(line)
    if opened["built"]:
        screen.show(say("demo.watch", url=f"{opened['url']}/watch"))
    return bool(opened["built"]), bool(opened["shown"])


class _DemoCourt:
    """Reads the lines that a court's process prints.

    Raises:
        UserError: if the process ends before the court is open.
    """

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._said: Queue[dict[str, Any] | None] = Queue()
        threading.Thread(target=self._listen, args=(process.stdout,), daemon=True).start()
        opened = self._said.get()
        if opened is None:
            raise UserError(say("demo.no-court"))
        self.name: str = opened["court"]
        self._match_id: str = opened["match_id"]
        self.address: str = opened["locators"][0]
        self.tokens: Mapping[str, str] = opened["tokens"]
        self.referee: str = opened["referee"]

    def hear(self, timeout_s: float) -> dict[str, Any] | None:
        """Return the next line that the court printed; None if none comes in time.

        Raises:
            UserError: if the court has ended.
        """
        try:
            event = self._said.get(timeout=timeout_s)
        except Empty:
            return None
        if event is None:
            raise UserError(say("demo.court-ended"))
        return event

    def record(self, folder: Path) -> Path:
        """Return the path that the record of the finished match has."""
        return packed_path(folder, self._match_id)

    def _listen(self, lines: IO[str]) -> None:
        for line in lines:
            self._said.put(json.loads(line))
        self._said.put(None)


def _follow(court: _DemoCourt, needed: Sequence[subprocess.Popen[str]], *, quiet: bool) -> str:
    """Show events until the match is official or void; return the sentence of the result, if any.

    Raises:
        UserError: if a process that the match needs fails.
    """
    result = ""
    while True:
        event = court.hear(_LOOK_S)
        if event is None:
            if any(process.poll() for process in needed):
                raise UserError(say("demo.gave-up"))
            continue
        if "number" not in event:  # an event of the court, not of the match
            continue
        if event["kind"] == "result":
            result = event["text"]
        if not quiet:
            screen.show(f"{log_clock(event['left_ticks'])}  {event['text']}")
        if event["kind"] == "phase" and event["data"]["after"] in ("OFFICIAL", "VOID"):
            return result


@contextmanager
def _court(
    arena: str, seconds: float | None, speed: float, recordings: Path
) -> Iterator[_DemoCourt]:
    words = ["serve", "--json", "--fresh", "--arena", arena, "--listen", "tcp/127.0.0.1:0"]
    words += ["--recordings", str(recordings), "--speed", str(speed)]
    words += ["--seconds", str(seconds)] if seconds else []
    with _ended(_lacoc(*words, output=subprocess.PIPE)) as process:
        yield _DemoCourt(process)


@contextmanager
def _process(
    *words: str, token: str = "", output: int | None = subprocess.DEVNULL
) -> Iterator[subprocess.Popen[str]]:
    with _ended(_lacoc(*words, output=output, token=token)) as process:
        yield process


@contextmanager
def _ended(process: subprocess.Popen[str]) -> Iterator[subprocess.Popen[str]]:
    """Ask a process to end when the block is left, and kill it if it does not."""
    try:
        yield process
    finally:
        process.terminate()
        try:
            process.wait(_END_S)
        except subprocess.TimeoutExpired:
            process.kill()


def _lacoc(*words: str, output: int | None = None, token: str = "") -> subprocess.Popen[str]:
    """Start the command `lacoc` with these arguments; pass it a token in the environment.

    Other users can't read the environment of a process.
    """
    environment = {name: value for name, value in os.environ.items() if name[:6] != "LACOC_"}
    if token:
        environment["LACOC_TOKEN"] = token
    return subprocess.Popen(
        [sys.executable, "-m", "lacoc_shared", *words],
        stdout=output,
        env=environment,
        text=True,
    )
