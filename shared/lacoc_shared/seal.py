"""Hashes of tokens, and the seals that prove from which seat a command comes.

A seat's token is sent with a join and to ask where a team plays, a referee's token with each
request of the referee. After a join the session's secret, 16 bytes from the court, seals every
command and request of the seat. A seal is a keyed BLAKE2b of 8 bytes over a text, whose parts are
joined by spaces: the key expression of the message, the number of the session, the sequence number,
and the other numbers of the message.
"""

import hashlib
import hmac

MAC_BYTES = 8
SECRET_BYTES = 16
_HASH_BYTES = 32


def hash_token(token: str, salt: bytes) -> str:
    """Hash a token for storage: "salt$hash", both hexadecimal.

    The hash is a fast one, because a court must verify it within a beat (20 ms). For random tokens
    (`lacoc_shared.contest.tokens`) this is safe. A short word that a person chose can be guessed
    from the hash, so don't publish records with such tokens while the tokens are in use.

    Args:
        token: the token.
        salt: 16 random bytes.
    """
    return f"{salt.hex()}${_hash(token, salt).hex()}"


def verify_token(token: str, token_hash: str) -> bool:
    """Return whether a token has this hash; takes the same time for every wrong token."""
    salt, _, digest = token_hash.partition("$")
    try:
        return hmac.compare_digest(_hash(token, bytes.fromhex(salt)), bytes.fromhex(digest))
    except ValueError:
        return False


def command_mac(
    secret: bytes,
    key_expression: str,
    session: int,
    seq: int,
    level: int,
    key: int,
    match: int,
    seen: int,
) -> bytes:
    """Compute the seal of a seat's command, from the command's numbers."""
    return _mac(secret, f"{key_expression} {session} {seq} {level} {key} {match} {seen}")


def request_mac(secret: bytes, key_expression: str, session: int, seq: int, *rest: int) -> bytes:
    """Compute the seal of a seat's request.

    Args:
        secret: the session's secret.
        key_expression: key expression of the request.
        session: number of the session.
        seq: sequence number of the request.
        *rest: the other numbers that the request contains, such as 1 for "ready"; the request's
            property `sealed` returns them.
    """
    numbers = (str(int(number)) for number in (session, seq, *rest))
    return _mac(secret, " ".join([key_expression, *numbers]))


def same(one: bytes, other: bytes) -> bool:
    """Return whether two seals are equal; the time that it takes does not depend on them."""
    return hmac.compare_digest(one, other)


def _mac(secret: bytes, text: str) -> bytes:
    return hashlib.blake2b(text.encode(), key=secret, digest_size=MAC_BYTES).digest()


def _hash(token: str, salt: bytes) -> bytes:
    data = token.encode("utf-8", "surrogatepass")
    return hashlib.blake2b(data, salt=salt, digest_size=_HASH_BYTES, person=b"lacoc token").digest()
