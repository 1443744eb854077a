"""The time that a bot may take: a bot that never answers ends like one that raises an error.

A thread looks several times a second at the bots that were called and have not answered. Two times
are limited. The first is the processor time of the bot's own thread, so a busy machine takes
nothing from a bot. The second is the time in which a bot uses no processor, because it sleeps,
reads or holds a lock. It is counted in looks, and a busy machine looks less often.

The limits are a thousand times what bots need. They decide no match: a match in which a bot does
not answer has no result.

To ask the system for the processor time of a thread takes longer than most bots need for a frame.
So the first part of a match's limit is measured by the clock instead (`_BY_CLOCK`). What a busy
machine adds there is little for the limit.
"""

import ctypes
import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from types import FrameType
from typing import Any, NamedTuple

from lacoc_shared.command import screen
from lacoc_shared.words import Phrase, say

LOOK_S = 0.25
_BY_CLOCK = 0.1
"""The part of `Most.match_s` that is measured by the clock, not by processor time."""
_IGNORED_LOOKS = 20
"""If a bot goes on after this many interruptions, the process ends."""


class Most(NamedTuple):
    """The longest times that a bot may take [s]."""

    begin_s: float = 60.0
    """Processor time to load the file, and to make a brain; big libraries need seconds."""
    frame_s: float = 10.0
    """Processor time for one frame."""
    match_s: float = 600.0
    """Processor time in all frames of a match."""
    wait_s: float = 60.0
    """Time that a bot waits in one call without using the processor."""
    match_wait_s: float = 600.0
    """Time that a bot waits in all frames of a match without using the processor."""


MOST = Most()


class TimeUp(BaseException):
    """Raised in the code of a bot that takes too long; `except Exception` does not catch it."""

    def __init__(self, why: Phrase | None = None) -> None:
        super().__init__()
        self.why = why


def _end_process(said: Phrase) -> None:
    screen.error(said)
    os._exit(1)


when_stuck: Callable[[Phrase], None] = _end_process
"""Called with the message about a bot that can't be interrupted. By default it shows the message
and ends the process."""

NAME_BYTES = 256


class _Value:
    """A value in this process only; used until other processes read it from shared memory."""

    def __init__(self, value: Any) -> None:
        self.value = value


class ShownBots(NamedTuple):
    """What another process may read about the bots of this process, in shared memory.

    A bot may hold Python's lock, for example in an endless sum, so that no other thread of its
    process runs. Then another process must say which bot it is.
    """

    bot: Any
    """`bot.value`: name of the bot that is being asked, UTF-8; empty: no bot is being asked."""
    looks: Any
    """`looks.value`: how often this process has looked at its bots."""


shown = ShownBots(_Value(b""), _Value(0))


class Timer:
    """Measures the time that one bot takes in one match.

    Args:
        bot: the bot's name, for messages.
    """

    def __init__(self, bot: str) -> None:
        self.bot = bot
        self._name = bot.encode(errors="replace")[: NAME_BYTES - 1]
        self.used_s = 0.0
        """Processor time that the bot used in all frames [s]; the first of it by the clock."""
        self.waited_s = 0.0
        """Time that the bot waited in all frames [s]."""
        _watch()

    def frame(self, function: Callable[..., Any], *arguments: object) -> Any:
        """Call a brain with a frame, within the limits for a frame and for a match.

        Raises:
            TimeUp: if it takes too long.
        """
        return self._call(True, function, arguments)

    def begin(self, function: Callable[..., Any], *arguments: object) -> Any:
        """Call a function that loads a bot or makes a brain, within the limit for this.

        Raises:
            TimeUp: if it takes too long.
        """
        return self._call(False, function, arguments)

    def _call(
        self, is_frame: bool, function: Callable[..., Any], arguments: tuple[object, ...]
    ) -> Any:
        thread = threading.get_ident()
        if thread in _calls:  # a bot that asks another bot answers for both
            return function(*arguments)
        call = _Call(self, is_frame, thread)
        shown.bot.value = self._name
        _calls[thread] = call
        try:
            try:
                found = function(*arguments)
            finally:
                call.end()
                shown.bot.value = b""
            if call.why is not None:  # it went on after the interruption, and answered then
                raise TimeUp
            return found
        except TimeUp as error:
            call.end()  # it may have been interrupted while it ended
            error.why = call.why
            raise


class _Call:
    """A call of a bot that has not returned yet."""

    why: Phrase | None = None
    """Why the bot takes too long; None: it does not."""
    _first_s: float | None = None
    """The thread's processor time at the first look [s]."""
    _last_s = 0.0
    _waited_s = 0.0
    _interrupted = 0
    _has_ended = False

    def __init__(self, timer: Timer, is_frame: bool, thread: int) -> None:
        self._timer = timer
        self._is_frame = is_frame
        self._thread = thread
        by_clock = timer.used_s < _BY_CLOCK * MOST.match_s
        self._clock_s = time.perf_counter if by_clock else time.thread_time
        self._began_s = self._clock_s()
        self._lock = threading.Lock()

    def end(self) -> None:
        """Mark the call as ended, so that nothing interrupts this thread any more."""
        with self._lock:
            if self._has_ended:
                return
            self._has_ended = True
            _calls.pop(self._thread, None)
            if self._interrupted:
                _raise_in(self._thread, None)
        if self._is_frame:
            self._timer.used_s += self._clock_s() - self._began_s
            self._timer.waited_s += self._waited_s

    def look(self) -> None:
        """Interrupt the bot if it takes too long. The watching thread calls this."""
        with self._lock:  # as long as it is held, the thread is there
            if self._has_ended:
                return
            now_s = _thread_time_s(self._thread)
            if self._first_s is None:
                self._first_s = now_s
            else:
                self._waited_s += max(0.0, LOOK_S - (now_s - self._last_s))
            self._last_s = now_s
            self.why = self.why or self._too_long(now_s - self._first_s)
            if self.why is None:
                return
            self._interrupted += 1
            _interrupt(self._thread)
        if self._interrupted > _IGNORED_LOOKS:
            when_stuck(self._said(self.why))

    def _said(self, why: Phrase) -> Phrase:
        """Return the message about a bot that does not answer, with the line that it is at."""
        frame, bot = sys._current_frames().get(self._thread), self._timer.bot
        while frame is not None and frame.f_code.co_filename != bot:
            frame = frame.f_back
        place = None if frame is None else f"{bot}:{frame.f_lineno}"
        return say("bot.no-answer", bot=bot, place=place, why=why)

    def _too_long(self, used_s: float) -> Phrase | None:
        if self._waited_s > MOST.wait_s:
            return say("bot.waits", seconds=MOST.wait_s)
        if not self._is_frame:
            long = used_s > MOST.begin_s
            return say("bot.begins-long", seconds=MOST.begin_s) if long else None
        if used_s > MOST.frame_s:
            return say("bot.frame-long", seconds=MOST.frame_s)
        if self._timer.waited_s + self._waited_s > MOST.match_wait_s:
            return say("bot.match-long", seconds=MOST.match_wait_s)
        long = self._timer.used_s + used_s > MOST.match_s
        return say("bot.match-long", seconds=MOST.match_s) if long else None


_calls: dict[int, _Call] = {}
"""The calls that have not returned, by thread."""
_watcher: threading.Thread | None = None
_signals_come = False
"""Whether signals can interrupt a bot that runs in the main thread."""


def _watch() -> None:
    """Start the watching thread, if this process has none (after a fork it has none)."""
    global _watcher, _signals_come
    if sys.platform != "win32" and threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGVTALRM, _on_signal)
        _signals_come = True
    if _watcher is None or not _watcher.is_alive():
        _watcher = threading.Thread(target=_look, daemon=True, name="bot-time")
        _watcher.start()


def _look() -> None:
    while True:
        time.sleep(LOOK_S)
        shown.looks.value += 1
        for call in [*_calls.values()]:
            call.look()


def _interrupt(thread: int) -> None:
    """Make a thread raise `TimeUp`."""
    if sys.platform != "win32" and _signals_come and thread == threading.main_thread().ident:
        signal.pthread_kill(thread, signal.SIGVTALRM)  # this wakes a sleeper too
    else:
        _raise_in(thread, TimeUp)


def _on_signal(number: int, stack: FrameType | None) -> None:
    """Raise `TimeUp` in the main thread, if its bot still takes too long."""
    call = _calls.get(threading.get_ident())
    if call is not None and call.why is not None:
        raise TimeUp(call.why)


def _raise_in(thread: int, error: type[TimeUp] | None) -> None:
    """Make a thread raise an error; with None, take back an error that it has not raised yet."""
    raised = None if error is None else ctypes.py_object(error)
    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread), raised)


def _thread_time_s(thread: int) -> float:
    """Return the processor time of a thread [s]; of the whole process if the system can't tell."""
    if sys.platform == "linux":
        return time.clock_gettime(time.pthread_getcpuclockid(thread))
    return time.process_time()
