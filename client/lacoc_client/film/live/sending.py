"""The process that encodes a stream and sends it.

FFmpeg holds Python's lock while a video server is asked or takes data. While a server says nothing,
every thread of the process stands still. So this process does nothing else, and it is ended if that
takes too long.
"""

import signal
from contextlib import suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any, NamedTuple

import av

from lacoc_client.film.live.segments import SegmentWatch
from lacoc_client.film.live.target import Target
from lacoc_client.film.movie import Movie
from lacoc_client.play.stopping import unreached
from lacoc_shared.words import Phrase, say

SOUND_HZ = 48_000
"""Samples a second of the sound."""
_OPTIONS = {"preset": "veryfast", "crf": "23", "maxrate": "4M", "bufsize": "8M"}
_SPAWN = get_context("spawn")
_SEGMENT_MOST_S = 20
"""A folder in whose list nothing new stands after the pictures of so many seconds is broken."""
_SILENT_S = 10.0
"""A video server that takes nothing for this long counts as gone [s]."""


class Part(NamedTuple):
    """A picture of a live stream, with the sound that belongs to it."""

    number: int
    picture: bytes
    """PNG or JPEG."""
    sound: bytes
    """As `Movie.hear` takes it."""


class NotSent(NamedTuple):
    """Why a part was not sent. The stream has ended; the next part begins a new one."""

    why: Phrase | str
    is_final: bool = False
    """Whether a new stream would be refused too, because FFmpeg lacks the protocol."""


class SendingProcess:
    """Encodes the parts of a stream and sends them, in a process of its own.

    The process starts with the first part, and again if it has ended.

    Args:
        target: where the stream goes.
        size: width and height of a picture [px].
        fps: pictures a second.
    """

    def __init__(self, target: Target, size: tuple[int, int], fps: int) -> None:
        self._what = (target, size, fps)
        self._wait_s = _SILENT_S if target.is_remote else None  # a disk may be slow
        self._running: tuple[BaseProcess, Any] | None = None
        """The process and the link to it, which has another type on Windows."""

    def send(self, part: Part) -> NotSent | None:
        """Send a part; return None when the encoder has it, else why it was not sent."""
        try:
            process, link = self._running = self._running or self._start()
        except OSError as error:  # no process or memory is free now
            return NotSent(error.strerror or str(error))
        with suppress(OSError, EOFError):
            link.send(part)
            if link.poll(self._wait_s):
                answer: NotSent | None = link.recv()
                return answer
            process.kill()
            self.end()
            return NotSent(say("stream.silent", seconds=_SILENT_S))
        self.end()
        return NotSent(say("stream.process-gone"))

    def end(self) -> None:
        """Send what is still in the encoder, and end the stream and the process."""
        if self._running is None:
            return
        process, link = self._running
        self._running = None
        link.close()
        process.join(_SILENT_S)
        process.kill()
        process.join()

    def _start(self) -> tuple[BaseProcess, Any]:
        here, there = _SPAWN.Pipe()
        process = _SPAWN.Process(target=_run, args=(there, *self._what), daemon=True)
        with unreached():  # it ignores Ctrl-C itself, but only when all is loaded
            process.start()
        there.close()
        with suppress(EOFError):  # it has ended already: then the part is not sent
            here.recv()
        return process, here


def _run(link: "Connection[Any, Any]", target: Target, size: tuple[int, int], fps: int) -> None:
    """Send streams, one after another, until the other end of the link is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C ends the command, and that ends this
    link.send(None)
    with suppress(EOFError, OSError):
        while True:
            try:
                _stream(link, target, size, fps)
            except av.FFmpegError as error:
                is_final = isinstance(error, av.ProtocolNotFoundError)
                link.send(NotSent(error.strerror or str(error), is_final))


def _stream(link: "Connection[Any, Any]", target: Target, size: tuple[int, int], fps: int) -> None:
    """Send one stream.

    Raises:
        FFmpegError: if the target can't be written.
        EOFError: when the stream has ended, because the other end of the link is closed.
    """
    part: Part = link.recv()
    first = part.number
    with av.open(target.address, "w", format=target.form, options=target.options) as container:
        watch = None
        if target.form == "hls":
            watch = SegmentWatch(Path(target.address), _SEGMENT_MOST_S * fps)
        film = Movie(container, size, fps, SOUND_HZ, _OPTIONS)
        container.start_encoding()  # the server is asked here
        try:
            while True:
                film.hear(part.sound)
                film.add(part.picture, part.number - first)
                if watch is not None and not watch.is_whole():
                    link.send(NotSent(say("stream.no-segment")))
                    return
                link.send(None)
                part = link.recv()
        except EOFError:
            film.end()
            raise
