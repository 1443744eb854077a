"""Watches a court: receives frames, all events of the match, the sheet and the scene."""

import time
from collections.abc import Callable
from typing import TypeVar

from lacoc_client.play.asking import fetch, understand, understood
from lacoc_shared.codec import message_hash
from lacoc_shared.keyspace import KeySpace
from lacoc_shared.messages import PROTOCOL, Event, Frame, Health, Scene, Sheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.court_view import CourtView, Told
from lacoc_shared.network.session import Mail, NoReply, Question, Refused, Session
from lacoc_shared.words import say

T = TypeVar("T")

_EVENTS_DEPTH = 4096
_FETCH_TRIES = 3
_STRAYS = 5
_SHEET_S = 0.2
"""Longest time between a frame and the sheet that belongs to it [s]; after this the sheet is
requested."""
_OTHER_SCENE_S = 3.0
_ANSWER_S = 2.0
"""Time after which a request without an answer is sent again [s]."""


class Spectator:
    """Everything public about a court: complete also for somebody who connects during the match.

    One thread uses it. Only `poll` and `wait_frame` change the attributes; `scene` may change the
    sheet. Lost messages are requested and come later. A frame waits for its sheet, but for no other
    lost message; a controller's commands wait for none.

    Args:
        session: an open client session.
        court: the court's name.
        notify: called on Zenoh's thread when a frame has come; it must return at once.

    Raises:
        UserError: if no such court answers, or it has another version of the protocol.
    """

    def __init__(
        self, session: Session, court: str, notify: Callable[[], None] | None = None
    ) -> None:
        self.keys = KeySpace(court)
        self._session = session
        self._frames = session.mailbox(self.keys.frame, 1, notify)
        self._sheets = session.mailbox(self.keys.sheet, 1)
        self._healths = session.mailbox(self.keys.health, 1)
        self._events = session.mailbox(self.keys.event, _EVENTS_DEPTH)
        self._new_events: list[Event] = []
        self._view: CourtView[Event] = CourtView(lambda event, _: event)
        self.sheet: Sheet
        """The newest sheet; when `poll` returns a frame, it belongs to this frame's scene."""
        self._lacking_sheet = _Lacking(session, self.keys.sheet)
        self._read_sheet(fetch(session, self.keys, self.keys.sheet))
        self.frame: Frame | None = None
        """The newest frame whose sheet was here; None: there was none yet."""
        self.frame_s = time.monotonic()
        """When the newest frame arrived [s, `time.monotonic`]; before the first frame, when the
        wait for it began."""
        self._other_since_s: float | None = None
        """Since when frames have come whose sheet is not here [s]; None: the sheet fits the newest
        frame."""
        self.health: Health | None = None
        """The newest health; None: none came yet."""
        self._strays = 0
        """Number of messages in a row that can't be decoded."""
        self._lacking_events = _Lacking(session, self.keys.event)
        self._read_events(fetch(session, self.keys, self.keys.event))

    @property
    def events(self) -> tuple[Event, ...]:
        """The events of the match so far; of very many the newest (`EVENTS_LISTED`)."""
        return tuple(self._view.log)

    def poll(self) -> Frame | None:
        """Read the messages of the court that have arrived.

        Returns:
            The newest frame; None if no frame came since the last call, or its sheet is not here
            yet.

        Raises:
            UserError: if the court's messages can't be decoded, or no sheet comes for its frames.
        """
        told: Health | None = None
        self._take_answers()
        self._take_events()
        if (mail := self._healths.take()) is not None:
            told = self._read(mail, Health)
            self.health = told or self.health
        newest = self._frames.take()
        if (mail := self._sheets.take()) is not None and self._read(mail, Sheet) is not None:
            self._lacking_sheet.forget()
            self._read_sheet(mail.payload)
        if told is not None:
            self._ask_for_what_is_missing(told)
        if newest is None or (frame := self._read(newest, Frame)) is None:
            return None
        self.frame_s = newest.arrived_s
        if not self._has_sheet_of(frame):
            return None
        self.frame = frame
        return frame

    def wait_frame(self, timeout_s: float) -> Frame | None:
        """Wait for a new frame and return it; None if no frame came in time.

        Raises:
            UserError: if the court's messages can't be decoded.
        """
        deadline_s = time.monotonic() + timeout_s
        while (frame := self.poll()) is None:
            left_s = deadline_s - time.monotonic()
            if left_s <= 0:
                return None
            self.wait(left_s)
        return frame

    def wait(self, timeout_s: float) -> None:
        """Sleep until a frame has arrived, for at most `timeout_s`."""
        self._frames.wait(timeout_s)

    def take_events(self) -> list[Event]:
        """Return the events that came since the last call, of this match and the one before."""
        events, self._new_events = self._new_events, []
        return events

    def silent_s(self, now_s: float) -> float:
        """Return for how long no frame has come [s]; a court sends one each 20 ms in each phase."""
        return max(0.0, now_s - self.frame_s)

    def scene(self) -> Scene:
        """Fetch from the court what is needed to draw the match's robots and field.

        Raises:
            UserError: if no court answers, or its scene does not fit its sheet.
        """
        for _ in range(_FETCH_TRIES):
            scene = fetch(self._session, self.keys, self.keys.scene)
            if message_hash(scene) == self.sheet.scene:
                return understand(scene, Scene)
            self._read_sheet(fetch(self._session, self.keys, self.keys.sheet))
        raise UserError(_OTHER_SCENE)

    def _read(self, mail: Mail, kind: type[T]) -> T | None:
        """Decode a message of the court; return None if it can't be decoded.

        Then the sheet is requested, because it says whether the court has another version of the
        protocol. A single bad message raises no error.

        Raises:
            UserError: if too many messages in a row can't be decoded.
        """
        try:
            message = understand(mail.payload, kind)
        except UserError:
            self._strays += 1
            if self._strays > _STRAYS and not self._lacking_sheet.is_asked:
                raise
            self._lacking_sheet.ask()
            return None
        self._strays = 0
        return message

    def _read_sheet(self, payload: bytes) -> None:
        view = self._view
        with understood():
            view.take_sheet(payload)
        if view.other_version is not None:
            raise UserError(
                say("spectator.other-version", court=view.other_version, program=PROTOCOL)
            )
        self.sheet = understand(payload, Sheet)

    def _ask_for_what_is_missing(self, told: Health) -> None:
        """Request events or the sheet if the court's health shows that some did not arrive."""
        self._view.see_health(Told(told.match, told.beat, told.events, told.sheet))
        if self._view.lacks_events:
            self._lacking_events.ask()
        if self._view.has_older_sheet:
            self._lacking_sheet.ask()

    def _has_sheet_of(self, frame: Frame) -> bool:
        """Return whether the newest sheet that came belongs to a frame.

        If none that fits has come for `_SHEET_S`, request it from the court.
        """
        self._view.see_frame(frame.scene)
        if self._view.fits:
            self._other_since_s = None
            return True
        self._other_since_s = self._other_since_s or self.frame_s
        waited_s = self.frame_s - self._other_since_s
        if waited_s > _OTHER_SCENE_S:
            raise UserError(_OTHER_SCENE)
        if waited_s > _SHEET_S:
            self._lacking_sheet.ask()
        return False

    def _read_events(self, payload: bytes) -> None:
        with understood():
            new = self._view.take_log(payload)
        for event in new:
            self._keep(event)
        self._new_events.sort(key=lambda event: (event.match, event.number))

    def _take_answers(self) -> None:
        """Read the court's answers to requests for lost events and for the sheet, if any came."""
        if (events := self._lacking_events.take()) is not None:
            self._read_events(events)
        if (sheet := self._lacking_sheet.take()) is not None:
            self._read_sheet(sheet)

    def _take_events(self) -> None:
        """Read new events, unless all events of the match have been requested from the court.

        The answer to this request is older than the new events, so it must be read first.
        """
        while not self._lacking_events.is_asked and (mail := self._events.take()) is not None:
            event = self._read(mail, Event)
            if event is not None and self._view.add_event(event, mail.payload):
                self._keep(event)

    def _keep(self, event: Event) -> None:
        """Keep a new event until `take_events`; drop events older than the previous match."""
        if self._new_events and self._new_events[-1].match != event.match:
            last = (event.match - 1, event.match)
            self._new_events = [one for one in self._new_events if one.match in last]
        self._new_events.append(event)


class _Lacking:
    """Requests from a court one kind of message that was lost; one request at a time."""

    def __init__(self, session: Session, key: str) -> None:
        self._session = session
        self._key = key
        self._question: Question | None = None

    @property
    def is_asked(self) -> bool:
        """Whether a request has been sent and not answered yet."""
        return self._question is not None

    def ask(self) -> None:
        """Send the request to the court, unless one waits for its answer already."""
        if self._question is None:
            self._question = self._session.question(self._key, timeout_s=_ANSWER_S)

    def forget(self) -> None:
        """Wait for no answer any more, because the message has arrived without the request."""
        self._question = None

    def take(self) -> bytes | None:
        """Return the court's answer if it has arrived since the last call; else None."""
        if self._question is None:
            return None
        try:
            answer = self._question.take()
        except (NoReply, Refused):  # the court went away: whoever still needs it asks again
            self._question = None
            return None
        if answer is not None:
            self._question = None
        return answer


_OTHER_SCENE = say("spectator.other-scene")
