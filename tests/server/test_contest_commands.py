"""Tests of `lacoc contest`: its file is private and valid, and `check` finds wrong settings."""

import json
import re
import stat
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
import trustme
from typer.testing import CliRunner

from lacoc_server.commands import serve
from lacoc_server.commands.contest.app import app
from lacoc_server.contest.kept.plans import game, open_stage, plans
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.link import Link
from lacoc_shared.mistakes import UserError


def run(*args: str) -> str:
    result = CliRunner().invoke(app, args)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result.stdout


@pytest.mark.parametrize("arena", ["othello", "flag-strike"])
def test_a_new_file_is_right_for_every_arena(tmp_path: Path, arena: str) -> None:
    """The file that `init` writes passes `check`; courts and stages play the arena."""
    file = tmp_path / "contest.toml"
    run("init", str(file), "--arena", arena, "--courts", "2")

    assert "has no mistakes" in run("check", str(file))
    contest = contests.load(file)
    assert {one.arena for one in contest.courts.values()} == {arena}
    assert {plan.arena for plan in plans(contest, file)} == {arena}


def test_a_new_file_has_no_secret_and_keeps_the_older(tmp_path: Path) -> None:
    """All tokens are in a file of mode 0600; an older contest file is renamed and kept."""
    file = tmp_path / "contest.toml"
    run("init", str(file))
    first = file.read_text()
    run("init", str(file), "--courts", "2")

    assert (tmp_path / "contest.1.toml").read_text() == first
    assert file.read_text() != first
    assert stat.S_IMODE(file.stat().st_mode) & 0o044 == 0o044
    kept = tmp_path / "contest.secrets.json"
    assert stat.S_IMODE(kept.stat().st_mode) == 0o600
    tokens = json.loads(kept.read_text())
    assert {*tokens} == {
        "office",
        "standby",
        "organiser",
        *(f"referee.main{n}" for n in ("", "-1", "-2")),
    }
    assert not any(token in file.read_text() for token in tokens.values())


def test_a_file_is_written_only_if_it_is_missing(tmp_path: Path) -> None:
    """With --if-missing, what an organiser wrote stays, and nothing is put aside."""
    file = tmp_path / "contest.toml"
    run("init", str(file), "--if-missing")
    file.write_text(file.read_text() + "# mine\n")
    files = {path: path.read_text() for path in tmp_path.iterdir()}
    run("init", str(file), "--if-missing", "--courts", "2")
    assert {path: path.read_text() for path in tmp_path.iterdir()} == files


@pytest.mark.parametrize("kind", [(), ("--open",)])
def test_init_and_check_doubt_a_game_in_a_folder(tmp_path: Path, kind: tuple[str, ...]) -> None:
    """Courts can't play a game that is not installed; without courts it can be played."""
    othello = Path(__file__).parents[2] / "arenas" / "lacoc_arenas" / "othello"
    file = tmp_path / "contest.toml"
    for words in (("init", str(file), "--arena", str(othello), *kind), ("check", str(file))):
        result = CliRunner().invoke(app, words)
        assert result.exit_code == 0
        assert f"not those in folders ({othello})" in " ".join(result.stderr.split())


def test_a_contest_of_open_matches_is_written(tmp_path: Path) -> None:
    """`init --open` plans no draw: one stage, in which whoever has a link plays."""
    file = tmp_path / "contest.toml"
    run("init", str(file), "--open", "--arena", "flag-strike")
    assert "has no mistakes" in run("check", str(file))
    contest = contests.load(file)
    assert plans(contest, file) == []
    stage = open_stage(contest, file)
    assert stage is not None
    assert stage.arena == "flag-strike"


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('arena = "othello"', 'arena = "chess"', "no arena .chess."),
        ("# settings.match.duration_s = 120.0", 'settings.match.duration_s = "long"', "duration_s"),
        ("# settings.match.duration_s = 120.0", "settings.match.duratoin_s = 1.0", "duratoin_s"),
        ("# legs_max = 8", "legs_maxx = 8", "legs_maxx"),
        ('robot = "hexapod"', 'robot = "missing.toml"', r"missing\.toml"),
    ],
)
def test_check_looks_into_arena_and_limits(tmp_path: Path, old: str, new: str, said: str) -> None:
    """`check` finds a wrong arena, setting, limit or robot before a court starts."""
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
    limit, court, *_, stage = str(caught.value).splitlines()
    assert "legs_maxx" in limit
    assert court.startswith('[court.main]: There is no arena "chess".')
    assert "[stage.show]" in stage


def test_the_length_of_the_games_is_a_commented_line(tmp_path: Path) -> None:
    """The lines of `init` that set the length are right if they are uncommented."""
    file = tmp_path / "contest.toml"
    run("init", str(file))
    assert "has no mistakes" in run("check", str(file))
    line = "settings.match.duration_s = 120.0"
    text = file.read_text()
    assert text.count(f"# {line} ") == 2
    file.write_text(text.replace(f"# {line} ", f"{line} "))
    assert "has no mistakes" in run("check", str(file))
    matches = [game(plan, tmp_path).match for plan in plans(contests.load(file), file)]
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


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("", "", ""),
        ("apart = true", "apart = false", "may meet again in the first round"),
        ("groups = 2", "groups = 1", "repeat one of it"),
    ],
)
def test_check_warns_if_teams_of_a_group_meet_again(
    tmp_path: Path, old: str, new: str, told: str
) -> None:
    """`check` says that a knockout may repeat matches of the groups, and names the way out."""
    file = tmp_path / "contest.toml"
    run("init", str(file))
    file.write_text(file.read_text().replace(old, new) if old else file.read_text())
    result = CliRunner().invoke(app, ["check", str(file)])
    assert result.exit_code == 0
    assert told in " ".join(result.stderr.split())
    assert bool(told) == ("finals" in result.stderr)


def test_referees_and_staff_are_invited_too(tmp_path: Path) -> None:
    """`invite --staff` has the links of all referees and all of the staff, also as a table."""
    file = tmp_path / "contest.toml"
    run("init", str(file), "--courts", "2")
    secrets = contests.load(file).secrets
    aiko = secrets.staff("Aiko")
    given = CliRunner().invoke(app, ["invite", "--contest", str(file), "--staff", "--json"])
    links = {kind: dict(found) for kind, found in json.loads(given.stdout).items()}
    assert [*links["referee"]] == ["main-1", "main-2"]
    assert Link.read(links["staff"]["Aiko"]).token == aiko
    read = Link.read(links["referee"]["main-2"])
    assert (read.page, read.court) == ("referee", "main-2")
    assert read.token == secrets.referee("main-2")
    table = CliRunner().invoke(app, ["invite", "--contest", str(file), "--staff", "--csv"])
    rows = [line.split(",") for line in table.stdout.splitlines()]
    assert [row[:2] for row in rows] == [
        ["kind", "name"],
        ["referee", "main-1"],
        ["referee", "main-2"],
        ["staff", "Aiko"],
    ]
    assert "referee of court main-1" in run("invite", "--contest", str(file), "--staff")


def test_invitations_have_the_port_of_the_last_run(tmp_path: Path) -> None:
    """Links of a contest file without `pages` have the port of the last run, also with --host."""

    def pages(*words: str) -> str:
        given = run("invite", "--contest", str(file), "--staff", "--json", *words)
        (link,) = json.loads(given)["referee"].values()
        return str(Link.read(link).pages)

    file = tmp_path / "contest.toml"
    run("init", str(file))
    assert pages().endswith(":8080")
    contests.port_path(file).write_text("9000")
    assert pages().endswith(":9000")
    assert pages("--host", "hall.local") == "http://hall.local:9000"
    text = file.read_text()
    file.write_text(text.replace("[contest]", '[contest]\npages = "https://cup.test"', 1))
    assert pages() == "https://cup.test"


def test_a_court_needs_a_name_that_fits_a_key(tmp_path: Path) -> None:
    """A court's name that can't be part of a key expression is refused, and no file is written."""
    with pytest.raises(UserError, match="Main Hall"):
        run("init", str(tmp_path / "contest.toml"), "--court", "Main Hall")
    assert list(tmp_path.iterdir()) == []


def test_a_court_says_where_it_is_open_and_not_that_its_match_is_new(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The line with a court's address does not call the match new, as it may be a resumed one."""
    at = ("tcp/127.0.0.1:7447",)
    serve._open_doors("main", "m-1", at, metrics=None, tokens=None, json=False)
    said = capsys.readouterr().out
    assert said == "Court main is open at tcp/127.0.0.1:7447: match m-1.\n"


def test_a_court_without_a_contest_file_may_have_any_name() -> None:
    """`serve --court bar` without a contest file makes a contest whose only court is "bar"."""
    contest = serve._alone("othello", None, "bar")
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
    run("init", str(file), "--pages", "https://lacoc.example.org")
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
