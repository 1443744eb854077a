"""Hands the pictures and sounds of a stream to the process that sends them, on a thread."""

import threading
import time
from collections.abc import Callable
from queue import Empty, Full, Queue
from typing import NamedTuple

from lacoc_client.film.live.mixer import Mixer
from lacoc_client.film.live.sending import SOUND_HZ, Part, SendingProcess
from lacoc_client.film.live.target import Target
from lacoc_shared.words import Phrase, say

_WAITING_MOST = 4
"""How many pictures may wait; further pictures are left out, so that a stream never falls
behind."""
_AHEAD_MOST_S = 60
"""Pages tell of sounds of the next seconds. A sound later than this [s] was timed by a clock that
was set since."""
_AGAIN_S = 2.0
_LOOK_S = 0.2
_SURE_S = 5.0
"""A server that takes a stream for this long has accepted it [s]: one that refuses the key ends the
connection after the first pictures."""


class LivePicture(NamedTuple):
    """A picture of a live stream."""

    number: int
    data: bytes
    """PNG or JPEG."""


class Sender:
    """Sends the pictures and sounds of a live stream.

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
        self._mixer, self._mixing = Mixer(_AHEAD_MOST_S * SOUND_HZ), threading.Lock()
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self.sent = 0
        """Number of pictures that were sent."""
        self.left_out = 0
        """Number of pictures left out, because the encoder or the server was too slow, or gone."""
        self.failed: Phrase | str | None = None
        """Why the file can't be written, or that FFmpeg lacks the server's protocol; the stream
        has ended then. None: there was no such error."""
        self._losses: set[str] = set()
        """Codes of what was told since the server last took the stream."""
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
        process = SendingProcess(self._target, self._size, self._fps)
        try:
            self._send_to(process)
        except Exception as error:  # a bug, but the stream must not go on without pictures
            self.failed = f"{type(error).__name__}: {error}"
            raise
        finally:
            process.end()

    def _send_to(self, process: SendingProcess) -> None:
        """Send pictures and sounds until the stream is told to end, or can't go on."""
        is_new, since_s = True, 0.0
        while not self._ending.is_set() or not self._waiting.empty():
            picture = self._next()
            if picture is None:
                continue
            if is_new:
                self._sound_until(picture.number)
                since_s = time.monotonic()
            sound = self._sound_until(picture.number + 1)
            refused = process.send(Part(picture.number, picture.data, sound))
            if refused is None:
                is_new = False
                self.sent += 1
                if self._losses and time.monotonic() - since_s > _SURE_S:
                    self._losses.clear()
                    self._tell(say("stream.back", target=self._target.shown))
            elif refused.is_final or not self._target.is_remote:
                self.failed = refused.why
                return
            else:
                self.left_out += 1
                # FFmpeg's own errors only: a process that was killed says nothing of the server.
                was_taken = not is_new and isinstance(refused.why, str)
                self._lost(refused.why, was_taken and time.monotonic() - since_s < _SURE_S)
                is_new = True
                self._pass(_AGAIN_S)

    def _lost(self, why: Phrase | str, was_taken: bool) -> None:
        """Tell once that the server is lost, and once that it ends each stream at once.

        Args:
            why: what FFmpeg says.
            was_taken: whether the server took pictures a moment ago.
        """
        lost = say("stream.away", target=self._target.shown, why=why)
        if was_taken:
            lost = say("stream.refused", target=self._target.shown, why=why)
        if not self._losses or (was_taken and lost.code not in self._losses):
            self._tell(lost)
        self._losses.add(lost.code)

    def _pass(self, seconds: float) -> None:
        """Drop the pictures in the queue and those of the next `seconds`, with their sounds.

        Return earlier if the stream is told to end.
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

    def _sound_until(self, number: int) -> bytes:
        with self._mixing:
            return self._mixer.take(round(number * SOUND_HZ / self._fps))
