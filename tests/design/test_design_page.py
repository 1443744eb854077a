"""Tests of a /design page's connection, with a real gateway, a real studio and a real folder."""

import contextlib
import re
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any, get_args

import msgpack
import msgspec
import psutil
import pytest
from design_client import DesignClient, Refused
from hypothesis import given
from hypothesis import strategies as st
from lacoc_process import Lacoc, run_lacoc
from own_page import OwnPage
from page_connection import PageConnection
from ports import free_port
from waiting import until

from lacoc_client.web.gateway.wire import MessageKind, Unreadable
from lacoc_client.workshop.design import requests
from lacoc_robots.library import find_robot
from lacoc_shared.studio import STUDIO_MAX_BYTES

pytestmark = pytest.mark.slow


class Gateway(OwnPage):
    """A running `lacoc design`."""

    def __init__(self, folder: Path, *words: str) -> None:
        super().__init__(folder, "design", str(folder), *words)
        self.folder = folder


@pytest.fixture(scope="module")
def gateway(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Gateway]:
    """Give a gateway that all tests of this file share; its folder has no files at first."""
    gateway = Gateway(tmp_path_factory.mktemp("design"))
    yield gateway
    gateway.close()


Opens = Callable[..., DesignClient]


@pytest.fixture
def opens(gateway: Gateway) -> Iterator[Opens]:
    """Give a function that opens a page; the page is closed when the test ends."""
    with ExitStack() as stack:

        def opened(key: str | None = gateway.key) -> DesignClient:
            page = DesignClient(gateway.url, key)
            stack.callback(page.close)
            return page

        yield opened


@pytest.fixture
def page(opens: Opens) -> DesignClient:
    """Give a page that has said hello."""
    return opens()


def sample(page: DesignClient) -> dict[str, Any]:
    table: dict[str, Any] = page.ask("sample")["table"]
    return table


def refused(page: DesignClient, do: str, **fields: Any) -> dict[str, Any]:
    """Send a request that must be refused, and return the reply."""
    with pytest.raises(Refused) as refusal:
        page.ask(do, **fields)
    return refusal.value.reply


DOCUMENT = Path(__file__).parents[2] / "docs" / "gateway.md"


def test_the_document_has_every_request_with_its_fields() -> None:
    """docs/gateway.md has each request of /design with all its fields."""
    text = DOCUMENT.read_text("utf-8").partition("\n## From /design to the gateway\n")[2]
    text = text.partition("\n## ")[0]
    rows = [line.split("|")[1:3] for line in text.splitlines() if line.startswith("| `")]
    found = {
        do.strip(" `"): set(re.findall(r"`(\w+)`", re.sub(r"\(.*?\)", "", fields)))
        for do, fields in rows
    }
    assert found == {
        str(kind.__struct_config__.tag): {field.name for field in msgspec.structs.fields(kind)}
        - {"id"}
        for kind in get_args(requests.Asked)
    }


def test_only_a_page_with_the_key_gets_anything(opens: Opens) -> None:
    """Without the page key every request is refused, and the connection is closed."""
    for do, fields in (("read", {"name": "Loco-data.txt"}), ("trial", {}), ("sample", {})):
        page = opens(None)
        for key in ("", "wrong"):
            assert refused(page, "hello", key=key)["error"]["code"] == "design.wrong-key"
        assert refused(page, do, **fields)["error"]["code"] == "design.wrong-key"
        assert page.code() == 1008
        assert (page.folder, page.studio) == ({}, {})


def test_a_page_is_told_of_the_folder_and_the_studio(page: DesignClient, gateway: Gateway) -> None:
    """A page is told the folder, the studio's presence, and each new file with its kind."""
    page.until(lambda: page.studio.get("present"))
    assert page.folder["folder"] == str(gateway.folder.resolve())
    (gateway.folder / "LocoTra-data-x.txt").write_text("1\n1\n")
    page.until(lambda: page.folder["changed"] == ["LocoTra-data-x.txt"])
    assert {"name": "LocoTra-data-x.txt", "slot": "locomotion"}.items() <= next(
        file for file in page.folder["files"] if file["name"] == "LocoTra-data-x.txt"
    ).items()
    reply = refused(page, "read", name="LocoTra-data-x.txt")
    assert reply["mistakes"][0]["row"] == 2


@pytest.mark.parametrize("name", ["Loco-data.xlsx", "Loco-data.txt"])
def test_an_older_version_never_overwrites_a_newer_one(page: DesignClient, name: str) -> None:
    """A page that saves over a newer file gets a conflict; it can still save with `force`."""
    table = sample(page)
    first = page.ask("save", name=name, table=table, version="")["version"]
    page.until(lambda: name in [file["name"] for file in page.folder["files"]])
    read = page.ask("read", name=name)
    assert (read["version"], read["table"]) == (first, table)
    table["rows"][0]["angles_deg"][0] = 12.5
    second = page.ask("save", name=name, table=table, version=first)["version"]
    mine = sample(page)
    conflict = page.ask("save", name=name, table=mine, version=first)["conflict"]
    assert (conflict["table"], conflict["version"]) == (table, second)
    assert page.ask("read", name=name)["version"] == second
    page.ask("save", name=name, table=mine, version=first, force=True)
    assert page.ask("read", name=name)["table"] == mine


def test_two_pages_share_one_table(opens: Opens) -> None:
    """A second page has what was changed on the first; each gets what the other does then.

    Both are told where the other is, and that they typed into the same cell at the same time.
    """
    one = opens()
    table = sample(one)
    one.edits(table)
    other = opens()
    assert other.shared.table == table
    other.ask("table", **other.shared.put({"p6/5.0/3": 33.0}))
    one.until(lambda: one.told[MessageKind.TABLE])
    one.shared.take(one.last(MessageKind.TABLE)["update"])
    assert one.shared.table == other.shared.table != table
    # Neither has seen the other's number.
    for page, angle_deg in ((one, 1.0), (other, 2.0)):
        page.ask("table", **page.shared.put({"p6/1.0/0": angle_deg}))
    for page in (one, other):
        page.until(lambda page=page: "clash" in page.last(MessageKind.TABLE))
        assert page.last(MessageKind.TABLE)["clash"]["cells"] == ["p6/1.0/0"]
    other.ask("place", row=5, col=3, typing="-2")
    one.until(lambda: "-2" in str(one.last(MessageKind.PEOPLE)))
    assert len(one.last(MessageKind.PEOPLE)["people"]) == 2
    other.until(lambda: "me" in other.last(MessageKind.PEOPLE))
    assert one.last(MessageKind.PEOPLE)["me"] != other.last(MessageKind.PEOPLE)["me"]


def test_what_is_no_table_is_refused(opens: Opens) -> None:
    """An update that makes no table changes nothing; a page with another document is told so."""
    page = opens()
    page.edits(sample(page))
    before = page.shared.table
    for entries, code in (
        ({"p6/1.0/18": 1.0}, "tables.unreadable"),
        ({"p6/1.0/1": "x" * 300}, "tables.unreadable"),
    ):
        wrong = opens()
        assert wrong.shared.table == before
        reply = refused(wrong, "table", **{**wrong.shared.put(entries), "cells": []})
        assert reply["error"]["code"] == code
    older = {**opens().shared.put({"p6/1.0/1": 1.0}), "epoch": "another"}
    assert refused(page, "table", **older)["error"]["code"] == "tables.older"
    bytes_ = {**page.shared.put({"p6/1.0/1": 1.5}), "update": b"\xff" * 30}
    assert refused(page, "table", **bytes_)["error"]["code"] == "tables.unreadable"
    assert opens().shared.table == before


def test_a_pasted_sheet_and_a_download(page: DesignClient) -> None:
    """A downloaded file can be dropped or pasted on the page again, and gives the same table."""
    table = sample(page)
    for name in ("Loco-data.xlsx", "Loco-data.txt"):
        data = page.ask("write", name=name, table=table)["data"]
        assert page.ask("parse", name=name, data=data)["table"] == table
    assert page.ask("parse", name="pasted", data=data.decode())["table"] == table
    robot = find_robot("octopod")[1]
    assert page.ask("parse", name="my.toml", data=robot)["robot"].encode() == robot
    assert refused(page, "parse", name="x", data=[1])["error"]["code"] == "gateway.bad-message"


def test_a_trial_and_its_robot(page: DesignClient) -> None:
    """A page gets the studio's descriptions of robots and trials, also of two trials at once."""
    robot = {"name": "robot.toml", "data": find_robot("octopod")[1]}
    assert len(page.ask("robot", robot=robot)["legs"]) == 8
    told = page.ask("robot")
    assert len(told["legs"]) == 6
    asked = [page.send("trial", table=sample(page), keys=keys) for keys in ("", "1")]
    forward, left = [page.reply(number) for number in asked]
    assert forward["figures"]["speed_mm_s"] > 40
    assert left["figures"]["drift_deg_s"] > 5
    assert len(forward["poses"]) == forward["ticks"] * (7 + 18) * 4
    sequences = [[0], [0], [2, 1, 4, 3]]
    other = page.ask("trial", table=sample(page), sequences=sequences)
    assert other["digest"] != forward["digest"]


def test_mistakes_of_a_table_have_their_places(page: DesignClient) -> None:
    """A table with an angle out of range is refused with row, column and joint of the angle."""
    table = sample(page)
    table["rows"][2]["angles_deg"][3] = 151.0
    (mistake,) = refused(page, "trial", table=table)["mistakes"]
    assert (mistake["row"], mistake["column"], mistake["joint"]) == (4, 5, 3)
    robot = {"name": "my.toml", "data": b"[body]\nmass_kg = -1\n"}
    assert refused(page, "robot", robot=robot)["mistakes"]


@pytest.mark.long
def test_a_search_tells_how_far_it_is_and_can_be_cancelled(page: DesignClient) -> None:
    """Progress has the name that the page gave to the search; a cancelled search gets a reply."""
    search = page.send("coach", job="search", table=sample(page), size="cell", seconds=60.0)
    page.until(lambda: page.progress)
    page.ask("cancel", job="search")
    reply = page.reply(search)
    assert reply["cancelled"]
    assert {one["job"] for one in page.progress} == {"search"}


def searched(page: DesignClient, do: str, **fields: Any) -> Any:
    """Return what a search found; ask again as a person would if the answer says so.

    On a full machine the link to the studio can break for a moment, and an answer is lost with it.
    Until the studio has ended that search, its job is taken.
    """
    found: list[Any] = []

    def ask() -> bool:
        try:
            found.append(page.ask(do, **fields))
        except Refused as refusal:
            if not refusal.reply["again"] and refusal.why.code != "studio.job-taken":
                raise
        return bool(found)

    until(ask)
    return found[0]


@pytest.mark.long
def test_other_gaits_are_found(page: DesignClient) -> None:
    """A map of gaits has at least the page's own; a table that lacks an angle gives no variants."""
    fields = {"table": sample(page), "sequences": [[0], [8, 7, 6, 5], [1, 2, 3, 4]]}
    found = searched(page, "map", job="map", **fields, seconds=0.0)
    own = next(cell for cell in found["cells"] if [cell["speed"], cell["arousal"]] == found["own"])
    assert own["gait"]["figures"]["speed_mm_s"] == pytest.approx(60, abs=3)
    kept = own["gait"]["table"]
    refusal = refused(page, "variants", job="six", **fields, keep=[kept[1:]])
    assert refusal["error"]["code"] == "studio.wrong-tables"
    variants = searched(page, "variants", job="six", **fields, keep=[kept], round=1)["variants"]
    assert all(len(one["table"]) == len(kept) for one in variants)
    assert {one["job"] for one in page.progress} == {"map", "six"}


def test_a_page_that_goes_ends_its_search(opens: Opens) -> None:
    """When a page has gone, its long search ends, and the search of another page begins."""
    gone = opens()
    gone.send("coach", job="long", table=sample(gone), size="table", seconds=120.0)
    gone.until(lambda: gone.progress)
    gone.close()
    other = opens()
    other.send("coach", job="short", table=sample(other), size="cell", seconds=0.0)
    other.until(lambda: any(one["stage"] != "waiting" for one in other.progress))


def test_too_much_is_one_clear_answer(page: DesignClient) -> None:
    """Requests and texts that are too long are refused, and the connection stays open."""
    pasted = "45\t" * (10_000_000 // 3)
    for do, fields in (
        ("parse", {"name": "x", "data": pasted}),
        ("save", {"name": "my.toml", "robot": "#" * STUDIO_MAX_BYTES}),
        ("hello", {"key": "k" * 300}),
    ):
        assert refused(page, do, **fields)["error"]["code"] == "gateway.bad-message"
    assert page.ask("ping", t=1) == {"t": 1}


@pytest.mark.parametrize("garbage", [b"", b"\xc1", b"\x93\x01\x02\x03", b"\x81\xa2do\xa4read"])
def test_garbage_closes_the_connection(opens: Opens, garbage: bytes) -> None:
    """A message whose id can't be read closes the connection with code 1008."""
    page = opens()
    page.socket.send(garbage)
    assert page.code() == 1008


def test_a_table_is_taken_to_practice(page: DesignClient) -> None:
    """Practice gets a page's table, and later the newer one; a table with mistakes is refused."""
    table = sample(page)
    sequences = [[0], [4, 3, 2, 1], [1, 2, 3, 4]]
    bad = {**table, "rows": [{**table["rows"][0], "angles_deg": [999.0] * 18}, *table["rows"][1:]]}
    reply = refused(page, "play", table=bad, sequences=sequences)
    assert reply["mistakes"]
    assert refused(page, "hand_on", table=bad, sequences=sequences)["mistakes"]
    files = page.ask("hand_on", table=table, sequences=sequences)
    assert files["robot"] is None
    assert all(files[kind]["data"] for kind in ("postures", "locomotion")), "level B is made, too"
    url = page.ask("play", table=table, sequences=sequences)["url"]
    address, key = url.split("/practice#key=")
    practice = PageConnection(address, "/ws")
    try:
        practice.ask("watch", key=key)
        practice.until(lambda: practice.last(MessageKind.FILES))
        first = practice.last(MessageKind.FILES)
        assert "Loco-data.txt" in str(first)
        rows = [{**table["rows"][0], "angles_deg": [7.0] * 18}, *table["rows"][1:]]
        assert page.ask("play", table={**table, "rows": rows}, sequences=sequences)["url"] == url
        practice.until(lambda: practice.last(MessageKind.FILES) != first)
    finally:
        practice.close()


@pytest.mark.long
def test_a_studio_that_dies_comes_back(page: DesignClient, gateway: Gateway) -> None:
    """A killed studio is started again; pages are told both, and the next trial works."""
    page.until(lambda: page.studio.get("present"))
    before = page.ask("trial", keys="2")["digest"]
    children = psutil.Process(gateway.process.pid).children(recursive=True)
    studio = next(one for one in children if "studio" in one.cmdline())
    for process in (studio, *studio.children(recursive=True)):
        process.kill()
    page.until(lambda: not page.studio["present"])
    page.until(lambda: page.studio["present"])
    assert page.ask("trial", keys="2")["digest"] == before


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--connect", "http://x"), "is not an address"),
        (("--robot", "nothing"), "There is no robot"),
        (("none",), "There is no folder none"),
    ],
)
def test_a_wrong_start_is_told(tmp_path: Path, words: tuple[str, ...], said: str) -> None:
    """A wrong folder, robot or address ends the command with an error that names it."""
    ended = run_lacoc("design", *words, "--no-open", cwd=tmp_path)
    assert ended.returncode == 2
    assert said in ended.stderr


@pytest.mark.long
def test_a_studio_elsewhere_may_come_later(tmp_path: Path) -> None:
    """With --connect a page is told why no studio is found; trials work once a studio starts."""
    address = f"tcp/127.0.0.1:{free_port()}"
    with ExitStack() as stack:
        gateway = Gateway(tmp_path, "--connect", address, "--robot", "quadruped")
        stack.callback(gateway.close)
        page = DesignClient(gateway.url, gateway.key)
        stack.callback(page.close)
        page.until(lambda: page.studio["why"])
        table = sample(page)
        assert table["legs"] == 4
        robot = page.ask("hello", key=gateway.key)["robot"]
        reply = refused(page, "trial", table=table, robot=robot)
        assert reply["again"]
        studio = stack.enter_context(Lacoc("studio", "--listen", address, "--jobs", "1"))
        stack.callback(studio.terminate)
        page.until(lambda: page.studio["present"])
        assert page.ask("trial", table=table, robot=robot)["figures"]["cycles"] > 0


@given(st.binary(max_size=300))
def test_no_bytes_break_the_reader(data: bytes) -> None:
    """For any bytes from a page, `read` returns a request or raises `Unreadable`."""
    with contextlib.suppress(Unreadable):
        requests.read(data)


def test_whole_numbers_of_a_browser_are_angles() -> None:
    """A browser sends the angle 45.0 as the integer 45, which is read as an angle."""
    rows = [{"key": 1, "posture": 0, "angles_deg": [45, -1.5] * 9}]
    body = {"id": 1, "do": "trial", "table": {"kind": "postures", "legs": 6, "rows": rows}}
    asked = requests.read(msgpack.packb(body))
    assert isinstance(asked, requests.TrialAsk)
    assert asked.table is not None
    assert asked.table.rows[0].angles_deg == (45.0, -1.5) * 9
