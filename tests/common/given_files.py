"""Files in the fragment of an address, as pages write and read them (core/given.ts)."""

import base64
import zlib
from typing import Any

import msgspec

_RAW = -15
"""Deflate without a header."""


def fragment_of(files: dict[str, dict[str, Any] | None]) -> str:
    """Return the fragment with which /enter gets files, by slot."""
    slots = {"robot": None, "postures": None, "locomotion": None}
    given = {"files": {**slots, **files}, "sequences": None, "key": None}
    packer = zlib.compressobj(wbits=_RAW)
    packed = packer.compress(msgspec.msgpack.encode(given)) + packer.flush()
    return f"#files={base64.urlsafe_b64encode(packed).decode().rstrip('=')}"


def given_in(url: str) -> dict[str, Any]:
    """Return what an address gives."""
    text = url.partition("#files=")[2]
    packed = base64.urlsafe_b64decode(text + "=" * (-len(text) % 4))
    found: dict[str, Any] = msgspec.msgpack.decode(zlib.decompress(packed, _RAW))
    return found
