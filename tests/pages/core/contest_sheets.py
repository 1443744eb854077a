"""Prints the sheets of contests with random results, for contest.test.mjs."""

import itertools
import json
import sys
from collections.abc import Iterator
from random import Random

from chance_event import Event

from lacoc_server.contest.league.sheet import encode, sheet


def sheets() -> Iterator[tuple[str, Event]]:
    """Play contests of several formats, some of them not to their end; yield names and events."""
    yield "entered", Event(16, 2, Random(1))
    event = Event(8, 2, Random(1))
    event.begin("groups", "round-robin", event.names, groups=2)
    played = event.play("groups")
    for _ in itertools.islice(played, 4):
        pass
    yield "groups", event
    for _ in played:
        pass
    best = list(event.contest.stage("groups").ranking[:4])
    event.begin("finals", "single-knockout", best, games=3, third_place=True)
    for _ in event.play("finals"):
        pass
    yield "finals", event
    for name, stage, teams, steps in (
        ("single", "single-knockout", 13, 9),
        ("double", "double-knockout", 21, 30),
        ("swiss", "swiss", 31, 40),
    ):
        event = Event(teams, 3, Random(teams))
        event.begin("cup", stage, event.names, third_place=True, rounds=4)
        for _ in itertools.islice(event.play("cup"), steps):
            pass
        yield name, event


def main() -> None:
    """Print the sheets as JSON, by name."""
    made = {name: json.loads(encode(sheet("Cup", event.contest))) for name, event in sheets()}
    json.dump(made, sys.stdout)


if __name__ == "__main__":
    main()
