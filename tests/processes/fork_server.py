"""Forks `lacoc` processes for tests, so that Python and its libraries are loaded only once.

`lacoc_process` starts this server with the descriptor of a Unix socket. A request carries the file
descriptors of the new process, and the server answers with its process id. When the process ends,
the server writes its wait status to the last of these descriptors. The server ends when the socket
is closed.
"""

import contextlib
import gc
import importlib
import json
import os
import pkgutil
import selectors
import signal
import socket
import struct
import sys
from pathlib import Path

from lacoc_shared.command.cli import main
from lacoc_shared.words.table import table

STATUS = struct.Struct("i")
MOST_BYTES = 1 << 20


PACKAGES = ("lacoc_shared", "lacoc_robots", "lacoc_arenas", "lacoc_server", "lacoc_client")
LATER = ("typer._adapters", "uvicorn.protocols.http.h11_impl")
"""Modules of libraries that are imported only when a command runs."""


def preload() -> None:
    """Import all our modules, also those that a command imports late, and read the sentences."""
    for package in map(importlib.import_module, PACKAGES):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if not module.name.endswith("__main__"):
                with contextlib.suppress(ImportError):  # without its satellite
                    importlib.import_module(module.name)
    for name in LATER:
        importlib.import_module(name)
    table()
    gc.freeze()  # garbage collection in a child then copies no shared memory


def serve(door: socket.socket) -> int:
    """Fork a process for each request, until the socket is closed.

    The function also returns in each forked process, after that process has run its command.

    Returns:
        0 in the server, and the exit code of the command in a forked process.
    """
    ring, rung = socket.socketpair()
    rung.setblocking(False)
    ring.setblocking(False)
    signal.signal(signal.SIGCHLD, lambda *_: None)
    signal.set_wakeup_fd(ring.fileno())
    waiting: dict[int, int] = {}
    with selectors.DefaultSelector() as selector:
        selector.register(door, selectors.EVENT_READ)
        selector.register(rung, selectors.EVENT_READ)
        while True:
            ready = {key.fileobj for key, _ in selector.select()}
            if rung in ready:
                rung.recv(4096)
                reap(waiting)
            if door not in ready:
                continue
            data, descriptors, _, _ = socket.recv_fds(door, MOST_BYTES, 4)
            if not data:
                return 0
            *streams, status = descriptors
            pid = os.fork()
            if pid == 0:
                for own in (selector, door, ring, rung):
                    own.close()
                for number in (status, *waiting.values()):
                    os.close(number)
                request = json.loads(data)
                become(request, streams)
                if request["module"] != "lacoc_shared":
                    sys.path.append(str(Path(__file__).parents[2]))
                    return importlib.import_module(request["module"]).main()
                return main()
            waiting[pid] = status
            for number in streams:
                os.close(number)
            door.send(STATUS.pack(pid))


def reap(waiting: dict[int, int]) -> None:
    """Report each process that has ended, and forget it.

    Args:
        waiting: process ids, each with the file descriptor to which its wait status is written.
    """
    for pid in list(waiting):
        ended, status = os.waitpid(pid, os.WNOHANG)
        if ended:
            number = waiting.pop(pid)
            with contextlib.suppress(BrokenPipeError):  # the reader has gone
                os.write(number, STATUS.pack(status))
            os.close(number)


def become(request: dict[str, object], streams: list[int]) -> None:
    """Give this process the streams, folder, environment and arguments of the request."""
    signal.set_wakeup_fd(-1)
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    for number, stream in enumerate(streams):
        os.dup2(stream, number)
        os.close(stream)
    # Python's stream objects remember whether the server's streams could seek: make new ones.
    sys.stdin = os.fdopen(0, encoding="utf-8", closefd=False)
    sys.stdout = os.fdopen(1, "w", encoding="utf-8", closefd=False)
    sys.stderr = os.fdopen(
        2, "w", encoding="utf-8", errors="backslashreplace", buffering=1, closefd=False
    )
    os.chdir(request["folder"])
    os.environ.clear()
    os.environ.update(request["environment"])
    sys.argv = ["lacoc", *request["words"]]


if __name__ == "__main__":
    preload()
    sys.exit(serve(socket.socket(fileno=int(sys.argv[1]))))
