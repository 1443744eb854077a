"""Draws the pictures of a film in several browsers at a time, and gives them in order.

Each browser gets all pictures in order, but draws only each N-th one: the automatic camera depends
on what it has shown before. So a film does not depend on how many browsers draw it.
"""

import contextlib
import threading
from collections.abc import Iterator, Sequence
from queue import Empty, Full, Queue
from typing import TypeVar

from lacoc_client.film.camera_page import CameraPage, camera_page
from lacoc_client.film.look import Look
from lacoc_client.film.plan import Picture

T = TypeVar("T")

SOUND_HZ = 24_000
"""Samples a second of a film's sound; its highest tone is below 3 kHz."""
_AHEAD = 4
"""How many pictures a browser may draw ahead of the film."""
_LOOK_S = 0.2


class Drawing:
    """A browser that draws its part of a film's pictures, on a thread of its own.

    Args:
        address: the page's address.
        look: how the film looks.
        number: which of the browsers this is, from 0.
        of: how many browsers draw the film.
    """

    def __init__(self, address: str, look: Look, number: int, of: int) -> None:
        self._address, self._look = address, look
        self._number, self._of = number, of
        self._wanted: Queue[tuple[Sequence[Picture], int]] = Queue()
        self._sound: Queue[bytes | BaseException] = Queue()
        self._ends: Queue[tuple[int, int] | BaseException] = Queue()
        self._drawn: Queue[bytes | BaseException] = Queue(_AHEAD)
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def ends(self) -> tuple[int, int]:
        """Wait until the page is open; return the first and the last beat of the replay.

        Raises:
            UserError: if the page can't be opened.
        """
        return _got(self._ends)

    def begin(self, pictures: Sequence[Picture], fps: int) -> None:
        """Begin to draw this browser's part of a film's pictures; may be called once."""
        self._wanted.put((pictures, fps))

    def sound(self) -> bytes:
        """Wait for the sound of all pictures (`CameraPage.sound`); only the first browser makes it.

        Raises:
            UserError: if it can't be made.
        """
        return _got(self._sound)

    def next(self) -> bytes:
        """Wait for this browser's next picture, and return it as PNG.

        Raises:
            UserError: if it can't be drawn.
        """
        return _got(self._drawn)

    def stop(self) -> None:
        """End this browser and the thread on which it draws."""
        self._stopped.set()
        self._thread.join()

    def _run(self) -> None:
        try:
            with camera_page(self._address, self._look) as page:
                self._ends.put((page.first, page.last))
                while not self._stopped.is_set():
                    with contextlib.suppress(Empty):
                        pictures, fps = self._wanted.get(timeout=_LOOK_S)
                        if self._number == 0:
                            self._sound.put(page.sound(pictures, fps, SOUND_HZ))
                        self._draw(page, pictures)
        except BaseException as error:  # whoever waits for a picture must get it
            self._ends.put(error)
            self._sound.put(error)
            self._put(error)

    def _draw(self, page: CameraPage, pictures: Sequence[Picture]) -> None:
        since = 0
        for index in range(self._number, len(pictures), self._of):
            if self._stopped.is_set():
                return
            self._put(page.picture(pictures[since : index + 1]))
            since = index + 1

    def _put(self, picture: bytes | BaseException) -> None:
        while not self._stopped.is_set():
            with contextlib.suppress(Full):
                self._drawn.put(picture, timeout=_LOOK_S)
                return


class Crew:
    """All browsers that together draw one record; `drawn_by` makes a crew."""

    def __init__(self, drawings: Sequence[Drawing]) -> None:
        self._drawings = drawings

    def ends(self) -> tuple[int, int]:
        """Wait until all pages are open; return the first and the last beat of the replay.

        Raises:
            UserError: if a page can't be opened.
        """
        *_, ends = [drawing.ends() for drawing in self._drawings]
        return ends

    def begin(self, pictures: Sequence[Picture], fps: int) -> bytes:
        """Begin to draw a film's pictures, and return the sound of all; may be called once.

        Raises:
            UserError: if it can't be made.
        """
        for drawing in self._drawings:
            drawing.begin(pictures, fps)
        return self._drawings[0].sound()

    def pictures(self, count: int) -> Iterator[bytes]:
        """Yield the pictures of the film as PNG, in order; may be called once, after `begin`.

        Raises:
            UserError: if one can't be drawn.
        """
        for index in range(count):
            yield self._drawings[index % len(self._drawings)].next()


@contextlib.contextmanager
def drawn_by(count: int, address: str, look: Look) -> Iterator[Crew]:
    """Open some browsers with the page of a record, until the `with` block ends.

    Args:
        count: how many.
        address: the page's address.
        look: how the film looks.
    """
    drawings = [Drawing(address, look, number, count) for number in range(count)]
    try:
        yield Crew(drawings)
    finally:
        for drawing in drawings:
            drawing.stop()


def _got(queue: "Queue[T | BaseException]") -> T:
    found = queue.get()
    if isinstance(found, BaseException):
        raise found
    return found
