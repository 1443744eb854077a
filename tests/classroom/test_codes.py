"""Tests of class codes, and of those who guess them."""

import pytest

from lacoc_client.web.gateway.guesses import Guesses
from lacoc_shared.contest.codes import new_code, read_code


@pytest.mark.parametrize("code", [new_code() for _ in range(20)], ids=range(20))
def test_a_code_is_read_as_it_was_meant(code: str) -> None:
    """A class code may be typed with small letters, spaces, hyphens or full-width letters."""
    assert len(code) == 6
    assert read_code(code) == code
    wide = "".join(chr(ord(letter) + 0xFEE0) for letter in code.lower())
    for typed in (code.lower(), f" {code[:3]} {code[3:]} ", f"{code[:3]}-{code[3:]}", wide):
        assert read_code(typed) == code


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
    assert len(guesses._machines._senders) == 1000
