"""Messages become bytes and come back; other bytes are refused (docs/protocol.md)."""

import hashlib
import subprocess
import sys

import msgpack
import pytest
from hypothesis import given
from hypothesis import strategies as st
from waiting import LIMIT_S

from lacoc_shared.codec import (
    BadMessage,
    decode,
    encode,
    message_hash,
    pack_states,
    unpack_states,
)
from lacoc_shared.messages import Command, Refusal
from lacoc_shared.mistakes import Mistake
from lacoc_shared.words import say

NO = say("gateway.no-token")


def test_a_payload_is_msgpack_for_anybody() -> None:
    """A refusal is one msgpack value, a map by field name, that any msgpack library reads."""
    refusal = Refusal(NO, (Mistake(file="a.txt", found="x", expected="a number", row=1),))
    data = encode(refusal)
    assert msgpack.unpackb(data)["why"] == {"code": "gateway.no-token"}
    assert msgpack.unpackb(data)["mistakes"][0]["row"] == 1
    assert decode(data, Refusal) == refusal
    assert decode(data, Refusal) == refusal, "also the second of its kind"


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "truncated"),
        (b"\xc1", "malformed"),
        (encode({"why": {"code": "x"}})[:-1], "truncated"),
        (encode({"why": {"code": "x"}}) + b"\x00", "trailing"),
        (encode({"why": 3}), "Expected `object`, got `int`"),
        (encode({}), "missing required field `why`"),
        (encode(["no", []]), "Expected `object`"),
        (b"\x81\xa3why\x81\xa4code\xa2\xff\xff", "utf-8"),
        (b"\x81\xa1x" + b"\x91" * 50_000 + b"\xc0", "recursion"),
    ],
    ids=["empty", "no msgpack", "cut", "more", "type", "field", "shape", "no UTF-8", "deep"],
)
def test_what_is_not_the_message_is_refused(data: bytes, words: str) -> None:
    """Wrong bytes raise BadMessage, which says what was found."""
    with pytest.raises(BadMessage, match=f"(?i){words}"):
        decode(data, Refusal)


def test_kinds_are_not_mistaken_for_one_another() -> None:
    """Bytes of one kind of message are refused where another kind is expected."""
    data = encode(Refusal(NO))
    assert decode(data, Refusal) == Refusal(NO)
    with pytest.raises(BadMessage):
        decode(data, Command)


def test_a_longer_payload_is_refused_unread() -> None:
    """A payload above its limit (64 KiB by default) is refused before it is decoded."""
    data = encode("x" * 100)
    assert decode(data, str, len(data)) == "x" * 100
    with pytest.raises(BadMessage, match=f"^{len(data)} bytes, at most {len(data) - 1} are read$"):
        decode(data, str, len(data) - 1)
    longest = b"\xc5\xff\xfd" + bytes(65_533)  # 64 KiB with its head
    assert decode(longest, bytes) == bytes(65_533)
    with pytest.raises(BadMessage, match=r"^65537 bytes, at most 65536 are read$"):
        decode(longest + b"\x00", bytes)


def test_a_scene_is_named_by_8_bytes_of_its_hash() -> None:
    """A scene's hash is 8 bytes of BLAKE2b over its encoded bytes."""
    assert message_hash(b"scene") == hashlib.blake2b(b"scene", digest_size=8).digest()
    assert message_hash(b"scene") != message_hash(b"scenf")


def test_states_are_two_bits_the_first_lowest() -> None:
    """A marker's state has two bits; the first marker's bits are the lowest of the first byte."""
    assert pack_states((1, 2, 3, 0, 2)) == bytes([0b00_11_10_01, 0b10])
    assert unpack_states(bytes([0b00_11_10_01, 0b10]), 5) == (1, 2, 3, 0, 2)
    assert [len(pack_states((0,) * count)) for count in (0, 1, 4, 5, 8, 36)] == [0, 1, 1, 2, 2, 9]


@given(st.lists(st.integers(0, 3), max_size=40).map(tuple))
def test_states_come_back_as_they_went(states: tuple[int, ...]) -> None:
    """Any number of packed states can be unpacked again."""
    assert unpack_states(pack_states(states), len(states)) == states


FIRST_USE = """
import sys, threading
import msgspec
from lacoc_shared.codec import decode, encode
from lacoc_shared.words import say

sys.setswitchinterval(1e-6)
for _ in range(400):

    class Inner(msgspec.Struct):
        a: int = 0
        b: tuple[int, ...] = ()

    class Middle(msgspec.Struct):
        x: tuple[Inner, ...] = ()
        y: dict[str, Inner] = {}

    class Outer(msgspec.Struct):
        m: tuple[Middle, ...] = ()
        n: Middle | None = None
        o: Inner | None = None

    data = encode(Outer((Middle((Inner(),), {"k": Inner()}),), Middle(), Inner()))
    together = threading.Barrier(6)

    def use():
        together.wait()
        decode(data, Outer)

    threads = [threading.Thread(target=use) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
"""


@pytest.mark.slow
def test_a_message_that_many_threads_read_first_ends_no_process() -> None:
    """Six threads that decode a new kind of message at the same time do not crash the process."""
    done = subprocess.run([sys.executable, "-c", FIRST_USE], capture_output=True, timeout=LIMIT_S)
    assert (done.returncode, done.stderr) == (0, b"")
