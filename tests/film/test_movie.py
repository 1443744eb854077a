"""A film is whole or not there, and has the pictures that were put in."""

import resource
import signal
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest

from lacoc_client.film.movie import movie
from lacoc_shared.mistakes import UserError

WIDTH, HEIGHT = 64, 48


def png(shade: int) -> bytes:
    """Return a picture whose left half has one shade of red, and whose right half is green."""
    pixels = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
    pixels[:, : WIDTH // 2, 0] = shade
    pixels[:, WIDTH // 2 :, 1] = 120
    frame = av.VideoFrame.from_ndarray(pixels, format="rgb24")
    frame.pts = 0
    codec = av.CodecContext.create("png", "w")
    codec.width, codec.height, codec.pix_fmt = WIDTH, HEIGHT, "rgb24"
    codec.time_base = Fraction(1, 30)
    return b"".join(bytes(packet) for packet in [*codec.encode(frame), *codec.encode(None)])


def decoded(path: Path) -> list[np.ndarray]:
    """Return the pictures of a film as arrays (height, width, 3)."""
    with av.open(str(path)) as film:
        return [
            frame.reformat(format="rgb24", src_colorspace="ITU709").to_ndarray()
            for frame in film.decode(video=0)
        ]


def test_pictures_come_out_as_they_went_in(tmp_path: Path) -> None:
    """Each picture is there once, in order, with its own colours."""
    shades = [10, 200, 60, 120, 250, 0, 90]
    with movie(tmp_path / "a.mp4", WIDTH, HEIGHT, 30) as film:
        for shade in shades:
            film.add(png(shade))
    pictures = decoded(tmp_path / "a.mp4")

    assert len(pictures) == film.count == len(shades)
    for shade, picture in zip(shades, pictures, strict=True):
        left, right = picture[:, :24].reshape(-1, 3), picture[:, 40:].reshape(-1, 3)
        assert left.mean(axis=0) == pytest.approx([shade, 0, 0], abs=9)
        assert right.mean(axis=0) == pytest.approx([0, 120, 0], abs=9)
    assert [path.name for path in tmp_path.iterdir()] == ["a.mp4"]


def test_a_sound_is_heard_with_its_picture(tmp_path: Path) -> None:
    """A tone of some pictures is heard within one picture of them; the rest is silent."""
    fps, rate_hz, count = 25, 24_000, 100
    time_s = np.arange(rate_hz // 5) / rate_hz
    tone = (20_000 * np.sin(2 * np.pi * 880 * time_s)).astype("<i2")
    samples = np.zeros((rate_hz * count // fps, 2), "<i2")
    begins = (20, 75)
    for begin in begins:
        at = begin * rate_hz // fps
        samples[at : at + len(tone), 0] = tone
    with movie(tmp_path / "a.mp4", WIDTH, HEIGHT, fps, rate_hz) as film:
        film.hear(samples.tobytes())
        for _ in range(count):
            film.add(png(50))
    with av.open(str(tmp_path / "a.mp4")) as found:
        frames = list(found.decode(audio=0))
        hz = found.streams.audio[0].rate
    heard = np.concatenate([frame.to_ndarray() for frame in frames], axis=1)
    loud = np.abs(heard[0]) > 0.1
    found_at = np.flatnonzero(loud & ~np.roll(loud, hz // 100)) / hz
    for begin in begins:
        assert min(abs(found_at - begin / fps)) < 1 / fps
    assert not loud[: int(0.7 * hz)].any()
    assert np.abs(heard[1]).max() < 0.01
    assert heard.shape[1] / hz == pytest.approx(count / fps, abs=0.1)


def test_most_pictures_are_no_key_pictures(tmp_path: Path) -> None:
    """Every two seconds a film has one key picture, which can be decoded without any other."""
    with movie(tmp_path / "a.mp4", WIDTH, HEIGHT, 10) as film:
        for _ in range(50):
            film.add(png(100))
    with av.open(str(tmp_path / "a.mp4")) as found:
        keys = [packet.is_keyframe for packet in found.demux(video=0) if packet.size]
    assert [index for index, key in enumerate(keys) if key] == [0, 20, 40]


def test_an_older_film_is_kept(tmp_path: Path) -> None:
    """An older film of this name is renamed with a number, but only when the new film is whole."""
    out = tmp_path / "a.mp4"
    out.write_bytes(b"older")
    with movie(out, WIDTH, HEIGHT, 30) as film:
        film.add(png(1))
        assert out.read_bytes() == b"older"
    assert (tmp_path / "a.1.mp4").read_bytes() == b"older"
    assert len(decoded(out)) == 1


def test_a_failure_leaves_nothing(tmp_path: Path) -> None:
    """A film that fails in the middle leaves no file, and an older film stays."""
    out = tmp_path / "a.mp4"
    out.write_bytes(b"older")

    def fail() -> None:
        with movie(out, WIDTH, HEIGHT, 30) as film:
            film.add(png(1))
            raise RuntimeError("stop")

    with pytest.raises(RuntimeError, match="stop"):
        fail()
    assert [path.name for path in tmp_path.iterdir()] == ["a.mp4"]
    assert out.read_bytes() == b"older"


def test_a_folder_that_can_not_be_written_to_is_told(tmp_path: Path) -> None:
    """The error about a folder that is not there names the film."""
    with (
        pytest.raises(UserError, match=r"a\.mp4"),
        movie(tmp_path / "none" / "a.mp4", WIDTH, HEIGHT, 30),
    ):
        pass


FULL = """
import sys
from pathlib import Path
from lacoc_client.film.movie import movie
from lacoc_shared.mistakes import UserError
import numpy as np, os
sys.path.insert(0, sys.argv[2])
from test_movie import png
try:
    with movie(Path(sys.argv[1]), 64, 48, 30) as film:
        for index in range(3000):
            film.add(png(index % 256))
except UserError as error:
    sys.exit(str(error))
"""


@pytest.mark.long
def test_a_full_disk_is_told(tmp_path: Path) -> None:
    """When no more can be written, the error says why, and nothing is left."""

    def limit() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # writing fails, as on a full disk
        resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))

    out = tmp_path / "a.mp4"
    done = subprocess.run(
        [sys.executable, "-c", FULL, str(out), str(Path(__file__).parent)],
        preexec_fn=limit,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1, done.stderr
    assert "a.mp4" in done.stderr
    assert "File too large" in done.stderr
    assert list(tmp_path.iterdir()) == []
