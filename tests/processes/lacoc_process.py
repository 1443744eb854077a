"""Starts `lacoc` in a process of its own, and saves the time that loading libraries takes."""

import atexit
import functools
import json
import os
import select
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Self

from waiting import LIMIT_S

COMMAND = (sys.executable, "-m", "lacoc_shared")
"""The command line that starts `lacoc` in a new interpreter, as users do."""
ALONE = "alone"
"""First word of a command line for `tests.processes.alone`: a court that is started alone."""

_SERVER = Path(__file__).with_name("fork_server.py")
_STATUS = struct.Struct("i")


class Lacoc(subprocess.Popen[Any]):
    """A `lacoc` process: a `Popen` that is forked from a server which has already loaded `lacoc`.

    Only the start differs: the process has its own memory, streams, signals and exit code.
    """

    _status = -1

    def __init__(self, *words: str, **options: Any) -> None:
        super().__init__(command_line(words), **options)

    if hasattr(socket, "send_fds"):  # Windows lacks it and starts a new interpreter

        def _execute_child(self, args: list[str], *options: Any) -> None:
            folder, environment = options[4:6]
            pipes = options[9:15]
            request = {
                "module": args[2],
                "words": args[len(COMMAND) :],
                "folder": str(Path(folder or ".").absolute()),
                "environment": dict(os.environ if environment is None else environment),
            }
            streams = [
                own if one == -1 else one for own, one in enumerate(pipes[i] for i in (0, 3, 5))
            ]
            self._status, status = os.pipe()
            try:
                self.pid = _server().fork(json.dumps(request).encode(), [*streams, status])
            finally:
                os.close(status)
            self._child_created = True
            self._close_pipe_fds(*pipes)

        def _try_wait(self, wait_flags: int) -> tuple[int, int]:
            """Return what `os.waitpid` would return if the process were a child of this one."""
            if wait_flags & os.WNOHANG and not select.select([self._status], [], [], 0)[0]:
                return 0, 0
            data = os.read(self._status, _STATUS.size)
            os.close(self._status)
            return self.pid, _STATUS.unpack(data)[0] if data else signal.SIGKILL  # server ended

        def _internal_poll(self, _deadstate: int | None = None) -> int | None:
            if self.returncode is None and self._waitpid_lock.acquire(False):
                try:
                    if self.returncode is None and self._status != -1:
                        pid, status = self._try_wait(os.WNOHANG)
                        if pid:
                            self._handle_exitstatus(status)
                finally:
                    self._waitpid_lock.release()
            return self.returncode


def command_line(words: Sequence[str]) -> list[str]:
    """Return the whole command line of a `lacoc` command, or of a court that is started alone."""
    if words[:1] == (ALONE,):
        return [sys.executable, "-m", "tests.processes.alone", *words[1:]]
    return [*COMMAND, *words]


def environment(**changes: str) -> dict[str, str]:
    """Return this process's environment without LACOC_ variables (options), and with `changes`."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("LACOC_")}
    return kept | changes


def started(
    *words: str, before: Sequence[str] = (), fresh: bool = False, **options: Any
) -> subprocess.Popen[Any]:
    """Start a `lacoc` command.

    Args:
        words: its words.
        before: words that precede it on the command line.
        fresh: whether it gets a new interpreter, as what is measured must have.
        options: of `subprocess.Popen`.
    """
    if before or fresh:
        return subprocess.Popen([*before, *command_line(words)], **options)
    return Lacoc(*words, **options)


class Running:
    """A `lacoc` command that runs until it is closed; a context manager.

    Args:
        words: its words; with them it must say in a line of JSON that it is open.
        log: file for its messages; None: they go where this process's go.
        options: of `started`.
    """

    def __init__(self, *words: str, log: Path | None = None, **options: Any) -> None:
        streams: dict[str, Any] = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE}
        with ExitStack() as stack:
            if log is not None:
                streams["stderr"] = stack.enter_context(log.open("ab"))
            self.process = started(*words, text=True, **streams | options)
        assert self.process.stdout is not None
        self.said: str = self.process.stdout.readline()
        """The standard output: its first line, and after `close` all of it."""
        self.opened: dict[str, Any] = json.loads(self.said)
        self._reader: threading.Thread | None = None

    def kill(self) -> None:
        """Kill the process, as a power cut does."""
        self.process.kill()
        self.process.wait(LIMIT_S)

    def signal(self, number: signal.Signals) -> None:
        """Send a signal to the process."""
        self.process.send_signal(number)

    def hush(self) -> None:
        """Throw away all further output: a full pipe would stop the process."""
        assert self.process.stdout is not None
        self._reader = threading.Thread(target=self.process.stdout.read, daemon=True)
        self._reader.start()

    def close(self) -> None:
        """Ask the process to end, also if it is stopped, and wait until it has."""
        assert self.process.stdout is not None
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGCONT)
            self.process.terminate()
        if self._reader is not None:
            self.process.wait(LIMIT_S)
        elif not self.process.stdout.closed:
            self.said += self.process.communicate(timeout=LIMIT_S)[0]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def contest_run(file: Path, *words: str, **options: Any) -> Running:
    """Run a contest with its office, courts and pages."""
    return Running("contest", "run", str(file), "--json", *words, **options)


def run_lacoc(*words: str, input: str = "", timeout_s: float = 60.0, **options: Any) -> Any:
    """Run a `lacoc` command to its end.

    Returns:
        A `subprocess.CompletedProcess` with its output as text.

    Raises:
        TimeoutExpired: if the command takes longer than `timeout_s`; the process is then killed.
    """
    streams = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with Lacoc(*words, text=True, **streams | options) as process:
        try:
            out, err = process.communicate(input, timeout=timeout_s)
        except subprocess.TimeoutExpired:
            process.kill()
            raise
    return subprocess.CompletedProcess(process.args, process.returncode, out, err)


class _ForkServer:
    """The server that forks `lacoc` processes; it ends with the process of the tests."""

    def __init__(self) -> None:
        self._socket, its = socket.socketpair()
        self._trouble = tempfile.TemporaryFile()  # noqa: SIM115 - open while the server runs
        self._lock = threading.Lock()
        with its:
            # No stream of the server may look like a terminal to its children.
            self._process = subprocess.Popen(
                [sys.executable, str(_SERVER), str(its.fileno())],
                pass_fds=[its.fileno()],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=self._trouble,
            )

    def fork(self, request: bytes, descriptors: list[int]) -> int:
        """Fork a process and return its id."""
        with self._lock:
            socket.send_fds(self._socket, [request], descriptors)
            answer = self._socket.recv(_STATUS.size)
        if not answer:
            self._trouble.seek(0)
            raise RuntimeError(f"The fork server has ended:\n{self._trouble.read().decode()}")
        pid: int = _STATUS.unpack(answer)[0]
        return pid

    def close(self) -> None:
        self._socket.close()
        self._process.wait()


@functools.cache
def _server() -> _ForkServer:
    server = _ForkServer()
    atexit.register(server.close)
    return server
