"""Tests of who may come into a class: class codes, nicknames and guesses."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_client.classroom.admission import (
    _UNSEEN,
    read_name,
    same_name,
)
from lacoc_client.gateway.guesses import Guesses
from lacoc_shared.contest.codes import new_code, read_code
from lacoc_shared.mistakes import UserError


@pytest.mark.parametrize("code", [new_code() for _ in range(20)], ids=range(20))
def test_a_code_is_read_as_it_was_meant(code: str) -> None:
    """A class code may be typed with small letters, spaces, hyphens or full-width letters."""
    assert len(code) == 6
    assert read_code(code) == code
    wide = "".join(chr(ord(letter) + 0xFEE0) for letter in code.lower())
    for typed in (code.lower(), f" {code[:3]} {code[3:]} ", f"{code[:3]}-{code[3:]}", wide):
        assert read_code(typed) == code


@given(st.text())
def test_a_name_is_short_text_that_can_be_seen(text: str) -> None:
    """Any text is refused as a nickname, or becomes 1 to 20 characters without needless spaces."""
    try:
        name = read_name(text)
    except UserError:
        name = None
    if name is None:
        signs = " ".join(text.split())
        assert not 1 <= len(signs) <= 20 or not text.isprintable() or not _UNSEEN.sub("", signs)
    else:
        assert 1 <= len(name) <= 20
        assert name.isprintable()
        assert name == " ".join(name.split()) == read_name(name)


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
    assert same_name(read_name(one)) == same_name(read_name(other))


@pytest.mark.parametrize(
    "name",
    ["\u3164", "\u2800", "\ufe0f", "\u115f \u1160", "An\u202ena", "An\u200bna", "\x07", "\u00ad"],
)
def test_a_name_that_nobody_sees_is_refused(name: str) -> None:
    """A nickname is refused if nothing of it can be seen, or if it has unprintable characters."""
    with pytest.raises(UserError):
        read_name(name)


def test_a_thousand_guesses_disturb_nobody_else() -> None:
    """After 20 quick guesses of a class code, a machine waits 1 s for each answer; others don't."""
    guesses = Guesses()
    waits_s = [guesses.wait_s("10.0.0.9", 100 + guess / 1000) for guess in range(1000)]
    assert waits_s == [0.0] * 20 + [1.0] * 980
    assert guesses.wait_s("10.0.0.8", 101.0) == 0.0
    assert guesses.wait_s("10.0.0.9", 104.0) == 0.0


def test_guesses_of_many_machines_need_no_more_room() -> None:
    """Guesses are remembered for only the 1000 machines that guessed last."""
    guesses = Guesses()
    for number in range(3000):
        assert guesses.wait_s(str(number), 1.0) == 0.0
    assert len(guesses._machines) == 1000
