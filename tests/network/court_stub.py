"""A court for tests: its network and inbox are real, its match accepts almost everything."""

import secrets
import threading
import time
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import msgspec

from lacoc_server.doors.decision_desk import DecisionDesk
from lacoc_server.doors.inbox import Inbox
from lacoc_server.doors.network import CourtNetwork
from lacoc_server.doors.team_desk import TeamDesk
from lacoc_shared.codec import encode, message_hash
from lacoc_shared.contest import tokens
from lacoc_shared.inputs import Decide, HeardSeat, Input, JoinSeat, KeySeat, SilentSeat
from lacoc_shared.keyspace import KeySpace
from lacoc_shared.messages import (
    PROTOCOL,
    DecisionReply,
    Done,
    Event,
    Frame,
    Health,
    Join,
    Outcome,
    Outlook,
    Refusal,
    Scene,
    SceneBody,
    SeatFrame,
    SentFile,
    Sheet,
    SheetSeat,
)
from lacoc_shared.messages.office import open_match
from lacoc_shared.mistakes import FileRefused, Mistake
from lacoc_shared.network.certificate import Pair
from lacoc_shared.seat import No, Phase
from lacoc_shared.words import Phrase, say

KEYS = KeySpace("main")
SEATS = ("left", "right")
TOKENS = {"left": "token of left", "right": "token of right"}
HASHES = {seat: tokens.new_token_hash(token) for seat, token in TOKENS.items()}
WHISTLE = "the referee's whistle"
WRONG = SentFile("mine.txt", b"wrong")
BOOK = SentFile("mine.xlsx", b"PK\x03\x04")
"""A workbook that nobody can read; it is refused as `WRONG` is."""
SLOW = SentFile("slow.txt", b"20 20")
"""A file whose weighing in takes twenty beats."""


_Inbox = TypeVar("_Inbox", bound=Inbox)


def opened(inbox: _Inbox, hashes: Mapping[str, str] = HASHES) -> _Inbox:
    """Open the seats of an inbox to everybody who has their tokens; return the inbox."""
    match = open_match({seat: [one] for seat, one in hashes.items()})
    inbox.admit(match, range(len(SEATS)))
    return inbox


class Scales:
    """Weighs files in without reading them: `WRONG` is refused, `SLOW` takes twenty beats."""

    def __init__(self) -> None:
        self.asked = 0
        """How many times the answer to a join with `SLOW` was asked for."""

    def __call__(self, join: Join, _: JoinSeat | None) -> tuple[Join, tuple[Phrase, ...]] | None:
        if join.postures in (WRONG, BOOK):
            found = [Mistake(file="mine.txt", found=f, expected="20", row=3) for f in ("a", "b")]
            raise FileRefused(found)
        if join.postures == SLOW:
            self.asked += 1
            if self.asked < 20:
                return None
        return msgspec.structs.replace(join, robot=join.robot or SentFile("r.toml", b"")), ()


def make_scene(name: str) -> Scene:
    body = SceneBody(name=name, parent=-1, pos=(0.0, 0.0, 0.0), quat=(1.0, 0.0, 0.0, 0.0))
    return Scene(bodies=(body,), geoms=())


def make_sheet(scene: Scene, **changes: Any) -> Sheet:
    seats = tuple(SheetSeat(id=seat, colour="#123456", pattern="plain") for seat in SEATS)
    fields: dict[str, Any] = {"protocol": PROTOCOL, "version": "0", "court": "main", "match": 1}
    fields |= {"arena": "test", "title": "Test", "duration_s": 180.0, "levels": (1,)}
    fields |= {"settings": {}, "seats": seats, "markers": ()}
    fields |= {"scene": message_hash(encode(scene))}
    return Sheet(**(fields | changes))


def make_event(number: int, match: int = 1, text: str = "something") -> Event:
    said = say("plain.text", text=text)
    return Event(number=number, match=match, beat=0, clock_ticks=0, kind="phase", said=said)


SEEN = Outlook(beat=7, clock_ticks=5, before=(1, 2), scores=(3, 4), seconds=2.0, phase=4, events=())
"""What the stub answers to every referee who asks for an outlook."""


class CourtStub:
    """A court with a beat every 5 ms on a thread of its own; `inputs` has all that its match got.

    Its match refuses digit 9, and a join by a team called "Nobody".
    """

    def __init__(
        self,
        listen: str = "127.0.0.1:0",
        certificate: Pair | None = None,
        court: str = "main",
        **restored: Any,
    ) -> None:
        keys = KeySpace(court)
        token_hashes = restored.pop("token_hashes", HASHES)
        self.scales = Scales()
        inbox = Inbox(keys, SEATS, self.scales, secrets.token_bytes, **restored)
        opened(inbox, token_hashes)
        self._links = inbox.links
        self.beat = 0
        """The newest beat; its frame may not be sent yet."""
        desk = DecisionDesk([tokens.new_token_hash(WHISTLE)])
        self.teams = TeamDesk()
        """Answers teams that ask where they play; no office has told it anything."""
        self.network = CourtNetwork(
            keys,
            [listen],
            inbox,
            desk,
            certificate,
            look_ahead=lambda _: lambda: SEEN,
            team_desk=self.teams,
        )
        self.trouble: Phrase | None = None
        """The reason why no beats pass, such as a full disk; None while they pass.

        While it is set, the court refuses requests and repeats the frame of its last beat.
        """
        self.inputs: list[Input] = []
        self.scene = make_scene("empty")
        self.silent = False
        self.held: list[JoinSeat | None] = [None, None]
        """The seats' joins; a match that has begun goes on with their files."""
        self._silent: set[int] = set()
        self._seats = {seat: SeatFrame(0, 0, 1, 0, 0, 0, 0, 0, 0, 0) for seat in range(2)}
        self._todo: list[Callable[[], None]] = []
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self.show(self.scene)

    def __enter__(self) -> "CourtStub":
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stopping.set()
        self._thread.join()
        self.network.__exit__()

    @property
    def address(self) -> str:
        return self.network.locators[0]

    @property
    def refused(self) -> Mapping[str, Mapping[str, int]]:
        return {seat.id: seat.refused for seat in self.network.seat_health(0.0)}

    def keys(self, seat: int = 0) -> list[tuple[int, int]]:
        return [(i.seq, i.key) for i in self.inputs if isinstance(i, KeySeat) and i.seat == seat]

    def named(self, seat: int = 0) -> tuple[int, int]:
        """Return match and beat of the newest frame that a seat's commands named."""
        return self._links._links[seat].newest

    def show(self, scene: Scene, **changes: Any) -> None:
        """Publish another scene, and a sheet that names it."""
        self.scene = scene
        self.network.publish_scene(scene)
        self.network.publish_sheet(make_sheet(scene, **changes))

    def in_a_beat(self, what: Callable[[], None]) -> None:
        """Call a function on the court's thread, after the next beat's inputs."""
        self._todo.append(what)

    def _run(self) -> None:
        while not self._stopping.wait(0.005):
            if self.trouble:
                self._stand_still(self.beat)
                continue
            self.beat = beat = self.beat + 1
            now_s = time.monotonic()
            silent = [seat in self._silent for seat in range(2)]
            self.network.hold(self.held, has_begun=True)
            arrivals = self.network.poll(now_s, 1, beat, silent)
            outcomes = [self._apply(arrival.input, beat) for arrival in arrivals]
            for arrival, outcome in zip(arrivals, outcomes, strict=True):
                if arrival.answer:
                    arrival.answer(outcome)
            while self._todo:
                self._todo.pop()()
            if not self.silent:
                self._publish_frame(beat, now_s)
                if beat % 10 == 0:
                    self._publish_health(beat, now_s)

    def _stand_still(self, beat: int) -> None:
        now_s = time.monotonic()
        self.network.turn_away(self.trouble)
        self._publish_frame(beat, now_s)
        self._publish_health(beat, now_s)

    def _publish_frame(self, beat: int, now_s: float) -> None:
        scene = message_hash(encode(self.scene))
        seats = tuple(self._seats.values())
        frame = Frame(1, beat, Phase.PLAYING, 0, 0, seats, b"", b"", scene, bytes(8))
        self.network.publish_frame(encode(frame), now_s)

    def _publish_health(self, beat: int, now_s: float) -> None:
        health = Health(
            match=1,
            beat=beat,
            real_time_factor=1.0,
            slow_beats=0,
            worst_late_ms=0.0,
            seats=self.network.seat_health(now_s),
            dropped=self.network.dropped,
            decisions={},
            record_trouble=self.trouble,
            events=self.network.newest_event,
            sheet=self.network.sheet_hash,
        )
        self.network.publish_health(health)

    def _apply(self, one: Input, beat: int) -> Outcome:
        self.inputs.append(one)
        if isinstance(one, SilentSeat):
            self._silent.add(one.seat)
        if isinstance(one, HeardSeat):
            self._silent.discard(one.seat)
        if isinstance(one, JoinSeat) and one.team == "Nobody":
            return Refusal(say("refused.match-on-join", phase="playing"))
        if isinstance(one, JoinSeat):
            return Done(say("note.next-match"))
        if isinstance(one, Decide):
            return DecisionReply(
                beat=beat, event=1, said=say("decision.start", seconds=3), scores=(0, 0)
            )
        if isinstance(one, KeySeat) and one.key == 9:
            self._change(one.seat, refused_seq=one.seq, refused_why=No.NO_SUCH_KEY)
        elif isinstance(one, KeySeat):
            self._change(one.seat, applied_seq=one.seq, applied_beat=beat, key=one.key)
        return Done()

    def _change(self, seat: int, **changes: int) -> None:
        self._seats[seat] = msgspec.structs.replace(self._seats[seat], **changes)
