"""Tests of a match by links alone, and of what somebody on the way sees of it."""

import json
import subprocess
from pathlib import Path

import pytest
from capture import Capture
from lacoc_process import run_lacoc, started
from ports import free_port
from waiting import LIMIT_S

from lacoc_server.contest.acts.certificate import make_certificate
from lacoc_server.contest.acts.organiser import enter
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.link import Link

TEAMS = ("Ants", "Bees")


def write_contest(folder: Path, pages_port: int, court_port: int, encrypted: bool) -> Path:
    """Write a contest of two teams, with a certificate if it is encrypted."""
    file = folder / "contest.toml"
    scheme = "https" if encrypted else "http"
    file.write_text(f"""
[contest]
pages = "{scheme}://localhost:{pages_port}"
[court.north]
listen = ["127.0.0.1:{court_port}"]
[stage.final]
format = "round-robin"
arena = "othello"
settings.match = {{ duration_s = 2.0, countdown_s = 0.1 }}
""")
    if encrypted:
        make_certificate(file, ("localhost",))
    for team in TEAMS:
        enter(file, team, None, "", "")
    return file


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.parametrize("encrypted", [True, False], ids=["tls", "plain"])
def test_a_match_by_links_alone(encrypted: bool, tmp_path: Path) -> None:
    """A bot, a person at a terminal, a referee and a watcher have a link each, and nothing else.

    Whoever captures all packets between them and the contest finds a token only if nothing is
    encrypted; nobody finds one in what the programs print.
    """
    ports = free_port(), free_port()
    file = write_contest(tmp_path, *ports, encrypted)
    plan = contests.load(file)
    try:
        capture = Capture(ports)
    except PermissionError:
        pytest.skip("only root may capture packets")
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    listen = ("--listen", f"127.0.0.1:{ports[0]}")
    run = started("contest", "run", str(file), *listen, "--until-over", "--json", **streams)
    processes = [run]
    said = []
    try:
        assert run.stdout is not None
        run.stdout.readline()  # it has the organiser's link, for whoever started the contest
        links = json.loads(run_lacoc("contest", "invite", "--contest", str(file), "--json").stdout)
        to_pages = Link(pages=plan.public.pages, authority=plan.public.fingerprint)
        token = plan.secrets.referee("north")
        link = Link(
            pages=to_pages.pages,
            page="referee",
            court="north",
            token=token,
            authority=to_pages.authority,
        ).text
        with capture:
            processes.append(started("bot", "straight", links["Ants"], **streams))
            words = ("play", links["Bees"], "--terminal", "--ready")
            processes.append(started(*words, cwd=tmp_path, stdin=subprocess.DEVNULL, **streams))
            watch = started("watch", to_pages.text, "--json", "--hz", "0", **streams)
            processes.append(watch)
            for decision in ("start", "official"):
                done = run_lacoc("referee", link, decision, "--yes", "--by", "Kim", "--wait", "120")
                assert done.returncode == 0, done.stderr
                said.append(done.stdout + done.stderr)
            for process in processes:
                said.append("".join(process.communicate(timeout=LIMIT_S)))
                assert process.returncode == 0, said[-1]
    finally:
        for process in processes:
            process.kill()
    assert '"OFFICIAL"' in said[-1]
    assert capture.ports == set(ports)
    tokens = {team: plan.secrets.team(team) for team in TEAMS} | {"referee": token}
    tokens |= {"office": plan.secrets.office, "organiser": plan.secrets.organiser}
    assert [name for name, one in tokens.items() if any(one in text for text in said)] == []
    seen = {name for name, one in tokens.items() if capture.has(one)}
    if encrypted:
        assert seen == set()
    else:
        assert seen >= {*TEAMS, "referee", "office"}  # the search finds tokens
