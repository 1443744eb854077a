"""Tests of tokens, hashes of tokens, and seals."""

import base64
import hashlib
import secrets

import pytest

from lacoc_server.doors.sessions import Sessions
from lacoc_shared import seal
from lacoc_shared.contest.tokens import new_token, new_token_hash


def test_tokens_are_random_and_safe_to_type() -> None:
    """A token has 26 small letters and digits, and no two are the same."""
    tokens = {new_token() for _ in range(100)}
    assert len(tokens) == 100
    assert all(len(token) == 26 and token.isalnum() and token.islower() for token in tokens)


def test_a_hash_knows_its_token_only() -> None:
    """Two hashes of a token differ, because each has its own salt; only that token fits both."""
    one, two = new_token_hash("secret"), new_token_hash("secret")
    assert one != two
    assert seal.verify_token("secret", one)
    assert seal.verify_token("secret", two)
    assert not seal.verify_token("Secret", one)
    assert "secret" not in one


def test_a_token_has_128_bits() -> None:
    """A token is 16 bytes in base32, in small letters and without padding."""
    token = new_token()
    assert len(base64.b32decode(token.upper() + "======")) == 16


def test_a_session_has_a_number_of_32_bits_and_a_secret_of_16_bytes() -> None:
    """A session has a random number of 32 bits, at least 1, and a random secret of 16 bytes."""
    sessions = Sessions(secrets.token_bytes)
    begun = [sessions.begin(0) for _ in range(100)]
    numbers, keys = ({one[i] for one in begun} for i in (0, 1))
    assert len(numbers) == len(keys) == 100
    assert all(1 <= number < 2**32 for number in numbers)
    assert max(numbers) > 2**24
    assert {len(key) for key in keys} == {16}


@pytest.mark.parametrize("byte", [0, 255])
def test_no_random_number_makes_a_session_without_a_number(byte: int) -> None:
    """A session's number is never 0, because 0 means "no session" on the wire."""
    number, _ = Sessions(lambda count: bytes([byte]) * count).begin(0)
    assert 1 <= number < 2**32


def test_a_kept_hash_opens_its_seat_in_later_versions_too() -> None:
    """The form of a token's hash does not change: "salt$hash", BLAKE2b with 32 bytes."""
    salt = bytes(range(16))
    digest = hashlib.blake2b(b"secret", salt=salt, digest_size=32, person=b"lacoc token")
    assert seal.verify_token("secret", f"{salt.hex()}${digest.hexdigest()}")
    kept_salt, _, kept = new_token_hash("secret").partition("$")
    assert (len(bytes.fromhex(kept_salt)), len(bytes.fromhex(kept))) == (16, 32)
    assert seal.verify_token("\udcff", new_token_hash("\udcff")), "whatever a shell hands over"


@pytest.mark.parametrize("stored", ["", "$", "zz$zz", "00", "00" * 17 + "$00", "é$é"])
def test_a_broken_hash_opens_nothing(stored: str) -> None:
    """A damaged hash opens no seat."""
    assert not seal.verify_token("", stored)


def test_a_command_seal_is_the_documented_one() -> None:
    """A command's seal is the one that docs/protocol.md describes."""
    secret = bytes(range(16))
    text = b"lacoc/main/seat/left/key 77 3 1 2 1 900"
    expected = hashlib.blake2b(text, key=secret, digest_size=8).digest()
    assert seal.command_mac(secret, "lacoc/main/seat/left/key", 77, 3, 1, 2, 1, 900) == expected
    assert seal.same(expected, bytes(expected))
    assert not seal.same(expected, expected[::-1])


@pytest.mark.parametrize("ready", [False, True])
def test_a_request_seal_is_the_documented_one(ready: bool) -> None:
    """The seal of ready and leave is the one that docs/protocol.md describes."""
    expected = hashlib.blake2b(b"lacoc/a 77 3 %d" % ready, key=b"k" * 16, digest_size=8).digest()
    assert seal.request_mac(b"k" * 16, "lacoc/a", 77, 3, ready) == expected


def test_every_part_changes_the_seal() -> None:
    """If any part of a command or request changes, its seal changes."""
    base = ("lacoc/main/seat/left/key", 7, 11, 1, 2, 1, 900)
    others = [
        ("lacoc/main/seat/right/key", 7, 11, 1, 2, 1, 900),
        ("lacoc/main/seat/left/key", 71, 1, 1, 2, 1, 900),
        ("lacoc/main/seat/left/key", 7, 1, 11, 2, 1, 900),
        ("lacoc/main/seat/left/key", 7, 11, 0, 2, 1, 900),
        ("lacoc/main/seat/left/key", 7, 11, 1, 3, 1, 900),
        ("lacoc/main/seat/left/key", 7, 11, 1, 2, 19, 0),
        ("lacoc/main/seat/left/key", 7, 11, 1, 2, 1, 901),
    ]
    seals = {seal.command_mac(b"s" * 16, *parts) for parts in [base, *others]}
    assert len(seals) == 8
    assert seal.command_mac(b"t" * 16, *base) not in seals
    requests = [("k", 7, 1, True), ("k", 7, 1, False), ("k", 7, 11, True), ("k", 71, 1, True)]
    assert len({seal.request_mac(b"s" * 16, *parts) for parts in requests}) == 4
