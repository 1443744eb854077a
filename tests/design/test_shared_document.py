"""Tests of the document of a shared table, and of the table that passes edits on."""

import asyncio
import random
from functools import partial
from typing import Any

import msgspec
import pytest
from aside import run_async
from hypothesis import given
from hypothesis import strategies as st
from page_table import PageTable
from pycrdt import Array, Doc, Map

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.viewer import Viewer
from lacoc_client.workshop.design import requests
from lacoc_client.workshop.design.table import FileTable
from lacoc_client.workshop.phases.class_file import Document
from lacoc_client.workshop.tables import document as documents
from lacoc_client.workshop.tables.document import TableDocument, document_of
from lacoc_client.workshop.tables.draft import draft_of
from lacoc_client.workshop.tables.entries import (
    ENTRIES_MOST,
    Entry,
    without_proposals,
)
from lacoc_client.workshop.tables.kept_table import kept_table
from lacoc_client.workshop.tables.shared_table import SharedTable, TableUpdate
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import UserError


def standing(rows: int = 9) -> dict[str, Entry]:
    """Return a table of six legs whose angles are all 0."""
    entries: dict[str, Entry] = {"shape": "p6", "keys": "0,8765,1234"}
    for key in range(rows):
        entries[f"p6/{key}.0"] = True
        entries |= {f"p6/{key}.0/{col}": 0.0 for col in range(18)}
    return entries


def page_of(document: TableDocument) -> PageTable:
    opened = {"table": "", "epoch": "", "seq": 0, "state": document.state}
    return PageTable(opened)


def angle_of(document: TableDocument, key: int, col: int) -> Entry:
    return document.entries[f"p6/{key}.0/{col}"]


def test_four_pages_converge_and_nothing_is_lost() -> None:
    """Four pages make 1,000 random edits each, with outages: gateway and pages agree at the end.

    Each number that nobody else typed over is there.
    """
    rng = random.Random(3)
    document = document_of(standing())
    pages = [page_of(document) for _ in range(4)]
    waiting: list[list[bytes]] = [[] for _ in pages]
    typed: dict[str, float] = {}
    for number in range(1000):
        for who, page in enumerate(pages):
            cell = f"p6/{rng.randrange(9)}.0/{4 * rng.randrange(4) + who}"
            typed[cell] = number + who / 10
            waiting[who].append(page.put({cell: typed[cell]})["update"])
            if rng.random() < 0.1:  # it is online for a moment
                for update in waiting[who]:
                    document.merge(update)
                waiting[who].clear()
                page.take(document.state)
    # Those of one page come in order: pycrdt loses entries otherwise.
    while left := [updates for updates in waiting if updates]:
        document.merge(rng.choice(left).pop(0))
    for page in pages:
        page.take(document.state)
        assert page.entries == document.entries
    assert {name: document.entries[name] for name in typed} == typed


def test_a_draft_is_the_table_with_its_keys_and_robot() -> None:
    """A cell without an angle makes no draft; rows of sequences are numbered without gaps."""
    entries = standing(3)
    draft = draft_of({**entries, "robot": '{"name":"a.toml","text":"[body]"}'})
    assert draft is not None
    assert draft.sequences == ((0,), (0,), (0,)), "keys without all their postures"
    assert draft.robot is not None
    assert (draft.robot.name, draft.robot.data) == ("a.toml", b"[body]")
    assert draft_of({**entries, "p6/1.0/3": "x"}) is None
    assert draft_of({}) is None
    gaps: dict[str, Entry] = {"shape": "l1"}
    for place in ("0.0", "2.1", "2.3"):
        gaps |= {f"l1/{place}": True, **{f"l1/{place}/{col}": 1.0 for col in range(3)}}
    found = draft_of(gaps)
    assert found is not None
    assert [(row.key, row.posture) for row in found.table.rows] == [(0, 0), (1, 0), (1, 1)]


def test_a_table_with_more_rows_than_a_key_may_have_is_no_draft() -> None:
    """A hundred rows of a key are one; with one more, nobody could read the table again."""
    entries: dict[str, Entry] = {"shape": "l1"}
    for rank in range(100):
        entries |= {f"l1/0.0_{rank}1": True}
        entries |= {f"l1/0.0_{rank}1/{col}": 1.0 for col in range(3)}
    draft = draft_of(entries)
    assert draft is not None
    assert msgspec.json.decode(msgspec.json.encode(draft.table), type=FileTable) == draft.table
    more = {name.replace("0.0_01", "0.99"): value for name, value in entries.items()}
    assert draft_of({**entries, **more}) is None


def test_what_somebody_proposed_can_be_removed() -> None:
    """Only the proposals of this person go."""
    kept: dict[str, Entry] = {**standing(1), "p6/0.0/1?": '{"text":"4","by":"Ben"}'}
    entries: dict[str, Entry] = {**kept, "p6/0.0/2?": '{"text":"5","by":"Ann"}'}
    assert without_proposals(entries, "Ann") == kept


WRONG: list[dict[str, Any]] = [
    {"other": 1.0},
    {"p6/1.0/18": 1.0},
    {"p33/1.0/1": 1.0},
    {"p6/1.0/1": float("inf")},
    {"p6/1.0/1": "x" * 201},
    {"p6/1.0": 1.0},
    {"p6/1.0/1": True},
    {"p6/1.0/1?": 5.0},
    {"shape": "q6"},
    {"robot": "x" * 40_001},
    {"robot": '{"name":5,"text":"x"}'},
    {"robot": '{"name":' + "[" * 39_000},
    {"file": "null"},
    {"file": '{"name":"a.txt","version":"1","digest":""}'},
    {"p6/1.0/1": Map({"a": 1.0})},
    {"p6/1.0/1": Array([1.0])},
]


def test_what_a_page_writes_of_its_files_is_taken() -> None:
    """Texts that name no file, too."""
    document = document_of(standing())
    file = '{"name":"a.txt","version":"1","digest":"","robotVersion":%s}'
    changes = [{"file": file % version} for version in ("null", '"7"')]
    changes += [{"robot": '{"name":"a.toml","text":"[body]"}'}, {"robot": "", "file": ""}]
    for change in changes:
        assert document.merge(page_of(document).put(change)["update"])


@pytest.mark.parametrize("entries", WRONG, ids=lambda one: str(one)[:40])
def test_what_is_no_table_changes_nothing(entries: dict[str, Any]) -> None:
    """An entry that no table has is refused, also in an update with right ones."""
    document = document_of(standing())
    state, before = document.state, dict(document.entries)
    update = page_of(document).put({"p6/2.0/2": 7.0, **entries})["update"]
    with pytest.raises(UserError):
        document.merge(update)
    assert (document.state, document.entries) == (state, before)
    assert document.merge(page_of(document).put({"p6/2.0/2": 7.0})["update"])
    assert angle_of(document, 2, 2) == 7.0


def test_other_roots_are_refused() -> None:
    """A document with another root than the table's is none."""
    document = document_of(standing())
    other: Doc[Any] = Doc()
    other.get("text", type=Array).append("hidden")
    with pytest.raises(UserError):
        document.merge(bytes(other.get_update()))
    assert angle_of(document, 1, 1) == 0.0


@given(st.binary(max_size=200))
def test_no_bytes_break_a_document(data: bytes) -> None:
    """Whatever a page sends as an update, it is merged or refused, and the table stays one."""
    document = document_of(standing(1))
    before = dict(document.entries)
    try:
        document.merge(data)
    except UserError:
        assert document.entries == before
    assert draft_of(document.entries) is not None


def test_a_table_can_not_grow_without_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """Too many entries are refused; a long past is cut off by a fresh document."""
    document = document_of(standing())
    many = {
        f"p32/{key}.{row}/{col}": 1.0 for key in range(10) for row in range(10) for col in range(90)
    }
    assert len(many) > ENTRIES_MOST
    with pytest.raises(UserError, match="too many rows"):
        document.merge(page_of(document).put(many)["update"])
    page = page_of(document)
    edits = 0
    while not document.is_long:
        document.merge(page.put({f"p6/1.0/{edits % 18}": float(edits)})["update"])
        edits += 1
    assert edits > 1000
    fresh = document.fresh()
    assert fresh.entries == document.entries
    assert len(fresh.state) < len(document.state) / 5
    monkeypatch.setattr(documents, "STATE_BYTES", len(document.state))
    with pytest.raises(UserError, match="too many rows"):
        document.merge(page.put({"p6/1.0/1": 0.5, "p6/1.0/2": 0.5})["update"])


class Wire:
    """Where a page's messages go."""

    keeps_up = True
    heard_s = 0.0
    drained = None

    def __init__(self) -> None:
        self.written: list[bytes] = []

    def write(self, framed: bytes) -> None:
        self.written.append(framed)

    def watch_closely(self) -> None:
        pass


def told(page: PageTable, entries: dict[str, Any], **changes: Any) -> TableUpdate:
    return TableUpdate(**{**page.put(entries), **changes})


async def keep_nothing(state: bytes, epoch: str) -> None:
    """Stand for a disk on which nothing is looked at."""


def test_edits_share_writes_and_wait_for_the_disk() -> None:
    """A reply waits until its edit is on the disk; edits that come meanwhile share one write."""
    kept: list[bytes] = []
    going = asyncio.Event

    async def edit() -> None:
        free = going()

        async def keep(state: bytes, epoch: str) -> None:
            await free.wait()
            kept.append(state)

        table = SharedTable("", keep)
        viewer = Viewer(Wire())
        table.add(viewer, "Ada")
        page = PageTable(table.opened())
        takes = [asyncio.ensure_future(table.take(viewer, told(page, dict(standing()))))]
        for number in range(20):
            change = {"p6/1.0/1": float(number)}
            takes.append(asyncio.ensure_future(table.take(viewer, told(page, change))))
        await asyncio.sleep(0.05)
        assert not any(take.done() for take in takes)
        free.set()
        await asyncio.gather(*takes)
        assert len(kept) <= 3
        assert TableDocument(kept[-1]).entries["p6/1.0/1"] == 19.0

    run_async(edit)


def test_a_table_that_was_only_opened_is_not_kept() -> None:
    """What a page begins with is shared but not kept; with the last page it is gone."""
    kept: list[bytes] = []

    async def keep(state: bytes, epoch: str) -> None:
        kept.append(state)

    async def open_it() -> None:
        table = SharedTable("", keep)
        one, other = Viewer(Wire()), Viewer(Wire())
        table.add(one, "")
        table.add(other, "")
        first, second = PageTable(table.opened()), PageTable(table.opened())
        await table.take(one, told(first, dict(standing()), begins=True, cells=()))
        with pytest.raises(UserError, match="older state"):
            await table.take(other, told(second, dict(standing()), begins=True, cells=()))
        assert (kept, table.draft) == ([], None)
        third = PageTable(table.opened())
        await table.take(other, told(third, {"p6/0.0/0": 5.0}))
        assert table.draft is not None
        assert len(kept) == 1
        untouched = SharedTable("", keep)
        untouched.add(one, "")
        page = PageTable(untouched.opened())
        await untouched.take(one, told(page, dict(standing()), begins=True, cells=()))
        untouched.leave(one)
        untouched.end()
        assert untouched.opened()["state"] == b""

    run_async(open_it)


def test_a_flood_at_one_table_is_refused() -> None:
    """More updates than a table takes are refused, and change nothing."""

    async def flood() -> None:
        table = SharedTable("", keep_nothing)
        viewer = Viewer(Wire())
        table.add(viewer, "")
        page = PageTable(table.opened())
        refused = 0
        for number in range(1000):
            try:
                await table.take(viewer, told(page, {"p6/0.0/0": float(number)}))
            except UserError as error:
                refused += error.phrase.code == "gateway.too-much"
        assert refused > 100

    run_async(flood)


def test_a_whole_table_comes_at_once_and_a_larger_one_is_refused_in_words() -> None:
    """A page may put in 8,000 entries and name them all; it is told if a table has more."""

    async def begin(postures: int) -> None:
        table = SharedTable("", keep_nothing)
        viewer = Viewer(Wire())
        table.add(viewer, "")
        page = PageTable(table.opened())
        rows = [f"l6/{key}.{posture}" for key in range(10) for posture in range(postures)]
        cells = {f"{row}/{col}": col / 7 for row in rows for col in range(18)}
        asked = page.put({"shape": "l6", **dict.fromkeys(rows, True), **cells})
        assert len(asked["cells"]) == len(cells)
        assert requests.read(msgspec.msgpack.encode({"id": 1, "do": "table", **asked}))
        await table.take(viewer, TableUpdate(**asked))
        assert PageTable(table.opened()).entries == page.entries

    run_async(partial(begin, 42))
    for postures in (43, 100):
        with pytest.raises(UserError) as refused:
            run_async(partial(begin, postures))
        assert refused.value.phrase.code == "tables.too-large"


def number(value: int) -> bytes:
    """Write a number as Yjs does."""
    found = b""
    while value > 127:
        found += bytes([value & 127 | 128])
        value >>= 7
    return found + bytes([value])


def made(value: bytes, client: int = 5, clock: int = 0, kind: int = 8, named: bool = True) -> bytes:
    """Make an update that no page writes."""
    text = b"".join(number(len(one)) + one for one in (b"table", b"p6/0.0/0")[: 1 + named])
    head = number(1) + number(1) + number(client) + number(clock)
    return head + bytes([kind | 0x20 * named]) + number(1) + text + value + number(0)


FORGED = {
    "a list in a list in a list": made(number(1) + b"\x75\x01" * 40_000 + b"\x78"),
    "a value that is not there": made(number(2**31)),
    "many pages": number(2**40),
    "no UTF-8": made(number(1) + b"\x77\x01\xff"),
    "no entry": made(number(1) + b"\x78", named=False),
    "a nested map": made(number(1), kind=7),
    "an edit after one that is missing": made(number(1) + b"\x78", clock=3),
    "an edit without an end": made(number(2**32 - 2), kind=1),
    "a deletion of what is not there": number(0) + number(1) + number(9) + b"\x01\x00\x05",
}


@pytest.mark.parametrize("update", FORGED.values(), ids=FORGED)
def test_a_forged_update_does_not_reach_the_library(update: bytes) -> None:
    """What no page writes is refused: the first one would end the process otherwise."""
    document = document_of(standing(1))
    with pytest.raises(UserError):
        document.merge(update)
    assert document.merge(page_of(document).put({"p6/0.0/0": 4.0})["update"])


def test_an_update_whose_predecessor_is_missing_is_refused() -> None:
    """It would take cells away otherwise, and would not be on the disk."""
    document = document_of(standing())
    page = page_of(document)
    first, second = (page.put({"p6/1.0/1": angle})["update"] for angle in (5.0, 6.0))
    before = dict(document.entries)
    with pytest.raises(UserError, match="older state"):
        document.merge(second)
    assert document.entries == before
    document.merge(first)
    document.merge(second)
    assert angle_of(document, 1, 1) == 6.0
    assert not document.merge(first), "it came again"


def test_a_state_with_a_past_is_cut_off_after_a_restart() -> None:
    """Each restart would allow as much more past otherwise, until nothing fits any more."""
    document = document_of(standing(1))
    page = page_of(document)
    while not document.is_long:
        document.merge(
            page.put({f"p6/0.0/{col}": page.seen + col + 0.5 for col in range(18)})["update"]
        )
        page.seen += 1
    assert TableDocument(document.state).is_long


def test_a_robot_entry_with_endless_brackets_is_the_workshops_robot() -> None:
    """The table stays usable, also after a restart."""
    draft = draft_of({**standing(1), "robot": '{"name":' + "[" * 39_000})
    assert draft is not None
    assert draft.robot is None


def test_a_draft_of_an_earlier_version_becomes_a_table() -> None:
    """Its angles, keys, robot and file are in the table; what can't be read is left out."""
    rows = [{"key": 3, "posture": 0, "angles_deg": [float(col) for col in range(6)]}]
    old = {
        "table": {"kind": "postures", "legs": 2, "rows": rows},
        "sequences": [[3], [3, 3]],
        "robot": {"name": "a.toml", "data": b"[body]"},
        "file": "Loco-data.txt",
        "file_version": "ab",
        "saved": True,
    }
    kept = Document("Ann", "draft", "7", 5.0, msgspec.msgpack.encode(old))
    token = Document("Ann", "token", "", 0.0, b"secret")
    table = kept_table([token, kept])
    assert table is not None
    entries = TableDocument(table.content).entries
    draft = draft_of(entries)
    assert draft is not None
    assert draft.table.rows[0].angles_deg == tuple(range(6))
    assert draft.sequences == ((3,), (3, 3))
    assert draft.robot == SentFile("a.toml", b"[body]")
    assert '"version":"ab"' in str(entries["file"])
    newer = Document("Ann", "table", "e", 6.0, document_of(standing(1)).state)
    assert kept_table([kept, newer]) == newer
    assert kept_table([token]) is None
    assert kept_table([Document("Ann", "draft", "", 0.0, b"\xc1")]) is None


def test_two_pages_with_one_number_do_not_hide_each_others_edits() -> None:
    """The second one is told to begin again, with a number of its own."""

    async def edit() -> None:
        table = SharedTable("", keep_nothing)
        one, other = Viewer(Wire()), Viewer(Wire())
        for viewer in (one, other):
            table.add(viewer, "")
        await table.take(one, told(PageTable(table.opened()), dict(standing())))
        pages = [PageTable(table.opened(), client=7) for _ in range(2)]
        await table.take(one, told(pages[0], {"p6/0.0/0": 1.0}))
        with pytest.raises(UserError, match="older state"):
            await table.take(other, told(pages[1], {"p6/0.0/1": 2.0}))
        table.leave(one)
        await table.take(other, told(pages[0], {"p6/0.0/2": 4.0}))  # it has connected again
        assert table.draft is not None
        assert table.draft.table.rows[0].angles_deg[:3] == (1.0, 0.0, 4.0)

    run_async(edit)


def test_an_edit_that_shows_nothing_holds_back_no_later_one() -> None:
    """A page that lacks one edit of another page shows none of that page's later edits."""

    async def edit() -> None:
        table = SharedTable("", keep_nothing)
        sockets = [Wire() for _ in range(2)]
        one, other = map(Viewer, sockets)
        for viewer in (one, other):
            table.add(viewer, "")
        await table.take(one, told(PageTable(table.opened()), dict(standing())))
        first, second = (PageTable(table.opened()) for _ in range(2))
        same = told(first, {"p6/0.0/0": 0.0})  # as after undo: the number that was there
        for update in (same, same, told(first, {"p6/0.0/1": 2.0})):
            await table.take(one, update)
        news = [msgspec.msgpack.decode(wire.opened(framed)[1]) for framed in sockets[1].written]
        updates = [body["update"] for body in news if "update" in body][1:]
        assert len(updates) == 2, "what comes again is passed on once"
        for update in updates:
            second.take(update)
        assert second.entries["p6/0.0/1"] == 2.0

    run_async(edit)


def test_the_newest_whole_table_is_the_draft() -> None:
    """A cell without an angle leaves the draft as it was just before."""

    async def edit() -> None:
        table = SharedTable("", keep_nothing)
        viewer = Viewer(Wire())
        table.add(viewer, "")
        page = PageTable(table.opened())
        for change in (dict(standing()), {"p6/0.0/0": 5.0}, {"p6/0.0/1": 6.0}, {"p6/0.0/0": "x"}):
            await table.take(viewer, told(page, change))
        await table.take(viewer, told(page, {"p6/0.0/2": 7.0}))
        assert table.draft is not None
        assert table.draft.table.rows[0].angles_deg[:3] == (5.0, 6.0, 0.0)
        await table.take(viewer, told(page, {"p6/0.0/0": 8.0}))
        assert table.draft.table.rows[0].angles_deg[:3] == (8.0, 6.0, 7.0)

    run_async(edit)


def test_pages_hear_of_places_at_a_bounded_rate() -> None:
    """However many pages move, each is told at most so often; the last place arrives."""

    async def move() -> None:
        table = SharedTable("", keep_nothing)
        sockets = [Wire() for _ in range(5)]
        viewers = [Viewer(socket) for socket in sockets]
        for viewer in viewers:
            table.add(viewer, "")
        for row in range(200):
            table.move(viewers[0], row, 0, None)
        await asyncio.sleep(0.2)
        for socket in sockets:
            assert len(socket.written) <= 5
        assert sockets[1].written[-1].count(b"row") == 5
        assert bytes([0xCC, 199]) in sockets[1].written[-1]

    run_async(move)
