"""The address at which everybody opens the pages, and the certificate for it.

A gateway serves pages at a port of its machine. Others may open them at another address: a domain
name that leads there, or the address of a proxy (docs/online.md).
"""

import ipaddress
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Self
from urllib.parse import SplitResult, urlsplit

import msgspec

from lacoc_shared.mistakes import Gathered, UserError, printable
from lacoc_shared.network.certificate import Pair, fingerprint
from lacoc_shared.words import say

_STANDARD = {"http": 80, "https": 443}
_ADDRESS = re.compile(
    r"(?P<scheme>https?)://(?P<host>[a-z0-9.-]+|\[[0-9a-f:.]+\])(:(?P<port>[0-9]{1,5}))?"
    r"(?P<path>(/[\w.~-]+)*/*)",
    re.ASCII | re.IGNORECASE,
)


class PublicAddress(msgspec.Struct, frozen=True, kw_only=True):
    """The address at which others reach the pages, with certificate and proxies."""

    pages: str = ""
    """Address of the pages without a slash at its end, such as "https://uni.example/lacoc"; "": the
    address of this machine.
    """
    certificate: Path | None = None
    """Certificate of pages and courts (PEM, with those between it and an authority); None: nothing
    is encrypted."""
    private_key: Path | None = None
    """The certificate's key (PEM)."""
    authority: Path | None = None
    """Certificate (PEM) of the private authority that signed it; None: a public authority did."""
    proxies: tuple[str, ...] = ()
    """Addresses or networks of proxies whose `X-Forwarded-For` is believed: it says which machine
    asks."""

    @classmethod
    def of(
        cls,
        pages: str = "",
        certificate: Path | None = None,
        private_key: Path | None = None,
        proxies: Iterable[str] = (),
        authority: Path | None = None,
    ) -> Self:
        """Make a public address from its parts, after checking them.

        Raises:
            UserError: if something is wrong; the message names all mistakes.
        """
        found, address = Gathered(), ""
        networks: tuple[str, ...] = ()
        with found:
            address = _address(pages)
        with found:
            networks = tuple(map(_network, proxies))
        with found:
            if (certificate is None) != (private_key is None):
                raise UserError(say("public.half-a-pair"))
        with found:
            if certificate is not None and address.startswith("http:"):
                raise UserError(say("public.not-https", pages=address))
        found.check()
        return cls(
            pages=address,
            certificate=certificate,
            private_key=private_key,
            authority=authority,
            proxies=networks,
        )

    @property
    def host(self) -> str:
        """Host of the pages in small letters; "": the pages have no address of their own."""
        return self._parts.hostname or ""

    @property
    def path(self) -> str:
        """Path below which the pages are, such as "/lacoc"; "": they are at the top."""
        return self._parts.path

    @property
    def origin(self) -> str:
        """Origin of the pages, as browsers send it; "": the pages have no address of their own."""
        return f"{self._parts.scheme}://{self._parts.netloc}" if self.pages else ""

    @property
    def scheme(self) -> str:
        """Scheme of the gateway's own port: "https" with a certificate, else "http"."""
        return "http" if self.certificate is None else "https"

    @property
    def protocol(self) -> str:
        """The protocol of courts whose addresses name none: TLS with a certificate, else TCP."""
        return "tcp" if self.certificate is None else "tls"

    @property
    def pair(self) -> Pair | None:
        """The files of certificate and private key; None: nothing is encrypted."""
        if self.certificate is None or self.private_key is None:
            return None
        return Pair(self.certificate, self.private_key)

    @property
    def fingerprint(self) -> str:
        """Fingerprint of the private authority, for links; "": there is no private authority.

        Raises:
            UserError: if its certificate can't be read, or is damaged.
        """
        authority = self.read_authority()
        try:
            return fingerprint(authority) if authority else ""
        except ValueError as error:
            why = str(error)
            raise UserError(say("public.no-authority", file=str(self.authority), why=why)) from None

    def read_authority(self) -> str:
        """Return the certificate (PEM) of the private authority; "": there is no private authority.

        Raises:
            UserError: if it can't be read.
        """
        if self.authority is None:
            return ""
        try:
            return self.authority.read_text(encoding="ascii")
        except (OSError, UnicodeDecodeError) as error:
            why = (error.strerror if isinstance(error, OSError) else None) or str(error)
            raise UserError(say("public.no-authority", file=str(self.authority), why=why)) from None

    @property
    def _parts(self) -> SplitResult:
        return urlsplit(self.pages)


def is_loopback(host: str) -> bool:
    """Return whether a host is this machine itself, such as "localhost" or 127.0.0.1."""
    if not is_number(host):
        return host.lower() == "localhost"
    return ipaddress.ip_address(host).is_loopback


def is_proxy(machine: str, proxies: Sequence[str] | str | None) -> bool:
    """Return whether an address is that of a proxy, or in a network of proxies."""
    if not proxies or not is_number(machine):
        return False
    found = ipaddress.ip_address(machine)
    return any(found in ipaddress.ip_network(one) for one in proxies)


def _address(pages: str) -> str:
    """Return the pages' address without a slash at its end; host and scheme in small letters."""
    if not pages.strip():
        return ""
    match = _ADDRESS.fullmatch(pages.strip())
    wrong = UserError(say("public.not-an-address", pages=printable(pages, 200)))
    if match is None:
        raise wrong
    scheme, host = match["scheme"].lower(), match["host"].lower()
    port = int(match["port"] or _STANDARD[scheme])
    if not 0 < port < 65_536 or (host[0] == "[" and not is_number(host[1:-1])):
        raise wrong
    where = host if port == _STANDARD[scheme] else f"{host}:{port}"
    return f"{scheme}://{where}{match['path'].rstrip('/')}"


def is_number(host: str) -> bool:
    """Return whether a host is an IP address."""
    try:
        ipaddress.ip_address(host)
    except ValueError:
        return False
    return True


def _network(proxy: str) -> str:
    try:
        network = ipaddress.ip_network(proxy.strip(), strict=False)
    except ValueError:
        raise UserError(say("public.not-a-proxy", proxy=printable(proxy, 80))) from None
    return str(network if network.num_addresses > 1 else network.network_address)
