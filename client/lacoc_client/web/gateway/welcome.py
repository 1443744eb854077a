"""The first message to a page: which courts there are, and what the page may do."""

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.home import Home
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_shared import __version__
from lacoc_shared.messages import PROTOCOL


def welcome(home: Home, court: str | None, can_act: bool = False, is_own: bool = False) -> bytes:
    """Make the first message to a page.

    Args:
        home: the gateway's settings.
        court: the court that the page watches; None: it follows the director, or the court that it
            named does not exist.
        can_act: whether the page may act, once a court accepts its token.
        is_own: whether this is a page of the person who started the gateway.
    """
    prefill = home.prefill if is_own else None
    filled = None
    if prefill is not None:
        filled = {
            "seat": prefill.seat,
            "name": prefill.name,
            "has_token": bool(prefill.token),
        }
    body = {
        "protocol": PROTOCOL,
        "version": __version__,
        "courts": list(home.courts),
        "court": court,
        "can_act": can_act,
        "home": home.kind,
        "contest": home.contest,
        "desk": home.desk,
        "cheers": home.cheers,
        "prefill": filled,
    }
    return wire.map_message(MessageKind.WELCOME, body)
