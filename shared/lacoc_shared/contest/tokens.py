"""Random tokens, such as those that open a seat or the referee's desk."""

import base64
import hashlib
import secrets

from lacoc_shared import seal

_SALT_BYTES = 16


def new_token() -> str:
    """Make a random token of 128 bits: 26 letters a-z and digits 2-7."""
    return base64.b32encode(secrets.token_bytes(16)).decode().rstrip("=").lower()


def new_token_hash(token: str) -> str:
    """Return a hash of a token for storage, with a random salt (`seal.hash_token`)."""
    return seal.hash_token(token, secrets.token_bytes(_SALT_BYTES))


def lasting_hash(token: str) -> str:
    """Return a hash of a token with a salt that is made from the token itself.

    So the hash is the same after each restart. If the next match of a court has the same hash for a
    seat, the controller keeps the seat.
    """
    return seal.hash_token(token, digest(token))


def digest(token: str) -> bytes:
    """Return a digest of a token, to look the token up in a set of digests.

    The time that the look-up takes reveals nothing about the token.
    """
    return hashlib.blake2b(token.encode("utf-8", "surrogatepass"), digest_size=16).digest()
