"""Encodes the pictures of a stream and sends them, on a thread of its own."""

import threading
import time
from collections.abc import Callable
from queue import Empty, Full, Queue
from typing import NamedTuple

import av

from lacoc_client.film.live.mixer import Mixer
from lacoc_client.film.live.target import Target
from lacoc_client.film.movie import Movie
from lacoc_shared.words import Phrase, say

SOUND_HZ = 48_000
"""Samples a second of the sound."""
_OPTIONS = {"preset": "veryfast", "crf": "23", "maxrate": "4M", "bufsize": "8M"}
_WAITING_MOST = 4
"""How many pictures may wait; further pictures are left out, so that a stream never falls
behind."""
_AGAIN_S = 2.0
_LOOK_S = 0.2


class LivePicture(NamedTuple):
    """A picture of a live stream."""

    number: int
    data: bytes
    """PNG or JPEG."""


class Sender:
    """Encodes the pictures and sounds of a live stream, and sends them.

    If the server is gone, tries again until it is back.

    Args:
        target: where the stream goes.
        size: width and height of a picture [px].
        fps: pictures a second.
        tell: called on the sender's thread with a sentence when the server is lost, or is back.
    """

    def __init__(
        self, target: Target, size: tuple[int, int], fps: int, tell: Callable[[Phrase], None]
    ) -> None:
        self._target, self._size, self._fps, self._tell = target, size, fps, tell
        self._waiting: Queue[LivePicture] = Queue(_WAITING_MOST)
        self._mixer, self._mixing = Mixer(), threading.Lock()
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self.sent = 0
        """Number of pictures that were sent."""
        self.left_out = 0
        """Number of pictures left out, because the encoder or the server was too slow, or gone."""
        self.failed: av.FFmpegError | None = None
        """Why the file can't be written, or why FFmpeg can't reach such a server; the stream has
        ended then. None: there was no such error."""
        self._is_away = False
        self._thread.start()

    def show(self, picture: LivePicture) -> None:
        """Put a picture into the queue to the encoder, or leave it out if the queue is full."""
        try:
            self._waiting.put_nowait(picture)
        except Full:
            self.left_out += 1

    def hear(self, at_s: float, samples: bytes) -> None:
        """Add a sound to the stream.

        Args:
            at_s: when the sound begins, counted from picture 0 [s].
            samples: of both sides in turn, each with 16 bits, little endian.
        """
        with self._mixing:
            self._mixer.add(round(at_s * SOUND_HZ), samples)

    def end(self) -> None:
        """Send the pictures that are still in the queue, then end the stream."""
        self._ending.set()
        self._thread.join(10 * _AGAIN_S)

    def _run(self) -> None:
        while not self._ending.is_set():
            try:
                self._send()
            except av.FFmpegError as error:
                if not self._target.is_remote or isinstance(error, av.ProtocolNotFoundError):
                    self.failed = error
                    return
                if not self._is_away:
                    why = error.strerror or str(error)
                    self._tell(say("stream.away", target=self._target.shown, why=why))
                self._is_away = True
                self._pass(_AGAIN_S)

    def _pass(self, seconds: float) -> None:
        """Drop the pictures in the queue and those of the next `seconds`, with their sounds.

        The end stops it.
        """
        end_s = time.monotonic() + seconds
        while time.monotonic() < end_s and not self._ending.is_set():
            picture = self._next()
            if picture is not None:
                self.left_out += 1
                self._sound_until(picture.number + 1)

    def _next(self) -> LivePicture | None:
        try:
            return self._waiting.get(timeout=_LOOK_S)
        except Empty:
            return None

    def _send(self) -> None:
        """Open the stream's target, and send it pictures and sounds until the stream ends.

        Raises:
            FFmpegError: if the target can't be written.
        """
        first = None
        with av.open(
            self._target.address, "w", format=self._target.form, options=self._target.options
        ) as container:
            film = Movie(container, self._size, self._fps, SOUND_HZ, _OPTIONS)
            while not self._ending.is_set() or not self._waiting.empty():
                picture = self._next()
                if picture is None:
                    continue
                if first is None:
                    first = picture.number
                    self._sound_until(first)
                    container.start_encoding()  # the server is asked here
                    if self._is_away:
                        self._tell(say("stream.back", target=self._target.shown))
                    self._is_away = False
                film.hear(self._sound_until(picture.number + 1))
                film.add(picture.data, picture.number - first)
                self.sent += 1
            film.end()

    def _sound_until(self, number: int) -> bytes:
        with self._mixing:
            return self._mixer.take(round(number * SOUND_HZ / self._fps))
