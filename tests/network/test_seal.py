"""Tokens and seals."""

import hashlib

import pytest

from lacoc_shared import seal


def test_tokens_are_random_and_safe_to_type() -> None:
    """128 bits, no sign that a shell or a reader mistakes."""
    tokens = {seal.new_token() for _ in range(100)}
    assert len(tokens) == 100
    assert all(len(token) == 26 and token.isalnum() and token.islower() for token in tokens)


def test_a_hash_knows_its_token_only() -> None:
    """Salted: the same token has another hash each time, and both know it."""
    one, two = seal.hash_token("secret"), seal.hash_token("secret")
    assert one != two
    assert seal.verify_token("secret", one)
    assert seal.verify_token("secret", two)
    assert not seal.verify_token("Secret", one)
    assert "secret" not in one


@pytest.mark.parametrize("stored", ["", "$", "zz$zz", "00", "00" * 17 + "$00", "é$é"])
def test_a_broken_hash_opens_nothing(stored: str) -> None:
    """A damaged settings file locks a seat; it does not open it."""
    assert not seal.verify_token("", stored)


def test_a_command_seal_is_the_documented_one() -> None:
    """docs/protocol.md: BLAKE2b keyed with the secret, 8 bytes, over text joined by spaces."""
    secret = bytes(range(16))
    text = b"lacoc/main/seat/left/key 77 3 1 2 1 900"
    expected = hashlib.blake2b(text, key=secret, digest_size=8).digest()
    assert seal.command_mac(secret, "lacoc/main/seat/left/key", 77, 3, 1, 2, 1, 900) == expected


def test_every_part_changes_the_seal() -> None:
    """No two different commands share a seal, also where digits could run together."""
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
    assert seal.request_mac(b"s" * 16, "k", 7, True) != seal.request_mac(b"s" * 16, "k", 7, False)
