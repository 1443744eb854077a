"""Tests of /replay: recordings in the browser, compared with what Python reads."""

from bisect import bisect_right
from collections.abc import Iterator
from contextlib import ExitStack
from operator import itemgetter
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from chromium import OpenPage
from drop import drop
from mcap.writer import Writer
from playwright.sync_api import Page, expect
from show import Show, violations
from venue import Venue

from lacoc_arenas import arena as arenas
from lacoc_server.simulate import player, simulate
from lacoc_shared.codec import decode, encode, unpack_states
from lacoc_shared.messages import Frame
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import Setup
from lacoc_shared.record.writer import RecordWriter
from lacoc_shared.words import render

pytestmark = pytest.mark.slow

LAPTOP = {"width": 1366, "height": 768}
PHONE = {"width": 390, "height": 844}
SECONDS = 40
RUN_UP = 50
"""A jump to an event leads to this many beats before the event."""
SAMPLE = """new Promise((done) => requestAnimationFrame((now_ms) => setTimeout(() =>
    done([now_ms / 1000, window.__replay.recording.beat.value]))))"""
"""Returns the time of a picture and its beat. At another moment the beat would be older."""


def played(folder: Path, match_id: str, arena: str, seconds: float) -> Path:
    """Play a match of two bots, and return its record's path."""
    settings = arenas.load(arena, {"match": {"duration_s": seconds}})
    setup = Setup(
        match_id=match_id, court="hall", match=3, arena=arena, settings=settings.settings, limits={}
    )
    players = [player(settings, seat, bot) for seat, bot in enumerate(("planner", "nearest"))]
    simulate(setup, players, folder)
    return folder / f"{match_id}.mcap"


@pytest.fixture(scope="module")
def library(built_pages: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Venue]:
    """Give a gateway with two recordings and without a court."""
    with ExitStack() as stack:
        venue = Venue(tmp_path_factory.mktemp("library"), stack)
        folder = venue.folder / "recordings"
        played(folder, "b-flags", "flag-strike", SECONDS)
        played(folder, "a-discs", "othello", 1)
        venue.web("--recordings", str(folder))
        yield venue


@pytest.fixture(scope="module")
def flags(library: Venue) -> Path:
    """Give the path of a recorded Flag-Strike match."""
    return library.folder / "recordings" / "b-flags.mcap"


@pytest.fixture(scope="module")
def record(flags: Path) -> Record:
    """Give the Flag-Strike recording, read by Python."""
    return Record.read(flags)


def frame_at(record: Record, beat: int) -> Frame:
    index = bisect_right(record.frames, beat, key=itemgetter(0)) - 1
    return decode(record.frames[index][1], Frame)


class Player(Show):
    """The replay page, for a recording or for the list of recordings.

    Args:
        page: a new page.
        venue: the gateway.
        query: such as "?file=b-flags.mcap&t=0"; with `t` [s] it opens paused at that time.
    """

    def __init__(self, page: Page, venue: Venue, query: str = "", **options: Any) -> None:
        between = "&" if query else "?"
        super().__init__(page, venue.url, f"/replay{query}{between}q=low&cam=arena", **options)

    @property
    def beat(self) -> float:
        beat: float = self.page.evaluate("window.__replay.recording.beat.value")
        return beat

    @property
    def ends(self) -> tuple[int, int]:
        first, last = self.page.evaluate(
            "[window.__replay.recording.firstBeat, window.__replay.recording.lastBeat]"
        )
        return first, last

    @property
    def playing(self) -> bool:
        return bool(self.page.evaluate("window.__replay.playing.value"))

    def opened(self, match_id: str = "b-flags") -> None:
        """Wait until a recording is open, and pause it."""
        name = "window.__replay?.recording.record.header.match_id"
        self.until(lambda: self.page.evaluate(name) == match_id, "it was not opened")
        self.page.evaluate("window.__replay.pause()")
        self.sees(".transport")
        # The page listens to keys once it has been painted.
        painted = "new Promise((done) => requestAnimationFrame(() => setTimeout(done, 50)))"
        self.page.evaluate(painted)

    def seek(self, beat: int) -> None:
        """Go to a beat, and wait until it is drawn; a recording that begins to play is paused."""
        go = "(beat) => { window.__replay.pause(); window.__replay.seek(beat); }"
        self.page.evaluate("(beat) => window.__replay.seek(beat)", beat)

        def is_drawn() -> bool:
            if self.beat != beat:
                self.page.evaluate(go, beat)
            return bool(self.view("drawnBeat") == beat)

        self.until(is_drawn, f"beat {beat} was not drawn")

    def press(self, *keys: str) -> None:
        for key in keys:
            self.page.keyboard.press(key)

    def drop(self, *paths: Path) -> None:
        """Drop files on the page."""
        drop(self.page, {path.name: path.read_bytes() for path in paths})


def test_what_is_shown_is_what_was_played(
    library: Venue, record: Record, open_page: OpenPage
) -> None:
    """At each beat the page shows the score, clock, board and poses that Python reads there."""
    page = open_page()
    sockets: list[str] = []
    page.on("websocket", lambda socket: sockets.append(socket.url))
    show = Player(page, library, "?file=b-flags.mcap&t=0")
    first, last = show.ends
    assert first == next(e.beat for e in record.events if e.data.get("after") == "COUNTDOWN") - 51
    assert last == record.last_beat
    events = [event.beat for event in record.events if event.kind in ("strike", "capture")]
    assert len(events) > 3
    sheet, scene = record.sheet_at(last), record.scene_at(last)
    assert sheet is not None
    assert scene is not None
    roots = {body.seat: body.name for body in scene.bodies if body.seat >= 0}
    beats = {first, last, *np.linspace(first, last, 7, dtype=int).tolist()}
    for beat in sorted(beats | {b for event in events[:3] for b in (event - 1, event)}):
        show.seek(beat)
        frame = frame_at(record, beat)
        show.has_scores(*(seat.score for seat in frame.seats))
        seconds = -(-(SECONDS * 50 - frame.clock_ticks) // 50)
        expect(show.find(".score-bug .clock")).to_have_text(f"{seconds // 60}:{seconds % 60:02}")
        states = unpack_states(frame.markers, len(sheet.markers))
        assert [show.view(f"marker({index})") for index in range(len(states))] == list(states)
        poses = np.frombuffer(frame.poses, "<f4")
        for seat, at in ((0, 0), (1, len(poses) // 2)) if len(poses) else ():
            found = show.view(f"bodyPos({roots[seat]!r})")
            np.testing.assert_allclose(found, poses[at : at + 3], atol=1e-6)
        happened = sum(event.beat <= beat for event in record.events)
        log = show.page.evaluate("window.__replay.recording.events.value.length")
        assert log == happened
    assert sockets == []


@pytest.mark.long
@pytest.mark.parametrize("slow_screen", [False])  # the test depends on drawing
def test_play_seek_step_and_speed(library: Venue, record: Record, open_page: OpenPage) -> None:
    """Keys and buttons play, pause, seek, step and change the speed of a recording."""
    show = Player(open_page(viewport=LAPTOP), library, "?file=b-flags.mcap")
    show.until(lambda: show.playing, "it does not play by itself")
    first, last = show.ends
    show.press("Space")
    show.until(lambda: not show.playing, "Space does nothing")
    show.seek(first + 400)
    show.press(".", ".", ",")
    assert show.beat == first + 401
    show.press("ArrowRight")
    assert show.beat == first + 651
    show.press("ArrowLeft")
    assert show.beat == first + 401
    for key in (".", "ArrowRight"):  # a held key repeats
        show.page.keyboard.down(key)
        show.page.keyboard.down(key)
        show.page.keyboard.up(key)
    assert show.beat == first + 903
    show.press("End")
    assert show.beat == last
    show.press("Home")
    assert show.beat == first
    speed = show.page.get_by_title("Speed")
    speed.click()
    speed.select_option("0.5")
    show.press("ArrowRight")  # a chooser that was clicked is done with
    assert show.beat == first + 250

    def beats_a_second() -> float:
        then: list[float] = []

        def enough() -> bool:
            then.extend(show.page.evaluate(SAMPLE))
            # A busy machine may draw nothing for longer than 1.2 s.
            return then[-2] - then[0] > 1.2 and then[-1] > then[1]

        show.until(enough, "time stands still")
        return (then[-1] - then[1]) / (then[-2] - then[0])

    speed.select_option("0.25")
    show.page.get_by_role("button", name="Play", exact=True).click()
    slow = beats_a_second()
    show.press(*["+"] * 5)
    show.until(
        lambda: show.page.evaluate("window.__replay.speed.value") == 8,
        "the keys do not change the speed",
    )
    fast = beats_a_second()
    # Between two pictures at most 0.25 s count, so a slow machine plays more slowly.
    assert 0.5 < slow < 20
    assert 5 * slow < fast < 460
    if show.beat < last - 300:
        show.page.evaluate("(beat) => window.__replay.seek(beat)", last - 200)
    show.until(lambda: not show.playing, "it does not end")
    assert show.beat == last
    show.press("Space")
    show.until(lambda: show.playing and show.beat < last, "it does not begin again")
    show.press("k")

    slider = show.page.get_by_role("slider")
    slider.focus()
    show.press("Home", "ArrowRight")
    assert show.beat == first + 250
    assert slider.get_attribute("aria-valuetext") == f"0:05 of {record_length(first, last)}"


def record_length(first: int, last: int) -> str:
    seconds = (last - first) // 50
    return f"{seconds // 60}:{seconds % 60:02}"


@pytest.mark.long
def test_marks_and_log(library: Venue, record: Record, open_page: OpenPage) -> None:
    """Each game event has a labelled mark; marks, keys and the log lead to one second before it."""
    show = Player(open_page(viewport=LAPTOP), library, "?file=b-flags.mcap&t=0")
    game = [event for event in record.events if "marker" in event.data]
    for seat in (0, 1):
        own = [str(event.beat) for event in game if event.seat == seat]
        marks = show.find(f".mark[data-seat='{seat}']").all()
        assert [mark.get_attribute("data-beat") for mark in marks] == own
    whole = show.find(".mark:not([data-seat])").all()
    assert [mark.get_attribute("data-kind") for mark in whole] == ["phase", "phase"]

    show.find(f".mark[data-beat='{game[0].beat}']").hover()
    marker = game[0].data["marker"].replace("flag", "flag ").replace("corner", "corner ")
    show.sees(".mark-label", f"{'planner' if game[0].seat == 0 else 'nearest'} strikes {marker}")
    show.find(f".mark[data-beat='{game[1].beat}']").click()
    assert show.beat == game[1].beat - RUN_UP

    show.press("Home", "n", "n")  # the first mark is the beginning of play
    assert show.beat == game[0].beat - RUN_UP
    show.press("n")
    assert show.beat == game[1].beat - RUN_UP
    show.seek(game[1].beat)
    show.sees(".third .gain", f"+{game[1].data['points']}")
    now = show.find(".replay-log [aria-current]")
    expect(now).to_have_count(1)
    expect(now).to_contain_text(render(game[1].said))
    expect(now).to_be_in_viewport()
    show.press("p")
    assert show.beat == game[0].beat - RUN_UP

    show.find(".replay-log button", has_text=render(game[2].said)).click()
    assert show.beat == game[2].beat - RUN_UP
    show.press("End")
    show.sees(".result .kicker", "Official")
    assert record.result is not None
    show.has_scores(*record.result.scores)


@pytest.mark.long
def test_the_servers_list_and_the_address(
    library: Venue, open_page: OpenPage, console: Any
) -> None:
    """Each recording and each time in it has an address; Back returns to the list."""
    console.expect("404")
    show = Player(open_page(viewport=LAPTOP), library, drawn=False)
    expect(show.find(".recordings b")).to_have_count(2)
    show.sees(".recordings li:first-child", "planner")
    show.find(".recordings a", has_text="Othello").click()
    show.sees(".score-bug .team", "planner")
    assert "file=a-discs.mcap" in show.page.url
    show.opened("a-discs")
    show.seek(220)
    show.page.get_by_role("button", name="Copy the address").click()
    show.page.wait_for_url("**/replay?file=a-discs.mcap&t=4.40")
    other = Show(open_page(), library.url, "/replay?file=a-discs.mcap&t=4.40&q=low")
    other.until(lambda: other.view("drawnBeat") == 220, "another moment")
    expect(show.page).to_have_title("planner – nearest")
    show.page.go_back()
    show.sees(".recordings")
    expect(show.page).to_have_title("Replays – LACOC")
    missing = Player(open_page(), library, "?file=none.mcap", drawn=False)
    missing.sees(".trouble", "does not have the recording none.mcap")
    missing.sees(".recordings")


@pytest.mark.long
def test_a_recording_that_was_given_up_says_nothing_more(
    library: Venue, open_page: OpenPage
) -> None:
    """While two recordings load, only the progress of the one chosen last is shown."""
    page = open_page(viewport=LAPTOP)
    page.add_init_script(
        """const get = window.fetch;
        window.arriving = {};
        window.fetch = (path) => {
          const name = /^recordings\\/(.+)$/.exec(path)?.[1];
          if (!name) return get(path);
          const body = new ReadableStream({ start: (one) => { window.arriving[name] = one; } });
          return Promise.resolve(new Response(body, { headers: { "Content-Length": "1000" } }));
        };"""
    )
    player = Player(page, library, drawn=False)
    for name in ("b-flags", "a-discs"):
        page.locator(f".recordings a[href*='{name}']").click()
        player.sees("[role=status]", f"{name}.mcap")
        if name == "b-flags":
            page.go_back()
            player.sees(".recordings")
    for name, part in (("b-flags", "500"), ("a-discs", "300")):
        arrive = f"window.arriving['{name}.mcap'].enqueue(new Uint8Array({part}))"
        page.evaluate(arrive)
    expect(page.locator("progress")).to_have_attribute("value", "0.3")
    page.evaluate("window.arriving['b-flags.mcap'].enqueue(new Uint8Array(100))")
    page.evaluate("new Promise((done) => setTimeout(done))")
    player.sees("[role=status]", "a-discs.mcap")
    expect(page.locator("progress")).to_have_attribute("value", "0.3")


@pytest.mark.long
def test_files_of_this_machine(
    library: Venue, flags: Path, record: Record, open_page: OpenPage
) -> None:
    """Files of this machine can be dropped on the page or chosen, without the server."""
    show = Player(open_page(viewport=LAPTOP), library, drawn=False)
    show.sees(".drop-here")
    show.drop(flags)
    show.opened()
    assert record.result is not None
    show.press("End")
    show.has_scores(*record.result.scores)
    show.drop(flags.with_name("a-discs.mcap"))
    show.has_scores(18, 18)
    show.page.get_by_role("button", name="Copy the address").click()
    show.sees(".toast", "give others the file")
    show.page.get_by_role("link", name="Other recordings").click()
    show.sees(".recordings")
    show.find("input[type=file]").set_input_files(flags)
    show.opened()


def write_segments(record: Record, folder: Path) -> list[Path]:
    """Write a match in two parts, as a killed and restarted court does; return their paths."""
    killed, again = 700, 650
    sheet, scene = record.sheet_at(again), record.scene_at(again)
    assert sheet is not None
    assert scene is not None
    first = RecordWriter(folder, record.header)
    second = RecordWriter(
        folder, msgspec.structs.replace(record.header, segment=1, first_beat=again)
    )
    second.scene(again, scene)
    second.sheet(again, sheet)
    scenes, sheets = dict(record.scenes), dict(record.sheets)
    for beat, data in record.frames:
        for writer in (*[first] * (beat < killed), *[second] * (beat > again)):
            if beat in scenes:
                writer.scene(beat, scenes[beat])
            if beat in sheets:
                writer.sheet(beat, sheets[beat])
        for event in (one for one in record.events if one.beat == beat):
            (first if beat < again else second).event(event)
        if beat >= again:
            second.frame(beat, data)
        if again <= beat < killed:  # the second part replaces this frame: its score is wrong
            frame = decode(data, Frame)
            seats = tuple(msgspec.structs.replace(seat, score=99) for seat in frame.seats)
            data = encode(msgspec.structs.replace(frame, seats=seats))
        if beat < killed:
            first.frame(beat, data)
    assert record.result is not None
    second.result(record.result)
    open_bytes = first.path.read_bytes()
    first.close()
    second.close()
    first.path.write_bytes(open_bytes + b"\x05\x40")  # it ends in the middle of a message
    return [first.path, second.path]


@pytest.mark.long
def test_the_parts_of_a_crashed_match_are_joined(
    library: Venue, record: Record, open_page: OpenPage, tmp_path: Path
) -> None:
    """Two parts of a match, dropped in any order, are joined as Python joins them."""
    first, second = write_segments(record, tmp_path)
    joined = Record.read([first, second])
    show = Player(open_page(viewport=LAPTOP), library, drawn=False)
    show.sees(".drop-here")
    show.drop(second, first)
    show.opened()
    assert show.page.evaluate("window.__replay.recording.record.notes") == []
    for beat in (640, 649, 650, 690, 700, 1500):
        show.seek(beat)
        show.has_scores(*(seat.score for seat in frame_at(joined, beat).seats))
    numbers = show.page.evaluate("window.__replay.recording.record.events.map((e) => e.number)")
    assert numbers == [event.number for event in joined.events]

    show.drop(first)
    show.sees(".notes", "stops at 0:13.9: it was never closed")
    show.opened()
    assert show.ends[1] == Record.read([first]).last_beat
    show.drop(second)
    show.sees(".notes", "Part 1 of this match is missing")
    assert show.ends[0] == 650
    show.page.get_by_role("button", name="Hide").click()
    show.misses(".notes")


@pytest.mark.long
def test_damage(
    library: Venue, record: Record, flags: Path, open_page: OpenPage, tmp_path: Path
) -> None:
    """The page plays the readable part of a damaged file, and says what is wrong."""
    whole = write_segments(record, tmp_path / "parts")[1]
    data = bytearray(whole.read_bytes())
    half = len(data) // 2
    data[half : half + 600] = b"\xff" * 600
    damaged = tmp_path / "damaged.mcap"
    damaged.write_bytes(data)
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(whole.read_bytes()[:half])
    show = Player(open_page(viewport=LAPTOP), library, drawn=False)
    show.sees(".drop-here")
    show.drop(damaged)
    show.sees(".notes", "damaged.mcap is damaged after 0:1")
    show.opened()
    last = show.ends[1]
    assert 700 < last < record.last_beat
    show.seek(last)
    show.has_scores(*(seat.score for seat in frame_at(record, last).seats))
    show.drop(cut)
    show.sees(".notes", "cut.mcap stops at 0:")

    text = tmp_path / "notes.mcap"
    text.write_text("no recording")
    show.drop(text)
    show.sees(".trouble", "notes.mcap is not a LACOC record")

    foreign = tmp_path / "foreign.mcap"
    writer = Writer(str(foreign))
    writer.start(profile="ros2")
    writer.finish()
    show.drop(foreign)
    show.sees(".trouble", "foreign.mcap is an MCAP file, but not a LACOC record")

    empty = tmp_path / "empty.mcap"
    writer = Writer(str(empty))
    writer.start(profile="lacoc")
    writer.finish()
    show.drop(empty)
    show.sees(".trouble", "empty.mcap contains no match")

    newer = RecordWriter(tmp_path / "newer", msgspec.structs.replace(record.header, format=2))
    newer.close()
    show.drop(newer.path)
    show.sees(".trouble", "has format 2, and this page reads format 1")

    bare = RecordWriter(tmp_path / "bare", record.header)
    bare.close()
    show.drop(bare.path)
    show.sees(".trouble", "has no picture of the match")

    show.drop(flags, flags.with_name("a-discs.mcap"))
    show.sees(".trouble", "belongs to match")
    show.drop(flags)
    show.opened()
    show.misses(".trouble")


def test_a_damaged_packed_file_says_so(
    library: Venue, flags: Path, open_page: OpenPage, tmp_path: Path
) -> None:
    """The page reports a changed byte in the compressed record of a finished match."""
    data = bytearray(flags.read_bytes())
    data[len(data) // 2] ^= 4
    path = tmp_path / "packed.mcap"
    path.write_bytes(data)
    show = Player(open_page(), library, drawn=False)
    show.sees(".drop-here")
    show.drop(path)
    show.sees(".trouble, .notes", "packed.mcap")


@pytest.mark.long
def test_without_the_servers_list(
    library: Venue, flags: Path, open_page: OpenPage, console: Any
) -> None:
    """If the server's list can't be loaded, the page still plays files of this machine."""
    console.expect("ERR_FAILED")
    page = open_page()
    page.route("**/recordings", lambda route: route.abort())
    show = Player(page, library, drawn=False)
    show.sees(".chooser", "The server's list can't be loaded")
    show.drop(flags)
    show.opened()


@pytest.mark.long
def test_a_phone(library: Venue, open_page: OpenPage) -> None:
    """On an upright phone everything fits the width, and buttons are large enough to touch."""
    page = open_page(viewport=PHONE, has_touch=True, is_mobile=True)
    show = Player(page, library, "?file=b-flags.mcap&t=20")
    show.sees(".board")
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["width"]
    tops = [
        show.find(selector).first.bounding_box()["y"]  # type: ignore[index]
        for selector in (".head", ".cameras", ".transport", ".board", ".replay-log")
    ]
    assert tops == sorted(tops)
    for button in show.find(".transport .button, .cameras .button").all():
        box = button.bounding_box()
        assert box is not None
        assert min(box["width"], box["height"]) >= 40
        assert 0 <= box["x"] <= PHONE["width"] - box["width"]


@pytest.mark.long
def test_accessible(library: Venue, open_page: OpenPage) -> None:
    """Axe-core finds no serious mistake in the list, the recording and the result."""
    pytest.importorskip("axe_core_python")
    show = Player(open_page(viewport=LAPTOP), library, drawn=False)
    show.sees(".recordings li")
    assert violations(show.page) == []
    show = Player(open_page(viewport=LAPTOP), library, "?file=b-flags.mcap&t=20")
    assert violations(show.page) == []
    show.press("End")
    show.sees(".result")
    assert violations(show.page) == []


@pytest.mark.long
def test_japanese(library: Venue, open_page: OpenPage) -> None:
    """In a Japanese browser the list, the log and the result are in Japanese."""
    show = Player(open_page(viewport=LAPTOP, locale="ja-JP"), library, drawn=False)
    show.sees("h1", "リプレイ")
    show.sees(".drop-here", "記録ファイルを開く")
    show = Player(open_page(viewport=LAPTOP, locale="ja-JP"), library, "?file=b-flags.mcap&t=20")
    show.sees(".replay-log", "プレー開始")
    show.press("End")
    show.sees(".result .kicker", "公式結果")
