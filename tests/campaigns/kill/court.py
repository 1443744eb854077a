"""`python -m tests.campaigns.kill.court`: kill a court at random moments of a match; it must go on.

A real court plays matches with two controllers and a referee. In each match the court is killed
(SIGKILL) at a random moment of each phase in `PLAN`, and each time started again on the same
records. The benchmark counts in which phase the court comes back, and measures the time until its
first frame. It also counts frames whose state hash differs from the record's, commands that were
lost after a frame had shown them as applied, decisions that were lost after their answer, and
records that don't verify.
"""

import json
import os
import random
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from arguments import arguments
from lacoc_process import ALONE, started
from ports import free_port

from lacoc_client.play.controller import Controller
from lacoc_client.play.referee import RefereeClient
from lacoc_server.journal.replay import verify
from lacoc_server.journal.verdict import Verdict, VerdictKind
from lacoc_shared.codec import decode
from lacoc_shared.contest.file import load
from lacoc_shared.contest.secrets import Secrets
from lacoc_shared.decisions import Adjust, Decision, Declare, Halt, Official, Resume, Start
from lacoc_shared.messages import DecisionReply, Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import Session, open_client
from lacoc_shared.record.files import record_paths
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import Phase
from lacoc_shared.words import render

P = Phase
BACK_IN = {P.PLAYING: P.HALTED, P.COUNTDOWN: P.HALTED}
"""The phase in which a killed court comes back, if it is not the phase of the kill."""
PLAN = (P.LOBBY, P.READY, P.COUNTDOWN, P.PLAYING, P.HALTED, P.PLAYING, P.PLAYING, P.FINISHED)
"""The phases in which the court is killed during a match, in this order."""
MOST_DELAY_S = 0.6
WAIT_S = 30.0


@dataclass
class Figures:
    """Counts over all kills."""

    kills: int = 0
    back: Counter[str] = field(default_factory=Counter)
    wrong_phase: int = 0
    ready_s: list[float] = field(default_factory=list)
    frames: int = 0
    differing_hashes: int = 0
    commands: int = 0
    lost_commands: int = 0
    decisions: int = 0
    lost_decisions: int = 0
    verified: int = 0
    not_same: list[str] = field(default_factory=list)

    @property
    def wrong(self) -> int:
        """Return how much was wrong or lost; 0: all is right."""
        bad = self.wrong_phase + self.differing_hashes + self.lost_commands
        return bad + self.lost_decisions + len(self.not_same)


def main() -> None:
    """Kill courts, and print the counts."""
    options = arguments(__doc__, kills=100, seed=1)
    figures = killed(options.kills, options.seed)
    print(json.dumps({**figures.__dict__, "ready_s": _spread(figures.ready_s)}))
    sys.exit(bool(figures.wrong))


def killed(kills: int, seed: int, *, fresh: bool = True) -> Figures:
    """Kill courts, and print the counts after each match.

    Args:
        kills: how many at least.
        seed: chooses the moments.
        fresh: whether each court gets a new interpreter, as the time until it is back needs it.
    """
    chance = random.Random(seed)
    figures = Figures()
    while figures.kills < kills:
        with tempfile.TemporaryDirectory() as folder:
            _Trial(Path(folder), chance, figures, fresh).run()
        print(
            f"{figures.kills} kills: {figures.wrong_phase} in a wrong phase, "
            f"{figures.differing_hashes} hashes of {figures.frames} differ, lost "
            f"{figures.lost_commands} of {figures.commands} commands and "
            f"{figures.lost_decisions} of {figures.decisions} decisions; "
            f"{figures.verified} records same, not same: {figures.not_same}",
            flush=True,
        )
    return figures


def _spread(times_s: list[float]) -> str:
    return f"median {statistics.median(times_s):.2f} s, worst {max(times_s):.2f} s"


class _Trial:
    """One match, whose court is killed as planned."""

    def __init__(self, folder: Path, chance: random.Random, figures: Figures, fresh: bool) -> None:
        self._folder = folder / "recordings"
        self._contest = folder / "contest.toml"
        self._contest.write_text(_contest())
        self._chance = chance
        self._figures = figures
        self._fresh = fresh
        self._process: subprocess.Popen[Any] | None = None
        self._answered: list[DecisionReply] = []
        self._seen: dict[int, Frame] = {}

    def run(self) -> None:
        plan = load(self._contest)
        name, court = plan.court()
        with ExitStack() as stack:
            stack.callback(self._stop)
            self._serve()
            session = stack.enter_context(open_client([court.address()], timeout_s=WAIT_S))
            self._controllers = _controllers(session, name, plan.secrets)
            self._referee = RefereeClient(session, name, plan.secrets.referee(name))
            for phase in PLAN:
                self._reach(phase)
                self._wait(self._chance.uniform(0, MOST_DELAY_S))
                self._kill_and_compare()
            self._decide(Official())
        self._check_record()

    def _serve(self) -> None:
        words = (str(self._contest), "--json", "--recordings", str(self._folder))
        self._process = started(ALONE, *words, fresh=self._fresh, stdout=subprocess.PIPE, text=True)

    def _stop(self) -> None:
        assert self._process is not None
        if (code := self._process.poll()) is not None:
            print(f"the court had ended with {code}", file=sys.stderr)
        self._process.terminate()
        self._process.communicate(timeout=WAIT_S)

    # Playing at the court

    @property
    def _frame(self) -> Frame:
        frame = self._controllers[0].view.frame
        assert frame is not None
        return frame

    def _poll(self, timeout_s: float = 0.01) -> None:
        for controller in self._controllers:
            if controller.wait_frame(timeout_s) is not None and controller.view.frame:
                self._seen[controller.view.frame.beat] = controller.view.frame
        if self._seen and self._frame.phase == P.PLAYING and self._chance.random() < 0.1:
            controller = self._chance.choice(self._controllers)
            controller.press(1, self._chance.choice((0, 1, 2, 3)))

    def _wait(self, seconds: float) -> None:
        end_s = time.monotonic() + seconds
        while time.monotonic() < end_s:
            self._poll()

    def _until(self, true: Callable[[], bool]) -> None:
        end_s = time.monotonic() + WAIT_S
        while not true():
            if time.monotonic() > end_s:
                raise TimeoutError(f"still {Phase(self._frame.phase).name}")
            self._poll()

    def _decide(self, decision: Decision) -> None:
        self._answered.append(self._referee.decide(decision, "a trial", "trial"))

    def _reach(self, phase: Phase) -> None:
        """Bring the match from an earlier phase, or from a halt, into this phase."""
        self._until(lambda: bool(self._seen))
        while (now := Phase(self._frame.phase)) is not phase:
            if now is P.LOBBY and phase > P.LOBBY:
                for controller in self._controllers:
                    controller.ready()
                self._until(lambda: self._frame.phase != P.LOBBY)
            elif now is P.READY:
                self._decide(Start())
                self._until(lambda: self._frame.phase != P.READY)
            elif now is P.PLAYING and phase in (P.HALTED, P.FINISHED):
                self._wait(0.3)
                self._decide(Halt())
                self._until(lambda: self._frame.phase != P.PLAYING)
            elif now is P.HALTED and phase is P.FINISHED:
                self._decide(Declare("draw"))
                self._until(lambda: self._frame.phase == P.FINISHED)
            elif now is P.HALTED:
                self._decide(Adjust("left", self._chance.randint(1, 9)))
                self._decide(Resume())
                self._until(lambda: self._frame.phase != P.HALTED)
            else:
                self._until(lambda now=now: self._frame.phase != now)  # type: ignore[misc]

    # The kill

    def _kill_and_compare(self) -> None:
        assert self._process is not None
        figures = self._figures
        os.kill(self._process.pid, signal.SIGKILL)
        self._process.communicate()
        for controller in self._controllers:
            controller.poll(time.monotonic())
        before = self._frame
        old_health = self._controllers[0].view.health
        begin_s = time.monotonic()
        self._serve()
        # The frames of the court that came back are those that arrive from now on.
        self._until(lambda: self._controllers[0].view.frame_s > begin_s)
        figures.ready_s.append(time.monotonic() - begin_s)
        # The first beat may still have the phase of the kill: the halt is an input of the next one.
        wanted = BACK_IN.get(Phase(before.phase), Phase(before.phase))
        after = self._settled(wanted)
        figures.kills += 1
        figures.back[f"{Phase(before.phase).name} -> {Phase(after.phase).name}"] += 1
        figures.wrong_phase += after.phase != wanted
        for old, new in zip(before.seats, after.seats, strict=True):
            figures.commands += old.applied_seq
            figures.lost_commands += max(0, old.applied_seq - new.applied_seq)
        self._until(lambda: self._controllers[0].view.health is not old_health)
        self._until(lambda: all(self._is_held(c) for c in self._controllers))

    def _settled(self, wanted: Phase) -> Frame:
        end_s = time.monotonic() + 2.0
        while self._frame.phase != wanted and time.monotonic() < end_s:
            self._poll()
        return self._frame

    def _is_held(self, controller: Controller) -> bool:
        """Return whether the court that came back gave the seat back to its controller."""
        health = controller.view.health
        return (
            controller.hold.value == "held"
            and health is not None
            and all(seat.session for seat in health.seats if seat.id == controller.seat)
        )

    def _check_record(self) -> None:
        """Compare all that was seen and answered with the record, and verify the record."""
        figures = self._figures
        end_s = time.monotonic() + WAIT_S
        while not (packed := [p for p in self._folder.glob("*.mcap") if ".live" not in p.name]):
            if time.monotonic() > end_s:
                break
            time.sleep(0.1)
        segments = sorted(self._folder.glob("*.live.mcap"))
        record = Record.read(packed[0] if packed else record_paths(segments[-1]))
        recorded = {beat: decode(frame, Frame) for beat, frame in record.frames}
        for beat, frame in self._seen.items():
            if beat in recorded:  # beats in which nothing happened have no frame
                figures.frames += 1
                figures.differing_hashes += recorded[beat].digest != frame.digest
        numbers = {event.number: event for event in record.events}
        for reply in self._answered:
            figures.decisions += 1
            found = numbers.get(reply.event or 0)
            figures.lost_decisions += found is None or found.beat != reply.beat
        *_, verdict = verify(record)
        assert isinstance(verdict, Verdict)
        if verdict.kind is VerdictKind.SAME:
            figures.verified += 1
        else:
            figures.not_same.append(render(verdict.said))


def _controllers(session: Session, name: str, secrets: Secrets) -> list[Controller]:
    end_s = time.monotonic() + WAIT_S
    while True:
        try:
            controllers = [
                Controller(session, name, seat, secrets.seat(name, seat), f"Team {seat}")
                for seat in ("left", "right")
            ]
            break
        except UserError:
            if time.monotonic() > end_s:
                raise
    for controller in controllers:
        controller.join()
    return controllers


def _contest() -> str:
    port = free_port()
    return f"""
[court.main]
arena = "othello"
listen = ["tcp/127.0.0.1:{port}"]
settings.match.countdown_s = 0.7
"""


if __name__ == "__main__":
    main()
