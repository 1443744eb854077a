"""Tests of which tokens open a seat after a court was killed and started again."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from lacoc_process import Running, run_lacoc
from running import frame, phase, until

from lacoc_client.play.controller import Controller
from lacoc_client.play.team_way import where
from lacoc_shared.gait.tables import Level
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import open_client
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import Phase

pytestmark = pytest.mark.slow


def serving(folder: Path, arena: str) -> list[str]:
    court = ["serve", "--json", "--arena", arena, "--listen", "tcp/127.0.0.1:0"]
    return [*court, "--recordings", str(folder)]


@contextmanager
def opened(folder: Path, arena: str = "practice") -> Iterator[dict[str, Any]]:
    """Run a court without a contest file; give what it prints when it opens.

    The court is killed at the end.
    """
    court = Running(*serving(folder, arena))
    try:
        yield court.opened
    finally:
        court.kill()


@contextmanager
def practising(court: dict[str, Any], token: str) -> Iterator[Controller]:
    with open_client([court["locators"][0]]) as session:
        controller = Controller(session, court["court"], "solo", token, "Ants")
        controller.join()
        yield controller


def test_the_printed_token_opens_the_seat_of_a_match_that_goes_on(tmp_path: Path) -> None:
    """After restarts, every token that opened the seat before and the newest one open it."""
    with opened(tmp_path) as first, practising(first, first["tokens"]["solo"]) as controller:
        controller.ready()
        until([controller], lambda: phase(controller) == Phase.PLAYING)
        until([controller], lambda: frame(controller).clock_ticks > 20)
    tokens = [first["tokens"]["solo"]]
    for _ in range(2):
        with opened(tmp_path) as again:
            assert again["match_id"] == first["match_id"]
            tokens.append(again["tokens"]["solo"])
            for token in tokens:
                with practising(again, token) as controller:
                    until([controller], lambda c=controller: phase(c) == Phase.PLAYING)
                    seq = controller.press(Level.LOCOMOTION, 2)
                    until(
                        [controller],
                        lambda c=controller, seq=seq: frame(c).seats[0].applied_seq == seq,
                    )
            with pytest.raises(UserError, match="not valid for the solo seat"):
                practising(again, "not-the-token-of-it").__enter__()


def test_another_arenas_match_is_not_gone_on_with(tmp_path: Path) -> None:
    """A court does not start with an arena other than that of its unfinished match."""
    with opened(tmp_path, "othello") as first:
        pass
    done = run_lacoc(*serving(tmp_path, "practice"))
    assert (done.returncode, done.stdout) == (2, "")
    said = " ".join(done.stderr.split())
    assert f"{first['match_id']}.000.live.mcap is not finished" in said
    assert 'played in arena "othello", and this court plays "practice"' in said
    assert "--fresh' opens a new match" in said


def test_a_court_alone_says_where_its_seat_is(tmp_path: Path) -> None:
    """Whoever asks with a token of a court without an office is told its open seat."""
    with opened(tmp_path) as court, open_client([court["locators"][0]]) as session:
        there = where(session, court["court"], court["tokens"]["solo"])
        assert (there.state, there.seat, there.team, there.open) == ("court", "solo", "", True)
        assert there.address == ""
        with pytest.raises(UserError, match="token"):
            where(session, court["court"], court["referee"])
    (segment,) = tmp_path.glob("*.live.mcap")
    assigned = Record.read([segment]).header.setup.assigned
    assert assigned is not None
    assert assigned.is_alone
