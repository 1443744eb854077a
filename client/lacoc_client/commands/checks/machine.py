"""Checks a machine that is to play, show or hold a match, and reports in sentences.

Nothing here needs MuJoCo, and nothing is changed: a port is opened and closed again, a small file
is written beside the records and removed.
"""

import ctypes.util
import os
import platform
import shutil
import socket
import statistics
import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from enum import StrEnum
from importlib.metadata import PackageNotFoundError, distribution, version
from pathlib import Path

import msgspec
from packaging.requirements import Requirement

from lacoc_client.play.link.fetch import fetch, trusting_all
from lacoc_client.web.gateway.health import GatewayHealth
from lacoc_shared import __version__
from lacoc_shared.command import installing
from lacoc_shared.command.priority import go_first
from lacoc_shared.keyspace import EVERY_COURT
from lacoc_shared.messages import PROTOCOL
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.address import ANY_HOST
from lacoc_shared.network.session import open_client
from lacoc_shared.seat import BEAT_S
from lacoc_shared.words import Phrase, render, say

_MIB = 1 << 20
_LEAST_FREE_BYTES, _GOOD_FREE_BYTES = 100 * _MIB, 1024 * _MIB
"""Less free space than the first is a problem; less than the second gives a note. A match needs
2 MiB packed, and 4 MiB while it is played."""
_FSYNCS = 10
_SLOW_FSYNC_S = 0.5
"""If one sync to the disk takes longer than this, there is a note [s]; a record is synced once a
second."""
_SLOW_PERCENT, _TOO_SLOW_PERCENT = 1.0, 10.0
_ASK_S = 1.0
_ANY_REACHED = dict(zip(ANY_HOST, ("127.0.0.1", "::1"), strict=True))
"""How this machine reaches a program that listens at every address."""


class Status(StrEnum):
    """How serious a finding of a check is."""

    OK = "ok"
    NOTE = "note"
    """It works, but somebody should read this."""
    PROBLEM = "problem"


class Finding(msgspec.Struct, frozen=True):
    """One finding of a check: what it is about, how serious it is, and what to do."""

    about: Phrase | str
    status: Status
    found: Phrase | str
    todo: Phrase | str = ""
    """What somebody should do about it; "": nothing needs to be done."""

    def in_words(self) -> "Finding":
        """Return the finding with its sentences in the language of this process."""
        return Finding(render(self.about), self.status, render(self.found), render(self.todo))


def packages() -> Iterator[Finding]:
    """Check that Python, LACOC and each needed package have the right versions."""
    lacoc = distribution("lacoc")
    wanted = lacoc.metadata["Requires-Python"]
    python = platform.python_version()
    fits = Requirement(f"python{wanted}").specifier.contains(python, prereleases=True)
    yield (
        Finding(
            "python",
            Status.OK,
            say("doctor.python-ok", python=python, system=platform.platform()),
        )
        if fits
        else Finding(
            "python",
            Status.PROBLEM,
            say("doctor.python-old", python=python, wanted=wanted),
            say("doctor.python-todo"),
        )
    )
    yield Finding("lacoc", Status.OK, say("doctor.lacoc", version=__version__, protocol=PROTOCOL))
    fine, lacking = [], []
    for text in lacoc.requires or ():
        needed = Requirement(text)
        here = needed.marker is None or needed.marker.evaluate({"extra": ""})
        if here or (needed.marker is not None and needed.marker.evaluate({"extra": "server"})):
            finding = _package(needed)
            if finding is None and not here:
                lacking.append(needed.name)
            elif finding is None:
                yield _not_installed(needed)
            elif finding.status is Status.OK:
                fine.append(f"{needed.name} {version(needed.name)}")
            else:
                yield finding
    yield Finding(say("doctor.packages"), Status.OK, ", ".join(fine))
    if lacking:
        todo = say("doctor.no-server-todo", install=installing.command("server"))
        found = say("doctor.no-server", packages=lacking)
        yield Finding(say("doctor.server"), Status.NOTE, found, todo)


def _not_installed(needed: Requirement) -> Finding:
    return Finding(needed.name, Status.PROBLEM, say("doctor.not-installed"), _install(needed))


def _install(needed: Requirement) -> Phrase:
    return say("doctor.install", install=installing.of(f"{needed.name}{needed.specifier}"))


def _package(needed: Requirement) -> Finding | None:
    """Check the version of a package that LACOC needs; None if the package is not installed."""
    try:
        found = version(needed.name)
    except PackageNotFoundError:
        return None
    if needed.specifier.contains(found, prereleases=True):
        return Finding(needed.name, Status.OK, found)
    what = say("doctor.other-package", found=found, wanted=str(needed.specifier))
    return Finding(needed.name, Status.PROBLEM, what, _install(needed))


def court_port(
    host: str, port: int, court: str | None, protocol: str = "tcp", authority: str = ""
) -> Finding:
    """Check that a port is free for a court, or that the right court already listens there.

    Args:
        host: address of this machine to listen at.
        port: the port.
        court: name of the court that the contest file has there; None: any court, and a taken
            port is only a note.
        protocol: "tls" if the court is encrypted.
        authority: certificate (PEM) of a private authority that signed the court's certificate; "":
            none.
    """
    about = say("doctor.port", port=port)
    why: Phrase | str = _why_taken(host, port)
    if not why:
        return Finding(about, Status.OK, say("doctor.port-free-court", host=host))
    try:
        at = f"{protocol}/{_reached(host, port)}"
        with open_client([at], _ASK_S, authority) as session:
            courts = [key.split("/")[1] for key in session.present(EVERY_COURT)]
    except UserError:
        courts = []
    if court in courts or (courts and court is None):
        return Finding(about, Status.OK, say("doctor.court-runs", courts=courts))
    if courts:
        why = say("doctor.court-other", courts=courts, court=court or "")
    status = Status.NOTE if court is None else Status.PROBLEM
    todo = say("doctor.court-port-todo")
    return Finding(about, status, say("doctor.court-port", host=host, why=why), todo)


def web_port(host: str, port: int, *, needed: bool, title: str = "") -> Finding:
    """Check that a port is free for a gateway, or that a gateway already listens there.

    Args:
        host: address of this machine to listen at.
        port: the port.
        needed: whether the user named the port; otherwise a taken port is only a note.
        title: name of the contest whose pages belong here; "": any pages may be there.
    """
    about = say("doctor.port", port=port)
    why: Phrase | str = _why_taken(host, port)
    if not why:
        return Finding(about, Status.OK, say("doctor.port-free-pages", host=host))
    urls = [f"{scheme}://{_reached(host, port)}" for scheme in ("http", "https")]
    if health := next(filter(None, map(_gateway, urls)), None):
        if not title or health.contest == title:
            return Finding(about, Status.OK, say("doctor.pages-run"))
        why = say("doctor.pages-of-other", contest=health.contest or None)
    status = Status.PROBLEM if needed else Status.NOTE
    todo = say("doctor.pages-port-todo")
    return Finding(about, status, say("doctor.pages-port", host=host, why=why), todo)


def _reached(host: str, port: int) -> str:
    """Return the address, "HOST:PORT", at which this machine reaches a program that has a port.

    Args:
        host: address of this machine at which the program listens.
        port: the port.
    """
    here = _ANY_REACHED.get(host, host)
    return f"[{here}]:{port}" if ":" in here else f"{here}:{port}"


def _gateway(url: str) -> GatewayHealth | None:
    """Ask a gateway for its state; None: there is none."""
    try:  # a certificate proves the public name, not this address
        found = fetch(f"{url}/healthz", trusting_all(), _MIB, wait_s=_ASK_S)
        return msgspec.json.decode(found.data, type=GatewayHealth)
    except (OSError, ValueError):
        return None


def _why_taken(host: str, port: int) -> str:
    """Return why a program can't listen at a port; "" if it can."""
    try:
        family, kind, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        with socket.socket(family, kind) as probe:
            if os.name == "posix":  # on Windows two programs could share the port
                probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind(address)
            probe.listen()
    except OSError as error:
        return error.strerror or str(error)
    except UnicodeError as error:  # a name of other form than names of machines have
        return str(error)
    return ""


def graphics() -> Finding:
    """Report which graphics a browser may use; only the browser can tell which it really uses."""
    about, look = say("doctor.graphics"), say("doctor.graphics-look")
    if sys.platform != "linux":
        found = say("doctor.graphics-own", system=platform.system())
        return Finding(about, Status.OK, found, look)
    devices = sorted(map(str, Path("/dev/dri").glob("renderD*")))
    usable = [device for device in devices if os.access(device, os.R_OK | os.W_OK)]
    libraries = [name for name in ("EGL", "GL", "GLX") if ctypes.util.find_library(name)]
    if usable:
        found = say("doctor.graphics-gpu", devices=usable, libraries=libraries)
        return Finding(about, Status.OK, found)
    if devices:
        todo = say("doctor.graphics-forbidden-todo")
        found = say("doctor.graphics-forbidden", devices=devices, libraries=libraries)
        return Finding(about, Status.NOTE, found, todo)
    found = say("doctor.graphics-none", libraries=libraries)
    return Finding(about, Status.NOTE, found, look)


def clock(seconds: float) -> Finding:
    """Measure how late this machine wakes a program that runs 50 times a second, as courts do."""
    with ThreadPoolExecutor(1) as thread:  # its priority is that of a court's beats
        went_first = thread.submit(go_first).result()
        late_s = thread.submit(_late_s, max(1, round(seconds / BEAT_S))).result()
    slow_percent = 100 * sum(one > BEAT_S for one in late_s) / len(late_s)
    resolution_ns = time.get_clock_info("monotonic").resolution * 1e9
    about = say("doctor.clock-name")
    found = say(
        "doctor.clock",
        beats=len(late_s),
        median_ms=1000 * statistics.median(late_s),
        worst_ms=1000 * max(late_s),
        slow_percent=slow_percent,
        resolution_ns=resolution_ns,
    )
    if slow_percent <= _SLOW_PERCENT:
        could = sys.platform == "linux" and not went_first
        return Finding(about, Status.OK, found, say("doctor.clock-could") if could else "")
    status = Status.NOTE if slow_percent <= _TOO_SLOW_PERCENT else Status.PROBLEM
    return Finding(about, status, found, say("doctor.clock-todo"))


def _late_s(beats: int) -> Sequence[float]:
    """Return how late each beat of a court would begin on this machine [s]."""
    late_s = []
    due_s = time.monotonic()
    for _ in range(beats):
        due_s += BEAT_S
        time.sleep(max(0.0, due_s - time.monotonic()))
        late_s.append(time.monotonic() - due_s)
        due_s = max(due_s, time.monotonic() - BEAT_S)  # a stall counts as one late beat, not many
    return late_s


def disk(folder: Path) -> Finding:
    """Check a folder for records: whether it can be written, its free space, the time of a sync."""
    about = say("doctor.disk-name")
    above = (folder.absolute(), *folder.absolute().parents)
    there = next(one for one in above if os.path.lexists(one))
    try:
        free_bytes = shutil.disk_usage(there).free
        syncs_s = _syncs_s(there)
    except OSError as error:
        why = error.strerror or str(error)
        found = say("doctor.disk-fail", folder=str(folder), why=why)
        return Finding(about, Status.PROBLEM, found, say("doctor.disk-fail-todo"))
    found = say(
        "doctor.disk",
        folder=str(folder),
        free_mib=free_bytes / _MIB,
        median_ms=1000 * statistics.median(syncs_s),
        worst_ms=1000 * max(syncs_s),
    )
    if free_bytes < _LEAST_FREE_BYTES:
        return Finding(about, Status.PROBLEM, found, say("doctor.disk-full"))
    if free_bytes < _GOOD_FREE_BYTES:
        return Finding(about, Status.NOTE, found, say("doctor.disk-low"))
    if max(syncs_s) > _SLOW_FSYNC_S:
        return Finding(about, Status.NOTE, found, say("doctor.disk-slow"))
    return Finding(about, Status.OK, found)


def _syncs_s(folder: Path) -> Sequence[float]:
    path = folder / f".lacoc-doctor-{os.getpid()}"
    times_s = []
    try:
        with path.open("xb", buffering=0) as file:
            for _ in range(_FSYNCS):
                file.write(bytes(4096))
                began_s = time.perf_counter()
                os.fsync(file.fileno())
                times_s.append(time.perf_counter() - began_s)
    finally:
        path.unlink(missing_ok=True)
    return times_s
