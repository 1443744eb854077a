"""Tests of `lacoc contest`: its file is private and valid, and `check` finds wrong settings."""

import json
import re
import stat
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
import trustme
from typer.testing import CliRunner

from lacoc_arenas import arena as arenas
from lacoc_server.commands import serve
from lacoc_server.commands.contest.app import app
from lacoc_server.contest.kept.plans import game, plans
from lacoc_shared.contest import file as contests
from lacoc_shared.mistakes import UserError


def run(*args: str) -> str:
    result = CliRunner().invoke(app, args)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result.stdout


@pytest.mark.parametrize(
    ("arena", "seats"),
    [
        ("othello", ["left", "right"]),
        ("flag-strike", ["left", "right"]),
        ("practice", ["solo"]),
    ],
)
def test_a_new_file_is_right_for_every_arena(tmp_path: Path, arena: str, seats: list[str]) -> None:
    """The file that `init` writes passes `check` and has the seats of its arena."""
    file = tmp_path / "contest.toml"
    run("init", str(file), "--arena", arena)

    assert "has no mistakes" in run("check", str(file))
    court = contests.load(file).courts["main"]
    assert court.arena == arena
    assert list(court.seat) == seats


def test_a_new_file_is_its_owners_alone_and_keeps_the_older(tmp_path: Path) -> None:
    """A new file has mode 0600, because it holds tokens; an older file is renamed and kept."""
    file = tmp_path / "contest.toml"
    run("init", str(file))
    first = file.read_text()
    run("init", str(file))

    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    assert (tmp_path / "contest.1.toml").read_text() == first
    assert file.read_text() != first


def test_a_team_may_have_its_own_look(tmp_path: Path) -> None:
    """Rules 4: a seat's colour and pattern in the contest file replace the arena's.

    The other seat keeps the arena's look. A colour that is no code such as #009e73 is refused.
    """
    file = tmp_path / "contest.toml"
    run("init", str(file))
    text = file.read_text()
    own = '[court.main.seat.right]\ncolour = "#009e73"\npattern = "dots"\n'
    file.write_text(text.replace("[court.main.seat.right]\n", own))
    assert "has no mistakes" in run("check", str(file))
    court = contests.load(file).courts["main"]
    left, right = arenas.load(court.arena, court.settings, court.looks).seats
    assert (right.colour, right.pattern) == ("#009e73", "dots")
    assert left == arenas.load(court.arena).seats[0]
    file.write_text(text.replace("[court.main.seat.right]\n", own.replace("#009e73", "green")))
    with pytest.raises(UserError, match=r"court\.main\.seat\.right"):
        contests.load(file)


def test_show_as_json(tmp_path: Path) -> None:
    """`show --json` gives a command line for each seat, for the referee and for spectators.

    The command line of a seat has the host that `--host` names, and the seat's token.
    """
    file = tmp_path / "contest.toml"
    run("init", str(file), "--court", "hall")
    lines = json.loads(run("show", str(file), "--json", "--host", "10.0.0.1"))

    left = contests.load(file).courts["hall"].seat["left"].token
    assert list(lines["hall"]) == ["left", "right", "referee", "spectators"]
    assert lines["hall"]["left"] == (
        f"lacoc play --court hall --connect tcp/10.0.0.1:7447 --seat left --token {left}"
    )


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('arena = "othello"', 'arena = "chess"', "no arena .chess."),
        ("# duration_s = 120.0", 'duration_s = "long"', "duration_s"),
        ("# duration_s = 120.0", "duratoin_s = 1.0", "duratoin_s"),
        ("# legs_max = 8", "legs_maxx = 8", "legs_maxx"),
        ("[court.main.seat.left]", "[court.main.seat.middle]", "left and right.*middle and right"),
    ],
)
def test_check_looks_into_arena_and_limits(tmp_path: Path, old: str, new: str, said: str) -> None:
    """`check` finds a wrong arena, setting, limit or seat before a court starts."""
    file = tmp_path / "contest.toml"
    run("init", str(file))
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))

    with pytest.raises(UserError, match=said):
        run("check", str(file))


def test_check_finds_all_mistakes_at_once(tmp_path: Path) -> None:
    """Limits, courts and stages are all looked at, whatever is wrong with the others."""
    file = tmp_path / "contest.toml"
    run("init", str(file))
    text = file.read_text()
    for old, new in (("# legs_max = 8", "legs_maxx = 8"), ('arena = "othello"', 'arena = "chess"')):
        assert old in text
        text = text.replace(old, new)
    file.write_text(text + '\n[stage.show]\nformat = "cup"\n')
    with pytest.raises(UserError) as caught:
        run("check", str(file))
    limit, court, stage = str(caught.value).splitlines()
    assert "legs_maxx" in limit
    assert court.startswith('[court.main]: There is no arena "chess".')
    assert "[stage.show]" in stage


def test_the_length_of_an_events_games_is_a_commented_line(tmp_path: Path) -> None:
    """The lines of `init --event` that set the length are right if they are uncommented."""
    file = tmp_path / "contest.toml"
    run("init", str(file), "--event")
    assert "has no mistakes" in run("check", str(file))
    line = "settings.match.duration_s = 120.0"
    text = file.read_text()
    assert text.count(f"# {line} ") == 2
    file.write_text(text.replace(f"# {line} ", f"{line} "))
    assert "has no mistakes" in run("check", str(file))
    matches = [game(plan).match for plan in plans(contests.load(file), file)]
    assert [(match.duration_s, match.start) for match in matches] == [(120.0, "ready")] * 2


@pytest.mark.parametrize(("year", "told"), [(2020, True), (2999, False)])
def test_check_warns_if_entries_are_over(tmp_path: Path, year: int, told: bool) -> None:
    """A time in the past is no mistake, but `check` says that no team can enter any more."""
    file = tmp_path / "contest.toml"
    run("init", str(file))
    close = f"{year}-11-25T09:00:00+09:00"
    file.write_text(file.read_text().replace("[contest]", f"[contest]\nentries_close = {close}"))
    result = CliRunner().invoke(app, ["check", str(file)])
    assert (result.exit_code, "has no mistakes" in result.stdout) == (0, True)
    assert (f"entries_close, {close}, is over" in result.stderr) == told


def test_a_court_needs_a_name_that_fits_a_key(tmp_path: Path) -> None:
    """A court's name that can't be part of a key expression is refused, and no file is written."""
    with pytest.raises(UserError, match="Main Hall"):
        run("init", str(tmp_path / "contest.toml"), "--court", "Main Hall")
    assert list(tmp_path.iterdir()) == []


def test_a_court_says_where_it_is_open_and_not_that_its_match_is_new(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The line with a court's address does not call the match new, as it may be a resumed one."""
    entry = contests.throwaway("othello").courts["main"]
    at = ("tcp/127.0.0.1:7447",)
    serve._open_doors("main", entry, "m-1", at, metrics=None, made_here=False, json=False)
    said = capsys.readouterr().out
    assert said == "Court main is open at tcp/127.0.0.1:7447: match m-1.\n"


def test_a_court_without_a_contest_file_may_have_any_name() -> None:
    """`serve --court bar` without a contest file makes a contest whose only court is "bar"."""
    contest, made_here = serve._contest(None, "othello", None, "bar")
    assert made_here
    assert contest.court("bar")[0] == "bar"
    assert list(contest.courts) == ["bar"]


@pytest.mark.parametrize(
    ("name", "days", "said"),
    [
        ("lacoc.example.org", 90, ""),
        ("*.example.org", 90, ""),
        ("lacoc.example.org", 7, "ends on"),
        ("other.example.org", 90, "browsers will not trust it"),
    ],
)
def test_the_certificate_of_the_pages_is_looked_at(
    tmp_path: Path, name: str, days: int, said: str
) -> None:
    """A check warns of a certificate that ends soon, or that is of another name."""
    file = tmp_path / "contest.toml"
    made = trustme.CA().issue_cert(name, not_after=datetime.now(UTC) + timedelta(days=days))
    (tmp_path / "a.pem").write_bytes(made.cert_chain_pems[0].bytes())
    (tmp_path / "b.pem").write_bytes(made.private_key_pem.bytes())
    run("init", str(file), "--event", "--pages", "https://lacoc.example.org")
    text = file.read_text("utf-8")
    for entry, pem in (("certificate", "a.pem"), ("private_key", "b.pem")):
        text = re.sub(rf"# {entry} = .*", f'{entry} = "{pem}"', text)
    file.write_text(text, "utf-8")
    told = CliRunner().invoke(app, ["check", str(file)]).output
    assert "has no mistakes" in told
    assert said in told
    assert said or "The certificate" not in told
    (tmp_path / "a.pem").write_text("nothing")
    with pytest.raises(UserError, match="can't be used"):
        run("check", str(file))
