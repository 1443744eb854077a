"""Tests of the metrics and the log of a real court (`lacoc serve --metrics`)."""

import json
import socket
import time
import urllib.error
import urllib.request
from collections.abc import Callable

import pytest
from court_process import OpenCourt
from prometheus_client.parser import text_string_to_metric_families
from waiting import LIMIT_S

from lacoc_client.play.controller import Controller
from lacoc_shared import __version__
from lacoc_shared.command import cli
from lacoc_shared.gait.tables import Level
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import open_client

pytestmark = pytest.mark.slow


def scrape(url: str) -> dict[tuple[str, ...], float]:
    """Read the metrics; return each sample by its name and the values of its labels."""
    with urllib.request.urlopen(url, timeout=LIMIT_S) as reply:
        text = reply.read().decode()
    return {
        (sample.name, *sample.labels.values()): sample.value
        for family in text_string_to_metric_families(text)
        for sample in family.samples
    }


def until(true: Callable[[], bool]) -> None:
    end_s = time.monotonic() + LIMIT_S
    while not true():
        assert time.monotonic() < end_s, "it did not come true"


def test_a_scrape_and_the_log_of_a_court(open_court: OpenCourt) -> None:
    """Metrics count beats, commands and refusals; the log has joins and refusals but no token."""
    court = open_court("--metrics", "127.0.0.1:0")
    url, match_id = court.opened["metrics"], court.opened["match_id"]
    until(lambda: ("lacoc_match_info", "main", match_id) in scrape(url))
    first = scrape(url)
    with open_client([court.address]) as session:
        wrong = Controller(session, "main", "left", "not the token", "Ants")
        with pytest.raises(UserError, match="not valid for"):
            wrong.join()
        left = Controller(session, "main", "left", court.tokens["left"], "Ants")
        left.join()
        left.press(Level.LOCOMOTION, 2)
        trip = ("lacoc_seat_round_trip_seconds", "main", "0.95", "left")
        until(lambda: left.wait_frame(0.5) is not None and trip in scrape(url))
        second = scrape(url)
    assert second["lacoc_build_info", __version__] == 1
    for path in ("", "/", "/other", "/metrics/more"):
        with pytest.raises(urllib.error.HTTPError, match="404"):
            scrape(url.removesuffix("/metrics") + path)
    beats = ("lacoc_beat_duration_seconds_count", "main")
    assert second[beats] > first[beats]
    assert second["lacoc_beat_duration_seconds_bucket", "main", "+Inf"] == second[beats]
    assert second["lacoc_beat_duration_seconds_sum", "main"] > 0
    assert second["lacoc_commands_total", "main", "left"] > 1
    assert second["lacoc_commands_total", "main", "right"] == 0
    assert second["lacoc_refused_total", "main", "left", "wrong-token"] == 1
    assert second[trip] > 0
    assert second["lacoc_seat_joined", "main", "left"] == 1
    assert second["lacoc_real_time_factor", "main"] > 0
    assert second["lacoc_slow_beats_total", "main"] >= 0
    assert second["lacoc_replay_advised", "main"] == 0
    court.process.terminate()
    out, _ = court.process.communicate(timeout=LIMIT_S)
    lines = [json.loads(line) for line in out.splitlines()]
    assert all({"timestamp", "level", "court", "kind", "text"} <= line.keys() for line in lines)
    assert {line["match_id"] for line in lines} == {match_id}
    told = {line["text"] for line in lines}
    assert "left seat: 1 message refused (wrong token)." in told
    assert "Ants takes the left seat with the robot Hexapod." in told
    assert not any(token in out for token in (*court.tokens.values(), court.referee))


def test_nothing_listens_unasked(open_court: OpenCourt) -> None:
    """A court without --metrics serves no metrics."""
    assert open_court().opened["metrics"] is None


def test_a_port_that_is_taken(capsys: pytest.CaptureFixture[str]) -> None:
    """If metrics can't be served, `lacoc serve` prints one sentence and exits with 2."""
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        where = f"127.0.0.1:{taken.getsockname()[1]}"
        assert cli.main(["serve", "--listen", "tcp/127.0.0.1:0", "--metrics", where]) == 2
    assert f"Metrics can't be served at {where}" in capsys.readouterr().err
    assert cli.main(["serve", "--metrics", "here"]) == 2
    assert "Write it like 127.0.0.1:9100" in capsys.readouterr().err
