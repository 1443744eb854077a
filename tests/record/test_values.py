"""Tests of how lists and maps are counted in msgpack."""

import math
from typing import Any

import msgspec
from hypothesis import given
from hypothesis import strategies as st

from lacoc_shared.codec import encode
from lacoc_shared.record.values import _counted, lists_and_maps

SCALARS = (
    st.none()
    | st.booleans()
    | st.integers(-(1 << 63), (1 << 64) - 1)
    | st.floats()
    | st.text()
    | st.binary(max_size=70_000)
    | st.builds(msgspec.msgpack.Ext, st.integers(-128, 127), st.binary(max_size=300))
)
VALUES = st.recursive(
    SCALARS,
    lambda inner: (
        st.lists(inner, max_size=40) | st.dictionaries(st.text() | st.integers(-9, 300), inner)
    ),
)


def containers(value: Any) -> int:
    if isinstance(value, list):
        return 1 + sum(map(containers, value))
    return 1 + sum(map(containers, value.values())) if isinstance(value, dict) else 0


@given(VALUES)
def test_the_count_is_exact(value: Any) -> None:
    """Texts, bytes and numbers are passed over, whatever bytes they have."""
    data = encode(value)
    assert _counted(data, math.inf) == containers(value)
    assert _counted(data, 2) == min(3, containers(value)), "the count ends above its limit"
    assert lists_and_maps(data, math.inf) >= containers(value)


@given(st.binary())
def test_damaged_bytes_raise_nothing(data: bytes) -> None:
    """Bytes that are no msgpack have some count, not more than there are bytes."""
    assert 0 <= _counted(data, math.inf) <= len(data)


def test_a_file_in_a_message_does_not_count() -> None:
    """A gait file with Japanese remarks has no values: its bytes are those of one text."""
    assert lists_and_maps(encode([{"data": "脚の角度".encode() * 4000}]), math.inf) == 2
