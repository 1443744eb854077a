"""Holds both seats of many courts in one process, to take little processor time.

The first line on standard input names the courts. The process joins all of them, starts their
matches, says so by a line of JSON, and plays until its input ends.
"""

import json
import random
import select
import sys
import time
from contextlib import ExitStack
from typing import Any

from lacoc_client.play.controller import Controller
from lacoc_client.play.referee import RefereeClient
from lacoc_shared.decisions import Start
from lacoc_shared.network.session import open_client
from lacoc_shared.seat import Phase

KEYS_HZ = 2.0
"""New keys a second for each seat; between them the controller repeats the last one."""
_POLL_S = 0.1
_WAIT_S = 60.0


class _Player:
    """The player of both seats of one court."""

    def __init__(self, court: dict[str, Any], stack: ExitStack) -> None:
        self._name, self._referee = court["name"], court["referee"]
        self._sessions = [
            stack.enter_context(open_client([court["address"]], _WAIT_S)) for _ in court["tokens"]
        ]
        self._controllers = [
            Controller(session, self._name, seat, token, seat.title())
            for session, (seat, token) in zip(self._sessions, court["tokens"].items(), strict=True)
        ]
        for controller in self._controllers:
            controller.join(_WAIT_S)
            controller.ready()

    def begin(self) -> None:
        """Start the match when both seats are ready."""
        end_s = time.monotonic() + _WAIT_S
        while (frame := self._controllers[0].view.frame) is None or frame.phase != Phase.READY:
            if time.monotonic() > end_s:
                raise TimeoutError(f"{self._name}: READY did not come")
            for controller in self._controllers:
                controller.wait_frame(_POLL_S)
        referee = RefereeClient(self._sessions[0], self._name, self._referee)
        referee.decide(Start(), "a benchmark", "benchmark")

    def poll(self, chance: random.Random) -> None:
        """Keep both seats, and press a key now and then."""
        for controller in self._controllers:
            controller.poll(time.monotonic())
            frame = controller.view.frame
            if frame and frame.phase == Phase.PLAYING and chance.random() < KEYS_HZ * _POLL_S:
                controller.press(1, chance.randrange(4))


def main() -> None:
    """Play until the input ends."""
    courts = json.loads(sys.stdin.readline())
    chance = random.Random(1)
    with ExitStack() as stack:
        players: list[_Player] = []
        for court in courts:
            players.append(_Player(court, stack))
            for player in players:
                player.poll(chance)
        for player in players:
            player.begin()
            for other in players:
                other.poll(chance)
        print(json.dumps({"courts": len(players)}), flush=True)
        while True:
            begin_s = time.monotonic()
            for player in players:
                player.poll(chance)
            wait_s = max(0.0, begin_s + _POLL_S - time.monotonic())
            if select.select([sys.stdin], [], [], wait_s)[0] and not sys.stdin.readline():
                return


if __name__ == "__main__":
    main()
