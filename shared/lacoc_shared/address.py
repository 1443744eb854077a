"""Addresses of courts: read as people write them, and explained when they don't work.

Zenoh has one sentence for every failed connection. Here the reason is found again
with a plain socket, after the failure, and said in words that help (network.md 4).
"""

import errno
import re
import socket
from collections.abc import Sequence

from lacoc_shared.mistakes import UserError

DEFAULT_PORT = 7447

_PROTOCOLS = ("tcp", "tls")
_ADDRESS = re.compile(
    r"(?:(?P<protocol>[a-z]+)/)?"
    r"(?P<host>\[[0-9A-Fa-f:.]+\]|[A-Za-z0-9_.-]+)"
    r"(?::(?P<port>[0-9]{1,5}))?"
)
_PROBE_S = 2.0


def endpoint(text: str) -> str:
    """Complete an address: "192.168.1.5" becomes "tcp/192.168.1.5:7447".

    Raises:
        UserError: if it is no address.
    """
    match = _ADDRESS.fullmatch(text.strip())
    protocol = match["protocol"] or "tcp" if match else ""
    port = int(match["port"] or DEFAULT_PORT) if match else 0
    if match is None or protocol not in _PROTOCOLS or port > 65_535:
        raise UserError(
            f"{text!r} is not an address. It looks like 192.168.1.5, court.example.org:7447 "
            "or tcp/127.0.0.1:7447."
        )
    return f"{protocol}/{match['host']}:{port}"


def check_names(endpoints: Sequence[str]) -> None:
    """Look up the names in complete addresses.

    Raises:
        UserError: if no address in the list has a name that is known.
    """
    unknown = [host for host, port in map(_split, endpoints) if not _resolves(host, port)]
    if unknown and len(unknown) == len(endpoints):
        raise UserError(
            f"The name {unknown[0]!r} is not known on this network. "
            "Check its spelling, or use the number (such as 192.168.1.5) instead."
        )


def why_not_connected(endpoints: Sequence[str]) -> str:
    """Say why none of these addresses could be connected, one sentence each."""
    return "\n".join(_why_not_connected(one) for one in endpoints)


def why_not_listening(endpoints: Sequence[str], error: Exception) -> str:
    """Say why it was not possible to listen on these addresses.

    Args:
        endpoints: complete addresses.
        error: the failure, for the case that a plain socket can listen on all of them.
    """
    reasons = filter(None, map(_why_not_listening, endpoints))
    return next(reasons, f"It is not possible to listen on {', '.join(endpoints)}: {error}")


def _split(one: str) -> tuple[str, int]:
    host, _, port = one.partition("/")[2].rpartition(":")
    return host.strip("[]"), int(port)


def _resolves(host: str, port: int) -> bool:
    try:
        return bool(socket.getaddrinfo(host, port, type=socket.SOCK_STREAM))
    except (OSError, UnicodeError):
        return False


def _why_not_connected(one: str) -> str:
    try:
        with socket.create_connection(_split(one), timeout=_PROBE_S):
            pass
    except ConnectionRefusedError:
        return f"Nobody listens at {one}. Is the court running, and is this its port?"
    except socket.gaierror:
        return f"The name in {one} is not known on this network."
    except OSError as error:
        reason = "no answer" if isinstance(error, TimeoutError) else error.strerror or str(error)
        return f"{one} can't be reached ({reason}). Check the address, the network and firewalls."
    return (
        f"Something answers at {one}, but it does not let this program in. Is it a court, "
        "and of the same version?"
    )


def _why_not_listening(one: str) -> str:
    host, port = _split(one)
    try:
        family, kind, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        with socket.socket(family, kind) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind(address)
            probe.listen()
    except socket.gaierror:
        return f"The name {host!r} is not known on this machine; listen on 0.0.0.0 or a number."
    except OSError as error:
        if error.errno == errno.EADDRINUSE:
            return (
                f"Port {port} is in use: another program listens at {one}. "
                "Stop it, or choose another port (0 takes a free one)."
            )
        if error.errno == errno.EADDRNOTAVAIL:
            return f"This machine has no address {host}. Listen on 0.0.0.0 to use all it has."
        if error.errno == errno.EACCES:
            return f"Port {port} needs the administrator's rights; take one above 1023."
        return f"It is not possible to listen at {one}: {error.strerror or error}."
    return ""
