"""Tests of the connection of the pages /office and /enter that need no desk."""

import json
import threading
import urllib.request

from starlette.applications import Starlette
from waiting import LIMIT_S

from lacoc_client.web.gateway import server
from lacoc_client.web.office.site import DeskSite


def test_a_page_learns_the_address_of_the_network() -> None:
    """A page that was opened at 127.0.0.1 can show the address that other machines can open."""
    address = "http://192.168.1.20:8080"
    site = DeskSite("tcp/127.0.0.1:1", address)
    opened, ended = server.listen(server.LOOPBACK), threading.Event()
    serving = threading.Thread(
        target=server.serve, args=(Starlette(routes=site.routes), opened, ended.is_set)
    )
    serving.start()
    try:
        with urllib.request.urlopen(f"{opened.url}/enter.json", timeout=LIMIT_S) as found:
            answer = json.load(found)
    finally:
        ended.set()
        serving.join(LIMIT_S)
    assert answer == {"pages": address}
