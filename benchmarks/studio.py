"""Measures how long a studio takes to answer trials: for one student, and for a whole class.

python -m benchmarks.studio --students 30 --seconds 60

In the class, each student tries another gait every 10 s. For comparison, the same trial is also
timed in this process, without a network.
"""

import argparse
import os
import random
import sys
import time
from dataclasses import dataclass, field
from statistics import median

from processes import LACOC, read_line, started

from benchmarks.trials import course_of, entry_of
from lacoc_server.studio.answers import answer
from lacoc_shared.codec import encode
from lacoc_shared.gait.tables import LocomotionTable, Posture
from lacoc_shared.gait.text import write_gait
from lacoc_shared.messages import PROTOCOL, SentFile
from lacoc_shared.network.session import Question, open_client
from lacoc_shared.studio import GaitFiles, StudioKeys, TrialRequest

_ROBOT = "hexapod"
_NOISE_RAD = 0.05
_LIMIT_S = 60.0
_LOOK_S = 0.002
_ALONE_AIM_S, _CLASS_AIM_S = 1.0, 2.0
_EVERY_S = 10.0


@dataclass
class Student:
    """A student who asks for trials."""

    due_s: float
    """When to ask for the next trial [s]."""
    asked_s: float = 0.0
    """When the last trial was asked for [s]."""
    question: Question | None = None
    """The trial that has not been answered yet."""
    took_s: list[float] = field(default_factory=list)
    """How long each answered trial took [s]."""


def main() -> None:
    """Measure, print, and exit with 1 if the aims are missed."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.studio", description=__doc__)
    parser.add_argument("--students", type=int, default=30)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    options = parser.parse_args()
    rng = random.Random(1)
    alone_s = bare_s(rng)
    print(f"bare trial, in one process            {alone_s:.3f} s")
    words = ("studio", "--json", "--jobs", str(options.jobs), "--listen", "tcp/127.0.0.1:0")
    with started(LACOC, *words) as process:
        opened = read_line(process)
        key = StudioKeys(opened["studio"]).request("trial")
        with open_client(opened["locators"]) as session:
            for _ in range(2 * options.jobs):  # every process compiles its floor once
                session.ask(key, _request(rng), _LIMIT_S)
            alone = []
            for _ in range(20):
                begin_s = time.perf_counter()
                session.ask(key, _request(rng), _LIMIT_S)
                alone.append(time.perf_counter() - begin_s)
            _print("one student alone", alone, alone_s)
            begin_s = time.perf_counter()
            students = [
                Student(begin_s + _EVERY_S * index / options.students)
                for index in range(options.students)
            ]
            while time.perf_counter() < begin_s + options.seconds:
                for student in students:
                    now_s = time.perf_counter()
                    if student.question is None and now_s >= student.due_s:
                        student.question = session.question(key, _request(rng), _LIMIT_S)
                        student.asked_s, student.due_s = now_s, student.due_s + _EVERY_S
                    elif student.question is not None and student.question.take() is not None:
                        student.took_s.append(time.perf_counter() - student.asked_s)
                        student.question = None
                time.sleep(_LOOK_S)
    together = [took for student in students for took in student.took_s]
    _print(f"{options.students} students, each every {_EVERY_S:.0f} s", together, alone_s)
    sys.exit(_p95(alone) > _ALONE_AIM_S or _p95(together) > _CLASS_AIM_S)


def _request(rng: random.Random) -> bytes:
    """Make a request for a trial of the sample gait with random changes."""
    entry = entry_of(_ROBOT)
    assert entry.gait.locomotion is not None

    def changed(posture: Posture) -> Posture:
        return tuple(angle + rng.uniform(-_NOISE_RAD, _NOISE_RAD) for angle in posture)

    sequences = tuple(
        tuple(changed(posture) for posture in sequence)
        for sequence in entry.gait.locomotion.sequences
    )
    sent = SentFile("LocoTra-data.txt", write_gait(LocomotionTable(sequences), entry.robot.labels))
    return encode(TrialRequest(protocol=PROTOCOL, files=GaitFiles(locomotion=sent)))


def bare_s(rng: random.Random) -> float:
    """Return the median time of a trial in this process, on a floor that is already compiled."""
    course = course_of(_ROBOT)
    times = []
    for _ in range(10):
        request = _request(rng)
        begin_s = time.perf_counter()
        assert answer("trial", request, lambda _: course).right
        times.append(time.perf_counter() - begin_s)
    return median(times)


def _p95(times_s: list[float]) -> float:
    return sorted(times_s)[int(0.95 * (len(times_s) - 1))]


def _print(what: str, times_s: list[float], bare_s: float) -> None:
    middle_s, high_s = median(times_s), _p95(times_s)
    print(
        f"{what:37} {middle_s:.3f} s median, {high_s:.3f} s p95 of {len(times_s)} trials "
        f"({middle_s / bare_s:.2f} and {high_s / bare_s:.2f} of the bare trial)"
    )


if __name__ == "__main__":
    main()
