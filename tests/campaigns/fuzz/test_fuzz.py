"""A short run of hostile bytes for every decoder and file reader; `make fuzz` is the long run."""

from collections.abc import Iterator
from signal import SIGPROF, getsignal, signal

import pytest
from tests.campaigns.fuzz.campaign import arm, feed
from tests.campaigns.fuzz.doors import (
    BATCH,
    KEYS,
    Doors,
    StateChanged,
    command,
    command_seeds,
    request_seeds,
)
from tests.campaigns.fuzz.mutate import Mutator
from tests.campaigns.fuzz.targets import CORPUS, TARGETS, Target

SLOW = {"gait workbook": 10, "gait text": 120, "record, exported": 10, "court: joins": 40}
INPUTS = 200


@pytest.fixture(autouse=True)
def hangs_are_seen() -> Iterator[None]:
    """Let an input that takes too long raise `Hang` in each test of this file."""
    before = getsignal(SIGPROF)
    arm()
    yield
    signal(SIGPROF, before)


@pytest.mark.parametrize("times", [1, pytest.param(20, marks=pytest.mark.long)])
@pytest.mark.parametrize("target", TARGETS, ids=lambda target: target.name)
def test_nothing_but_the_documented_refusals(target: Target, times: int) -> None:
    """Each input is accepted or refused, without a crash, a hang or a forbidden change."""
    inputs = times * SLOW.get(target.name, INPUTS)
    *_, figures = feed(target, len(target.seeds) + inputs, seed=times)
    assert not figures.findings, "\n".join(figures.findings)
    assert figures.inputs == figures.accepted + figures.refused


@pytest.mark.parametrize("target", TARGETS, ids=lambda target: target.name)
def test_the_same_seed_makes_the_same_inputs(target: Target) -> None:
    """The same random seed makes the same inputs."""
    one, other = (Mutator(target.seeds, target.kind, "7") for _ in range(2))
    assert [one.next() for _ in range(20)] == [other.next() for _ in range(20)]


def test_good_packets_get_in() -> None:
    """The committed requests and commands are the ones that today's code makes.

    Of the packets that a court is fed, it accepts at least one request, one join and one decision.
    """
    for folder, seeds in (("requests", request_seeds()), ("commands", command_seeds())):
        kept = [path.read_bytes() for path in sorted((CORPUS / folder).iterdir())]
        assert kept == seeds, "run python -m tests.campaigns.fuzz.make_corpus"
    for name in ("court: requests", "court: joins", "court: decisions"):
        target = next(target for target in TARGETS if target.name == name)
        *_, figures = feed(target, len(target.seeds) + 100, seed=1)
        assert figures.accepted


def test_a_change_of_state_would_be_seen() -> None:
    """`Doors` raises StateChanged if a command takes effect although no controller sent it."""
    court = Doors()
    court.beat()
    forged = command(0, 99, 1, 9)  # rightly sealed, but not sent by the seat's controller
    for _ in range(BATCH - 1):
        court.feed(KEYS.command("left"), forged)
    with pytest.raises(StateChanged, match="without a right"):
        court.feed(KEYS.command("left"), forged)
