"""The bad link that other tests use delays, loses, stalls and cuts as it should."""

import socket
import threading
import time
from collections.abc import Iterator

import pytest
from slow_link import SlowLink
from waiting import LIMIT_S


@pytest.fixture
def echo() -> Iterator[str]:
    """Give the address of a server that sends back everything it receives."""
    with socket.create_server(("127.0.0.1", 0)) as server:

        def answer() -> None:
            while True:
                try:
                    connection, _ = server.accept()
                except OSError:
                    return
                threading.Thread(target=send_back, args=(connection,)).start()

        thread = threading.Thread(target=answer)
        thread.start()
        yield f"tcp/127.0.0.1:{server.getsockname()[1]}"
        server.shutdown(socket.SHUT_RDWR)
        thread.join()


def send_back(connection: socket.socket) -> None:
    with connection:
        try:
            while data := connection.recv(4096):
                connection.sendall(data)
        except OSError:
            return


def connect(link: SlowLink) -> socket.socket:
    host, _, port = link.address.removeprefix("tcp/").rpartition(":")
    return socket.create_connection((host, int(port)), timeout=LIMIT_S)


def round_trip_s(client: socket.socket, packet: bytes = b"x") -> float:
    begun_s = time.monotonic()
    client.sendall(packet)
    while packet:
        packet = packet.removeprefix(client.recv(len(packet)))
    return time.monotonic() - begun_s


def test_both_ways_are_delayed_and_order_is_kept(echo: str) -> None:
    """A round trip takes at least twice the delay, and jitter does not change the order."""
    with SlowLink(echo, delay_s=0.05) as link, connect(link) as client:
        assert round_trip_s(client) >= 0.1
        link.delay_s = link.jitter_s = 0.02
        sent = bytes(range(100))
        for number in sent:
            client.sendall(bytes([number]))
            time.sleep(0.001)
        received = b""
        while len(received) < len(sent):
            received += client.recv(100)
        assert received == sent


def test_a_lost_packet_comes_late(echo: str) -> None:
    """A packet that the simulated link loses arrives late, as with TCP."""
    with SlowLink(echo, loss=1.0) as link, connect(link) as client:
        assert round_trip_s(client) >= 2 * SlowLink.RESEND_S


def test_a_stalled_link_keeps_what_was_sent(echo: str) -> None:
    """A stalled link delivers nothing and closes nothing; later it delivers what was sent."""
    with SlowLink(echo) as link, connect(link) as client:
        assert round_trip_s(client) < 5
        link.stall()
        client.sendall(b"later")
        client.settimeout(0.2)
        with pytest.raises(TimeoutError):
            client.recv(5)
        link.flow()
        client.settimeout(10)
        assert client.recv(5) == b"later"


def test_a_cut_link_breaks_and_is_mended(echo: str) -> None:
    """A cut link closes its connections and refuses new ones, until it is mended."""
    with SlowLink(echo) as link:
        with connect(link) as client:
            round_trip_s(client)
            link.cut()
            assert client.recv(1) == b""
        with connect(link) as client:
            assert client.recv(1) == b""
        link.mend()
        with connect(link) as client:
            round_trip_s(client)
