"""Settings of all tests: which tests run, and how many examples check each property."""

import gc
import os
import signal

import pytest
from hypothesis import settings

# No deadline: the time of an example says more about the machine than about the code.
settings.register_profile("quick", deadline=None, max_examples=20)
settings.register_profile("thorough", deadline=None, max_examples=80)

# The commands of these tests print English, also on a machine whose language is Japanese.
os.environ["LACOC_LANGUAGE"] = "en"

# A process that a shell starts in the background ignores Ctrl-C, and its children would too.
signal.signal(signal.SIGINT, signal.default_int_handler)


_PRIORITY = os.nice(0) if hasattr(os, "nice") else 0


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option --long, with which `make test-all` runs pytest."""
    parser.addoption(
        "--long",
        action="store_true",
        help="run also the tests marked long, and check properties with 4 times as many examples",
    )


def pytest_configure(config: pytest.Config) -> None:
    """Let 20 examples check each property, or 80 with --long.

    Also keep the programs that tests start from writing bytecode.
    """
    settings.load_profile("thorough" if config.getoption("long") else "quick")
    if "PYTEST_XDIST_WORKER" in os.environ or not config.getoption("numprocesses", None):
        # A process whose files may not grow would write half of its bytecode, which breaks others.
        os.environ["PYTHONDONTWRITEBYTECODE"] = "1"


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out tests marked long, unless --long is given; begin with those that take long."""
    long = {item for item in items if item.get_closest_marker("long")}
    others = set() if config.getoption("long") else long
    config.hook.pytest_deselected(items=[item for item in items if item in others])
    wanted = [item for item in items if item not in others]
    items[:] = spread(wanted, int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1")))


def pytest_collection_finish() -> None:
    """Take what collecting made out of the garbage collector, which else visits it all the time."""
    gc.freeze()


def pytest_runtest_logfinish(nodeid: str) -> None:
    """Stop if a test lowered the priority of this process: later tests would be starved."""
    if hasattr(os, "nice") and os.nice(0) != _PRIORITY:
        pytest.exit(f"{nodeid} changed the priority of its process")


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Print why tests failed that ran once more."""
    for report in terminalreporter.getreports("rerun"):
        terminalreporter.write_sep("_", f"first run of {report.nodeid}")
        terminalreporter.write_line(report.longreprtext)


def spread(items: list[pytest.Item], processes: int) -> list[pytest.Item]:
    """Return the tests reordered: each process begins with its share of those that take long.

    Args:
        items: the tests, in the order of their files.
        processes: number of processes; each gets an equal part of the order.
    """
    slow = sorted((item for item in items if minutes(item)), key=minutes, reverse=True)
    ordered = [item for item in items if not minutes(item)]
    for number, item in enumerate(slow):
        ordered.insert(number % processes * -(-len(items) // processes), item)
    return ordered


def minutes(item: pytest.Item) -> float:
    """Return how many minutes a test takes, as its mark `long` or `slow` says; else 0."""
    marks = filter(None, map(item.get_closest_marker, ("long", "slow")))
    return max((float(mark.kwargs.get("minutes", 0)) for mark in marks), default=0.0)
