"""Tests of the file that has all tokens of a contest."""

import json
import stat
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from lacoc_shared.contest import file as contests
from lacoc_shared.contest.secrets import Secrets
from lacoc_shared.mistakes import UserError


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "contest.secrets.json"


def test_each_token_is_made_when_it_is_first_asked_for(path: Path) -> None:
    """A token stays the same for everybody who reads the file, and all tokens differ."""
    secrets = Secrets(path)
    assert not path.exists()
    asked = [secrets.team("Ants"), secrets.referee("red"), secrets.seat("red", "left")]
    asked += [secrets.office, secrets.standby, secrets.team("red"), secrets.seat("blue", "left")]
    other = Secrets(path)
    again = [other.team("Ants"), other.referee("red"), other.seat("red", "left")]
    again += [other.office, other.standby, other.team("red"), other.seat("blue", "left")]
    assert asked == again
    assert len({*asked}) == len(asked)
    assert len(asked[0]) == 26


def test_only_its_owner_can_read_it(path: Path) -> None:
    """The file has mode 0600 from its first byte on; nothing else is readable beside it."""
    Secrets(path).referee("red")
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert all(not one.read_bytes() for one in path.parent.iterdir() if one != path)


def test_a_token_opens_for_a_team_alone(path: Path) -> None:
    """Only tokens of teams are of a team; a forgotten one opens nothing, and a new one is made."""
    secrets = Secrets(path)
    first = secrets.team("Ants")
    assert secrets.team_of(first) == "Ants"
    assert secrets.team_of(secrets.office) is None
    assert secrets.team_of(secrets.referee("Ants")) is None
    assert secrets.team_of("") is None
    secrets.forget("Ants", "nobody")
    assert secrets.team_of(first) is None
    assert secrets.team("Ants") != first


def test_a_token_can_be_replaced_by_hand(path: Path) -> None:
    """Whoever reads the file next has the new one; a removed one is made again."""
    secrets = Secrets(path)
    before = secrets.referee("red"), secrets.office
    tokens = json.loads(path.read_text())
    path.write_text(json.dumps(tokens | {"referee.red": "another whistle"}))
    assert (secrets.referee("red"), secrets.office) == ("another whistle", before[1])
    del tokens["referee.red"]
    path.write_text(json.dumps(tokens))
    assert secrets.referee("red") not in (before[0], "another whistle")


def test_many_programs_make_tokens_at_once(path: Path) -> None:
    """No token is lost, and everybody gets the same one."""
    readers = [Secrets(path) for _ in range(4)]
    names = [f"Team {number % 5}" for number in range(40)]
    with ThreadPoolExecutor(8) as pool:
        made = [*pool.map(lambda n: (n[1], readers[n[0] % 4].team(n[1])), enumerate(names))]
    assert len({*made}) == 5
    assert dict(made) == {name: Secrets(path).team(name) for name in {*names}}


def test_a_copy_must_have_the_tokens(path: Path) -> None:
    """On another machine no token is made: it would be another one than the office's."""
    secrets = Secrets(path)
    with pytest.raises(UserError, match="lacks tokens of this contest"):
        secrets.check_copied()
    secrets.referee("red")
    secrets.check_copied("red")
    with pytest.raises(UserError, match=r"contest\.secrets\.json lacks"):
        secrets.check_copied("red", "blue")
    assert "referee.blue" not in path.read_text()


def test_what_can_not_be_read_is_said(path: Path) -> None:
    """A damaged file is named, and not replaced."""
    path.write_text("{")
    with pytest.raises(UserError, match=r"contest\.secrets\.json"):
        Secrets(path).team("Ants")
    assert path.read_text() == "{"


def test_it_is_beside_the_contest_file(tmp_path: Path) -> None:
    """Its name is made from the contest file's; reading a contest makes no token."""
    contest = contests.loads(b"[court.red]\n", tmp_path / "cup.toml")
    assert [*tmp_path.iterdir()] == []
    assert contest.secrets.referee("red") in (tmp_path / "cup.secrets.json").read_text()
