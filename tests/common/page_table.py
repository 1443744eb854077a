"""A page's copy of the table that it shares with others, without a browser."""

from collections.abc import Sequence
from typing import Any

import msgspec
from pycrdt import Doc, Map

from lacoc_client.workshop.tables.draft import draft_of
from lacoc_client.workshop.tables.entries import Entry

Table = dict[str, Any]


class PageTable:
    """A page's document of a table.

    Args:
        opened: what the gateway sends a page to begin with.
        client: the number of the page; None: it draws one.
    """

    def __init__(self, opened: dict[str, Any], client: int | None = None) -> None:
        self.opened = opened
        self.seen: int = opened["seq"]
        self._document: Doc[Any] = Doc(client_id=client)
        self._map: Map[Any] = self._document.get("table", type=Map)
        self.take(opened["state"])

    @property
    def entries(self) -> dict[str, Entry]:
        """All entries by name."""
        return dict(self._map.to_py() or {})

    @property
    def table(self) -> Table | None:
        """The table, as requests send it; None while it has none."""
        draft = draft_of(self.entries)
        return None if draft is None else msgspec.json.decode(msgspec.json.encode(draft.table))

    def take(self, update: bytes) -> None:
        """Merge an update of another page."""
        if update:
            self._document.apply_update(update)

    def put(self, entries: dict[str, Any]) -> dict[str, Any]:
        """Set entries; return the fields of the request that tells them."""
        before = self._document.get_state()
        with self._document.transaction():
            for name, value in entries.items():
                self._map[name] = value
        return {
            "table": self.opened["table"],
            "epoch": self.opened["epoch"],
            "update": bytes(self._document.get_update(before)),
            "cells": [name for name in entries if name.count("/") == 2],
            "seen": self.seen,
        }

    def write(
        self,
        table: Table,
        sequences: Sequence[Sequence[int]] | None = None,
        robot: dict[str, Any] | None = None,
    ) -> dict[str, Any]:
        """Write a table as a page does; return the fields of the request that tells it."""
        shape = f"{table['kind'][0]}{table['legs']}"
        wanted: dict[str, Any] = {"shape": shape, "robot": ""}
        if sequences is not None:
            wanted["keys"] = ",".join("".join(map(str, digits)) for digits in sequences)
        if robot is not None:
            text = {"name": robot["name"], "text": robot["data"].decode()}
            wanted["robot"] = msgspec.json.encode(text).decode()
        for row in table["rows"]:
            name = f"{shape}/{row['key']}.{row['posture']}"
            wanted[name] = True
            for col, angle in enumerate(row["angles_deg"]):
                wanted[f"{name}/{col}"] = float(angle)
        before = self.entries
        return self.put({name: one for name, one in wanted.items() if before.get(name) != one})


class SharingPage:
    """A page that has a shared table open; for classes of pages that ask."""

    hello: dict[str, Any]
    """The reply to hello."""
    shared: PageTable

    def opens(self) -> None:
        """Begin with the table that the reply to hello has."""
        self.shared = PageTable(self.hello["table"])

    def edits(self: Any, table: Table, by: str = "hand", **fields: Any) -> Any:
        """Change the table, and tell the edit as evidence; return what came of it."""
        known = {name: fields.get(name) for name in ("sequences", "robot")}
        before = self.shared.table or table
        reply = self.ask("table", **self.shared.write(table, **known))
        self.shared.seen = reply["seq"]
        return self.ask("edit", before=before, table=table, by=by, **fields)


def from_kept(content: bytes) -> Table | None:
    """Return the table of a kept document."""
    return PageTable({"table": "", "epoch": "", "seq": 0, "state": content}).table
