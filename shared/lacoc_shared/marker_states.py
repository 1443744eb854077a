"""The states of a board's markers, packed as in frames."""


def pack_states(states: tuple[int, ...]) -> bytes:
    """Pack marker states, two bits each, the first in the lowest bits of the first byte."""
    packed = bytearray((len(states) + 3) // 4)
    for index, state in enumerate(states):
        packed[index >> 2] |= state << (index & 3) * 2
    return bytes(packed)


def unpack_states(packed: bytes, count: int) -> tuple[int, ...]:
    """Unpack the states of `count` markers from bytes that `pack_states` made."""
    return tuple(packed[index >> 2] >> (index & 3) * 2 & 3 for index in range(count))
