"""Zenoh's configuration for courts and for everyone else, each entry with its reason.

Six of Zenoh's defaults are dangerous for a public court: a memory limit of 351
clients, unlimited messages, blocking sends, peers that go round the access rules.
This is the one place where they are set right.
"""

from collections.abc import Sequence
from typing import Any

from lacoc_shared.keyspace import COMMAND_MAX_BYTES, DECISION_MAX_BYTES, JOIN_MAX_BYTES

Config = dict[str, Any]

RUNTIME_POOLS = (
    "(rx:(worker_threads:16),acc:(worker_threads:8),net:(worker_threads:8),"
    "tx:(worker_threads:4),app:(worker_threads:4))"
)
"""Value of ZENOH_RUNTIME for a court: with the default pools three clients that vanish silently
hold up everybody's commands for ten seconds."""

_HEADERS_BYTES = 2048
_CLIENT_MAX_BYTES = 1 << 20  # a scene is far above what a court needs to take in
_LEASE_MS = 3000


def court_config(listen: Sequence[str]) -> Config:
    """The configuration of a court's own session.

    Args:
        listen: complete addresses.
    """
    return {
        **_common("router"),
        "listen": {"endpoints": list(listen)},
        # Read by the court itself, to learn the port it got; the access rules deny it to others.
        "adminspace": {"enabled": True, "permissions": {"read": True, "write": False}},
        "access_control": _access(),
        "low_pass_filter": [
            _limit("commands", "lacoc/*/seat/*/key", COMMAND_MAX_BYTES),
            _limit("ready", "lacoc/*/seat/*/ready", COMMAND_MAX_BYTES),
            _limit("leave", "lacoc/*/seat/*/leave", COMMAND_MAX_BYTES),
            _limit("decisions", "lacoc/*/referee/*", DECISION_MAX_BYTES),
            _limit("joins", "lacoc/*/seat/*/join", JOIN_MAX_BYTES),
        ],
        "transport": _transport(JOIN_MAX_BYTES + _HEADERS_BYTES)
        | {
            # Connections that never say anything must not keep others waiting.
            "unicast": {"max_sessions": 800, "accept_pending": 1000, "accept_timeout": 3000}
        },
    }


def client_config(connect: Sequence[str], timeout_s: float) -> Config:
    """The configuration of everyone who is not a court.

    Args:
        connect: complete addresses; the first that answers is taken.
        timeout_s: how long the first connection may take; later ones are tried for ever.
    """
    return {
        **_common("client"),
        "connect": {
            "endpoints": list(connect),
            "timeout_ms": round(timeout_s * 1000),
            # A court that comes back is found within half a second.
            "retry": {"period_init_ms": 100, "period_max_ms": 500, "period_increase_factor": 1.5},
        },
        "transport": _transport(_CLIENT_MAX_BYTES),
    }


def _common(mode: str) -> Config:
    return {
        "mode": mode,  # a peer would not be brokered, or would go round the access rules
        # Nobody is searched for, so there is nothing to wait half a second for either.
        "scouting": {"delay": 0, "multicast": {"enabled": False}, "gossip": {"enabled": False}},
    }


def _transport(max_message_bytes: int) -> Config:
    return {
        # Shared memory ends at 351 clients and leaves litter behind killed ones.
        "shared_memory": {"enabled": False},
        "link": {
            "tx": {
                "lease": _LEASE_MS,
                "keep_alive": 4,
                # Replies always block: 0.2 s for a client that does not read, then it is cut off.
                "queue": {"congestion_control": {"block": {"wait_before_close": 200_000}}},
            },
            "rx": {"max_message_size": max_message_bytes},
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


def _access() -> Config:
    """Access rules: all that is not allowed is denied, so nobody but the court sends frames."""
    # A wildcard does not cover the @ of a history: it is named.
    histories = ["lacoc/*/event/@adv/**", "lacoc/*/sheet/@adv/**"]
    rules = {
        "court-to-all": _rule(
            "egress",
            ["lacoc/**", *histories],
            [
                *("put", "delete", "reply", "query", "declare_subscriber", "declare_queryable"),
                *("liveliness_token", "liveliness_query", "declare_liveliness_subscriber"),
            ],
        ),
        "watch": _rule(
            "ingress",
            [*(f"lacoc/*/{what}" for what in ("frame", "event", "sheet", "health")), *histories],
            ["declare_subscriber"],
        ),
        "fetch": _rule(
            "ingress",
            [*(f"lacoc/*/{what}" for what in ("sheet", "scene", "event/**")), *histories],
            ["query"],
        ),
        "presence": _rule(
            "ingress",
            ["lacoc/*/live/**", *histories],
            ["liveliness_query", "declare_liveliness_subscriber"],
        ),
        "command": _rule("ingress", ["lacoc/*/seat/*/key"], ["put"]),
        "request": _rule("ingress", ["lacoc/*/seat/*/*", "lacoc/*/referee/*"], ["query"]),
    }
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": [{"id": name, **rule} for name, rule in rules.items()],
        "subjects": [{"id": "anyone"}],
        "policies": [{"rules": list(rules), "subjects": ["anyone"]}],
    }


def _rule(flow: str, key_expressions: list[str], messages: list[str]) -> Config:
    return {
        "permission": "allow",
        "flows": [flow],
        "key_exprs": key_expressions,
        "messages": messages,
    }
