"""Addresses of courts: read as people write them, and explained when they don't work.

Zenoh has one sentence for every failed connection. Here the reason is found again
with a plain socket, after the failure, and said in words that help (network.md 4).
"""

import errno
import itertools
import re
import socket
import ssl
from collections.abc import Sequence

from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

DEFAULT_PORT = 7447

ANY_HOST = ("0.0.0.0", "::")
"""Every address of this machine: to listen at, not to call."""

_PROTOCOLS = ("tcp", "tls")
_ADDRESS = re.compile(
    r"(?:(?P<protocol>[a-z]+)/)?"
    r"(?P<host>\[[0-9A-Fa-f:.]+\]|[A-Za-z0-9_.-]+)"
    r"(?::(?P<port>[0-9]{1,5}))?"
)
_PROBE_S = 2.0


def endpoint(text: str, protocol: str = "tcp") -> str:
    """Complete an address: "192.168.1.5" becomes "tcp/192.168.1.5:7447".

    Args:
        text: what a person wrote.
        protocol: "tls" for a court with keys.

    Raises:
        UserError: if it is no address.
    """
    match = _ADDRESS.fullmatch(text.strip())
    protocol = match["protocol"] or protocol if match else ""
    port = int(match["port"] or DEFAULT_PORT) if match else 0
    if match is None or protocol not in _PROTOCOLS or port > 65_535:
        raise UserError(say("address.none", text=text))
    return f"{protocol}/{match['host']}:{port}"


def host(one: str) -> str:
    """The host of a complete address."""
    return _split(one)[0]


def collisions(these: Sequence[str], others: Sequence[str]) -> list[str]:
    """Which of these complete addresses a machine can't listen at beside the others."""
    return [one for one in these if any(_collide(_split(one), _split(other)) for other in others)]


def free_beside(one: str, taken: Sequence[str]) -> str:
    """A complete address as this one, with the first port that none of those taken has."""
    ports = {_split(other)[1] for other in taken}
    free = next(port for port in itertools.count(DEFAULT_PORT) if port not in ports)
    return f"{one.rpartition(':')[0]}:{free}"


def check_protocols(endpoints: Sequence[str], *, keys: bool) -> None:
    """See that complete addresses are encrypted where there are keys, and plain elsewhere.

    Raises:
        UserError: if one is not.
    """
    for one in endpoints:
        protocol, _, place = one.partition("/")
        if keys and protocol != "tls":
            raise UserError(say("address.plain-with-keys", at=one, place=place))
        if protocol == "tls" and not keys:
            raise UserError(say("address.needs-keys", at=one))


def why_not_known(endpoints: Sequence[str]) -> str | None:
    """Look up the names in complete addresses; say so if no address has a name that is known."""
    unknown = [host for host, port in map(_split, endpoints) if not _resolves(host, port)]
    if unknown and len(unknown) == len(endpoints):
        return (
            f"The name {unknown[0]!r} is not known on this network. "
            "Check its spelling, or use the number (such as 192.168.1.5) instead."
        )
    return None


def why_not_connected(endpoints: Sequence[str], ca: str = "") -> str:
    """Say why none of these addresses could be connected, one sentence each.

    Args:
        endpoints: complete addresses.
        ca: certificate of the authority that vouches for the court (PEM); "" without keys.
    """
    return "\n".join(_why_not_connected(one, ca) for one in endpoints)


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


def _collide(one: tuple[str, int], other: tuple[str, int]) -> bool:
    same_host = one[0] == other[0] or one[0] in ANY_HOST or other[0] in ANY_HOST
    return same_host and one[1] == other[1] != 0  # port 0 takes a free one


def _resolves(host: str, port: int) -> bool:
    try:
        return bool(socket.getaddrinfo(host, port, type=socket.SOCK_STREAM))
    except (OSError, UnicodeError):
        return False


def _why_not_connected(one: str, ca: str) -> str:
    try:
        with socket.create_connection(_split(one), timeout=_PROBE_S) as probe:
            return _why_not_let_in(one, probe, ca)
    except ConnectionRefusedError:
        return f"Nobody listens at {one}. Is the court running, and is this its port?"
    except socket.gaierror:
        return f"The name in {one} is not known on this network."
    except OSError as error:
        reason = "no answer" if isinstance(error, TimeoutError) else error.strerror or str(error)
        return f"{one} can't be reached ({reason}). Check the address, the network and firewalls."


def _why_not_let_in(one: str, probe: socket.socket, ca: str) -> str:
    """Say why a court that answers did not take a client in.

    Args:
        one: its complete address.
        probe: a plain connection to it.
        ca: as in `why_not_connected`.
    """
    host = _split(one)[0]
    try:
        context = ssl.create_default_context(cadata=ca) if ca else _trusting_all()
    except (ssl.SSLError, TypeError):  # TypeError: a character that is not ASCII
        return "The certificate in the invitation is damaged: ask the organiser for it again."
    try:
        with context.wrap_socket(probe, server_hostname=host):
            pass
    except ssl.SSLCertVerificationError as error:
        sentence = _CERTIFICATE_SENTENCES.get(error.verify_code, _OTHER_CERTIFICATE)
        return sentence.format(at=one, host=host, reason=error.verify_message)
    except OSError:  # it speaks no TLS
        return (_NO_KEYS if ca else _NO_COURT).format(at=one)
    if not ca:
        return (
            f"The court at {one} has keys: enter with the invitation that the organiser has for "
            "you (--invitation FILE), or with the contest file."
        )
    return (
        f"The court at {one} is the right one, but it does not take this token. Ask the organiser "
        "for the invitation that is valid now; a court that is full or of another version refuses "
        "in the same way."
    )


def _trusting_all() -> ssl.SSLContext:
    """For a look whether there are keys at all."""
    context = ssl.create_default_context()
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    return context


_NO_COURT = (
    "Something answers at {at}, but it does not let this program in. Is it a court, and of the "
    "same version?"
)
_NO_KEYS = (
    "What answers at {at} has no keys, and your invitation is for a court that has. Is it the "
    "right port, and was the court started with its contest file?"
)
_OTHER_CERTIFICATE = (
    "What answers at {at} can't prove that it is the court of your invitation ({reason}). Do not "
    "go on; ask the organiser whether the address is right and the invitation the newest."
)
_WRONG_NAME = (
    "The certificate of the court at {at} is not made for the name {host}. Use the name in your "
    "invitation; an organiser adds one with 'lacoc contest keys --host {host}'."
)
_CERTIFICATE_SENTENCES = {  # OpenSSL's X509_V_ERR_..., which Python has no names for
    9: "The certificate of the court at {at} is not valid yet: is this machine's clock right?",
    10: "The certificate of the court at {at} has expired, or this machine's clock is wrong. "
    "An organiser makes new keys with 'lacoc contest keys --renew'.",
    62: _WRONG_NAME,
    64: _WRONG_NAME,
}


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
