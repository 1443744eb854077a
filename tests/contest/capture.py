"""All that is sent to and from some ports of this machine, as somebody on the way would see it."""

import socket
import struct
import threading
from collections import defaultdict
from collections.abc import Collection
from typing import Self

_ALL = 3  # ETH_P_ALL
_ETHERNET_BYTES = 14
_TCP = 6
_OUTGOING = 4  # PACKET_OUTGOING; on the loopback each packet is seen twice


class Capture:
    """Captures TCP over IPv4 on the loopback interface; a context manager.

    Args:
        ports: the ports of interest.

    Raises:
        OSError: if this process may not capture; only root may.
    """

    def __init__(self, ports: Collection[int]) -> None:
        self._ports = frozenset(ports)
        self._socket = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(_ALL))
        self._socket.bind(("lo", 0))
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 64 << 20)
        self._socket.settimeout(0.1)
        self._flows: defaultdict[tuple[int, int], bytearray] = defaultdict(bytearray)
        """What was sent, by the ports of sender and receiver."""
        self._ended = False
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended = True
        self._thread.join()
        self._socket.close()

    @property
    def ports(self) -> set[int]:
        """The ports of interest at which something was seen."""
        return {port for flow in self._flows for port in flow if port in self._ports}

    def has(self, text: str) -> bool:
        """Return whether a text was sent in one piece of one direction."""
        return any(text.encode() in flow for flow in self._flows.values())

    def _run(self) -> None:
        while not self._ended:
            try:
                packet, (_, _, kind, *_) = self._socket.recvfrom(1 << 17)
            except TimeoutError:
                continue
            if kind != _OUTGOING:
                self._take(packet[_ETHERNET_BYTES:])

    def _take(self, packet: bytes) -> None:
        if len(packet) < 40 or packet[0] >> 4 != 4 or packet[9] != _TCP:
            return
        head = 4 * (packet[0] & 15)
        flow = struct.unpack_from("!HH", packet, head)
        if self._ports.isdisjoint(flow):
            return
        body = head + 4 * (packet[head + 12] >> 4)
        self._flows[flow] += packet[body:]
