"""Zenoh's access rules for a court, a studio and an office's desk.

They are the same for all clients. Zenoh gives a court no trustworthy information about a sender, so
the rules check only the kind of message: one that no client may send reaches neither the court nor
another client.
"""

from typing import Any

from lacoc_shared.keyspace import DESK

Rules = dict[str, dict[str, Any]]
"""Rules by their names."""


def court_access_control() -> dict[str, Any]:
    """Make Zenoh's access control for a court: anybody may watch, send commands and make requests.

    Tokens and seals show who sent commands and requests. Only the court may send frames, events,
    sheets and health, and answer requests.
    """
    seen = ["frame", "event", "sheet", "health"]
    asked = ["sheet", "scene", "event", "seat/*/*", "referee/*", "office/*", "outlook", "where"]
    return _for_anyone(
        {
            "court-to-all": _to_all(),
            "watch": _rule("ingress", [f"lacoc/*/{one}" for one in seen], ["declare_subscriber"]),
            "request": _rule("ingress", [f"lacoc/*/{one}" for one in asked], ["query"]),
            "command": _rule("ingress", ["lacoc/*/seat/*/key"], ["put"]),
            "presence": _presence(),
        }
    )


def studio_access_control() -> dict[str, Any]:
    """Make Zenoh's access control for a studio: anybody may send requests and hear its reports."""
    rules = {
        "studio-to-all": _to_all(),
        "ask": _rule("ingress", ["lacoc/*/studio/ask/*"], ["query"]),
        "progress": _rule("ingress", ["lacoc/*/studio/progress/*"], ["declare_subscriber"]),
        "presence": _presence(),
    }
    return _for_anyone(rules)


def desk_access_control() -> dict[str, Any]:
    """Make Zenoh's access control for an office's desk: anybody may send it requests, no more."""
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


def _rule(flow: str, key_expressions: list[str], messages: list[str]) -> dict[str, Any]:
    return {
        "permission": "allow",
        "flows": [flow],
        "key_exprs": key_expressions,
        "messages": messages,
    }
