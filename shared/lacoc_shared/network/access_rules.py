"""Zenoh's access rules: for a court, made from its users; for a studio; for an office's desk.

Zenoh gives a court no trustworthy information about a sender, so the rules do the check:
a message that a user may not send reaches neither the court nor anybody else.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from lacoc_shared.keyspace import DESK, Keys

Rules = dict[str, dict[str, Any]]
"""Rules by name."""


class Credentials(NamedTuple):
    """A client's name and password for a court's network, and a certificate to check the court."""

    user: str
    password: str
    ca: str
    """Certificate of the contest's authority (PEM)."""

    def __repr__(self) -> str:
        return f"Credentials(user={self.user!r})"  # an accidental print must not show the password


class Protection(NamedTuple):
    """Certificate and users of a court with keys."""

    court: str
    certificate: Path
    private_key: Path
    passwords: Mapping[str, str]
    """Passwords by user."""
    seats: Mapping[str, str]
    """The user of each seat, by the seat's name."""
    referee: str
    """The referee's user."""


def access_control(protection: Protection | None) -> dict[str, Any]:
    """Make Zenoh's access control for a court; everything that is not allowed is denied.

    Only the court sends frames, events, sheets and health, and answers requests.

    Args:
        protection: the court's users; None: anybody may send commands and requests, and only
            tokens and seals show whose they are.
    """
    if protection is None:
        requests = ["lacoc/*/seat/*/*", "lacoc/*/referee/*", "lacoc/*/office/*"]
        requests += ["lacoc/*/outlook", "lacoc/*/where"]
        anyone = _acting(["lacoc/*/seat/*/key"], requests)
        groups: dict[str, tuple[dict[str, Any], Rules]] = {"anyone": ({}, _watching() | anyone)}
    else:
        groups = {"anyone": ({"usernames": list(protection.passwords)}, _watching())}
        groups |= {
            user: ({"usernames": [user]}, rules) for user, rules in _actors(protection).items()
        }
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": [
            {"id": f"{group} {name}", **rule}
            for group, (_, rules) in groups.items()
            for name, rule in rules.items()
        ],
        "subjects": [{"id": group, **subject} for group, (subject, _) in groups.items()],
        "policies": [
            {"rules": [f"{group} {name}" for name in rules], "subjects": [group]}
            for group, (_, rules) in groups.items()
        ],
    }


def studio_access_control() -> dict[str, Any]:
    """Make Zenoh's access control for a studio: anybody may ask it and hear how far a search is."""
    rules = {
        "studio-to-all": _to_all(),
        "ask": _rule("ingress", ["lacoc/*/studio/ask/*"], ["query"]),
        "progress": _rule("ingress", ["lacoc/*/studio/progress/*"], ["declare_subscriber"]),
        "presence": _presence(),
    }
    return _for_anyone(rules)


def desk_access_control() -> dict[str, Any]:
    """Make Zenoh's access control for an office's desk: anybody may ask it, and do nothing else."""
    rules = {"desk-to-all": _to_all(), "ask": _rule("ingress", [DESK], ["query"])}
    return _for_anyone(rules)


def _for_anyone(rules: Rules) -> dict[str, Any]:
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": [{"id": name, **rule} for name, rule in rules.items()],
        "subjects": [{"id": "anyone"}],
        "policies": [{"rules": list(rules), "subjects": ["anyone"]}],
    }


def _to_all() -> dict[str, Any]:
    return _rule(
        "egress",
        ["lacoc/**"],
        [
            *("put", "delete", "reply", "query", "declare_subscriber", "declare_queryable"),
            *("liveliness_token", "liveliness_query", "declare_liveliness_subscriber"),
        ],
    )


def _presence() -> dict[str, Any]:
    return _rule(
        "ingress",
        ["lacoc/*/live/**"],
        ["liveliness_query", "declare_liveliness_subscriber"],
    )


def _watching() -> Rules:
    return {
        "court-to-all": _to_all(),
        "watch": _rule(
            "ingress",
            [f"lacoc/*/{what}" for what in ("frame", "event", "sheet", "health")],
            ["declare_subscriber"],
        ),
        "fetch": _rule(
            "ingress",
            [f"lacoc/*/{what}" for what in ("sheet", "scene", "event")],
            ["query"],
        ),
        "presence": _presence(),
    }


def _actors(protection: Protection) -> dict[str, Rules]:
    """Return the rules by user: a seat's user may send keys and requests, the referee decisions."""
    keys = Keys(protection.court)
    seats = {
        user: _acting(
            [keys.command(seat)], [keys.request(seat, what) for what in ("join", "ready", "leave")]
        )
        for seat, user in protection.seats.items()
    }
    return seats | {protection.referee: _acting([], [keys.decision("*"), keys.outlook])}


def _acting(commands: list[str], requests: list[str]) -> Rules:
    rules = {"request": _rule("ingress", requests, ["query"])}
    return rules | ({"command": _rule("ingress", commands, ["put"])} if commands else {})


def _rule(flow: str, key_expressions: list[str], messages: list[str]) -> dict[str, Any]:
    return {
        "permission": "allow",
        "flows": [flow],
        "key_exprs": key_expressions,
        "messages": messages,
    }
