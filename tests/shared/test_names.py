"""Tests of names that people choose."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_shared.contest.names import (
    _UNSEEN,
    look_alike,
    read_name,
    same_name,
    told_apart,
)

MOST = 20


@given(st.text())
def test_a_name_is_short_text_that_can_be_seen(text: str) -> None:
    """Any text is refused as a nickname, or becomes 1 to 20 characters without needless spaces."""
    name = read_name(text, MOST)
    if name is None:
        signs = " ".join(text.split())
        assert not 1 <= len(signs) <= 20 or not text.isprintable() or not _UNSEEN.sub("", signs)
    else:
        assert 1 <= len(name) <= 20
        assert name.isprintable()
        assert name == " ".join(name.split()) == read_name(name, MOST)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("Anna", "ANNA"),
        ("ｱﾝﾅ", "アンナ"),
        ("Ｂｅｎ", "ben"),
        ("Jose\u0301", "José"),
        ("Anna", "An\ufe0fna\u3164"),
        ("An na", "An \u2800na"),
        ("❤", "❤\ufe0f"),
    ],
)
def test_names_that_hardly_differ_are_the_same(one: str, other: str) -> None:
    """Nicknames that differ in capitals, widths or what can't be seen count as the same one."""
    names = [read_name(one, MOST), read_name(other, MOST)]
    assert same_name(names[0]) == same_name(names[1])
    assert look_alike(*names)


@pytest.mark.parametrize(
    "name",
    ["\u3164", "\u2800", "\ufe0f", "\u115f \u1160", "An\u202ena", "An\u200bna", "\x07", "\u00ad"],
)
def test_a_name_that_nobody_sees_is_refused(name: str) -> None:
    """A nickname is refused if nothing of it can be seen, or if it has unprintable characters."""
    assert read_name(name, MOST) is None


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("Bees", "\u0412\u0435es"),
        ("Bees", "\u0412\u0435\u0435s"),
        ("Otto 1", "Otto l"),
        ("Team 0", "Team O"),
        ("ロボ", "口ボ"),
        ("rnars", "mars"),
    ],
)
def test_names_that_look_alike(one: str, other: str) -> None:
    """Letters of other alphabets, and digits like letters, make no name that can be told apart."""
    assert look_alike(one, other)
    assert look_alike(other, one)


@pytest.mark.parametrize(
    ("one", "other"),
    [("Bees", "Ants"), ("Ai", "Al"), ("Mia", "Mla"), ("カエル", "カニ"), ("Ants 1", "Ants 2")],
)
def test_names_that_people_tell_apart(one: str, other: str) -> None:
    """Other names stay possible, also if they differ in a single letter."""
    assert not look_alike(one, other)


@pytest.mark.parametrize(
    ("name", "others", "told"),
    [
        ("planner", [], "planner"),
        ("planner", ["straight"], "planner"),
        ("planner", ["Planner"], "planner (right)"),
        ("planner (right)", ["planner (right)"], "planner (right)"),
        ("a name of twenty-four ch", ["a name of twenty-four ch"], "a name of twenty (right)"),
    ],
)
def test_names_beside_each_other_are_told_apart(name: str, others: list[str], told: str) -> None:
    """A name that looks like another one gets its side, and is shortened for it if need be."""
    assert told_apart(name, others, "right", 24) == told
