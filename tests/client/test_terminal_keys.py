"""Tests of how bytes from a terminal become names of keys."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_client.play.terminal.keys import KeyDecoder


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (b"2", ["2"]),
        (b"xZ", ["x", "z"]),
        (b"\x1b[A\x1b[B\x1b[C\x1b[D", ["up", "down", "right", "left"]),
        (b"\x1bOA\x1bOD", ["up", "left"]),
        (b"\t ", ["tab", "space"]),
        ("２ｘ\u3000".encode(), ["2", "x", "space"]),  # with a Japanese input method
        (b"\x1b[1;5A\x1b[15~3", ["3"]),  # Ctrl-up and F5 are no keys here
        (b"\x1bx2", ["x", "2"]),  # Alt-x
        (b"\x1b2", ["2"]),  # Esc or Alt before it, and nothing after it
        (b"\x00\x7f\r4", ["4"]),
    ],
)
def test_bytes_become_keys(data: bytes, expected: list[str]) -> None:
    """Digits, arrows, Tab, space, x and z are read, also with a Japanese input method (rules 3)."""
    assert KeyDecoder().feed(data) == expected


KEYS = [b"2", b"\x1b[A", b"\x1bOD", "２".encode(), b"\t", b"\x1b", b"\x1b2", b"\x1b[15~"]


@given(st.lists(st.sampled_from(KEYS)), st.data())
def test_a_sequence_may_come_in_pieces(keys: list[bytes], data: st.DataObject) -> None:
    """The bytes of a key give the same key whether they arrive together or in pieces."""
    whole = b"".join(keys)
    cuts = sorted(data.draw(st.lists(st.integers(0, len(whole)))))
    pieces = [whole[a:b] for a, b in zip([0, *cuts], [*cuts, len(whole)], strict=True)]
    decoder = KeyDecoder()

    assert [key for piece in pieces for key in decoder.feed(piece)] == KeyDecoder().feed(whole)


@given(st.lists(st.binary()))
def test_no_bytes_break_it(pieces: list[bytes]) -> None:
    """Any bytes from a terminal give names of keys, never an exception."""
    decoder = KeyDecoder()
    assert all(key for piece in pieces for key in decoder.feed(piece))
