"""Bytes to messages and back: msgpack, typed and size-checked, one error family.

`msgspec` reads and writes the same bytes as `msgpack`; it also checks every type, so
nothing that arrives is used before it is known to be what it should be.
"""

import hashlib
import threading
from typing import Any, TypeVar

import msgspec

T = TypeVar("T")

_encoder = msgspec.msgpack.Encoder()
_decoders: dict[Any, msgspec.msgpack.Decoder[Any]] = {}
_looking = threading.Lock()

encode = _encoder.encode
"""Encode a message to msgpack bytes."""


class BadMessage(ValueError):
    """Bytes from outside that are not the message they should be: the sender's fault."""


def decode(data: bytes, kind: type[T], max_bytes: int = 65_536) -> T:
    """Decode one message.

    Args:
        data: the bytes as they arrived.
        kind: the message they must be.
        max_bytes: a longer payload is refused unread.

    Raises:
        BadMessage: if they are too many, not msgpack, or not that message.
    """
    if len(data) > max_bytes:
        raise BadMessage(f"{len(data)} bytes, at most {max_bytes} are read")
    decoder = _decoders.get(kind) or _new_decoder(kind)
    try:
        return decoder.decode(data)  # type: ignore[no-any-return]
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise BadMessage(str(error)) from None


def _new_decoder(kind: Any) -> msgspec.msgpack.Decoder[Any]:
    # msgspec looks into a struct when it is first used. A thread that meets one into which another
    # looks at that moment ends the process (SIGSEGV), so only one at a time may look.
    with _looking:
        if kind not in _decoders:
            _decoders[kind] = msgspec.msgpack.Decoder(kind)
        return _decoders[kind]


def message_hash(message: bytes) -> bytes:
    """The 8 bytes by which frames, sheets and health name an encoded `Scene` or `Sheet`."""
    return hashlib.blake2b(message, digest_size=8).digest()
