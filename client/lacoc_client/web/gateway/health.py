"""The answer of a gateway to a program that checks whether the gateway is well."""

import msgspec


class GatewayHealth(msgspec.Struct, frozen=True, kw_only=True):
    """The state of a gateway, for programs that watch it, and how their request reached it."""

    version: str
    """Version of LACOC."""
    contest: str
    """Name of the contest; "" if there is none."""
    host: str
    """`Host` of the request as it arrived here; a proxy may have replaced it."""
    unnamed_proxy: bool
    """Whether a proxy named the machine that asks, but the gateway does not trust this proxy. Then
    all pages seem to come from one machine."""
    pages: tuple[str, ...] = ()
    """Paths at which the gateway has pages."""
