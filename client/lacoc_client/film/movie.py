"""Writes pictures into an MP4 that every browser plays.

The file gets its final name when it is complete.
"""

import secrets
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import numpy as np
from av.video.frame import PictureType
from av.video.reformatter import ColorRange, Colorspace

from lacoc_shared.command import keep
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_CODEC = "libx264"
_OPTIONS = {"preset": "veryfast", "crf": "20"}
_THREADS = 4
"""Number of the encoder's threads. It changes the bits of a film, so it is the same on every
machine."""
_BT709 = 1
_SOUND_CODEC, _SOUND_HZ = "aac", 48_000
_PNG = b"\x89PNG"
_SAMPLE_BYTES = 4
"""Bytes of a sample of both sides together."""


class Movie:
    """A film that is being written; `movie` opens it.

    Args:
        container: the open file.
        size: width and height of each picture [px].
        fps: pictures a second.
        sound_hz: samples a second of the sound; 0: the film is silent.
        options: options of the encoder.
    """

    def __init__(
        self,
        container: Any,
        size: tuple[int, int],
        fps: int,
        sound_hz: int = 0,
        options: Mapping[str, str] = _OPTIONS,
    ) -> None:
        self._container = container
        self._fps = fps
        self._sound_hz = sound_hz
        self._track = None
        self._stream = container.add_stream(_CODEC, rate=fps, options=dict(options))
        self._stream.width, self._stream.height = size
        self._stream.pix_fmt = "yuv420p"
        self._stream.time_base = self._stream.codec_context.time_base = Fraction(1, fps)
        context = self._stream.codec_context
        context.gop_size = 2 * fps  # a player that seeks decodes two seconds at most
        context.thread_type, context.thread_count = "FRAME", _THREADS
        context.color_range = ColorRange.MPEG
        context.colorspace = context.color_primaries = context.color_trc = _BT709
        self.count = 0
        """Number of the next picture."""
        if sound_hz:
            self._track = container.add_stream(_SOUND_CODEC, rate=_SOUND_HZ, layout="stereo")
        self._samples = bytearray()
        """Sound that was added and is not written yet."""
        self._heard = 0
        """How many samples of each side are written."""

    def hear(self, samples: bytes) -> None:
        """Add the sound that belongs to the next pictures.

        Args:
            samples: of the left and the right side in turn, each with 16 bits, little endian.
        """
        self._samples += samples

    def add(self, picture: bytes, number: int | None = None) -> None:
        """Add a picture to the film.

        Args:
            picture: PNG or JPEG.
            number: its number in the film, larger than that of the picture before; None: the next.

        Raises:
            OSError: if the file can't be written.
        """
        # A new decoder each time: one decoder draws a picture over those before, for animations.
        decoder = av.CodecContext.create("png" if picture.startswith(_PNG) else "mjpeg", "r")
        (decoded,) = decoder.decode(av.Packet(picture))
        frame = decoded.reformat(
            format="yuv420p", dst_colorspace=Colorspace.ITU709, dst_color_range=ColorRange.MPEG
        )
        frame.pts = self.count = self.count if number is None else number
        frame.pict_type = PictureType.NONE  # a PNG is a key picture, but not of this film
        frame.time_base = self._stream.codec_context.time_base
        self._container.mux(self._stream.encode(frame))
        self.count += 1
        self._sound_on()

    def end(self) -> None:
        """Write the pictures and sounds of the film that are still in the encoders."""
        self._container.mux(self._stream.encode(None))
        if self._track is not None:
            self._container.mux(self._track.encode(None))

    def _sound_on(self) -> None:
        """Write the film's sound up to the end of the newest picture.

        Where sound is missing, write silence.
        """
        if self._track is None:
            return
        until = round(self.count * self._sound_hz / self._fps)
        length = _SAMPLE_BYTES * (until - self._heard)
        part = bytes(self._samples[:length]).ljust(length, b"\0")
        del self._samples[:length]
        values = np.frombuffer(part, "<i2").reshape(1, -1)
        frame = av.AudioFrame.from_ndarray(values, format="s16", layout="stereo")
        frame.sample_rate, frame.pts = self._sound_hz, self._heard
        frame.time_base = Fraction(1, self._sound_hz)
        self._heard = until
        self._container.mux(self._track.encode(frame))


@contextmanager
def movie(out: Path, width: int, height: int, fps: int, sound_hz: int = 0) -> Iterator[Movie]:
    """Open a film for writing; when the `with` block has ended, the film is at `out`.

    If the block fails, or the program is killed, no new file gets the film's name, and an older
    file of this name stays. When the film is complete, an older file is kept under a numbered name.

    Args:
        out: the film's path.
        width: width of each picture [px], even.
        height: height of each picture [px], even.
        fps: pictures a second.
        sound_hz: samples a second of its sound; 0: it is silent.

    Raises:
        UserError: if the film can't be written, for example because the disk is full.
    """
    part = out.with_name(f".{out.name}.{secrets.token_hex(4)}.part")
    try:
        part.open("xb").close()
        # The index comes first, so that a browser begins before it has loaded all.
        container = av.open(str(part), "w", format="mp4", options={"movflags": "+faststart"})
        try:
            film = Movie(container, (width, height), fps, sound_hz)
            yield film
            film.end()
        finally:
            container.close()
        keep.make_room(out)
        part.replace(out)
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("command.cannot-write", path=str(out), why=why)) from None
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)
