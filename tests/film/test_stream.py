"""Tests of `lacoc stream`: its pace, its sound, and what a video server gets of a real match."""

import os
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, suppress
from fractions import Fraction
from http.server import BaseHTTPRequestHandler, HTTPServer
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import av
import numpy as np
import pytest
from every_third import every_third
from hypothesis import given
from hypothesis import strategies as st
from lacoc_process import Lacoc, environment
from page_client import PageClient
from playwright.sync_api import Error
from ports import free_port
from show import decide, playing
from venue import Venue
from waiting import LIMIT_S, until

from lacoc_client.commands.film import look_of
from lacoc_client.film import camera_page
from lacoc_client.film.live import sender, sending, stream
from lacoc_client.film.live.mixer import Mixer
from lacoc_client.film.live.pace import PicturePace
from lacoc_client.film.live.segments import SegmentWatch
from lacoc_client.film.live.sender import LivePicture, Sender
from lacoc_client.film.live.sending import SOUND_HZ, NotSent, Part, SendingProcess
from lacoc_client.film.live.target import Target, target
from lacoc_client.film.live.waiting import PageWaiting
from lacoc_client.film.live.watchdog import watched
from lacoc_client.film.look import Quality, View
from lacoc_client.play.stopping import unreached
from lacoc_shared.mistakes import UserError
from lacoc_shared.seat import BEATS_PER_S
from lacoc_shared.words import Phrase, render

SIZE, FPS = (320, 180), 10
SCORE = np.s_[0:24, 110:145]
"""Where the left score stands in a picture of this size."""


@given(st.integers(1, 60), st.lists(st.floats(0, 2), max_size=50))
def test_a_pace_never_falls_behind(fps: int, busy_s: list[float]) -> None:
    """Each picture is the one that is due; what was left out is counted."""
    began_s = 1_700_000_000.0
    pace, now_s, numbers = PicturePace(fps, began_s), began_s, []
    for one_s in busy_s:
        now_s += pace.wait_s(now_s)
        numbers.append(number := pace.take(now_s))
        assert abs(pace.time_s(number) - now_s) < 1 / fps + 1e-5
        now_s += one_s
    assert numbers == sorted({*numbers})
    assert pace.taken == len(numbers)
    assert pace.left_out == (numbers[-1] + 1 - len(numbers) if numbers else 0)


@given(
    st.lists(st.tuples(st.integers(0, 400), st.integers(1, 50)), max_size=20), st.integers(1, 99)
)
def test_a_mixer_adds_sounds_at_their_time(sounds: list[tuple[int, int]], step: int) -> None:
    """All sounds that are known in time are in the track, where they begin."""
    mixer, whole = Mixer(500), np.zeros((500, 2), int)
    for at, length in sounds:
        sound = np.full((length, 2), (7, -9), "<i2")
        mixer.add(at, sound.tobytes())
        whole[at : at + length] += sound
    taken = b"".join(mixer.take(until) for until in [*range(step, 500, step), 500])
    assert np.array_equal(np.frombuffer(taken, "<i2").reshape(-1, 2), whole)


@pytest.mark.parametrize("at", [0, 13, 10**12, -(10**12)])
def test_a_sound_at_a_wrong_time_is_heard_at_once(at: int) -> None:
    """A sound whose time was taken already, or is far away, begins with the next sample.

    Such a time comes from a clock that was set: the memory for all samples until then is never
    taken.
    """
    mixer = Mixer(10)
    assert mixer.take(2) == bytes(8)
    mixer.add(at, np.array([[5, 6]], "<i2").tobytes())
    assert np.frombuffer(mixer.take(4), "<i2").tolist() == [5, 6, 0, 0]


def test_where_a_stream_can_go(tmp_path: Path) -> None:
    """Servers, folders and files are told apart."""
    assert target("rtmp://a.example/live/key").form == "flv"
    assert target(f"{tmp_path}").address == f"{tmp_path}/index.m3u8"
    assert target(f"{tmp_path}/hls").address == f"{tmp_path}/hls/index.m3u8"
    (tmp_path / "a.mkv").write_bytes(b"of yesterday")
    assert target(f"{tmp_path}/a.mkv").form == "matroska"
    assert (tmp_path / "a.1.mkv").read_bytes() == b"of yesterday"
    for wrong in (
        "http://a.example",
        f"{tmp_path}/a.avi",
        f"{tmp_path}/none/a.mkv",
        f"{tmp_path}/a.example/live",
    ):
        with pytest.raises(UserError):
            target(wrong)


@pytest.mark.parametrize(
    "rest",
    ["live/KEY", "live/KEY/", "?streamid=KEY", "live?name=KEY#KEY", "KEY", "live/a@KEY", ""],
)
def test_the_key_of_a_stream_is_not_shown(rest: str) -> None:
    """Neither by an address that is right nor by the error about one that is not."""
    assert target(f"rtmp://user:KEY@a.example:1935/{rest}").shown == "rtmp://a.example:1935/..."
    assert target(f"srt://a.example{rest and '?' + rest}").shown == "srt://a.example/..."
    with pytest.raises(UserError) as mistake:
        target(f"rtmpx://a.example/{rest}")
    assert "rtmpx://a.example/..." in str(mistake.value)
    assert "KEY" not in str(mistake.value)


@pytest.fixture(scope="module")
def picture() -> bytes:
    """Give a picture as the browser takes it."""
    encoder = av.CodecContext.create("mjpeg", "w")
    (encoder.width, encoder.height), encoder.pix_fmt = SIZE, "yuvj420p"
    encoder.time_base = Fraction(1, FPS)
    packets = [*encoder.encode(av.VideoFrame(*SIZE, "yuvj420p")), *encoder.encode(None)]
    return bytes(packets[0])


class Streamer:
    """Gives a sender pictures with their sounds, as the browser's page does."""

    def __init__(self, where: Target, picture: bytes) -> None:
        self.told: list[str] = []
        self.count = 0
        self._picture = picture
        self.sender = Sender(where, SIZE, FPS, lambda phrase: self.told.append(phrase.code))

    def until(self, true: Callable[[], object]) -> None:
        """Give pictures until a condition is true."""

        def give() -> bool:
            self.sender.hear(self.count / FPS, bytes(4 * SOUND_HZ // FPS))
            self.sender.show(LivePicture(self.count, self._picture))
            self.count += 1
            return bool(true())

        until(give)


def test_what_a_server_does_is_told_once(picture: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    """A server that refuses is told once, its return when it takes the stream, and a new loss."""
    tries = []

    class Counted(SendingProcess):
        def send(self, part: Part) -> NotSent | None:
            if refused := super().send(part):
                tries.append(refused)
            return refused

    monkeypatch.setattr(sender, "SendingProcess", Counted)
    monkeypatch.setattr(sender, "_AGAIN_S", 0.01)
    monkeypatch.setattr(sender, "_SURE_S", 0.2)
    with socket.socket() as server:
        server.bind(("127.0.0.1", 0))
        streamer = Streamer(target(f"tcp://127.0.0.1:{server.getsockname()[1]}"), picture)
        streamer.until(lambda: len(tries) > 3)
        assert streamer.told == ["stream.away"]
        server.listen()
        streamer.until(lambda: len(streamer.told) > 1)
        assert streamer.told[1:] == ["stream.back"]
        server.accept()[0].close()
        streamer.until(lambda: len(streamer.told) > 2)
        assert streamer.told[2] == "stream.away"
        streamer.sender.end()


def test_a_server_that_refuses_the_key_is_not_back_each_time(
    picture: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It takes the first pictures, then ends the connection, each time: that is told once."""
    monkeypatch.setattr(sender, "_AGAIN_S", 0.01)
    ended = []

    def refuse(server: socket.socket) -> None:
        with suppress(OSError):
            while True:
                connection = server.accept()[0]
                connection.recv(1)
                connection.close()
                ended.append(True)

    with socket.create_server(("127.0.0.1", 0)) as server:
        threading.Thread(target=refuse, args=(server,), daemon=True).start()
        streamer = Streamer(target(f"tcp://127.0.0.1:{server.getsockname()[1]}"), picture)
        streamer.until(lambda: len(ended) > 3)
        assert streamer.told == ["stream.refused"]
        streamer.sender.end()


def test_the_sounds_of_pictures_that_are_left_out_go_too(
    picture: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While the server is away, no sound is kept that nobody will hear."""
    taken = []

    class Watched(Mixer):
        def take(self, until: int) -> bytes:
            taken.append(until)
            return super().take(until)

    monkeypatch.setattr(sender, "Mixer", Watched)
    monkeypatch.setattr(sender, "_AGAIN_S", 2 * LIMIT_S)
    with socket.socket() as server:
        server.bind(("127.0.0.1", 0))
        streamer = Streamer(target(f"tcp://127.0.0.1:{server.getsockname()[1]}"), picture)
        streamer.until(lambda: streamer.told)
        away = streamer.count
        streamer.until(lambda: taken[-1] > away * SOUND_HZ // FPS)
        streamer.sender.end()


def test_an_address_that_no_server_can_have_is_away(picture: bytes) -> None:
    """An error of FFmpeg that is no error of the system is told too."""
    streamer = Streamer(target("tcp://no-port"), picture)
    streamer.until(lambda: streamer.told)
    assert streamer.told == ["stream.away"]
    streamer.sender.end()


def test_a_protocol_that_ffmpeg_lacks_ends_the_stream(picture: bytes) -> None:
    """No server can come back by it."""
    streamer = Streamer(Target("lacoc://127.0.0.1/key", "mpegts", is_remote=True), picture)
    streamer.until(lambda: streamer.sender.failed)
    assert streamer.sender.failed == "Protocol not found"
    assert streamer.told == []
    streamer.sender.end()


@pytest.mark.parametrize("protocol", every_third(["rtmp", "tcp"]))
def test_a_server_that_takes_nothing_is_away(
    picture: bytes, monkeypatch: pytest.MonkeyPatch, protocol: str
) -> None:
    """A server that accepts and then says nothing, or reads nothing, stops no other thread."""
    monkeypatch.setattr(sending, "_SILENT_S", 1.0)
    monkeypatch.setattr(sender, "_SURE_S", 0.5)
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
        address = f"{protocol}://127.0.0.1:{server.getsockname()[1]}/live/key"
        streamer = Streamer(target(address), picture)
        streamer.until(lambda: streamer.told)
        assert streamer.told == ["stream.away"]
        streamer.sender.end()


def test_a_folder_is_continued(picture: bytes, tmp_path: Path) -> None:
    """A stream that is started again uses no name of a segment that players know."""
    names: list[set[str]] = []
    for _ in range(2):
        streamer = Streamer(target(f"{tmp_path}"), picture)
        sent = streamer.sender
        streamer.until(lambda sent=sent: sent.sent >= 3 * FPS)  # type: ignore[misc]
        streamer.sender.end()
        names.append({one.name for one in tmp_path.glob("*.ts")})
    listed = (tmp_path / "index.m3u8").read_text()
    assert names[0] < names[1]
    assert all(name in listed for name in names[1])


def test_a_segment_that_is_not_on_the_disk_is_found(tmp_path: Path) -> None:
    """It is empty, cut, or missing; or the list stays as it is, though pictures go on."""
    path = tmp_path / "index.m3u8"
    watch = SegmentWatch(path, 3)
    assert watch.is_whole()
    for number, (size, is_whole) in enumerate(
        [(376, True), (0, False), (4096, False), (188, True)]
    ):
        (tmp_path / f"index{number}.ts").write_bytes(bytes(size))
        path.unlink(missing_ok=True)
        path.write_text(f"#EXTM3U\n#EXTINF:2,\nindex{number}.ts\n")
        assert watch.is_whole() is is_whole, size
    assert [watch.is_whole() for _ in range(4)] == [True, True, False, False]
    path.write_text("gone\n")
    assert not watch.is_whole()
    path.unlink()
    assert not watch.is_whole()
    path.write_text("")
    assert not watch.is_whole()


def test_a_folder_whose_segments_are_not_written_ends_the_stream(
    picture: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """FFmpeg itself says nothing of it; the operator is told."""
    monkeypatch.setattr(sending, "_SPAWN", get_context("fork"))
    monkeypatch.setattr(SegmentWatch, "is_whole", lambda _: False)
    streamer = Streamer(target(f"{tmp_path}"), picture)
    streamer.until(lambda: streamer.sender.failed)
    assert isinstance(streamer.sender.failed, Phrase)
    assert streamer.sender.failed.code == "stream.no-segment"
    streamer.sender.end()


def test_each_reason_for_a_page_without_a_match_is_told_once() -> None:
    """It is told when it has stood for some seconds, whatever seconds it counts; and its end."""
    waiting = PageWaiting()
    looks = [
        *("Connecting", "", "in 20 s", "in 19 s", "in 18 s", "in 17 s", "in 16 s", "no court"),
        *("no court", "", "no court", "no court", "no court", "no court", "", "", "", "", ""),
    ]
    told = [waiting.see(text, float(now_s)) for now_s, text in enumerate(looks)]
    found = {at: render(one) for at, one in enumerate(told) if one is not None}
    assert list(found) == [5, 13, 17], found
    assert "in 17 s" in found[5]
    assert "no court" in found[13]


def test_a_sending_process_that_cannot_start_is_tried_again(
    picture: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No free process at one moment does not end a stream to a server."""
    start, failed = SendingProcess._start, []

    def first_fails(process: SendingProcess) -> Any:
        if not failed:
            failed.append(True)
            raise BlockingIOError(11, "Resource temporarily unavailable")
        return start(process)

    monkeypatch.setattr(SendingProcess, "_start", first_fails)
    monkeypatch.setattr(sender, "_AGAIN_S", 0.01)
    monkeypatch.setattr(sender, "_SURE_S", 0.2)
    with socket.create_server(("127.0.0.1", 0)) as server:
        streamer = Streamer(target(f"tcp://127.0.0.1:{server.getsockname()[1]}"), picture)
        streamer.until(lambda: len(streamer.told) > 1)
        assert streamer.told == ["stream.away", "stream.back"]
        streamer.sender.end()


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_a_bug_in_the_sender_ends_the_stream(
    picture: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A stream does not go on without pictures: it has failed, and says why."""

    def broken(process: SendingProcess, part: Part) -> None:
        raise RuntimeError("a bug")

    monkeypatch.setattr(SendingProcess, "send", broken)
    streamer = Streamer(target("tcp://127.0.0.1:1"), picture)
    streamer.until(lambda: streamer.sender.failed)
    assert streamer.sender.failed == "RuntimeError: a bug"
    streamer.sender.end()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows blocks no signal")
def test_ctrl_c_does_not_reach_a_process_that_is_still_starting() -> None:
    """Ctrl-C in a terminal reaches all processes: the stream itself must end the others."""
    with unreached():
        child = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    child.send_signal(signal.SIGINT)
    child.communicate(b"\n")
    assert child.returncode == 0
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, ())


def test_a_sending_process_that_is_killed_is_started_again(picture: bytes, tmp_path: Path) -> None:
    """What it wrote before stays; the next part begins a new stream."""
    process = SendingProcess(target(f"{tmp_path}/out.mkv"), SIZE, FPS)
    part = Part(0, picture, bytes(4 * SOUND_HZ // FPS))
    assert process.send(part) is None
    assert process._running is not None
    process._running[0].kill()
    refused = process.send(part)
    assert refused is not None
    assert isinstance(refused.why, Phrase)
    assert process.send(part) is None
    process.end()
    with av.open(f"{tmp_path}/out.mkv") as container:
        assert len([*container.decode(video=0)]) == 1


@pytest.fixture
def venue(tmp_path: Path, with_browser: str) -> Iterator[Venue]:
    """Give a court and its gateway."""
    with ExitStack() as stack:
        yield Venue(tmp_path, stack)


@pytest.mark.long
@pytest.mark.usefixtures("with_browser")
def test_the_page_of_an_error_is_not_streamed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A proxy whose gateway is gone answers with an error: the stream waits for the real page."""
    answers = iter([502, 503])

    class Proxy(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(next(answers, 200))
            self.end_headers()
            self.wfile.write(b"<!doctype html><title>page</title>")

        def log_message(self, *_: object) -> None:
            pass

    monkeypatch.setattr(stream, "_AGAIN_S", 0.05)
    told: list[Phrase] = []
    with HTTPServer(("127.0.0.1", 0), Proxy) as proxy:
        threading.Thread(target=proxy.serve_forever, daemon=True).start()
        source = stream.Streamed(f"http://127.0.0.1:{proxy.server_port}")
        look = look_of("320x180", View.AUTO, Quality.LOW, True, None)
        running = stream._Streaming(source, target(f"{tmp_path}/a.mkv"), look, FPS, told.append)

        def opened() -> str:
            with camera_page.window(look) as (page, _):
                assert page.context.browser is not None
                with watched(page.context.browser, lambda: False, LIMIT_S) as dog:
                    running._open(page, lambda: False, dog)
                    return page.title()

        with ThreadPoolExecutor(1) as aside:  # this thread may have a browser of other tests
            assert aside.submit(opened).result() == "page"
        running.sender.end()
        proxy.shutdown()
    assert [one.code for one in told] == ["stream.no-page", "stream.page-back"]
    assert "HTTP 502" in render(told[0])


@pytest.mark.long
@pytest.mark.usefixtures("with_browser")
@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="no signal here makes a process hang")
def test_a_browser_that_hangs_is_ended() -> None:
    """Whoever waits for it gets an error, as if it had crashed, and no process is left."""
    look = look_of("320x180", View.AUTO, Quality.LOW, True, None)

    def hangs() -> Phrase | None:
        with camera_page.window(look) as (page, _):
            assert page.context.browser is not None
            tools = page.context.browser.new_browser_cdp_session()
            found = tools.send("SystemInfo.getProcessInfo")["processInfo"]
            renderers = [one["id"] for one in found if one["type"] == "renderer"]
            with watched(page.context.browser, lambda: False, 1.0) as dog:
                for renderer in renderers:
                    os.kill(renderer, signal.SIGSTOP)
                with pytest.raises(Error):
                    page.evaluate("document.title")
            return dog.why

    with ThreadPoolExecutor(1) as aside:  # this thread may have a browser of other tests
        why = aside.submit(hangs).result()
    assert why is not None
    assert why.code == "stream.browser-hangs"


def streaming(venue: Venue, where: str, stack: ExitStack) -> Lacoc:
    """Start a stream of the court."""
    words = ("--pages", venue.url, "--court", "main", "--size", "320x180", "--fps", "10")
    log = stack.enter_context((venue.folder / "stream.log").open("ab"))
    process = Lacoc("stream", where, *words, stderr=log, env=environment(LACOC_LANGUAGE="en"))
    stack.callback(process.kill)
    return process


def pictures(container: Any) -> Iterator[tuple[float, np.ndarray]]:
    """Give time [s] and pixels of each picture."""
    for frame in container.decode(video=0):
        yield float(frame.time), frame.to_ndarray(format="rgb24")


def play_on(referee: PageClient, seconds: float) -> None:
    """Wait until the match has gone on for some time, so that a stream has pictures of it."""
    assert referee.frame is not None
    end = referee.frame.beat + round(seconds * BEATS_PER_S)
    referee.wait(lambda: referee.frame is not None and referee.frame.beat > end)


@pytest.mark.long(minutes=1)
@pytest.mark.slow
def test_a_match_is_streamed_into_a_file(venue: Venue, tmp_path: Path) -> None:
    """The file has the match as it goes on: pictures at their times, its sounds, the score."""
    venue.court()
    venue.web()
    with ExitStack() as stack:
        out = tmp_path / "out.mkv"
        running = streaming(venue, str(out), stack)
        until(lambda: out.exists() and out.stat().st_size > 10_000, 3 * LIMIT_S)
        referee = playing(venue)
        play_on(referee, 1)
        decide(referee, "for the test", type="adjust", seat="left", points=70)
        play_on(referee, 3)
        running.send_signal(signal.SIGINT)
        assert running.wait(LIMIT_S) == 0
    with av.open(str(out)) as container:
        shown = [*pictures(container)]
    times = [at_s for at_s, _ in shown]
    assert times == sorted({*times})
    assert {one.shape for _, one in shown} == {(SIZE[1], SIZE[0], 3)}
    scores = [one[SCORE].astype(int) for _, one in shown]
    assert np.abs(scores[-1] - scores[len(scores) // 4]).mean() > 1
    with av.open(str(out)) as container:
        sound = np.concatenate([one.to_ndarray() for one in container.decode(audio=0)], axis=1)
    assert np.abs(sound).max() > 0.1, "the count-down is heard"
    assert sound.shape[1] / 48_000 == pytest.approx(times[-1] - times[0], abs=0.5)


class VideoServer:
    """Takes a stream by RTMP, as a video platform does, until it is closed."""

    def __init__(self, port: int) -> None:
        self.address = f"rtmp://127.0.0.1:{port}/live/key"
        self.count = 0
        self.sounds = 0
        self._closing = False
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        listening = av.open(self.address, "r", format="flv", options={"listen": "1"})
        with suppress(OSError), listening as container:  # a stream that ends is no error here
            for packet in container.demux():
                self.count += packet.stream.type == "video"
                self.sounds += packet.stream.type == "audio"
                if self._closing:
                    return

    def close(self) -> None:
        """End the connection."""
        self._closing = True
        self._thread.join(LIMIT_S)
        assert not self._thread.is_alive(), "no packet came, and the connection did not end"


@pytest.mark.long
@pytest.mark.slow
def test_a_stream_survives_what_dies(venue: Venue) -> None:
    """Court, gateway and video server are killed in turn; pictures and sound go on each time."""
    court, web = venue.court(), venue.web()
    server = VideoServer(port := free_port())

    def goes_on() -> None:
        """Wait until pictures and sound come again."""
        count, sounds = server.count, server.sounds
        until(lambda: server.count > count + 20 and server.sounds > sounds + 20)

    with ExitStack() as stack:
        running = streaming(venue, server.address, stack)
        goes_on()
        court.kill()
        goes_on()
        venue.court()
        web.kill()
        goes_on()
        venue.web()
        goes_on()
        server.close()
        until(lambda: "can't be reached" in (venue.folder / "stream.log").read_text())
        server = VideoServer(port)
        goes_on()
        running.send_signal(signal.SIGINT)
        assert running.wait(LIMIT_S) == 0
    log = (venue.folder / "stream.log").read_text()
    assert "again" in log
    assert "live/key" not in log
