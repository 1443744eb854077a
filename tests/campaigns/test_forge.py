"""Short runs of the campaigns of `forge` that attack over the network."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]


def forged(what: str, attempts: int) -> list[dict[str, Any]]:
    """Run a campaign, and return the results that it prints."""
    command = [sys.executable, "-m", f"tests.campaigns.forge.{what}", "--attempts", str(attempts)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr
    decoder, found, text = json.JSONDecoder(), [], done.stdout.strip()
    while text:
        one, end = decoder.raw_decode(text)
        found.append(one)
        text = text[end:].strip()
    return found


@pytest.mark.parametrize("attempts", [500, pytest.param(10_000, marks=pytest.mark.long)])
def test_no_role_does_what_is_anothers(attempts: int) -> None:
    """No forgery is accepted, no client overhears another, and the organiser still gets answers."""
    (found,) = forged("desk", attempts)
    assert found["right"]
    assert sum(found["attempts"].values()) == attempts
    assert not found["accepted"]
    asked = {"desk.not-organiser", "desk.no-such-team", "desk.name-taken", "desk.bad-request"}
    assert asked <= set(found["refused"]), "the forgeries did arrive"


@pytest.mark.slow
@pytest.mark.long(minutes=2)
def test_nothing_forged_is_accepted() -> None:
    """A court accepts no forgery.

    This holds with all protection, with tokens and seals alone, and with TLS.
    """
    found = forged("messages", 1000)
    assert [one["right"] for one in found] == [True] * 3
    assert {sum(one["accepted"].values()) for one in found} == {0}
    refused = found[1]["refused by the court"]["commands"]
    assert {"bad-seal", "old", "not-your-seat"} <= set(refused)  # so the forgeries did arrive
