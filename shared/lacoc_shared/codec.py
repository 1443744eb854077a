"""Encodes and decodes messages: msgpack with checks of types and size, and one class of error.

`msgspec` reads and writes the same bytes as `msgpack`. It also checks every type, so no value from
the network is used before its type is checked.
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
    """Raised when bytes are not the expected message; it is the fault of their sender."""


def decode(data: bytes, kind: type[T], max_bytes: int = 65_536) -> T:
    """Decode the bytes of one message, and check its type.

    Args:
        data: the bytes as they arrived.
        kind: the expected message.
        max_bytes: greatest length; longer data are refused without being decoded.

    Raises:
        BadMessage: if there are too many bytes, or they are not msgpack or not this message.
    """
    if len(data) > max_bytes:
        raise BadMessage(f"{len(data)} bytes, at most {max_bytes} are read")
    decoder = _decoders.get(kind) or _new_decoder(kind)
    try:
        return decoder.decode(data)  # type: ignore[no-any-return]
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise BadMessage(str(error)) from None


class _AnyVersion(msgspec.Struct):
    """The only field that requests have in every version of the protocol."""

    protocol: int


def protocol_of(data: bytes, max_bytes: int) -> int:
    """Return the version of the protocol in which a request was sent.

    Raises:
        BadMessage: if there are too many bytes, or they contain no version.
    """
    return decode(data, _AnyVersion, max_bytes).protocol


def _new_decoder(kind: Any) -> msgspec.msgpack.Decoder[Any]:
    # msgspec analyses a struct at its first use. If two threads do so at the same time, the process
    # crashes (SIGSEGV), so the lock lets only one do it.
    with _looking:
        if kind not in _decoders:
            _decoders[kind] = msgspec.msgpack.Decoder(kind)
        return _decoders[kind]


def message_hash(message: bytes) -> bytes:
    """Return the hash of an encoded `Scene` or `Sheet`: 8 bytes, by which messages refer to it."""
    return hashlib.blake2b(message, digest_size=8).digest()


def pack_states(states: tuple[int, ...]) -> bytes:
    """Pack the states of markers into bytes: two bits each, from the lowest bits of a byte on."""
    packed = bytearray((len(states) + 3) // 4)
    for index, state in enumerate(states):
        packed[index >> 2] |= state << (index & 3) * 2
    return bytes(packed)


def unpack_states(packed: bytes, count: int) -> tuple[int, ...]:
    """Unpack the states of `count` markers from bytes that `pack_states` made."""
    return tuple(packed[index >> 2] >> (index & 3) * 2 & 3 for index in range(count))
