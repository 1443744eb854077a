"""Feeds inputs to a target, counts the outcomes, and stops each input after 1 s of CPU time."""

import signal
import time
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from tests.campaigns.fuzz.doors import StateChanged
from tests.campaigns.fuzz.mutate import Mutator
from tests.campaigns.fuzz.targets import Target

MOST_S = 1.0
"""CPU time allowed for one input [s]."""


class Hang(BaseException):
    """An input takes too long. It is a BaseException, so that no `except Exception` hides it."""


@dataclass
class Figures:
    """The number of inputs that a target got, and the number with each outcome."""

    name: str
    inputs: int = 0
    accepted: int = 0
    crashes: int = 0
    hangs: int = 0
    state_changes: int = 0
    worst_s: float = 0.0
    findings: dict[str, bytes] = field(default_factory=dict)
    """One input for each place in the code where something went wrong, by its traceback."""

    @property
    def refused(self) -> int:
        """Return the number of inputs that were refused with a documented error."""
        return self.inputs - self.accepted - self.crashes - self.hangs - self.state_changes


def feed(target: Target, count: int, seed: int) -> Iterator[Figures]:
    """Feed a target its seeds, and then hostile inputs until it has had `count` inputs.

    Yields:
        The figures so far, after every 1000 inputs and at the end.
    """
    figures = Figures(target.name)
    mutator = Mutator(target.seeds, target.kind, f"{seed} {target.name}")
    for data in target.seeds:
        _one(target, data, figures)
    while figures.inputs < count:
        _one(target, mutator.next(), figures)
        if figures.inputs % 1000 == 0:
            yield figures
    with _limited(MOST_S):
        target.finish()
    yield figures


def _one(target: Target, data: bytes, figures: Figures) -> None:
    figures.inputs += 1
    begin = time.process_time()
    try:
        with _limited(MOST_S):
            figures.accepted += target.eat(data)
    except Hang as error:
        figures.hangs += 1
        _keep(figures, error, data)
    except StateChanged as error:
        figures.state_changes += 1
        _keep(figures, error, data)
    except Exception as error:
        figures.crashes += 1
        _keep(figures, error, data)
    figures.worst_s = max(figures.worst_s, time.process_time() - begin)


def _keep(figures: Figures, error: BaseException, data: bytes) -> None:
    where = traceback.extract_tb(error.__traceback__)
    text = f"{type(error).__name__}: {str(error)[:300]}\n" + "".join(
        traceback.format_list(where[-6:])
    )
    place = (type(error).__name__, *[(frame.filename, frame.lineno) for frame in where[-1:]])
    known = f"{place}\n"
    if not any(text_known.startswith(known) for text_known in figures.findings):
        figures.findings[known + text] = data


@contextmanager
def _limited(seconds: float) -> Iterator[None]:
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


def arm() -> None:
    """Set the signal handler that raises `Hang` in an input that takes too long."""

    def ring(*_: object) -> None:
        raise Hang(f"more than {MOST_S:g} s of CPU time")

    signal.signal(signal.SIGPROF, ring)
