"""Encrypts the messages between an office and the machine that copies it.

The key is made from a token that stands in the secrets file of both machines and is never sent. So
somebody who listens learns nothing, and an answer of somebody else is noticed.
"""

import hashlib
import os

from cryptography.exceptions import InvalidTag
from cryptography.hazmat.primitives.ciphers.aead import ChaCha20Poly1305

_NONCE_BYTES = 12


class BadSeal(Exception):
    """Bytes can't be decrypted: they were made with another key or purpose, or were changed."""


class Sealing:
    """Encrypts and authenticates messages with a key that is made from a token.

    Args:
        token: the token. Even a short word that a person chose is slow to guess: the key is made
            with scrypt.
    """

    def __init__(self, token: str) -> None:
        key = hashlib.scrypt(token.encode(), salt=b"lacoc standby", n=1 << 14, r=8, p=1, dklen=32)
        self._cipher = ChaCha20Poly1305(key)

    def seal(self, message: bytes, purpose: bytes) -> bytes:
        """Encrypt a message.

        Args:
            message: the message.
            purpose: what the message is for. `open` must be given the same purpose.
        """
        nonce = os.urandom(_NONCE_BYTES)
        return nonce + self._cipher.encrypt(nonce, message, purpose)

    def open(self, sealed: bytes, purpose: bytes) -> bytes:
        """Decrypt a message.

        Args:
            sealed: the encrypted message.
            purpose: what the message must be for.

        Raises:
            BadSeal: if it was not encrypted with this key for this purpose.
        """
        nonce, hidden = sealed[:_NONCE_BYTES], sealed[_NONCE_BYTES:]
        try:
            return self._cipher.decrypt(nonce, hidden, purpose)
        except (InvalidTag, ValueError):  # ValueError: too short
            raise BadSeal from None


REQUEST = b"request"
"""Purpose of each request. The purpose of its answer is the encrypted request itself, so that an
answer to an earlier request can't be sent again."""
