"""A contest in a hall whose certificate a private authority issued, and its renewal."""

import json
import socket
import ssl
import subprocess
from pathlib import Path

import pytest
from lacoc_process import started
from ports import free_port
from waiting import LIMIT_S, until

from lacoc_client.play.spectator import Spectator
from lacoc_server.contest.acts.certificate import make_certificate
from lacoc_server.contest.acts.organiser import enter
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.live import venue
from lacoc_shared.contest import file as contests
from lacoc_shared.network.session import open_client
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import IN_PLAY, Phase

CONTEST = """
[court.north]
arena = "othello"
listen = ["127.0.0.1:{port}"]
[stage.league]
format = "round-robin"
arena = "othello"
settings.match = {{ duration_s = 6.0, countdown_s = 0.1, start = "ready" }}
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """Give a contest file with one court and a certificate."""
    path = tmp_path / "contest.toml"
    path.write_text(CONTEST.format(port=free_port()))
    make_certificate(path, ())
    return path


def serial(file: Path, at: str) -> str:
    """Return the serial number of the certificate that a court shows; "" if it is away."""
    authority = contests.load(file).public.read_authority()
    context = ssl.create_default_context(cadata=authority)
    host, _, port = at.partition("/")[2].rpartition(":")
    try:
        with (
            socket.create_connection((host, int(port)), LIMIT_S) as raw,
            context.wrap_socket(raw, server_hostname=host) as wrapped,
        ):
            return str((wrapped.getpeercert() or {})["serialNumber"])
    except OSError:
        return ""


def is_renewed(file: Path, at: str, before: str) -> bool:
    return serial(file, at) not in ("", before)


@pytest.mark.slow
@pytest.mark.long
def test_a_waiting_court_takes_a_renewed_certificate(file: Path, tmp_path: Path) -> None:
    """It starts again at the same port, and a client that was there comes back by itself."""
    opened = venue.court(ContestFolder(file), "north", tmp_path / "north", 1.0, print, here=True)
    with opened as at:
        access = contests.load(file).access(contests.load(file).court()[0])
        with open_client(access.addresses, authority=access.authority) as session:
            view = Spectator(session, "north")
            before, court = serial(file, at), session.links()
            (tmp_path / "tls/privkey.pem").write_text("half of a pair")
            make_certificate(file, ())
            until(lambda: is_renewed(file, at, before))
            until(lambda: session.links() not in ((), court))
            until(view.poll)


@pytest.mark.long
@pytest.mark.slow
def test_a_renewal_disturbs_no_match(file: Path, tmp_path: Path) -> None:
    """Office, gateway and bots of a contest use TLS; a match goes on with the old certificate.

    When the match is over, the court shows the new one, and the contest has its official end.
    """
    for team, bot in {"Ants": "straight", "Bees": "nearest"}.items():
        enter(file, team, None, bot, "")
    words = ("contest", "run", str(file), "--until-over", "--json")
    run = started(*words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert run.stdout is not None
        opened = json.loads(run.stdout.readline())
        at = opened["courts"]["north"]
        assert (at.partition("/")[0], opened["url"].partition(":")[0]) == ("tls", "https")
        access = contests.load(file).access(contests.load(file).court()[0])
        with open_client(access.addresses, authority=access.authority) as session:
            view = Spectator(session, "north")
            until(lambda: view.poll() and view.frame and view.frame.phase in IN_PLAY)
            before = serial(file, at)
            make_certificate(file, ())
            phases = set()
            while Phase.OFFICIAL not in phases:
                frame = view.wait_frame(LIMIT_S)
                assert frame is not None
                phases.add(Phase(frame.phase))
                assert frame.phase not in IN_PLAY or serial(file, at) == before
        until(lambda: is_renewed(file, at, before))
        end = json.loads(run.communicate(timeout=LIMIT_S)[0].splitlines()[-1])
    finally:
        run.kill()
    assert (run.returncode, end["games"]) == (0, 1)
    (record,) = (tmp_path / "recordings").glob("*.mcap")
    assert len(Record.read(record).headers) == 1  # the court was not started again in the match
