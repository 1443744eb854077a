"""The log of a long-running process: one line for each event, for a person or a program.

The log is silent until `start` switches it on. Lines are written on a thread of their own:
a stopped terminal, or a pipe that nobody reads, must never delay a beat.
"""

import atexit
import logging
import queue
import sys
import threading
from datetime import datetime
from typing import Any

import structlog
from structlog.typing import FilteringBoundLogger

from lacoc_shared.command import screen
from lacoc_shared.seat import BEATS_PER_S

_WAITING_MOST = 10_000
"""How many lines may wait to be written; further lines are dropped, and their number is logged."""
_END_S = 1.0
"""When the process ends, the longest time to write the lines that still wait [s]."""
_CLOCK = "%H:%M:%S"
_DIM, _WARN, _PLAIN = "\x1b[2m", "\x1b[33m", "\x1b[0m"


class _Writer:
    """Writes the lines of the log, in order, on a thread of its own."""

    def __init__(self) -> None:
        self._lines: queue.Queue[str | None] = queue.Queue(_WAITING_MOST)
        self._lost = 0
        self._thread = threading.Thread(target=self._run, name="log", daemon=True)
        self._thread.start()
        atexit.register(self.close)

    def msg(self, line: str) -> None:
        """Put a line into the queue, or drop the line if the queue is full; never blocks."""
        try:
            if self._lost:
                self._lines.put_nowait(f"({self._lost} lines of the log were lost here)")
                self._lost = 0
            self._lines.put_nowait(line)
        except queue.Full:
            self._lost += 1

    info = warning = msg  # structlog calls the method of the level

    def close(self) -> None:
        """Wait until all queued lines of the log are written, but at most a second.

        If the queue is full, do not wait at all.
        """
        try:
            self._lines.put_nowait(None)
        except queue.Full:
            return
        self._thread.join(_END_S)

    def _run(self) -> None:
        while (line := self._lines.get()) is not None:
            try:
                sys.stdout.write(f"{line}\n")
                sys.stdout.flush()
            except (BrokenPipeError, ValueError):  # the reader has gone
                return
            except OSError:  # the disk is full; standard output writes later what it could buffer
                continue


def start(as_json: bool) -> None:
    """Switch the log on. If the process crashes, a log for a person has the stacks of its threads.

    Args:
        as_json: True: write lines of JSON for a program; False: write words for a person.
    """
    screen.accept_any_text()
    if not as_json:  # a program expects only objects: for it the stack goes to standard error
        screen.show_crashes(sys.stdout)
    writer = _Writer()
    structlog.configure(
        processors=[
            structlog.processors.add_log_level,
            structlog.processors.TimeStamper(fmt="iso", utc=True),
            structlog.processors.EventRenamer("text"),
            _json if as_json else _words,
        ],
        wrapper_class=structlog.make_filtering_bound_logger(logging.INFO),
        logger_factory=lambda *_: writer,
        cache_logger_on_first_use=False,
    )


def get(**always: Any) -> FilteringBoundLogger:
    """Return a logger that adds the given values to every line of the log."""
    logger: FilteringBoundLogger = structlog.get_logger(**always)
    return logger


def _json(_: Any, __: str, line: structlog.typing.EventDict) -> str:
    return screen.json_line(line)


def _words(_: Any, level: str, line: structlog.typing.EventDict) -> str:
    """Format a line for a person: time of day, match or court, match clock and sentence."""
    at = datetime.fromisoformat(line["timestamp"]).astimezone().strftime(_CLOCK)
    head = " ".join(filter(None, (at, line.get("match_id") or line.get("court"))))
    ticks = line.get("left_ticks", line.get("clock_ticks"))
    clock = "" if ticks is None else f" {log_clock(ticks)}"
    if not screen.stdout.is_terminal or screen.stdout.no_color:
        return f"{head}{clock}  {line['text']}"
    tone = _PLAIN if level == "info" else _WARN
    return f"{_DIM}{head}{_PLAIN}{clock}  {tone}{line['text']}{_PLAIN}"


def log_clock(ticks: int) -> str:
    """Format ticks of a match's clock with tenths of a second, such as "2:04.6".

    Never below "0:00.0".
    """
    tenths = max(0, ticks) * 10 // BEATS_PER_S
    return f"{tenths // 600}:{tenths % 600 / 10:04.1f}"


structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(logging.CRITICAL))
