"""Hostile clients against a real court: how much is accepted?

In each of three configurations an honest contestant plays in each seat. Meanwhile hostile clients
use real Zenoh sessions. They send commands for the other seat, commands as a spectator, commands
that were heard before, altered commands, and decisions without being the referee. At the end they
publish frames, events, a sheet and health as if they were the court.

An attempt is accepted if it is in the court's record, if the court answered the decision, or if
another spectator received the message. As a control, the same code sends commands and decisions
with the right tokens and secrets: these must be accepted. Of two commands that arrive in one beat
only the newer one counts, so half of the commands are enough.
"""

import json
import random
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter, deque
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

import alone
import msgspec
from arguments import arguments
from ports import free_port

from lacoc_client.play.controller import Controller
from lacoc_client.play.referee import RefereeClient
from lacoc_client.play.spectator import Spectator
from lacoc_server.contest.acts.certificate import make_certificate
from lacoc_shared.codec import decode, encode
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.access import Access
from lacoc_shared.decisions import Adjust, Start
from lacoc_shared.inputs import Decide, KeySeat
from lacoc_shared.keyspace import KeySpace
from lacoc_shared.messages import Command, DecisionRequest
from lacoc_shared.network import config as network_config
from lacoc_shared.network.session import NoReply, Refused, Session, open_client
from lacoc_shared.record.reader import Record
from lacoc_shared.seal import MAC_BYTES, SECRET_BYTES, command_mac
from lacoc_shared.seat import Phase

KEYS = KeySpace("main")
SEATS = ("left", "right")
REFEREE = "benchmark"
CONTROLS = 50
"""How often the code of the attacks is tried with the right tokens and secrets."""
_PRESS_S = 0.25
_SLICE_S = 0.02
_WAIT_S = 60.0
_HEARD = 40  # commands that are kept, those of about four seconds
_DECIDERS = 4  # threads: a court refuses at most four requests in a beat


class Way(NamedTuple):
    """A configuration of the court."""

    name: str
    without: str
    """What is switched off in the court's process: "" or "rules"."""
    encrypted: bool = False
    """Whether the contest has a certificate, so that its courts speak TLS."""


WAYS = (
    Way("all protection", ""),
    Way("transport's rules off", "rules"),
    Way("with TLS", "", encrypted=True),
)


def forging(way: Way, attempts: int, folder: Path) -> dict[str, Any]:
    """Make all attacks in one configuration.

    Args:
        way: the configuration.
        attempts: number of attempts of each kind.
        folder: an empty folder.

    Returns:
        The accepted attempts by kind, what the court refused, and how many honest keys and controls
        were accepted.
    """
    people = _contest(folder, way.encrypted)
    with ExitStack() as stack:
        court = _serve(folder, way.without)
        stack.callback(_stop, court)

        def enter(who: str) -> Session:
            access = people[who]
            return stack.enter_context(open_client([access.connect], _WAIT_S, access.authority))

        sessions = {who: enter(who) for who in people}
        honest = [_Honest(enter(seat), people[seat]) for seat in SEATS]
        referee = RefereeClient(sessions["referee"], "main", people["referee"].token)
        view = Spectator(sessions["spectators"], "main")
        _until(lambda: view.poll() and view.frame and view.frame.phase == Phase.READY)
        referee.decide(Start(), "", REFEREE)
        _until(lambda: view.poll() and view.frame and view.frame.phase == Phase.PLAYING)
        for one in honest:
            one.start()
        stack.callback(lambda: [one.stop() for one in honest])
        _until(lambda: all(len(one.sent) == _HEARD for one in honest))
        answered, forged = _attack(attempts, sessions, honest, people)
        _until(lambda: view.poll() and view.health)
        health = view.health
        for one in honest:
            one.stop()
        received = _publish(attempts, sessions, enter("spectators"))
        controls = _controls(sessions, honest, people)
    record = _record(folder)
    inputs = [one for ones in record.inputs.values() for one in ones]
    keys = [(i.seat, i.seq, i.key) for i in inputs if isinstance(i, KeySeat)]
    applied = set(keys)
    pressed = {(index, *key) for index, one in enumerate(honest) for key in one.pressed}
    decided = [one for one in inputs if isinstance(one, Decide)]
    accepted = {kind: len(commands & applied) for kind, commands in forged.items()}
    accepted["a replayed command"] = len(keys) - len(applied)  # it would be recorded twice
    accepted["a decision by a contestant"] = answered
    return {
        "way": way.name,
        "attempts": attempts,
        "accepted": accepted,
        "decisions in the record": len(decided) - 1 - CONTROLS,
        "forged frames, events, sheets, health received": received,
        "honest keys applied": f"{len(pressed & applied)} of {len(pressed)}",
        "controls accepted": f"{len(controls & applied)} of {CONTROLS} commands",
        "refused by the court": {
            "commands": dict(sum((Counter(s.refused) for s in health.seats), Counter())),
            "decisions": dict(health.dropped),
        }
        if health
        else {},
        "right": pressed <= applied
        and 2 * len(controls & applied) >= CONTROLS
        and len(decided) == 1 + CONTROLS
        and not any(accepted.values())
        and (received == 0) == (way.without != "rules"),
    }


class _Honest:
    """An honest contestant; a thread presses a key every 0.25 s, once the last is applied."""

    def __init__(self, session: Session, access: Access) -> None:
        self.controller = Controller(session, "main", access.seat, access.token, access.seat)
        self.controller.join()
        self.controller.ready()
        joined = self.controller._joined
        assert joined is not None
        self.session, self.secret = joined.session, joined.secret
        self.pressed: list[tuple[int, int]] = []
        """Sequence number and key of each press."""
        self.sent: deque[bytes] = deque(maxlen=_HEARD)
        """The newest commands, which an attacker who listens on the line could have heard."""
        self._door, self.controller._commands = self.controller._commands, self  # type: ignore[assignment]
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._play)

    def put(self, payload: bytes) -> None:
        """Send what the controller sends, and remember it."""
        self.sent.append(payload)
        self._door.put(payload)

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        """Wait until the last key is applied, and end the thread."""
        self._stopping.set()
        if self._thread.is_alive():
            self._thread.join()

    def _play(self) -> None:
        controller, chance = self.controller, random.Random(1)
        while not self._stopping.is_set():
            key = chance.randrange(4)
            self.pressed.append((controller.press(1, key), key))
            pressed_s = time.monotonic()
            while (waited_s := time.monotonic() - pressed_s) < _PRESS_S or not self._done():
                controller.wait_frame(0.02)
                if waited_s > _WAIT_S:
                    return  # the key is lost, and will be missing in the record

    def _done(self) -> bool:
        frame = self.controller.view.frame
        assert frame is not None
        seat = frame.seats[self.controller.index]
        return seat.applied_seq >= self.pressed[-1][0]


Forged = dict[str, set[tuple[int, int, int]]]
"""By kind of attack: seat, sequence number and key of commands that must not be applied."""


def _attack(
    attempts: int,
    sessions: dict[str, Session],
    honest: list[_Honest],
    people: dict[str, Access],
) -> tuple[int, Forged]:
    """Attack in all ways; return how many forged decisions were made, and the forged commands."""
    answered: list[int] = []
    tokens = [people[seat].token for seat in SEATS]
    deciders = [
        threading.Thread(
            target=lambda number=number: answered.append(
                sum(
                    _decide(sessions[SEATS[number % 2]], tokens[try_ % 2])
                    for try_ in range(number, attempts, _DECIDERS)
                )
            )
        )
        for number in range(_DECIDERS)
    ]
    for thread in deciders:
        thread.start()
    forged = _send_commands(attempts, sessions, honest)
    for thread in deciders:
        thread.join()
    return sum(answered), forged


def _send_commands(attempts: int, sessions: dict[str, Session], honest: list[_Honest]) -> Forged:
    chance = random.Random(2)
    kinds: dict[str, tuple[Callable[[int, int], bytes], str | None]] = {
        # Sealed with the attacker's own secret, for either seat's session, which health shows.
        "another seat's command": (
            lambda seat, seq: forge(
                KEYS.command(SEATS[seat]),
                honest[chance.choice((seat, 1 - seat))].session,
                seq,
                honest[1 - seat].secret,
            ),
            None,
        ),
        "a spectator's publish": (
            lambda seat, seq: forge(
                KEYS.command(SEATS[seat]), honest[seat].session, seq, chance.randbytes(SECRET_BYTES)
            ),
            "spectators",
        ),
        "a replayed command": (
            lambda seat, _: honest[seat].sent[chance.randrange(_HEARD // 2)],
            None,
        ),
        "an altered command": (lambda seat, seq: _alter(honest[seat].sent[-1], seq, chance), None),
    }
    forged: Forged = {kind: set() for kind in kinds}
    doors = {
        (who, seat): sessions[who].publisher(KEYS.command(seat))
        for who in (*SEATS, "spectators")
        for seat in SEATS
    }
    sent = 0
    while sent < attempts:
        # One of each kind in a beat: few enough that the court looks at all it receives.
        for number, (kind, (make, who)) in enumerate(kinds.items()):
            seat = (sent + number) % 2
            payload = make(seat, 10**6 + len(kinds) * sent + number)
            command = decode(payload, Command)
            if kind != "a replayed command":  # these have the honest contestant's numbers
                forged[kind].add((seat, command.seq, command.key))
            doors[who or SEATS[1 - seat], SEATS[seat]].put(payload)
        sent += 1
        time.sleep(_SLICE_S)
    return forged


def forge(key_expression: str, session: int, seq: int, secret: bytes) -> bytes:
    """Return a command that is sealed with a secret."""
    numbers = (session, seq, 1, seq % 4, 0, 0)
    return encode(Command(*numbers, command_mac(secret, key_expression, *numbers)))


def _alter(heard: bytes, seq: int, chance: random.Random) -> bytes:
    """Return a command that was heard, with another number and key, and perhaps another seal."""
    command = decode(heard, Command)
    mac = command.mac if chance.random() < 0.5 else chance.randbytes(MAC_BYTES)
    return encode(msgspec.structs.replace(command, seq=seq, key=chance.randrange(10), mac=mac))


def _decide(session: Session, token: str) -> int:
    """Ask for a decision; return 1 if it was made, else 0."""
    request = DecisionRequest(token=token, by=REFEREE, reason="x", decision=Adjust("left", 1))
    try:
        session.ask(KEYS.decision("adjust"), encode(request), timeout_s=_WAIT_S)
    except (NoReply, Refused):
        return 0
    return 1


def _publish(attempts: int, sessions: dict[str, Session], spectator: Session) -> int:
    """Publish as if from the court; return how many messages another spectator received."""
    expressions = (KEYS.frame, KEYS.event, KEYS.sheet, KEYS.health)
    boxes = [spectator.mailbox(key, 100_000) for key in expressions]
    doors = [sessions[who].publisher(key) for who in sessions for key in expressions]
    for number in range(attempts):
        for door in doors[number % len(sessions) :: len(sessions)]:
            door.put(b"forged")
        if number % 50 == 0:
            time.sleep(0.01)
    for session in (*sessions.values(), spectator):
        session.ask(KEYS.scene)  # answered after all earlier messages
    time.sleep(0.2)
    return sum(mail.payload == b"forged" for box in boxes for mail in _mails(box.take))


def _mails(take: Callable[[], Any]) -> Iterator[Any]:
    return iter(take, None)


def _controls(
    sessions: dict[str, Session], honest: list[_Honest], people: dict[str, Access]
) -> set[tuple[int, int, int]]:
    """Send commands and decisions with the right tokens and secrets; return the commands."""
    door = sessions["left"].publisher(KEYS.command("left"))
    first = honest[0].pressed[-1][0] + 1
    for seq in range(first, first + CONTROLS):
        door.put(forge(KEYS.command("left"), honest[0].session, seq, honest[0].secret))
        _decide(sessions["referee"], people["referee"].token)  # answered in a later beat
    return {(0, seq, seq % 4) for seq in range(first, first + CONTROLS)}


def _contest(folder: Path, encrypted: bool) -> dict[str, Access]:
    port = free_port()
    file = folder / "contest.toml"
    file.write_text(
        f'[court.main]\narena = "othello"\nlisten = ["127.0.0.1:{port}"]\n'
        "settings.match.countdown_s = 0.1\nsettings.match.duration_s = 3600.0\n"
    )
    if encrypted:
        make_certificate(file, ())
    contest = contests.load(file)
    watching, secrets = contest.access(contest.court()[0]), contest.secrets
    people = {seat: watching.of_seat(seat, secrets.seat("main", seat)) for seat in SEATS}
    return people | {
        "referee": watching.of_referee(secrets.referee("main")),
        "spectators": watching,
    }


def _serve(folder: Path, without: str) -> subprocess.Popen[str]:
    words = [sys.executable, "-m", "tests.campaigns.forge.messages", "--serve", str(folder)]
    court = subprocess.Popen([*words, without], stdout=subprocess.PIPE, text=True)
    assert court.stdout is not None
    court.stdout.readline()
    threading.Thread(target=court.stdout.read, daemon=True).start()
    return court


def _stop(court: subprocess.Popen[str]) -> None:
    court.terminate()
    court.wait(_WAIT_S)


def _record(folder: Path) -> Record:
    return Record.read(next((folder / "recordings").glob("*.mcap")))


def _until(condition: Callable[[], object]) -> None:
    end_s = time.monotonic() + _WAIT_S
    while not condition():
        if time.monotonic() > end_s:
            sys.exit("what should have happened did not")
        time.sleep(0.005)


def _court(folder: Path, without: str) -> None:
    """Run the court in this process, with some of its protection switched off."""
    if without == "rules":
        network_config.court_access_control = lambda: {"enabled": False}
    sys.argv = [
        "alone",
        str(folder / "contest.toml"),
        "--json",
        "--recordings",
        str(folder / "recordings"),
    ]
    alone.main()


def main() -> None:
    """Attack and print the result, or run the court."""
    if sys.argv[1:2] == ["--serve"]:
        _court(Path(sys.argv[2]), sys.argv[3])
    options = arguments(__doc__, attempts=(10_000, "of each kind"))
    right = True
    for way in WAYS:
        with tempfile.TemporaryDirectory() as folder:
            found = forging(way, options.attempts, Path(folder))
        print(json.dumps(found, indent=1), flush=True)
        right &= found["right"]
    sys.exit(not right)


if __name__ == "__main__":
    main()
