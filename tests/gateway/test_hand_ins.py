"""Tests of how often files may be handed in to a contest's office."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_client.web.office.hand_ins import HandIns
from lacoc_shared.codec import encode
from lacoc_shared.messages.desk import Apply, ChangeFiles, Own, TeamFiles
from lacoc_shared.mistakes import UserError


def _let_in(hand_ins: HandIns, machine: str, request: object, now_s: float) -> bool:
    try:
        hand_ins.count(machine, encode(request), now_s)
    except UserError:
        return False
    return True


def test_a_machine_can_not_fill_the_list_and_a_school_can_enter() -> None:
    """A machine applies 80 times at once, then once a minute; another machine is not affected."""
    hand_ins, applied = HandIns(), Apply(secret="K7QM3X", team="Bees", files=TeamFiles())
    flood = [_let_in(hand_ins, "10.0.0.9", applied, 100 + n / 100) for n in range(10_000)]
    assert sum(flood) == 80 + 1
    school = [_let_in(hand_ins, "10.0.0.8", applied, 150.0) for _ in range(2 * 35)]
    assert all(school)
    assert _let_in(hand_ins, "10.0.0.9", Own(secret="token"), 200.0)


def test_a_team_can_not_keep_the_scales_busy() -> None:
    """A team changes its files ten times at once, then every 10 s; another team is not affected."""
    hand_ins = HandIns()
    mine, other = (ChangeFiles(secret=secret, files=TeamFiles()) for secret in ("mine", "other"))
    assert sum(_let_in(hand_ins, "10.0.0.9", mine, 100.0) for _ in range(50)) == 10
    assert _let_in(hand_ins, "10.0.0.9", other, 100.0)
    assert not _let_in(hand_ins, "10.0.0.9", mine, 105.0)
    assert _let_in(hand_ins, "10.0.0.9", mine, 110.1)


@given(st.binary(max_size=300))
def test_what_is_no_request_is_left_to_the_desk(request: bytes) -> None:
    """Any bytes pass, because the desk answers what is wrong with them."""
    HandIns().count("10.0.0.9", request, 100.0)


@pytest.mark.parametrize("request_", [{"do": 3}, {"do": "apply", "secret": 7}, [1, 2]])
def test_odd_requests_raise_nothing(request_: object) -> None:
    """A request with fields of other kinds is left to the desk too."""
    HandIns().count("10.0.0.9", encode(request_), 100.0)
