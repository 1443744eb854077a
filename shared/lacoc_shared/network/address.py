"""Addresses of courts: reads them, and explains why a connection failed.

Zenoh reports every failed connection with the same sentence. After a failure this module finds the
reason with a plain socket, and says what to do (docs/facts.md 4).
"""

import errno
import itertools
import re
import socket
import ssl
from collections.abc import Sequence
from contextlib import suppress
from functools import cache

from lacoc_shared.mistakes import UserError
from lacoc_shared.network.public import is_loopback, is_number
from lacoc_shared.words import Phrase, say

DEFAULT_PORT = 7447

ANY_HOST = ("0.0.0.0", "::")
"""Hosts that mean every address of this machine: one can listen at them, but not connect to
them."""

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
        text: the address as a person wrote it.
        protocol: the protocol for an address that names none: "tcp", or "tls" for a court with a
            certificate.

    Raises:
        UserError: if it is not an address.
    """
    match = _ADDRESS.fullmatch(text.strip())
    protocol = match["protocol"] or protocol if match else ""
    port = int(match["port"] or DEFAULT_PORT) if match else 0
    if match is None or protocol not in _PROTOCOLS or port > 65_535:
        raise UserError(say("address.none", text=text))
    return f"{protocol}/{match['host']}:{port}"


def host(one: str) -> str:
    """Return the host of a complete address."""
    return _split(one)[0]


def collisions(these: Sequence[str], others: Sequence[str]) -> list[str]:
    """Return those of `these` addresses at which a machine can't listen while it uses `others`."""
    return [one for one in these if any(_collide(_split(one), _split(other)) for other in others)]


def free_beside(one: str, taken: Sequence[str]) -> str:
    """Return address `one` with another port: the first from 7447 on that `taken` does not have."""
    ports = {_split(other)[1] for other in taken}
    free = next(port for port in itertools.count(DEFAULT_PORT) if port not in ports)
    return f"{one.rpartition(':')[0]}:{free}"


def check_protocols(endpoints: Sequence[str], *, encrypted: bool) -> None:
    """Check the protocols of a court's addresses: all TLS if it has a certificate, else none.

    Raises:
        UserError: if an address is wrong.
    """
    for one in endpoints:
        protocol, _, place = one.partition("/")
        if encrypted and protocol != "tls":
            raise UserError(say("address.not-encrypted", at=one, place=place))
        if protocol == "tls" and not encrypted:
            raise UserError(say("address.needs-certificate", at=one))


def why_not_known(endpoints: Sequence[str]) -> Phrase | None:
    """Return that the addresses' host names are unknown; None if any of them is known."""
    unknown = [host for host, port in map(_split, endpoints) if not _resolves(host, port)]
    if unknown and len(unknown) == len(endpoints):
        return say("connect.name-unknown", name=unknown[0])
    return None


def why_not_connected(endpoints: Sequence[str], authority: str = "") -> Phrase:
    """Return why no connection could be opened, in one sentence for each of these addresses.

    Args:
        endpoints: complete addresses.
        authority: certificate (PEM) of a private authority; "": only public authorities are
            trusted.
    """
    reasons = [_why_not_connected(one, authority) for one in endpoints]
    return reasons[0] if len(reasons) == 1 else say("plain.sentences", sentences=reasons)


def is_open(one: str, timeout_s: float = 0.5) -> bool:
    """Return whether a program listens at a complete address.

    This check is much faster than to open a session.
    """
    try:
        with socket.create_connection(_split(one), timeout=timeout_s):
            return True
    except OSError:
        return False


def check_free(endpoints: Sequence[str]) -> None:
    """Check that a program can listen on these complete addresses.

    Raises:
        UserError: if it can't listen on one of them; the message says why, and what to do.
    """
    for one in endpoints:
        if (why := _why_not_listening(one)) is not None:
            raise UserError(why)


def why_not_listening(endpoints: Sequence[str], error: Exception) -> Phrase:
    """Return why it was not possible to listen at these addresses.

    Args:
        endpoints: complete addresses.
        error: Zenoh's own error; it is shown if a plain socket can listen at all of them.
    """
    try:
        check_free(endpoints)
    except UserError as found:
        return found.phrase
    return say("listen.impossible", at=", ".join(endpoints), why=str(error))


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


def _why_not_connected(one: str, authority: str) -> Phrase:
    try:
        with socket.create_connection(_split(one), timeout=_PROBE_S) as probe:
            return _why_not_let_in(one, probe, authority)
    except ConnectionRefusedError:
        return say("connect.nobody", at=one)
    except socket.gaierror:
        return say("connect.unknown-name", at=one)
    except OSError as error:
        if isinstance(error, TimeoutError):
            return say("connect.unreachable", at=one, why=say("connect.no-answer"))
        return say("connect.unreachable", at=one, why=error.strerror or str(error))


def _why_not_let_in(one: str, probe: socket.socket, authority: str) -> Phrase:
    """Return why a court that can be reached did not let a client in.

    Args:
        one: the court's complete address.
        probe: a plain connection to the court.
        authority: as in `why_not_connected`.
    """
    protocol, _, place = one.partition("/")
    is_encrypted, name = protocol == "tls", _split(one)[0]
    context = ssl.create_default_context()
    try:
        if authority:
            context.load_verify_locations(cadata=authority)
    except (ssl.SSLError, TypeError):  # TypeError: a character that is not ASCII
        return say("connect.damaged-authority")
    context.check_hostname = is_encrypted and not is_own(name)
    if not is_encrypted:  # to see whether the court is encrypted
        context.verify_mode = ssl.CERT_NONE
    try:
        with context.wrap_socket(probe, server_hostname=name):
            pass
    except ssl.SSLCertVerificationError as error:
        return _why_not_trusted(one, name, error)
    except OSError:  # the other end has no TLS
        return (
            say("connect.not-encrypted", at=one)
            if is_encrypted
            else say("connect.not-let-in", at=one)
        )
    if is_encrypted:
        return say("connect.not-let-in", at=one)
    return say("connect.encrypted", at=one, place=place)


def _why_not_trusted(one: str, host: str, error: ssl.SSLCertVerificationError) -> Phrase:
    match error.verify_code:  # OpenSSL's X509_V_ERR_... codes; Python has no names for them
        case 9:
            return say("connect.not-valid-yet", at=one)
        case 10:
            return say("connect.expired", at=one)
        case 62 | 64:
            return say("connect.wrong-name", at=one, host=host)
    return say("connect.not-proven", at=one, reason=error.verify_message)


def _why_not_listening(one: str) -> Phrase | None:
    host, port = _split(one)
    try:
        family, kind, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        with socket.socket(family, kind) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind(address)
            probe.listen()
    except socket.gaierror:
        return say("listen.unknown-name", name=host)
    except OSError as error:
        if error.errno == errno.EADDRINUSE:
            return say("listen.port-used", port=str(port), at=one)
        if error.errno == errno.EADDRNOTAVAIL:
            return say("listen.not-this-machine", host=host)
        if error.errno == errno.EACCES:
            return say("listen.rights", port=str(port))
        return say("listen.impossible", at=one, why=error.strerror or str(error))
    return None


def own_address() -> str:
    """Return this machine's IP address towards the internet.

    If no route leads there, as in a hall with a switch alone, the address is the one that the
    machine's name has; if that has none, 127.0.0.1.
    """
    return _sender_to("192.0.2.1") or _by_name() or "127.0.0.1"


@cache
def _by_name() -> str:
    """Return the IP address of this machine's own name; "": it has none but loopback ones."""
    with suppress(OSError):
        for *_, at in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET):
            if not is_loopback(str(at[0])):
                return str(at[0])
    return ""


def is_own(name: str) -> bool:
    """Return whether an IP address or "localhost" is this machine: messages stay on it."""
    return is_loopback(name) or (is_number(name) and _sender_to(name) == name)


def _sender_to(number: str) -> str:
    """Return this machine's own IP address for messages to `number`; "": no way leads there."""
    family = socket.AF_INET6 if ":" in number else socket.AF_INET
    with socket.socket(family, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect((number, 9))  # sends nothing: it only finds the route
        except OSError:
            return ""
        return str(probe.getsockname()[0])
