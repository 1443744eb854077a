"""`lacoc film`: a film has every picture of its record, drawn by a real Chromium."""

import functools
import http.server
import shutil
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import av
import numpy as np
import pytest
from aside import aside
from chromium import FLAGS
from playwright.sync_api import sync_playwright
from waiting import until

from lacoc_client.film import camera_page, contest, film, plan
from lacoc_client.film.chromium import find
from lacoc_client.film.look import Look, Quality, View
from lacoc_client.film.site import served
from lacoc_server.simulate.forks.jobs import ForkJob, play_fork
from lacoc_shared.command import cli, installing
from lacoc_shared.mistakes import UserError
from lacoc_shared.seat import BEATS_PER_S

pytestmark = pytest.mark.slow

WIDTH, HEIGHT, FPS = 320, 180, 5
LOOK = Look(overlay=True, width=WIDTH, height=HEIGHT, quality=Quality.LOW)


def made(record: Path, out: Path, look: Look = LOOK, browsers: int = 1) -> list[np.ndarray]:
    """Make a film, and return its decoded pictures."""
    known: list[int] = []
    count = film.make(
        [film.part(record)], out, look, FPS, browsers, lambda _, all: known.append(all)
    )
    with av.open(str(out)) as opened:
        pictures = [frame.to_ndarray(format="rgb24") for frame in opened.decode(video=0)]
    assert len(pictures) == count == known[-1] == len(known)
    return pictures


@pytest.fixture(scope="module")
def alone(
    recorded: Path, with_browser: str, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Path, list[np.ndarray]]:
    """Give a film that one browser has drawn, and its pictures."""
    out = tmp_path_factory.mktemp("alone") / "a.mp4"
    return out, made(recorded, out)


@pytest.mark.long
def test_two_browsers_make_the_same_film(
    recorded: Path, alone: tuple[Path, list[np.ndarray]], tmp_path: Path
) -> None:
    """Two browsers draw as many pictures as one browser, and each is nearly the same."""
    _, pictures = alone
    again = made(recorded, tmp_path / "b.mp4", browsers=2)

    # Not bit for bit: a name above a robot can have other edges (docs/film.md).
    for one, other in zip(pictures, again, strict=True):
        assert np.abs(one.astype(int) - other.astype(int)).mean() < 0.5
    assert pictures[0].shape == (HEIGHT, WIDTH, 3)
    # The robots walk: pictures of play differ from each other.
    middle = pictures[len(pictures) // 3 : len(pictures) // 2]
    assert len({picture.tobytes() for picture in middle}) == len(middle)


@pytest.mark.long
def test_a_browser_that_makes_its_own_frames_draws_the_same(
    recorded: Path, with_browser: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A Chromium that can't be told when to make a frame draws the same pictures."""
    look = Look(width=WIDTH, height=HEIGHT, quality=Quality.LOW)
    part = film.part(recorded)
    way = plan.pictures([plan.Shot(100, 130)], FPS)

    def drawn() -> tuple[bool, list[bytes]]:
        with served(part.paths) as site:
            address = site.address(look)
            with camera_page.camera_page(address, look) as page:
                return page.shots.paced, [page.picture([step]) for step in way]

    told = aside(drawn)
    monkeypatch.setattr(camera_page, "PACED", ())
    monkeypatch.setattr(
        camera_page, "empty_page", lambda browser, context, look: (context.new_page(), False)
    )
    by_itself = aside(drawn)
    assert [told[0], by_itself[0]] == [True, False]
    assert told[1] == by_itself[1]
    assert len(set(told[1])) == len(way)


def test_a_film_is_as_long_as_the_replay(
    recorded: Path, alone: tuple[Path, list[np.ndarray]]
) -> None:
    """The film shows the replay at its speed; the result stays longer than in the record."""
    out, pictures = alone
    part = film.part(recorded)
    phases = {event.data.get("after"): event.beat for event in part.record.events}
    begin, last = phases["COUNTDOWN"], phases["OFFICIAL"] + 5 * BEATS_PER_S
    assert part.record.last_beat < last

    assert len(pictures) == len(plan.pictures(plan.whole(max(0, begin - 150), last), FPS))
    with av.open(str(out)) as opened:
        stream = opened.streams.video[0]
        assert stream.average_rate == FPS
        assert stream.duration is not None
        assert stream.duration * stream.time_base == pytest.approx(len(pictures) / FPS)


def test_its_sound_has_each_cue_at_its_picture(
    recorded: Path, alone: tuple[Path, list[np.ndarray]]
) -> None:
    """The start, all points and the end are heard within a picture of their events."""
    out, pictures = alone
    events = film.part(recorded).record.events
    begin = max(0, next(one.beat for one in events if one.data.get("after") == "COUNTDOWN") - 150)
    with av.open(str(out)) as opened:
        hz = opened.streams.audio[0].rate
        heard = np.concatenate([one.to_ndarray() for one in opened.decode(audio=0)], axis=1)
    assert heard.shape[1] / hz == pytest.approx(len(pictures) / FPS, abs=0.1)
    volume = np.abs(heard).max(axis=0)
    wanted = [
        (one.beat - begin) / BEATS_PER_S
        for one in events
        if one.data.get("after") in ("PLAYING", "FINISHED") or one.data.get("points")
    ]
    assert len(wanted) >= 3
    for at_s in wanted:
        near = volume[int((at_s - 0.02) * hz) : int((at_s + 1 / FPS + 0.05) * hz)]
        assert near.max() > 0.05, at_s
    assert volume[: int(0.9 * hz)].max() < 0.01  # nobody counts yet


@pytest.mark.long
def test_views_differ_and_a_still_is_a_picture(
    recorded: Path, with_browser: str, tmp_path: Path
) -> None:
    """Each view gives a picture of its own, of the size that was asked for."""
    seen = set()
    for view, overlay in ((View.ARENA, True), (View.SPLIT, False)):
        look = Look(view, overlay, "en", WIDTH, HEIGHT, Quality.LOW)
        out = tmp_path / f"{view}{overlay}.png"
        film.still(film.part(recorded), out, look)
        with av.open(str(out)) as opened:
            (picture,) = [frame.to_ndarray(format="rgb24") for frame in opened.decode(video=0)]
        assert picture.shape == (HEIGHT, WIDTH, 3)
        assert picture.std() > 10  # not one colour
        seen.add(picture.tobytes())
    assert len(seen) == 2


@pytest.fixture
def web_server(alone: tuple[Path, list[np.ndarray]]) -> Iterator[str]:
    """Give the address of the film on a web server."""
    out, _ = alone

    class Handler(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_: object) -> None:
            pass

    handler = functools.partial(Handler, directory=str(out.parent))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}/{out.name}"
        server.shutdown()


PLAYED = """() => new Promise((resolve) => {
  const film = document.querySelector("video");
  film.muted = true;
  const told = (ok) => resolve([ok, film.error?.message ?? "", film.duration, film.videoWidth]);
  film.onended = () => told(true);
  film.onerror = () => told(false);
  film.currentTime = Math.max(0, film.duration - 1);
  film.play().catch(() => told(false));
})"""


@pytest.mark.long
def test_a_browser_plays_it(
    alone: tuple[Path, list[np.ndarray]], web_server: str, with_browser: str
) -> None:
    """Chromium plays the film to its end."""
    _, pictures = alone

    def play() -> list[Any] | None:
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=with_browser, args=list(FLAGS))
            page = browser.new_page()
            page.goto(web_server)
            if not page.evaluate("document.createElement('video').canPlayType('video/mp4')"):
                return None
            return page.evaluate(PLAYED)

    played = aside(play)
    if played is None:
        pytest.skip("this Chromium has no H.264")
    ended, error, duration_s, width = played
    assert ended, error
    assert duration_s == pytest.approx(len(pictures) / FPS, abs=0.02)
    assert width == WIDTH


@pytest.mark.long
def test_ffprobe_reads_it(alone: tuple[Path, list[np.ndarray]]) -> None:
    """FFprobe, where it is installed, counts as many pictures as were decoded."""
    program = shutil.which("ffprobe")
    if program is None:
        pytest.skip("there is no ffprobe")
    out, pictures = alone
    words = ["-v", "error", "-select_streams", "v", "-count_frames"]
    words += ["-show_entries", "stream=nb_read_frames"]
    told = subprocess.check_output([program, *words, "-of", "csv=p=0", str(out)], text=True)
    assert int(told) == len(pictures)


@pytest.mark.long
def test_a_kill_leaves_no_half_film(recorded: Path, with_browser: str, tmp_path: Path) -> None:
    """A program that is killed while it draws leaves nothing under the film's name."""
    out = tmp_path / "killed.mp4"
    words = [sys.executable, "-m", "lacoc_shared", "film", str(recorded), str(out), "--jobs", "1"]
    process = subprocess.Popen(words, stderr=subprocess.DEVNULL)
    try:
        until(lambda: any(part.stat().st_size > 40 for part in tmp_path.glob(".killed.mp4.*")), 120)
        assert process.poll() is None, "it ended before it was killed"
    finally:
        process.kill()
        process.wait()
    assert not out.exists()


@pytest.mark.long
def test_a_request_to_end_leaves_nothing(
    recorded: Path, with_browser: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """SIGTERM leaves no part of a film, and no copy of the record."""
    films, temporary = tmp_path / "films", tmp_path / "temporary"
    films.mkdir()
    temporary.mkdir()
    monkeypatch.setenv("TMPDIR", str(temporary))
    words = [sys.executable, "-m", "lacoc_shared", "film", str(recorded), str(films / "a.mp4")]
    process = subprocess.Popen(words, stderr=subprocess.DEVNULL)
    try:
        until(lambda: any(part.stat().st_size > 40 for part in films.glob(".a.mp4.*")), 120)
        process.terminate()
        assert process.wait(60) != 0
    finally:
        process.kill()
    assert not list(films.iterdir())
    assert not list(temporary.glob("lacoc-film-*"))


@pytest.mark.long
def test_a_film_of_a_fork_is_marked(recorded: Path, with_browser: str, tmp_path: Path) -> None:
    """A film of a fork says on each picture that it is one, also without the overlay."""
    job = ForkJob(file=str(recorded), beat=200, bots=("straight", "-"), folder=str(tmp_path))
    play_fork(job)
    look = Look(width=WIDTH, height=HEIGHT, quality=Quality.LOW)
    yellow = []
    for record in (recorded, tmp_path / "fork.mcap"):
        film.still(film.part(record), out := tmp_path / f"{record.stem}.png", look)
        with av.open(str(out)) as opened:
            (picture,) = [frame.to_ndarray(format="rgb24") for frame in opened.decode(video=0)]
        corner = picture[HEIGHT * 3 // 4 :, WIDTH * 3 // 4 :].astype(int)
        yellow.append(int((np.abs(corner - (0xF2, 0xC9, 0x4C)).max(axis=2) < 8).sum()))
    assert yellow[0] == 0
    assert yellow[1] > 50


def test_a_missing_extra_is_told(tmp_path: Path) -> None:
    """Without PyAV or Playwright the command says how to install them; its help still works."""
    for missing in ("av", "playwright"):
        without = (
            f"import sys; sys.modules[{missing!r}] = None; "
            "from lacoc_shared.command import cli; sys.exit(cli.main(sys.argv[1:]))"
        )

        def lacoc(*words: str, without: str = without) -> subprocess.CompletedProcess[str]:
            command = [sys.executable, "-c", without, "film", *words]
            return subprocess.run(command, capture_output=True, text=True, check=False)

        told = lacoc("any.mcap", str(tmp_path / "a.mp4"))
        assert told.returncode == cli.WRONG_USE
        assert installing.command("film") in told.stderr
        assert lacoc("--help").returncode == 0
    assert list(tmp_path.iterdir()) == []


def test_a_missing_browser_is_told(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, recorded: Path
) -> None:
    """Without a browser the error says how to get one; a wrong CHROMIUM is named."""
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CHROMIUM", raising=False)
    with pytest.raises(UserError, match="playwright install chromium"):
        find(str(tmp_path / "none"))
    own = tmp_path / "chrome"
    own.touch()
    assert find(str(own)) == str(own)
    monkeypatch.setenv("CHROMIUM", "nowhere")
    with pytest.raises(UserError, match="CHROMIUM"):
        film.make([film.part(recorded)], tmp_path / "a.mp4", LOOK, FPS, 1, lambda *_: None)
    assert not (tmp_path / "a.mp4").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("x.mcap", "a.mp4"), "x.mcap"),
        (("{record}", "a.avi"), "must end with .mp4"),
        (("{record}", "none/a.mp4"), "There is no folder"),
        (("{record}", "a.mp4", "--size", "99x17"), "two even numbers"),
        (("{record}", "a.mp4", "--moments", "m.json"), "--highlights"),
        ((".", "a.mp4"), "contest.json"),
        ((".", "a.mp4", "--highlights"), "A film of a contest"),
        (("bad.mcap", "a.mp4"), "bad.mcap"),
    ],
)
def test_a_wrong_use_is_told(
    words: tuple[str, ...],
    said: str,
    recorded: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Each mistake is told in a sentence before anything is drawn, and nothing is written."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "300")
    Path("bad.mcap").write_bytes(b"no record")
    before = sorted(tmp_path.iterdir())
    code = cli.main(["film", *(word.format(record=recorded) for word in words)])

    assert code == cli.WRONG_USE
    assert said in capsys.readouterr().err
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{", "Publish the contest again"),
        ('{"stages": []}', "no game"),
        ('{"stages": [{"matches": [{"games": [{"record": "../x.mcap"}]}]}]}', "x.mcap"),
    ],
)
def test_a_bad_contest_is_told(text: str, said: str, tmp_path: Path) -> None:
    """A file that is no sheet, and a sheet without a game or with a missing record, are refused."""
    folder = tmp_path / "contest"
    folder.mkdir()
    (tmp_path / "x.mcap").touch()  # a name of the sheet leads to no other folder
    (folder / "contest.json").write_text(text)
    with pytest.raises(UserError, match=said):
        contest.games(folder)
