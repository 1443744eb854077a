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
import urllib.error
import urllib.request
from collections.abc import Iterator, Sequence
from enum import StrEnum
from importlib.metadata import PackageNotFoundError, distribution, version
from pathlib import Path

import msgspec
from packaging.requirements import Requirement

from lacoc_shared import __version__
from lacoc_shared.keyspace import EVERY_COURT
from lacoc_shared.messages import PROTOCOL
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.access_rules import Credentials
from lacoc_shared.network.session import open_client
from lacoc_shared.seat import BEAT_S

_MIB = 1 << 20
_LEAST_FREE_BYTES, _GOOD_FREE_BYTES = 100 * _MIB, 1024 * _MIB
"""A match needs 2 MiB packed, and 4 MiB while it is played."""
_FSYNCS = 10
_SLOW_FSYNC_S = 0.5
"""Slower than this is noted: a record is synced once a second."""
_SLOW_PERCENT, _TOO_SLOW_PERCENT = 1.0, 10.0
_ASK_S = 1.0


class Status(StrEnum):
    """How serious a finding is."""

    OK = "ok"
    NOTE = "note"
    """It works, but somebody should know."""
    PROBLEM = "problem"


class Finding(msgspec.Struct, frozen=True):
    """A finding about one thing."""

    about: str
    status: Status
    found: str
    todo: str = ""
    """What to do about it; "": nothing."""


def packages() -> Iterator[Finding]:
    """Check Python, this software, and that every package it needs is there and in range."""
    lacoc = distribution("lacoc")
    wanted = lacoc.metadata["Requires-Python"]
    python = platform.python_version()
    fits = Requirement(f"python{wanted}").specifier.contains(python, prereleases=True)
    yield (
        Finding("python", Status.OK, f"{python} on {platform.platform()}")
        if fits
        else Finding("python", Status.PROBLEM, f"{python}, wanted {wanted}", "Install a newer one.")
    )
    yield Finding("lacoc", Status.OK, f"{__version__}, version {PROTOCOL} of the protocol")
    fine = []
    for text in lacoc.requires or ():
        needed = Requirement(text)
        here = needed.marker is None or needed.marker.evaluate({"extra": ""})
        if here or (needed.marker is not None and needed.marker.evaluate({"extra": "server"})):
            finding = _package(needed, optional=not here)
            if finding.status is Status.OK:
                fine.append(f"{finding.about} {finding.found}")
            else:
                yield finding
    yield Finding("packages", Status.OK, ", ".join(fine))


def _package(needed: Requirement, *, optional: bool) -> Finding:
    about, wanted = needed.name, f"{needed.name}{needed.specifier}"
    try:
        found = version(needed.name)
    except PackageNotFoundError:
        if optional:
            what = "not installed: this machine can play and show, but hold no match"
            return Finding(about, Status.NOTE, what, 'For a court: pip install "lacoc[server]"')
        return Finding(about, Status.PROBLEM, "not installed", f'pip install "{wanted}"')
    if needed.specifier.contains(found, prereleases=True):
        return Finding(about, Status.OK, found)
    what = f"{found} is installed, wanted is {needed.specifier}"
    return Finding(about, Status.PROBLEM, what, f'pip install "{wanted}"')


def court_port(
    host: str, port: int, court: str | None, credentials: Credentials | None = None
) -> Finding:
    """Check that a court can listen at a port, or does already.

    Args:
        host: address of this machine to listen at.
        port: the port.
        court: the court that should listen there, by the contest file; None: any court, and a taken
            port is only a note.
        credentials: credentials to ask a court that has keys.
    """
    about = f"port {port}"
    why = _why_taken(host, port)
    if not why:
        return Finding(about, Status.OK, f"free at {host}, for a court")
    try:
        with open_client([f"127.0.0.1:{port}"], _ASK_S, credentials) as session:
            courts = [key.split("/")[1] for key in session.present(EVERY_COURT)]
    except UserError:
        courts = []
    if court in courts or (courts and court is None):
        return Finding(about, Status.OK, f"court {', '.join(courts)} runs here")
    if courts:
        why = f"court {', '.join(courts)} runs here, and the contest file has court {court} here"
    status = Status.NOTE if court is None else Status.PROBLEM
    todo = "End the program that has it, or give the court another address (--listen)."
    return Finding(about, status, f"a court can't listen at {host}: {why}", todo)


def web_port(host: str, port: int, *, needed: bool) -> Finding:
    """Check that a gateway can listen at a port, or does already.

    Args:
        host: address of this machine to listen at.
        port: the port.
        needed: whether it was asked for; otherwise a taken port is only a note.
    """
    about = f"port {port}"
    why = _why_taken(host, port)
    if not why:
        return Finding(about, Status.OK, f"free at {host}, for the pages")
    try:
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=_ASK_S) as reply:
            ours = b"LACOC" in reply.read(_MIB)
    except (OSError, ValueError, urllib.error.URLError):
        ours = False
    if ours:
        return Finding(about, Status.OK, "pages are served here")
    status = Status.PROBLEM if needed else Status.NOTE
    todo = "End the program that has it, or give 'lacoc web' another port (--listen)."
    return Finding(about, status, f"the pages can't be served at {host}: {why}", todo)


def _why_taken(host: str, port: int) -> str:
    """Say why a program can't listen there; "" if it can."""
    try:
        family, kind, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        with socket.socket(family, kind) as probe:
            if os.name == "posix":  # on Windows two programs could share the port
                probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind(address)
            probe.listen()
    except OSError as error:
        return error.strerror or str(error)
    return ""


def graphics() -> Finding:
    """Report the graphics that a browser may use; only the browser knows which it uses."""
    look = (
        "In the browser: chrome://gpu or about:support says what it draws with. If a page is slow, "
        "choose the quality 'low' in its settings."
    )
    if sys.platform != "linux":
        found = f"{platform.system()}'s own: not looked at from here"
        return Finding("graphics", Status.OK, found, look)
    devices = sorted(map(str, Path("/dev/dri").glob("renderD*")))
    usable = [device for device in devices if os.access(device, os.R_OK | os.W_OK)]
    libraries = [name for name in ("EGL", "GL", "GLX") if ctypes.util.find_library(name)]
    drawn = f"libraries {', '.join(libraries) or 'none'}"
    if usable:
        return Finding("graphics", Status.OK, f"GPU {', '.join(usable)}; {drawn}")
    if devices:
        todo = f"Let this user in: add it to the group of the device. {look}"
        found = f"GPU {', '.join(devices)}, which this user may not use; {drawn}"
        return Finding("graphics", Status.NOTE, found, todo)
    found = f"no GPU found: a browser here draws by software; {drawn}"
    return Finding("graphics", Status.NOTE, found, look)


def clock(seconds: float) -> Finding:
    """Measure how punctually this machine wakes a program 50 times a second, as a court needs."""
    late_s = []
    due_s = time.monotonic()
    for _ in range(max(1, round(seconds / BEAT_S))):
        due_s += BEAT_S
        time.sleep(max(0.0, due_s - time.monotonic()))
        late_s.append(time.monotonic() - due_s)
        due_s = max(due_s, time.monotonic() - BEAT_S)  # a stall counts as one late beat, not many
    slow_percent = 100 * sum(one > BEAT_S for one in late_s) / len(late_s)
    resolution_ns = time.get_clock_info("monotonic").resolution * 1e9
    found = (
        f"{len(late_s)} beats of 20 ms: late by {_ms(statistics.median(late_s))} (median), "
        f"{_ms(max(late_s))} (worst), {slow_percent:.1f} % by more than 20 ms; resolution "
        f"{resolution_ns:.0f} ns"
    )
    if slow_percent <= _SLOW_PERCENT:
        return Finding("clock", Status.OK, found)
    todo = (
        "Something else keeps this machine busy: end it, switch off power saving, and hold no "
        "match here until this is ok."
    )
    status = Status.NOTE if slow_percent <= _TOO_SLOW_PERCENT else Status.PROBLEM
    return Finding("clock", status, found, todo)


def disk(folder: Path) -> Finding:
    """Check that records can be written to a folder, its free space, and how long a sync takes."""
    above = (folder.absolute(), *folder.absolute().parents)
    there = next(one for one in above if os.path.lexists(one))
    try:
        free_bytes = shutil.disk_usage(there).free
        syncs_s = _syncs_s(there)
    except OSError as error:
        found = f"records can't be written to {folder}: {error.strerror}"
        todo = "Name another folder: --recordings, or 'recordings' in the contest file."
        return Finding("disk", Status.PROBLEM, found, todo)
    found = (
        f"{folder}: {free_bytes / _MIB:,.0f} MiB free, a match has about 4; a sync takes "
        f"{_ms(statistics.median(syncs_s))} (median), {_ms(max(syncs_s))} (worst)"
    )
    if free_bytes < _LEAST_FREE_BYTES:
        return Finding("disk", Status.PROBLEM, found, "Make room.")
    if free_bytes < _GOOD_FREE_BYTES:
        return Finding("disk", Status.NOTE, found, "Make room before a long day.")
    if max(syncs_s) > _SLOW_FSYNC_S:
        todo = "A power cut may cost more than a second of a match: take a faster disk."
        return Finding("disk", Status.NOTE, found, todo)
    return Finding("disk", Status.OK, found)


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


def _ms(seconds: float) -> str:
    return f"{seconds * 1000:.1f} ms"
