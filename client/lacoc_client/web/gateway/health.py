"""What a gateway says of itself, and how a request came to it."""

import msgspec


class GatewayHealth(msgspec.Struct, frozen=True, kw_only=True):
    """What a gateway says of itself to whoever watches over it."""

    version: str
    """Version of LACOC."""
    contest: str
    """Name of the contest; "" if there is none."""
    host: str
    """The request's `Host`, which a proxy may have replaced."""
    unnamed_proxy: bool
    """Whether a proxy says who asks and is not believed: all then seem to be one machine."""
    pages: tuple[str, ...] = ()
    """Paths of the pages."""
