"""Tests of the processes of a contest."""

import socket
from pathlib import Path

import pytest
from benchmarks.contest_played import CONTEST, SWISS

from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.live import venue
from lacoc_shared.words import Phrase, render

COURT = """
[court.red]
arena = "othello"
listen = ["127.0.0.1:{port}"]
"""


@pytest.mark.slow
def test_a_court_whose_port_is_taken_says_so_before_it_tries_again(tmp_path: Path) -> None:
    """The message names court and port, and says what to do; once the port is free, it opens."""
    told: list[Phrase] = []
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]

        def tell(what: Phrase) -> None:
            told.append(what)
            other.close()

        file = tmp_path / "contest.toml"
        file.write_text(CONTEST + COURT.format(port=port) + SWISS, "utf-8")
        opened = venue.court(ContestFolder(file), "red", tmp_path / "red", 1.0, tell, here=True)
        with opened as address:
            assert address == f"tcp/127.0.0.1:{port}"
    (why,) = map(render, told)
    assert why.startswith(f"Court red can't be opened. Port {port} is in use")
    assert "[court.red]" in why
