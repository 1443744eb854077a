"""A seat sends 10,000 commands a second: what does a beat cost then?

A real court runs on the first core. On the last core run two more processes: a controller that
floods its seat with commands, each sealed and new, and a controller that plays as usual. Quiet and
flooded rounds take turns. The CPU time of a beat is that of the court's own thread.
"""

import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import ExitStack
from typing import Any

from arguments import arguments
from measured_court import NAME, MeasuredCourt, measured_court

from lacoc_client.play.controller import Controller
from lacoc_client.play.referee import RefereeClient
from lacoc_shared.codec import encode
from lacoc_shared.decisions import Start
from lacoc_shared.keyspace import KeySpace
from lacoc_shared.messages import Command
from lacoc_shared.network.session import open_client
from lacoc_shared.seal import command_mac
from lacoc_shared.seat import Phase

RATE_HZ = 10_000
SETTLE_BEATS = 25
"""The first beats of each round, which are not measured."""
_ROUND_BEATS = 150
_SLICE_S = 0.005
_LOST_S = 5.0


def flood(rounds: int) -> dict[str, Any]:
    """Measure a court's beats in turns: quiet rounds, and rounds with a flood of commands.

    Returns:
        The CPU time of a beat [us], quiet and flooded; their ratios; how many commands the flooder
        sent; and what became of the other seat's commands.
    """
    cores = sorted(os.sched_getaffinity(0))
    with ExitStack() as stack:
        os.sched_setaffinity(0, cores[:1])
        stack.callback(os.sched_setaffinity, 0, cores)
        opened = stack.enter_context(measured_court())
        left, right = opened.tokens
        words = [
            ("flooder", left, opened.tokens[left]),
            ("player", right, opened.tokens[right], opened.referee),
        ]
        others = [
            _Other(role, cores[-1], opened.address, seat, *tokens) for role, seat, *tokens in words
        ]
        for other in others:
            stack.callback(other.stop)
        plan = _Plan(opened.court, others[0], rounds)
        opened.court.run(plan.ended)
        pressed, sent = (other.stop() for other in reversed(others))
    quiet, flooded = plan.rounds_s[0::2], plan.rounds_s[1::2]
    ratios = [after / before for before, after in zip(quiet, flooded, strict=True)]
    return {
        "quiet_us": statistics.median(quiet) * 1e6,
        "flooded_us": statistics.median(flooded) * 1e6,
        "ratios": [round(ratio, 3) for ratio in ratios],
        "ratio": statistics.median(ratios),
        "sent": sent["sent"],
        "sent_hz": sent["sent"] / max(1e-9, sent["seconds"]),
        "refused_left": dict(opened.inbox.health(time.monotonic())[0].refused),
        "right": pressed,
    }


class _Plan:
    """The plan of quiet and flooded rounds in turns; the court's own loop counts their beats."""

    def __init__(self, court: MeasuredCourt, flooder: "_Other", rounds: int) -> None:
        self._court, self._flooder = court, flooder
        self._left = 2 * rounds
        self._begin: int | None = None
        self.rounds_s: list[float] = []
        """Mean CPU time of a beat, for each round."""

    def ended(self) -> bool:
        """Return whether all rounds are over; called before every beat."""
        beats_s = self._court.cpu_s
        if self._begin is None:
            if self._court.phase is Phase.PLAYING:
                self._begin = len(beats_s)
            return False
        if len(beats_s) < self._begin + SETTLE_BEATS + _ROUND_BEATS:
            return False
        self.rounds_s.append(statistics.mean(beats_s[self._begin + SETTLE_BEATS :]))
        self._begin = len(beats_s)
        self._flooder.say("quiet" if len(self.rounds_s) % 2 == 0 else "flood")
        return len(self.rounds_s) == self._left


class _Other:
    """A process that holds a seat and runs on a given core."""

    def __init__(self, role: str, core: int, *words: str) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.campaigns.flood.seat", "--role", role, str(core), *words],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self._said: dict[str, Any] = {}

    def say(self, word: str) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(f"{word}\n")
        self._process.stdin.flush()

    def stop(self) -> dict[str, Any]:
        """End the process, and return what it has counted."""
        if not self._process.stdin or self._process.stdin.closed:
            return self._said
        told, _ = self._process.communicate("stop\n", timeout=20)
        self._said = json.loads(told or "{}")
        return self._said


def _controller(words: list[str]) -> tuple[Any, Controller]:
    address, seat, token = words[:3]
    session = open_client([address], timeout_s=20.0)
    controller = Controller(session, NAME, seat, token, seat.title())
    controller.join(20.0)
    controller.ready()
    return session, controller


def _commands() -> Callable[[], str]:
    """Return a function that gives the newest word of standard input without waiting."""
    os.set_blocking(sys.stdin.fileno(), False)
    words: list[str] = ["quiet"]

    def newest() -> str:
        while line := sys.stdin.readline():
            words.append(line.strip())
        return words[-1]

    return newest


def flooder(words: list[str]) -> dict[str, Any]:
    """Join a seat; on request send new sealed commands at `RATE_HZ`, and report their number."""
    session, controller = _controller(words)
    joined = controller._joined
    assert joined is not None
    key = KeySpace(NAME).command(words[1])
    publisher = session.publisher(key)
    newest, sent, seconds, seq = _commands(), 0, 0.0, joined.last_seq
    with session:
        while (word := newest()) != "stop":
            controller.poll(time.monotonic())
            if word != "flood":
                time.sleep(0.02)
                continue
            begin_s, due = time.monotonic(), 0
            while newest() == "flood":
                while due < (time.monotonic() - begin_s) * RATE_HZ:
                    seq += 1
                    due += 1
                    digit = seq % 4
                    numbers = (joined.session, seq, 1, digit, 0, 0)
                    mac = command_mac(joined.secret, key, *numbers)
                    publisher.put(encode(Command(*numbers, mac)))
                time.sleep(_SLICE_S)
            controller._seq = seq
            sent, seconds = sent + due, seconds + time.monotonic() - begin_s
    return {"sent": sent, "seconds": seconds}


def player(words: list[str]) -> dict[str, Any]:
    """Join a seat, start the match, and press a key ten times a second."""
    session, controller = _controller(words)
    newest = _commands()
    with session:
        _wait_for(controller, Phase.READY)
        RefereeClient(session, NAME, words[3]).decide(Start(), "a benchmark", "benchmark")
        _wait_for(controller, Phase.PLAYING)
        pressed, applied, waits_ms = 0, 0, []
        while newest() != "stop":
            begin_s = time.monotonic()
            seq = controller.press(1, pressed % 4)
            pressed += 1
            waited_s = 0.0
            while waited_s < _LOST_S:
                controller.wait_frame(0.02)
                waited_s = time.monotonic() - begin_s
                frame = controller.view.frame
                if frame is not None and frame.seats[1].applied_seq >= seq:
                    applied += 1
                    waits_ms.append(waited_s * 1000)
                    break
                if newest() == "stop":  # the court has ended: nobody answers this one
                    pressed -= 1
                    break
            time.sleep(max(0.0, begin_s + 0.1 - time.monotonic()))
            controller.poll(time.monotonic())
    return {"pressed": pressed, "applied": applied, "wait_ms": statistics.median(waits_ms)}


def _wait_for(controller: Controller, phase: Phase) -> None:
    while (frame := controller.wait_frame(1.0)) is None or frame.phase != phase:
        pass


def main() -> None:
    """Measure and print, or play a role in a measurement."""
    if sys.argv[1:2] == ["--role"]:
        name, core, *words = sys.argv[2:]
        os.sched_setaffinity(0, [int(core)])
        print(json.dumps({"flooder": flooder, "player": player}[name](words)))
        return
    found = flood(arguments(__doc__, rounds=(7, "quiet and flooded ones each")).rounds)
    print(json.dumps(found, indent=1))
    sys.exit(found["ratio"] > 1.5 or found["right"]["pressed"] != found["right"]["applied"])


if __name__ == "__main__":
    main()
