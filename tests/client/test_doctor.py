"""Tests of `lacoc doctor` on this machine, with real ports, courts and stubs of courts."""

import json
import os
import re
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import trustme
from court_process import OpenCourt
from court_stub import CourtStub
from lacoc_process import environment
from ports import free_port
from proxies import issue

from lacoc_client.commands.checks import machine as doctor
from lacoc_client.commands.checks.link import link
from lacoc_client.commands.checks.machine import Status
from lacoc_shared.command import cli
from lacoc_shared.contest.access import Access
from lacoc_shared.words import render, say


@pytest.fixture
def taken() -> Iterator[int]:
    """Give a port that is taken by a program that is neither a court nor a gateway."""
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        listener.listen()
        yield listener.getsockname()[1]


def look(
    capsys: pytest.CaptureFixture[str], folder: Path, *words: str
) -> dict[str, dict[str, Any]]:
    """Run `lacoc doctor`, check its exit code, and return its findings by subject."""
    always = ("--json", "--seconds", "0.4", "--recordings", str(folder))
    with pytest.raises(SystemExit) as ended:
        cli.main(["doctor", *always, *words])
    findings = json.loads(capsys.readouterr().out)
    assert ended.value.code == any(finding["status"] == "problem" for finding in findings)
    assert all(finding["todo"] for finding in findings if finding["status"] != "ok")
    return {finding["about"]: finding for finding in findings}


def contest(folder: Path, port: int) -> str:
    path = folder / "contest.toml"
    path.write_text(f'[court.main]\narena = "othello"\nlisten = ["tcp/127.0.0.1:{port}"]\n')
    return str(path)


def test_this_machine(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """Doctor checks this machine without a court, and leaves no file behind."""
    found = look(capsys, tmp_path / "records", "--web", f"127.0.0.1:{free_port()}")
    assert {"python", "lacoc", "packages", "graphics", "clock", "disk"} <= found.keys()
    assert found["python"]["status"] == found["packages"]["status"] == "ok"
    assert "eclipse-zenoh 1.10" in found["packages"]["found"]
    assert found["clock"]["found"].startswith("20 beats of 20 ms")
    assert "MiB free" in found["disk"]["found"]
    assert [*tmp_path.iterdir()] == []  # doctor left no file and no folder


def test_words_for_a_person(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """Without --json, doctor prints a table that says what to do."""
    with pytest.raises(SystemExit):
        cli.main(["doctor", "--seconds", "0.2", "--recordings", str(tmp_path)])
    out = capsys.readouterr().out
    assert "what to do" in out
    assert "chrome://gpu" in out
    assert max(map(len, out.splitlines())) <= 100


def packages_beside(folder: Path, metadata: dict[str, str]) -> list[list[str]]:
    """Add packages that are only metadata, and return doctor's findings about all packages.

    Args:
        folder: where to write the metadata.
        metadata: for each package, such as "mcap-0.1", the lines of its METADATA file.

    Returns:
        For each finding: its subject, its status, what was found, and what to do.
    """
    for name, text in metadata.items():
        (folder / f"{name}.dist-info").mkdir()
        (folder / f"{name}.dist-info" / "METADATA").write_text(f"Metadata-Version: 2.1\n{text}\n")
    code = (
        "from lacoc_client.commands.checks import machine as doctor; import json; "
        "found = [one.in_words() for one in doctor.packages()]; "
        "print(json.dumps([[f.about, f.status, f.found, f.todo] for f in found]))"
    )
    path = os.pathsep.join([str(folder), *sys.path])
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=environment(PYTHONPATH=path),
        capture_output=True,
        check=True,
        text=True,
    )
    found: list[list[str]] = json.loads(done.stdout)
    return found


def test_a_package_of_the_wrong_version(tmp_path: Path) -> None:
    """A package of a wrong version is a problem, and doctor gives the command that installs it."""
    found = packages_beside(tmp_path, {"mcap-0.1": "Name: mcap\nVersion: 0.1"})
    wrong = [finding for finding in found if finding[1] == Status.PROBLEM]
    assert [finding[0] for finding in wrong] == ["mcap"]
    assert "0.1 is installed, but " in wrong[0][2]
    assert re.search(r"pip install '?mcap[<>=]", wrong[0][3])


def test_packages_that_are_not_there(tmp_path: Path) -> None:
    """An old Python or a missing package is a problem; packages for courts are one note."""
    needs = (
        "Requires-Dist: no-such-thing>=2\n"
        'Requires-Dist: no-engine>=3; extra == "server"\n'
        'Requires-Dist: no-rating>=1; extra == "server"'
    )
    metadata = f"Name: lacoc\nVersion: 9\nRequires-Python: >=3.99\n{needs}"
    found = packages_beside(tmp_path, {"lacoc-9": metadata})
    by_name = {finding[0]: finding[1:] for finding in found}
    assert by_name["python"][0] == Status.PROBLEM
    assert by_name["no-such-thing"][:2] == [Status.PROBLEM, "not installed"]
    assert "no-such-thing>=2" in by_name["no-such-thing"][2]
    (note,) = [finding for finding in found if finding[1] == Status.NOTE]  # one for all of them
    assert "no-engine, no-rating. " in note[2]
    assert "run a court" in note[2]
    assert re.search("pip install .*no-engine>=3.* .*no-rating>=1", note[3])


@pytest.mark.long
def test_ports_that_are_taken(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, taken: int
) -> None:
    """A port that the user named and that is taken is a problem; a taken default port is a note."""
    file = contest(tmp_path, taken)
    found = look(capsys, tmp_path, "--contest", file, "--web", f"127.0.0.1:{taken}")
    assert found[f"port {taken}"]["status"] == "problem"
    assert "lacoc web" in found[f"port {taken}"]["todo"]
    assert found["court main"]["status"] == "problem"
    assert doctor.court_port("127.0.0.1", taken, None).status is Status.NOTE
    assert doctor.court_port("127.0.0.1", taken, "main").status is Status.PROBLEM
    assert doctor.court_port("192.0.2.7", free_port(), "main").status is Status.PROBLEM


@pytest.mark.skipif(sys.platform != "linux", reason="a folder in which nobody can write")
def test_a_disk_that_takes_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    """A folder in which no record can be written is a problem, and doctor advises --recordings."""
    found = look(capsys, Path("/proc/records"))["disk"]
    assert found["status"] == "problem"
    assert "--recordings" in found["todo"]


def test_a_file_where_the_records_should_go(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """A file or a broken link in the place of the records' folder is a problem."""
    for name in ("file", "link"):
        folder = tmp_path / name
        folder.write_text("") if name == "file" else folder.symlink_to(tmp_path / "nowhere")
        found = look(capsys, folder)["disk"]
        assert found["status"] == "problem"
        assert str(folder) in found["found"]
        assert "--recordings" in found["todo"]


def test_the_port_of_another_court(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """If a court of another name has the port of the contest's court, doctor reports a problem."""
    with CourtStub() as court:
        port = int(court.address.rpartition(":")[2])
        text = Path(contest(tmp_path, port)).read_text().replace("court.main", "court.hall")
        file = tmp_path / "contest.toml"
        file.write_text(text)
        found = look(capsys, tmp_path, "--contest", str(file))[f"port {port}"]
        assert found["status"] == "problem"
        assert (
            "court main runs here, but the contest file gives this port to court hall"
            in found["found"]
        )
        assert "--listen" in found["todo"]
        assert doctor.court_port("127.0.0.1", port, None).status is Status.OK


@pytest.mark.skipif(sys.platform != "linux", reason="needs two addresses of this machine")
def test_a_court_is_asked_at_its_own_address() -> None:
    """Doctor recognises a court that listens at one address of this machine only."""
    with CourtStub(listen="127.0.0.2:0") as court:
        host, port = court.address.partition("/")[2].split(":")
        found = doctor.court_port(host, int(port), "main")
    assert (found.status, render(found.found)) == (Status.OK, "court main runs here")


def test_a_court_that_stands_still() -> None:
    """Doctor reports that a court stands still and that its record can't be written."""
    with CourtStub() as court:
        court.trouble = say("plain.text", text="The record m-1 can't be written.")
        access = Access(court="main", connect=court.address)
        found = {one.about: one for one in (each.in_words() for each in link(access, 0.5))}
    assert found["frames of main"].status is Status.PROBLEM
    assert "stands still: the match is being played" in found["frames of main"].found
    assert found["record of main"].status is Status.PROBLEM
    assert found["record of main"].found == render(court.trouble)


def test_every_court_of_a_contest(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """Doctor checks the links to all courts of a contest; with --court, it checks only one."""
    with CourtStub() as court:
        text = Path(contest(tmp_path, int(court.address.rpartition(":")[2]))).read_text()
        port = free_port()
        hall = Path(contest(tmp_path, port)).read_text().replace("court.main", "court.hall")
        file = tmp_path / "contest.toml"
        file.write_text(hall + text)
        found = look(capsys, tmp_path, "--contest", str(file))
        one = look(capsys, tmp_path, "--contest", str(file), "--court", "main")
    assert found["court hall"]["status"] == "note"
    assert "does not run yet" in found["court hall"]["found"]
    assert "Test at tcp/" in found["court main"]["found"]
    assert found["frames of main"]["status"] != "problem"
    assert "disk" in found
    assert "court main" in one
    assert not {"court hall", f"port {port}"} & one.keys()


def test_no_court_there(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """A court that does not run is reported as a problem in one sentence."""
    there = f"tcp/127.0.0.1:{free_port()}"
    found = look(capsys, tmp_path, "--connect", there)
    assert found["court main"]["status"] == "problem"
    assert "No program answers at" in found["court main"]["found"]
    # Who names an address expects a court there, also beside a contest file.
    found = look(capsys, tmp_path, "--contest", contest(tmp_path, free_port()), "--connect", there)
    assert found["court main"]["status"] == "problem"


def test_a_contest_that_does_not_run_yet(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """Before a contest no court runs: that is a note, also for a court with two addresses."""
    file = contest(tmp_path, free_port())
    assert look(capsys, tmp_path, "--contest", file)["court main"]["status"] == "note"
    text = Path(file).read_text()
    Path(file).write_text(f'{text}elsewhere = "tcp/127.0.0.1:{free_port()}"\n')
    found = look(capsys, tmp_path, "--contest", file)["court main"]
    assert (found["status"], found["found"].count("tcp/")) == ("note", 2)


@pytest.mark.slow
def test_the_link_to_a_court(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, open_court: OpenCourt
) -> None:
    """Doctor checks the version, round trip and frames of a real court, and recognises its port."""
    court = open_court()
    found = look(capsys, tmp_path, "--connect", court.address, "--seconds", "1")
    assert found["court main"]["status"] == "ok"
    assert found["round trip to main"]["found"].startswith("50 requests, ")
    assert " frames a second while the match is in the lobby; " in found["frames of main"]["found"]
    assert found["frames of main"]["status"] != "problem"
    port = int(court.address.rpartition(":")[2])
    here = doctor.court_port("127.0.0.1", port, "main")
    assert (here.status, render(here.found)) == (Status.OK, "court main runs here")
    other = look(capsys, tmp_path, "--connect", court.address, "--court", "other")
    assert "The courts there: main" in other["court other"]["found"]


def test_an_encrypted_court_is_known_by_its_authority(tmp_path: Path) -> None:
    """With the authority's certificate, doctor recognises a court and checks the link."""
    authority = trustme.CA()
    pem = authority.cert_pem.bytes().decode()
    with CourtStub(certificate=issue(tmp_path, authority, "lacoc.example.org")) as court:
        port = int(court.address.rpartition(":")[2])
        found = doctor.court_port("127.0.0.1", port, "main", "tls", pem)
        assert (found.status, render(found.found)) == (Status.OK, "court main runs here")
        access = Access(court="main", connect=court.address, authority=pem)
        findings = list(link(access, 0.5))
    assert "Test at tls/" in render(findings[0].found)
