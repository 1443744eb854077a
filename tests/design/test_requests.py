"""Requests that a page can send: what is too large is refused before any work is done."""

from typing import Any

import msgspec
import pytest

from lacoc_client.web.gateway.wire import Unreadable
from lacoc_client.workshop.design.requests import EditAsk, read

ROW = {"key": 0, "posture": 0, "angles_deg": [0.0] * 18}


def ask(**table: Any) -> bytes:
    full = {"kind": "postures", "legs": 6, "rows": [ROW], **table}
    return msgspec.msgpack.encode(
        {"id": 1, "do": "edit", "before": full, "table": full, "by": "hand"}
    )


def test_a_table_is_read() -> None:
    """A table of six legs is read."""
    asked = read(ask())
    assert isinstance(asked, EditAsk)
    assert asked.table.legs == 6


@pytest.mark.parametrize(
    "table",
    [
        {"legs": 1_000_000},
        {"legs": 0},
        {"legs": -1},
        {"rows": [{**ROW, "angles_deg": [0.0] * 10_000}]},
        {"rows": [{**ROW, "angles_deg": []}] * 4_000},
        {"rows": [{**ROW, "posture": 2**40}]},
    ],
)
def test_a_table_that_no_robot_has_is_refused(table: dict[str, Any]) -> None:
    """A table that is too large for any robot, or has no legs, is refused at once."""
    with pytest.raises(Unreadable):
        read(ask(**table))
