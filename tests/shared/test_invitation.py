"""Invitations: how they are written, read and refused."""

import os
from pathlib import Path

import msgspec
import pytest

from lacoc_client.commands import entrance
from lacoc_shared.contest.access import Access, invitation_text, read_invitation
from lacoc_shared.mistakes import UserError

WATCH = Access(
    court="main", connect="tls/court.example.org:7447", ca="-----BEGIN\nAB==\n-----END\n"
)
LEFT = WATCH.of_seat("left", 'a "token" \\ of left')
REFEREE = WATCH.of_referee("token of the referee")
GATEWAY = WATCH.of_gateway("token of the gateway")


def written(folder: Path, access: Access) -> Path:
    path = folder / f"{access.user}.toml"
    path.write_text(invitation_text(access, "Spring\n'contest' \x00"), encoding="utf-8")
    return path


@pytest.mark.parametrize("access", [WATCH, LEFT, REFEREE, GATEWAY], ids=lambda one: one.role)
def test_an_invitation_is_read_as_it_was_written(tmp_path: Path, access: Access) -> None:
    """An invitation is read exactly as it was written, with any characters in its token."""
    assert read_invitation(written(tmp_path, access)) == access


def test_an_address_in_an_invitation_may_be_short(tmp_path: Path) -> None:
    """An invitation that is written by hand may have a short address."""
    path = tmp_path / "mine.toml"
    path.write_text('court = "main"\nconnect = "10.0.0.7"\n')
    assert read_invitation(path).connect == "tcp/10.0.0.7:7447"
    path.write_text(path.read_text() + 'ca = "x"\n')
    assert read_invitation(path).connect == "tls/10.0.0.7:7447"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("court = 3", "court"),
        ('court = "main"', "connect"),
        ('court = "Main"\nconnect = "x"', '"Main"'),
        ('court = "main"\nconnect = "http://x"', '"http://x" is not an address'),
        ('court = "main"\nconnect = "x"\nrole = "king"', "role"),
        ("x" * 70_000, "bytes"),
        ("court = \n", "line 1"),
    ],
)
def test_what_is_no_invitation_is_said(tmp_path: Path, text: str, said: str) -> None:
    """A file that is no invitation is refused; the message names the file and the mistake."""
    path = tmp_path / "mine.toml"
    path.write_text(text)
    with pytest.raises(UserError, match=said) as caught:
        read_invitation(path)
    assert str(path) in str(caught.value)
    with pytest.raises(UserError, match="No such file"):
        read_invitation(tmp_path / "none.toml")


def test_an_invitation_is_for_one_role(tmp_path: Path) -> None:
    """An invitation works only for its own role, but every invitation lets its owner watch."""
    left, referee, gateway = (written(tmp_path, one) for one in (LEFT, REFEREE, GATEWAY))
    nothing = (None, None, None)

    assert entrance.seat(left, *nothing, None, None) == LEFT
    assert entrance.perhaps_seat(left, *nothing, None, None) == LEFT
    assert entrance.referee(referee, *nothing, None) == REFEREE
    assert entrance.gateway(gateway, *nothing) == GATEWAY
    assert entrance.gateway(left, *nothing) == WATCH
    for invitation in (left, referee, gateway):
        assert entrance.spectator(invitation, *nothing) == WATCH
    with pytest.raises(UserError, match="for the role of referee, not of contestant"):
        entrance.seat(referee, *nothing, None, None)
    with pytest.raises(UserError, match="for the role of contestant, not of referee"):
        entrance.referee(left, *nothing, None)


@pytest.mark.parametrize("place", range(5))
def test_an_invitation_stands_alone(tmp_path: Path, place: int) -> None:
    """No option for contest, court, address, seat or token may be given beside an invitation."""
    others = [None] * 5
    others[place] = "x"  # type: ignore[call-overload]
    with pytest.raises(UserError, match="do not give --contest"):
        entrance.seat(written(tmp_path, LEFT), *others)


def test_a_secret_is_not_shown_by_accident() -> None:
    """The `repr` of an access shows neither its token nor its password."""
    assert 'a "token"' not in repr(LEFT)
    assert LEFT.credentials is not None
    assert LEFT.credentials.password not in repr(LEFT.credentials)
    assert os.path.sep not in LEFT.user
    assert msgspec.structs.asdict(LEFT)["token"] == LEFT.token
