"""Zenoh's configuration for courts and for all other programs, with a reason for each entry.

Some of Zenoh's defaults are dangerous for a public court: shared memory fails at 351 clients,
messages may have any size, a send may block, and peers bypass the access rules. Only this module
sets them.
"""

import base64
from collections.abc import Sequence
from typing import Any

from lacoc_shared.keyspace import (
    ASSIGN_MAX_BYTES,
    COMMAND_MAX_BYTES,
    DECISION_MAX_BYTES,
    JOIN_MAX_BYTES,
)
from lacoc_shared.network import address
from lacoc_shared.network.access_rules import (
    court_access_control,
    desk_access_control,
    studio_access_control,
)
from lacoc_shared.network.certificate import Pair
from lacoc_shared.studio import TRIAL_REPLY_MAX_BYTES

Config = dict[str, Any]

RUNTIME_POOLS = (
    "(rx:(worker_threads:16),acc:(worker_threads:8),net:(worker_threads:8),"
    "tx:(worker_threads:1),app:(worker_threads:4))"
)
"""Value of ZENOH_RUNTIME for a court. With the default pools, three clients that vanish silently
delay everybody's commands for ten seconds."""

MAX_SESSIONS = 1100
"""Most sessions of a court: 1,000 spectators, which it can serve (docs/measured.md), and some
for seats, referees and gateways. More pages need gateways; each gateway is one session."""

_HEADERS_BYTES = 2048
# Clients receive scenes and trials, which are larger than what a court receives.
_CLIENT_MAX_BYTES = TRIAL_REPLY_MAX_BYTES + _HEADERS_BYTES
_ASKED_MAX_BYTES = 1 << 20
"""Largest request that reaches a studio [bytes]. It is much larger than a studio reads, so that the
studio can answer that a request is too large."""
_LEASE_MS = 3000


def court_config(
    listen: Sequence[str],
    certificate: Pair | None = None,
    office: bool = False,
) -> Config:
    """Make the configuration of a court's own session.

    Args:
        listen: complete addresses.
        certificate: the certificate with which the court proves its name; None: nothing is
            encrypted.
        office: whether an office may assign matches; its requests are larger than all others.
    """
    largest = ASSIGN_MAX_BYTES if office else JOIN_MAX_BYTES
    return {
        **_common("router"),
        "listen": {"endpoints": list(listen)},
        # The court reads this itself to learn its port; the access rules deny it to all others.
        "adminspace": {"enabled": True, "permissions": {"read": True, "write": False}},
        "access_control": court_access_control(),
        "low_pass_filter": [
            _limit("commands", "lacoc/*/seat/*/key", COMMAND_MAX_BYTES),
            _limit("ready", "lacoc/*/seat/*/ready", COMMAND_MAX_BYTES),
            _limit("leave", "lacoc/*/seat/*/leave", COMMAND_MAX_BYTES),
            _limit("tries", "lacoc/*/seat/*/try", COMMAND_MAX_BYTES),
            _limit("decisions", "lacoc/*/referee/*", DECISION_MAX_BYTES),
            _limit("outlooks", "lacoc/*/outlook", DECISION_MAX_BYTES),
            _limit("joins", "lacoc/*/seat/*/join", JOIN_MAX_BYTES),
            _limit("office", "lacoc/*/office/*", ASSIGN_MAX_BYTES),
            _limit("where", "lacoc/*/where", COMMAND_MAX_BYTES),
        ],
        "transport": _transport(largest + _HEADERS_BYTES, _court_tls(certificate))
        | {"unicast": _unicast()},
    }


def studio_config(listen: Sequence[str]) -> Config:
    """Make the configuration of a studio's own session; nothing is encrypted.

    Args:
        listen: complete addresses.
    """
    return {
        **_common("router"),
        "listen": {"endpoints": list(listen)},
        "adminspace": {"enabled": True, "permissions": {"read": True, "write": False}},
        "access_control": studio_access_control(),
        "transport": _transport(_ASKED_MAX_BYTES + _HEADERS_BYTES, {}) | {"unicast": _unicast()},
    }


def desk_config(listen: Sequence[str]) -> Config:
    """Make the configuration of the session of an office's desk.

    It is that of a studio, with the access rules of a desk.

    Args:
        listen: complete addresses.
    """
    return studio_config(listen) | {"access_control": desk_access_control()}


def client_config(connect: Sequence[str], timeout_s: float, authority: str = "") -> Config:
    """Make the Zenoh configuration of a client of a court or a studio.

    Args:
        connect: complete addresses; the first that answers is used.
        timeout_s: time limit of the first connection; later ones are tried forever.
        authority: certificate (PEM) of a private authority, which is trusted in addition to the
            public ones.
    """
    return {
        **_common("client"),
        "connect": {
            "endpoints": [_checked(one) for one in connect],
            "timeout_ms": round(timeout_s * 1000),
            # A client finds a court that comes back within half a second.
            "retry": {"period_init_ms": 100, "period_max_ms": 500, "period_increase_factor": 1.5},
        },
        "transport": _transport(_CLIENT_MAX_BYTES, _client_tls(authority)),
    }


def _common(mode: str) -> Config:
    return {
        "mode": mode,  # a peer would not be brokered, or would bypass the access rules
        # Nobody is searched for, so the delay of half a second for the search is not needed.
        "scouting": {"delay": 0, "multicast": {"enabled": False}, "gossip": {"enabled": False}},
    }


def _unicast() -> Config:
    # Connections that stay silent must not keep others waiting.
    return {"max_sessions": MAX_SESSIONS, "accept_pending": 1000, "accept_timeout": 3000}


def _court_tls(certificate: Pair | None) -> Config:
    if certificate is None:
        return {}
    files = {"listen_certificate": certificate.certificate, "listen_private_key": certificate.key}
    return {"tls": {name: str(path) for name, path in files.items()}}


def _checked(endpoint: str) -> str:
    """Return an endpoint that makes Zenoh check the court's name, unless it is this machine.

    A message to this machine stays on it, and no public certificate is for 127.0.0.1.
    """
    here = endpoint.startswith("tls/") and address.is_own(address.host(endpoint))
    return f"{endpoint}#verify_name_on_connect=false" if here else endpoint


def _client_tls(authority: str) -> Config:
    # Zenoh knows the public authorities by itself.
    encoded = base64.b64encode(authority.encode()).decode()
    return {"tls": {"root_ca_certificate_base64": encoded}} if authority else {}


def _transport(max_message_bytes: int, tls: Config) -> Config:
    return {
        # Shared memory fails at 351 clients, and killed clients leave files behind.
        "shared_memory": {"enabled": False},
        "link": {
            "tx": {
                "lease": _LEASE_MS,
                "keep_alive": 4,
                # Replies always block: a client that does not read is disconnected after 0.2 s.
                "queue": {"congestion_control": {"block": {"wait_before_close": 200_000}}},
            },
            "rx": {"max_message_size": max_message_bytes},
            **tls,
        },
    }


def _limit(name: str, key_expression: str, max_bytes: int) -> Config:
    return {
        "id": name,
        "flows": ["ingress"],
        "messages": ["put", "delete", "query"],
        "key_exprs": [key_expression],
        "size_limit": max_bytes,
    }
