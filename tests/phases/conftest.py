"""Fixtures for the tests of the phases: real trials by the studio's code, in this process."""

from collections.abc import Callable
from pathlib import Path

import pytest

from lacoc_client.workshop.phases.facts import TrialFacts, trial_facts
from lacoc_server.studio.floors import answered
from lacoc_shared.codec import decode, encode
from lacoc_shared.gait.tables import LocomotionTable, Posture, PostureTable
from lacoc_shared.gait.text import read_gait, write_gait
from lacoc_shared.messages import PROTOCOL, SentFile
from lacoc_shared.studio import TRIAL_REPLY_MAX_BYTES, GaitFiles, TrialReply, TrialRequest

SAMPLE = Path(__file__).parents[2] / "robots/lacoc_robots/samples/hexapod/Loco-data.txt"
LEGS = ("R,F", "R,C", "R,B", "L,B", "L,C", "L,F")

Asks = Callable[..., TrialReply]
Tries = Callable[..., TrialFacts]


@pytest.fixture(scope="session")
def sample() -> dict[int, Posture]:
    """Give the postures of the workshop's sample gait by key [rad]."""
    table = read_gait(SAMPLE.read_bytes(), SAMPLE.name)
    assert isinstance(table, PostureTable)
    return table.postures


@pytest.fixture(scope="session")
def ask_trial() -> Asks:
    """Give a function that tries postures or sequences on the workshop's robot.

    Unless `sequences` says otherwise, a trial of postures has two keys at level B: 0 stands in
    posture 0; 1 repeats postures 1 to 4.
    """
    answers: dict[bytes, TrialReply] = {}

    def ask(
        gait: dict[int, Posture] | LocomotionTable,
        keys: str,
        seconds: float | None = None,
        sequences: tuple[tuple[int, ...], ...] = ((0,), (1, 2, 3, 4)),
    ) -> TrialReply:
        if isinstance(gait, LocomotionTable):
            files = GaitFiles(locomotion=SentFile("LocoTra-data.txt", write_gait(gait, LEGS)))
        else:
            data = write_gait(PostureTable(gait), LEGS)
            files = GaitFiles(postures=SentFile("Loco-data.txt", data), sequences=sequences)
        request = TrialRequest(protocol=PROTOCOL, files=files, keys=keys, seconds=seconds)
        asked = encode(request)
        if asked not in answers:
            answer = answered("trial", asked)
            assert answer.right, answer.payload
            answers[asked] = decode(answer.payload, TrialReply, TRIAL_REPLY_MAX_BYTES)
        return answers[asked]

    return ask


@pytest.fixture(scope="session")
def try_gait(ask_trial: Asks) -> Tries:
    """Give a function that returns the facts of a trial; it takes the arguments of `ask_trial`."""

    def tried(
        gait: dict[int, Posture] | LocomotionTable, keys: str, seconds: float | None = None
    ) -> TrialFacts:
        return trial_facts(ask_trial(gait, keys, seconds), keys)

    return tried
