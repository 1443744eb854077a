"""Gives a contest tokens that a test knows."""

import json
from collections.abc import Iterable, Mapping
from pathlib import Path

from lacoc_shared.contest.file import secrets_path


def keep_tokens(
    contest: Path, seats: Mapping[str, str], referee: str, courts: Iterable[str] = ("main",)
) -> None:
    """Write the secrets file of a contest.

    Args:
        contest: the contest file.
        seats: tokens of the open seats, by name; all courts have the same.
        referee: token of all referees.
        courts: names of the courts.
    """
    tokens = {"office": "the token of the office", "standby": "the token of the standby"}
    for court in courts:
        tokens[f"referee.{court}"] = referee
        tokens |= {f"seat.{court}.{seat}": token for seat, token in seats.items()}
    secrets_path(contest).write_text(json.dumps(tokens))
