"""Counts the lists and maps in msgpack, without unpacking it."""

from collections.abc import Mapping

_LISTS_AND_MAPS = bytes([*range(0x80, 0xA0), *range(0xDC, 0xE0)])
"""The bytes with which a list or a map begins in msgpack; texts and files may have them too."""
_FEW = 100
_FIXED: Mapping[int, int] = {
    **dict.fromkeys((0xCC, 0xD0), 1),
    **dict.fromkeys((0xCD, 0xD1, 0xDC, 0xDE, 0xD4), 2),
    0xD5: 3,
    **dict.fromkeys((0xCA, 0xCE, 0xD2, 0xDD, 0xDF), 4),
    0xD6: 5,
    **dict.fromkeys((0xCB, 0xCF, 0xD3), 8),
    0xD7: 9,
    0xD8: 17,
}
"""By first byte of a value: how many bytes follow it, if this number is fixed. For a list or map
these bytes are its length."""
_SIZED: Mapping[int, tuple[int, int]] = {
    **dict.fromkeys((0xC4, 0xD9), (1, 0)),
    **dict.fromkeys((0xC5, 0xDA), (2, 0)),
    **dict.fromkeys((0xC6, 0xDB), (4, 0)),
    0xC7: (1, 1),
    0xC8: (2, 1),
    0xC9: (4, 1),
}
"""By first byte of a text, of bytes or of an extension: how many bytes its length takes, and how
many bytes follow in addition to this length."""


def lists_and_maps(data: bytes, most: float) -> int:
    """Return how many lists and maps are in msgpack; the number may be too large, not too small.

    If only few bytes could begin a list or map, each of them counts as one. Otherwise the values
    are counted one by one, until there are more than `most`.
    """
    could_begin = len(data) - len(data.translate(None, _LISTS_AND_MAPS))
    return could_begin if could_begin <= _FEW else _counted(data, most)


def _counted(data: bytes, most: float) -> int:
    at, found, end = 0, 0, len(data)
    while at < end and found <= most:
        head = data[at]
        at += 1
        if 0x80 <= head < 0xA0 or 0xDC <= head < 0xE0:
            found += 1
        if 0xA0 <= head < 0xC0:  # a short text
            at += head & 0x1F
        elif head in _FIXED:
            at += _FIXED[head]
        elif head in _SIZED:
            size, more = _SIZED[head]
            at += size + more + int.from_bytes(data[at : at + size], "big")
    return found
