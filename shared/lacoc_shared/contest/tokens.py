"""Random tokens, such as those that open a seat or the referee's desk."""

import base64
import secrets

from lacoc_shared import seal

_SALT_BYTES = 16


def new_token() -> str:
    """Make a random token of 128 bits: 26 letters a-z and digits 2-7."""
    return base64.b32encode(secrets.token_bytes(16)).decode().rstrip("=").lower()


def hash_token(token: str) -> str:
    """Hash a token for storage, with its own salt (`seal.hash_token`)."""
    return seal.hash_token(token, secrets.token_bytes(_SALT_BYTES))
