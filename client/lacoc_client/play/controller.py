"""Holds a seat: joins it, presses keys, reports refusals, and joins again after a break."""

import time
from collections.abc import Callable
from enum import Enum
from typing import NamedTuple, TypeVar

import msgspec

from lacoc_client.play.asking import NoAnswer, NoCourt, NotNow, ask
from lacoc_client.play.spectator import Spectator
from lacoc_shared import seal
from lacoc_shared.codec import encode
from lacoc_shared.keyspace import JOIN_MAX_BYTES
from lacoc_shared.messages import (
    PROTOCOL,
    Command,
    Done,
    Frame,
    Health,
    Join,
    Joined,
    SeatFrame,
    SeatRequest,
    SentFile,
    TriedKey,
    TryOutReply,
    TryOutRequest,
)
from lacoc_shared.mistakes import FILES_REFUSED, FileRefused, UserError
from lacoc_shared.network.session import Session
from lacoc_shared.seat import (
    BEATS_PER_S,
    FRESH_BEATS,
    REPEATS_HZ,
    RESTART_KEY,
    SILENT_AFTER_S,
    WHY_NO,
)
from lacoc_shared.words import Phrase, say

REPEAT_S = 1 / REPEATS_HZ

_Sealed = TypeVar("_Sealed", SeatRequest, TryOutRequest)

_REJOIN_TIMEOUT_S = 1.0
_REMEMBERED = 64
_REPEATED_BEATS = FRESH_BEATS - BEATS_PER_S
"""For a player who sees the frames elsewhere, such as on a page: greatest age of a frame that a
repeated command names [beats]. The court accepts frames that are a second older, so the command has
time to arrive."""
_WHY = {int(no): why for no, why in WHY_NO.items()}


class Hold(Enum):
    """Whether a controller holds its seat, and if not, why; each value names a text `hold.*`."""

    NOT_JOINED = "not-joined"
    HELD = "held"
    LOST = "lost"
    """The court was restarted and has not answered yet, or refuses for now. The controller goes on
    asking."""
    REPLACED = "replaced"
    """A newer session with the same token has taken the seat."""
    REFUSED = "refused"
    """The court was restarted and refuses to let this controller join again."""
    LEFT = "left"

    @property
    def phrase(self) -> Phrase:
        """The sentence that describes this state, for cases without a more exact reason."""
        return _HOLDS[self]


_HOLDS = {
    Hold.NOT_JOINED: say("hold.not-joined"),
    Hold.HELD: say("hold.held"),
    Hold.LOST: say("hold.lost"),
    Hold.REPLACED: say("hold.replaced"),
    Hold.REFUSED: say("hold.refused"),
    Hold.LEFT: say("hold.left"),
}


class SeenFrame(NamedTuple):
    """Names a frame that the player has seen: its match and its beat."""

    match: int
    beat: int


class RefusedKey(NamedTuple):
    """A key press that the match has refused, with the reason."""

    level: int
    key: int
    why: Phrase

    @property
    def name(self) -> str:
        """The refused key as people press it: a digit, or x."""
        return "x" if self.key == RESTART_KEY else str(self.key)


class _PressedKey(NamedTuple):
    level: int
    key: int
    at_s: float


class Controller:
    """Holds one seat of a court for a player: a person, a bot or a ghost.

    One thread uses it. While the seat is held, that thread calls `poll` or `wait_frame` at least
    ten times a second: they repeat the last command, so that the seat does not become silent. After
    a restart of the court they join again, with the same token and files.

    Every command names the newest frame that the player saw. If the player sees the frames
    elsewhere, that is the newest frame given to `saw` or `press`. Then `poll` repeats the command
    only while that frame is recent: a command never names a frame that the player did not see.

    Args:
        session: an open client session.
        court: the court's name.
        seat: the seat's id.
        token: the seat's token.
        team: the team's name.
        robot: a robot file; None: the contest's robot.
        postures: a Loco-data file.
        locomotion: a LocoTra-data file. Without any of the three files a team keeps those with
            which it holds the seat; else it gets the contest's robot with its sample gait.
        notify: called on Zenoh's thread when a frame has come; it must return at once.
        elsewhere: whether the player sees the frames elsewhere, such as on a page.

    Raises:
        UserError: if no such court answers, or it has no such seat.
    """

    def __init__(
        self,
        session: Session,
        court: str,
        seat: str,
        token: str,
        team: str,
        *,
        robot: SentFile | None = None,
        postures: SentFile | None = None,
        locomotion: SentFile | None = None,
        notify: Callable[[], None] | None = None,
        elsewhere: bool = False,
    ) -> None:
        self.view = Spectator(session, court, notify)
        """Everything public about the court: frames, events, sheet, health."""
        self.seat = seat
        self._session = session
        self._keys = self.view.keys
        self._join = Join(
            protocol=PROTOCOL,
            token=token,
            name=team,
            robot=robot,
            postures=postures,
            locomotion=locomotion,
        )
        self.index  # noqa: B018 - raises early if there is no such seat
        self._commands = session.publisher(self._keys.command(seat))
        self._joined: Joined | None = None
        self._health_seen: Health | None = None
        self._other_holder = False
        """Whether the newest health named another session as the holder of the seat."""
        self._leaving = False
        """Whether the player gave up the seat, and no answer or health has shown the result."""
        self._seq = 0
        self._requests = 0
        """Number of ready and leave requests in this session."""
        self._standing = (0, 0, 0)
        """Sequence number, level and key of the command that is repeated now."""
        self._elsewhere = elsewhere
        self._seen: SeenFrame | None = None
        """The newest frame that the player saw in this session, as given to `saw` or `press`."""
        self._sent_s = 0.0
        self._pressed: dict[int, _PressedKey] = {}
        self._refused: list[RefusedKey] = []
        self.repeating = True
        """Whether `poll` repeats the command and joins a restarted court again; False when the
        player has gone.
        """
        self.hold = Hold.NOT_JOINED
        self.reason: Phrase | None = None
        """Why the seat is not held, if this is known more exactly than `hold` says."""
        self.round_trip_ms: float | None = None
        """Time from a key press to the frame that shows it, of the newest such key [ms]; None: none
        was shown yet."""

    @property
    def index(self) -> int:
        """The seat's index in the sheet and in frames.

        Raises:
            UserError: if the court has no such seat.
        """
        names = [seat.id for seat in self.view.sheet.seats]
        if self.seat not in names:
            raise UserError(
                say("court.no-seat", court=self._keys.court, seat=self.seat, seats=names)
            )
        return names.index(self.seat)

    @property
    def session(self) -> int:
        """Number of the court's session with which this controller holds its seat; 0: none."""
        return self._joined.session if self._joined is not None else 0

    def join(self, timeout_s: float = 5.0) -> tuple[Phrase, ...]:
        """Take the seat; if an older controller with the same token has it, it loses the seat.

        Returns:
            The court's notes for the contestant, such as remarks on the files.

        Raises:
            FileRefused: if the files have mistakes.
            UserError: if the court refuses for another reason, or does not answer.
        """
        size = len(encode(self._join))
        if size > JOIN_MAX_BYTES - 1024:
            most_kib = JOIN_MAX_BYTES // 1024 - 1
            raise UserError(
                say("refused.files-too-large", size_kib=size // 1024, most_kib=most_kib)
            )
        key = self._keys.request(self.seat, "join")
        joined = ask(self._session, self._keys, key, self._join, Joined, timeout_s, repeatable=True)
        self._skip_health()
        self._other_holder = self._leaving = False
        self._joined = joined
        self._requests = 0
        self._seq = joined.last_seq
        self._pressed.clear()
        self.hold, self.reason = Hold.HELD, None
        self._standing = (0, 0, 0)
        self._seen = None  # a restarted court may have lost that frame
        self._send()
        if any(note.code == FILES_REFUSED for note in joined.notes):
            # After a restart the court would refuse them. Without files the seat keeps its own.
            self._join = msgspec.structs.replace(
                self._join, robot=None, postures=None, locomotion=None
            )
        return joined.notes

    def ready(self, ready: bool = True) -> Phrase | None:
        """Tell the court that the team is ready, or no longer ready.

        Returns:
            A sentence from the court, if it sent one.

        Raises:
            UserError: if the court refuses or does not answer.
        """
        return self._request("ready", ready)

    def leave(self) -> Phrase | None:
        """Give up the seat.

        Returns:
            A sentence from the court, if it sent one.

        Raises:
            UserError: if the court refuses or does not answer. In the second case the court's next
                health message decides whether the seat is given up.
        """
        try:
            said = self._request("leave", True)
        except NoAnswer:
            self._skip_health()
            self._leaving = True
            raise
        self.hold, self._joined = Hold.LEFT, None
        return said

    def try_out(
        self, keys: tuple[TriedKey, ...], first: int, until: int, drawn: bool
    ) -> Callable[[], TryOutReply]:
        """Prepare a request: how would the robot walk alone with some keys, before the match?

        Args:
            keys: as in `TryOutRequest`.
            first: as in `TryOutRequest`.
            until: as in `TryOutRequest`.
            drawn: as in `TryOutRequest`.

        Returns:
            A function that sends the request and waits for the answer. Any thread may call it, so
            the controller's thread can go on repeating the command. It raises `UserError` if the
            court refuses or does not answer.

        Raises:
            UserError: if the seat is not held.
        """
        key, request = self._sealed(
            "try",
            lambda session, seq: TryOutRequest(
                session=session,
                seq=seq,
                drawn=drawn,
                first=first,
                until=until,
                keys=keys,
                mac=b"",
            ),
        )
        return lambda: ask(self._session, self._keys, key, request, TryOutReply)

    def saw(self, frame: SeenFrame) -> None:
        """Tell the court, if the seat is held, that the player elsewhere still sees new frames.

        Args:
            frame: the frame that the player saw.
        """
        if self.hold is Hold.HELD:
            self._note(frame)
            self._send(self._seen)

    def press(self, level: int, key: int, upon: SeenFrame | None = None) -> int:
        """Send a new command of the seat; `poll` repeats it until the next one.

        Args:
            level: a `Level`.
            key: a digit, or `RESTART_KEY`.
            upon: the frame that the player saw; None: the newest frame that this controller got.

        Returns:
            The command's sequence number.

        Raises:
            UserError: if the seat is not held.
        """
        self._session_held()
        self._seq += 1
        self._pressed[self._seq] = _PressedKey(level, key, time.monotonic())
        if len(self._pressed) > _REMEMBERED:
            del self._pressed[next(iter(self._pressed))]
        self._standing = (self._seq, level, key)
        if upon is not None:
            self._note(upon)
        self._send(upon)
        return self._seq

    def poll(self, now_s: float) -> Frame | None:
        """Read the court's messages; send the last command again, or join again, if it is time.

        Args:
            now_s: `time.monotonic()`.

        Returns:
            The newest frame; None if no frame came since the last call.

        Raises:
            UserError: if the court's messages can't be decoded.
        """
        frame = self.view.poll()
        if frame is not None and self.index < len(frame.seats):
            self._compare(frame.seats[self.index])
        if self.repeating and self.hold in (Hold.HELD, Hold.LOST):
            self._check_hold()
        if self.repeating and self.hold is Hold.HELD and now_s - self._sent_s >= REPEAT_S:
            sent_s = self._sent_s
            self._send()
            # Frames wake the caller, so a repeat may be late; the next is then due earlier.
            self._sent_s = max(sent_s + REPEAT_S, now_s - REPEAT_S / 2)
        return frame

    def wait_frame(self, timeout_s: float) -> Frame | None:
        """Wait for a new frame; return it, or None if none came in time.

        Meanwhile send the last command again and again.

        Raises:
            UserError: if the court's messages can't be decoded.
        """
        deadline_s = time.monotonic() + timeout_s
        while (frame := self.poll(now_s := time.monotonic())) is None:
            if now_s >= deadline_s:
                return None
            self.view.wait(min(deadline_s - now_s, REPEAT_S))
        return frame

    def take_refused(self) -> list[RefusedKey]:
        """Return the key presses that the match refused since the last call."""
        refused, self._refused = self._refused, []
        return refused

    @property
    def why_not_held(self) -> Phrase:
        """Why the seat is not held."""
        return self.reason or self.hold.phrase

    def link(self, now_s: float) -> Phrase | None:
        """Return what is wrong with the seat or the connection; None if nothing is wrong."""
        silent_s = self.view.silent_s(now_s)
        if self.hold is not Hold.HELD:
            return self.why_not_held
        return None if silent_s < SILENT_AFTER_S else say("hold.silent", seconds=silent_s)

    def _session_held(self) -> Joined:
        if self.hold is not Hold.HELD or self._joined is None:
            raise UserError(say("refused.not-yours", seat=self.seat, why=self.why_not_held))
        return self._joined

    def _request(self, what: str, ready: bool) -> Phrase | None:
        key, request = self._sealed(
            what,
            lambda session, seq: SeatRequest(session=session, seq=seq, ready=ready, mac=b""),
        )
        return ask(self._session, self._keys, key, request, Done).said

    def _sealed(self, what: str, make: Callable[[int, int], _Sealed]) -> tuple[str, _Sealed]:
        """Make a request for the seat, with its seal; return its key expression and the request.

        Args:
            what: the kind of request, as in `KeySpace.request`.
            make: makes the request without a seal, from the session's number and a sequence number.
        """
        joined = self._session_held()
        key = self._keys.request(self.seat, what)
        self._requests += 1
        request = make(joined.session, self._requests)
        mac = seal.request_mac(joined.secret, key, joined.session, self._requests, *request.sealed)
        return key, msgspec.structs.replace(request, mac=mac)

    def _note(self, frame: SeenFrame) -> None:
        """Remember the newest frame that the player saw elsewhere, such as on a page."""
        self._seen = max(self._seen or frame, frame)

    def _newest(self) -> SeenFrame | None:
        """Return the frame that the command names when it is repeated; None: do not repeat it now.

        None if the player sees the frames elsewhere and has seen no recent one: an old frame does
        not count as a sign of life.
        """
        frame, seen = self.view.frame, self._seen
        if not self._elsewhere:
            return SeenFrame(frame.match, frame.beat) if frame is not None else SeenFrame(0, 0)
        if frame is None or seen is None:
            return None
        is_fresh = seen.match == frame.match and frame.beat - seen.beat < _REPEATED_BEATS
        return seen if is_fresh else None

    def _send(self, upon: SeenFrame | None = None) -> None:
        """Send the newest command; it names the frame `upon`, or the newest that the player saw."""
        assert self._joined is not None
        seen, key_expression = upon or self._newest(), self._keys.command(self.seat)
        if seen is None:
            return
        numbers = (self._joined.session, *self._standing, *seen)
        mac = seal.command_mac(self._joined.secret, key_expression, *numbers)
        self._commands.put(encode(Command(*numbers, mac)))
        self._sent_s = time.monotonic()

    def _compare(self, seat: SeatFrame) -> None:
        """Note which of the pressed keys a frame shows as applied or refused.

        From this follow the refused keys and the time from a key press to its effect.
        """
        newest = max(seat.applied_seq, seat.refused_seq)
        for seq in [seq for seq in self._pressed if seq <= newest]:
            press = self._pressed.pop(seq)
            if seq in (seat.applied_seq, seat.refused_seq):
                self.round_trip_ms = (self.view.frame_s - press.at_s) * 1000
            if seq == seat.refused_seq:
                why = _WHY.get(seat.refused_why, say("key.refused"))
                self._refused.append(RefusedKey(press.level, press.key, why))

    def _skip_health(self) -> None:
        """Ignore the health messages that have come so far: they are older than what was asked."""
        self.view.poll()
        self._health_seen = self.view.health

    def _check_hold(self) -> None:
        """Find out from the court's health whether this controller still holds the seat.

        Health names the session that holds each seat. A restarted court knows no session, and a
        newer session with the same token replaces this one. A health message from before the join
        may arrive after it, so another session counts only when two messages in a row name it.
        """
        health = self.view.health
        if health is None or health is self._health_seen:
            return
        self._health_seen = health
        holder = next((seat.session for seat in health.seats if seat.id == self.seat), 0)
        believed, self._other_holder = self._other_holder, False
        if holder == 0 and self._leaving:
            self.hold, self.reason, self._joined = Hold.LEFT, None, None
        elif self._joined is None or holder == 0:
            self._join_again()
        elif holder == self._joined.session:
            self._leaving = False
            self.hold, self.reason = Hold.HELD, None
        elif believed:
            self.hold, self.reason = Hold.REPLACED, None
        else:
            self._other_holder = True

    def _join_again(self) -> None:
        try:
            self.join(_REJOIN_TIMEOUT_S)
        except NoCourt:  # the court may have made a session: its next health message decides
            self.hold, self.reason, self._joined = Hold.LOST, None, None
        except NotNow as error:  # the court has made none: another session may hold the seat now
            self.hold, self.reason = Hold.LOST, error.phrase
        except FileRefused:
            self.hold, self.reason = Hold.REFUSED, say("hold.files-refused")
        except UserError as error:
            self.hold, self.reason = Hold.REFUSED, error.phrase
