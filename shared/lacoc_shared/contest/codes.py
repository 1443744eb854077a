"""Short codes that people type, such as the class code or the event code."""

import hashlib
import secrets
import unicodedata

_LETTERS = "ABCDEFGHJKLMNPQRSTUVWXYZ23456789"
"""Letters and digits of codes; I, O, 0 and 1 are missing, because people confuse them."""
_LENGTH = 6


def new_code() -> str:
    """Make a random code, such as "K7QM3X"."""
    return "".join(secrets.choice(_LETTERS) for _ in range(_LENGTH))


def code_of(secret: str) -> str:
    """Make a code from a secret; the same secret always gives the same code."""
    digest = hashlib.blake2b(secret.encode(), digest_size=_LENGTH, person=b"lacoc event code")
    return "".join(_LETTERS[byte % len(_LETTERS)] for byte in digest.digest())


def read_code(text: str) -> str:
    """Return a typed code in its usual form: "ｋ7q m3x" becomes "K7QM3X"."""
    wide = unicodedata.normalize("NFKC", text).upper()
    return "".join(letter for letter in wide if letter.isalnum())
