"""Tests of what people decided, as the sheet of a contest says it."""

from random import Random
from typing import Any

import pytest
from chance_event import Event
from cup import Cup

from lacoc_server.contest.league.decided import Decided, decided
from lacoc_server.contest.league.facts import (
    Closed,
    Disqualified,
    Entered,
    FilesChanged,
    NoShow,
    OfDecision,
    Planned,
    Replaced,
    Replay,
    StageSettings,
    Voided,
    Withdrawn,
    new,
)
from lacoc_server.contest.league.sheet import sheet
from lacoc_shared.words import render

TEAMS = ("t001", "t004")
GAME = {"pairing": "cup:w1.1", "game": 1, "teams": TEAMS, "reason": "why"}


def said(event: Event) -> list[str]:
    """Return what was decided, in words."""
    return [render(one.what) for one in decided(event.contest)]


@pytest.mark.parametrize(
    ("fact", "words"),
    [
        (new(Withdrawn, team="t002", reason="why"), "t002 has withdrawn"),
        (new(Disqualified, team="t002", reason="why"), "t002 is disqualified"),
        (new(Replay, **GAME), "Semi-final 1: t001 and t004 play again"),
        (
            new(Replaced, scores=(2, 7), outcome="right", **GAME),
            "Semi-final 1: the result is t001 2 : 7 t004",
        ),
        (
            new(Voided, pairing="cup:w1.1", teams=TEAMS, reason="why"),
            "Semi-final 1: the match of t001 and t004 counts for nobody",
        ),
        (
            new(NoShow, pairing="cup:w1.1", team="t004", reason="why"),
            "Semi-final 1: t004 did not come",
        ),
        (new(NoShow, pairing="gone:x9", team="t004", reason="why"), "gone:x9: t004 did not come"),
    ],
)
def test_each_decision_says_what_was_decided(fact: OfDecision, words: str) -> None:
    """A decision names its match as people read it, and its reason and time are kept."""
    cup = Cup("single-knockout")
    cup.now_ms = 9000
    placed = cup.append(fact)
    (one,) = decided(cup.contest)
    pairing = getattr(fact, "pairing", "")
    assert one == Decided(fact=placed.id, at_ms=9000, what=one.what, pairing=pairing, reason="why")
    assert render(one.what) == words


def test_the_game_of_a_longer_match_is_named() -> None:
    """A decision about a game of several names the game."""
    cup = Cup("single-knockout", games=3)
    cup.add(Replay, **{**GAME, "game": 2})
    assert said(cup) == ["Semi-final 1, game 2 of 3: t001 and t004 play again"]


@pytest.mark.parametrize(
    ("form", "settings", "pairing", "words"),
    [
        ("round-robin", {"groups": 2}, "cup:b1.1", "Group stage, group B, round 1"),
        ("round-robin", {}, "cup:a2.1", "Round robin, round 2"),
        ("single-knockout", {}, "cup:w1.2", "Knockout, round 1"),
    ],
)
def test_a_match_whose_draw_was_taken_back_is_named(
    form: str, settings: dict[str, Any], pairing: str, words: str
) -> None:
    """A decision of before is read with stage, group and round, and not with the match's id."""
    event = Event(8, 1, Random(1))
    event.add(Planned, stage="cup", format=form, settings=StageSettings(**settings))
    event.add(NoShow, pairing=pairing, team="t001", reason="why")
    assert said(event)[-1] == f"{words}: t001 did not come"


def test_other_files_are_a_decision_once_entries_are_closed() -> None:
    """While entries are open, a team changes its files as it likes."""
    event = Event(0, 1, Random(1))
    event.add(Entered, team="Bees", files="1")
    event.add(FilesChanged, team="Bees", files="2")
    event.add(Closed)
    event.add(FilesChanged, team="Bees", files="3", reason="motor")
    assert said(event) == ["Bees has other files after entries were closed"]


def test_the_sheet_has_the_newest_decision_first() -> None:
    """The sheet lists all decisions, also those that change nothing."""
    cup = Cup("single-knockout")
    facts = [cup.add(Withdrawn, team="t002"), cup.add(Withdrawn, team="nobody")]
    made = sheet("Cup", cup.contest)
    assert [one.fact for one in made.decided] == [fact.id for fact in reversed(facts)]
    assert [one.fact for one in made.unused] == [facts[1].id]
