"""Tests of contests that are played without a network, also after kills in between."""

import json
import os
import re
import shutil
import signal
from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path

import msgspec
import psutil
import pytest
import small_contest
from lacoc_process import Lacoc
from small_contest import BOTS, CONTEST, FINAL, SWISS, Here
from waiting import LIMIT_S, until

from lacoc_arenas import arena as arenas
from lacoc_arenas import time_limit
from lacoc_server.contest.acts import organiser
from lacoc_server.contest.headless.play import play_contest
from lacoc_server.contest.headless.pool import Job, PlayedAlone, Pool, attempt_match
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.publish import tables
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.facts import Played, Replaced, Replay, new
from lacoc_server.contest.verify.games import check_game, games_of
from lacoc_server.contest.verify.published import check_published, read
from lacoc_server.simulate.headless import seated
from lacoc_shared.command import plugins
from lacoc_shared.mistakes import UserError
from lacoc_shared.record import pack
from lacoc_shared.record.summary import Summary, summary
from lacoc_shared.words import Phrase, render

pytestmark = pytest.mark.slow

ALL_PLAY_ALL = CONTEST + SWISS.replace('"swiss"', '"round-robin"').replace("rounds = 2\n", "")


def games(played: Path) -> int:
    """Return how many records a contest has."""
    return len([*(played / "records").iterdir()])


@pytest.mark.long
def test_any_number_of_processes_gives_the_same_tables(played: Path, tmp_path: Path) -> None:
    """Two worker processes give the same CSV tables, byte for byte, as this process alone."""
    again = small_contest.enter(tmp_path / "again")
    assert small_contest.play(again, jobs=2) == games(played)
    first, second = (organiser.sheet(file) for file in (played / "contest.toml", again))
    assert tables(first) == tables(second)
    assert [*(played / "records").iterdir()] != []
    names = [
        sorted(path.name for path in (one / "records").iterdir()) for one in (played, again.parent)
    ]
    assert names[0] == names[1]
    ranks = [row.rank for table in second.stages[0].tables for row in table.rows]
    # A rank is the number of teams before it, and one: those that are equal in all share it.
    assert ranks == [1 + sum(other < rank for other in ranks) for rank in ranks]


@pytest.mark.long
def test_without_a_network_no_draw_waits(played: Path, tmp_path: Path) -> None:
    """Nobody is there to draw, so a stage that waits for the organiser is drawn at once."""
    waits = FINAL.replace("teams = 2", 'teams = 2\ndraw = "organiser"')
    file = small_contest.enter(tmp_path / "waits", CONTEST + SWISS + waits)
    shutil.copytree(played / "records", file.parent / "records")
    assert small_contest.play(file) == 0
    made = organiser.sheet(file)
    assert [view.plan.draw for view in made.stages] == ["at-once", "organiser"]
    assert tables(made) == tables(organiser.sheet(played / "contest.toml"))
    folder = small_contest.publish(file)
    assert [*check_published(folder, read(folder))] == []


def test_what_is_known_is_not_played_again(played: Path, tmp_path: Path, copied: Path) -> None:
    """A game whose record has a result is not played again, not even in a new contest."""
    assert small_contest.play(copied) == 0
    again = small_contest.enter(tmp_path / "new")
    shutil.copytree(played / "records", again.parent / "records")
    assert small_contest.play(again) == 0
    assert tables(organiser.sheet(again)) == tables(organiser.sheet(copied))
    shutil.rmtree(again.parent / "records")
    shutil.copytree(played / "records", again.parent / "records")
    damaged, endless, *_ = (again.parent / "records").iterdir()
    damaged.write_bytes(b"damaged")
    messages = [one for one in pack.read_messages([endless]) if one[0] != "/lacoc/result"]
    endless.unlink()
    pack.write_packed(messages, endless)
    again.with_suffix(".db").unlink()
    small_contest.enter(again.parent)
    assert small_contest.play(again) == 2


class _Damaged(Here):
    """Plays games whose records come back damaged, as from a worker of other software."""

    def submit(self, job: Job) -> "Future[PlayedAlone | Phrase]":
        """Play a game at once; return a future with a record that can't be read."""
        found = attempt_match(job)
        assert isinstance(found, PlayedAlone)
        future: Future[PlayedAlone | Phrase] = Future()
        future.set_result(found._replace(record=b"damaged"))
        return future


def test_an_unexpected_error_ends_one_game(capsys: pytest.CaptureFixture[str]) -> None:
    """An unexpected error in a game comes back as a message, and its traceback is printed."""
    one = seated(arenas.load("othello"), 0, "straight")
    one = msgspec.structs.replace(one, program=b"raise KeyboardInterrupt")
    found = attempt_match(
        Job(match_id="game", arena="othello", overrides={}, players=(one,), late_ticks=0)
    )
    assert isinstance(found, Phrase)
    assert "match of straight ended with an unexpected error: Keyboard" in render(found)
    assert "line 1, in <module>\nKeyboardInterrupt" in capsys.readouterr().err


def test_a_record_without_a_result_is_told(tmp_path: Path) -> None:
    """If no result can be read from the record of a game that was just played, an error says so."""
    file = small_contest.enter(tmp_path, CONTEST + SWISS, dict([*BOTS.items()][:2]))
    with pytest.raises(UserError, match="no result can be read from its record"):
        organiser.play_headless(file, "planner", _Damaged(), lambda done, there: None)


def test_a_game_without_an_end_is_refused(tmp_path: Path) -> None:
    """A stage whose games have no time limit is refused before anything is played."""
    file = small_contest.enter(
        tmp_path, CONTEST + SWISS.replace("duration_s = 2.6", "duration_s = 0")
    )
    with pytest.raises(UserError, match='stage "swiss" has no time limit'):
        small_contest.play(file)


def test_a_contest_with_a_game_in_a_folder_may_be_moved(tmp_path: Path) -> None:
    """Its game is found beside it again; what was played counts, and nobody calls it false."""
    othello = plugins.folder_of(plugins.package("lacoc.arenas", "arena", "flag-strike"))
    first = tmp_path / "first"
    shutil.copytree(othello, first / "mine", ignore=shutil.ignore_patterns("__pycache__"))
    stage = SWISS.replace('"flag-strike"', '"./mine"')
    file = small_contest.enter(first, CONTEST + stage, dict([*BOTS.items()][:2]))
    assert small_contest.play(file) > 0
    first.rename(tmp_path / "second")
    file = tmp_path / "second" / file.name
    assert small_contest.play(file) == 0
    published = small_contest.publish(file)
    assert str(tmp_path) not in (published / "facts.json").read_text()
    games = [check_game(published, game, proven=True) for game in games_of(read(published))]
    assert [game.wrong for game in games] == [()] * len(games)
    assert all("is not installed here" in render(game.unchecked[0]) for game in games)


def test_a_contest_that_runs_is_not_run_again(copied: Path) -> None:
    """While one program runs a contest, another one is refused; later it may."""
    with ContestFolder(copied).alone(), pytest.raises(UserError, match="another program"):
        small_contest.play(copied)
    assert small_contest.play(copied) == 0


def test_the_sheet_has_what_is_decided_after_the_end(
    copied: Path, lacoc: Callable[..., tuple[int, str, str]]
) -> None:
    """Pages and films read it. While a contest runs, nobody but its office writes it."""
    small_contest.play(copied)

    def counted() -> list[str]:
        matches = json.loads(copied.with_suffix(".json").read_text())["stages"][0]["matches"]
        return [match["pairing"]["id"] for match in matches if match.get("games")]

    words = ("contest", "decide", "void", "--reason", "x", "--yes", "--contest", copied)
    first, second, *others = counted()
    assert lacoc(*words, first)[0] == 0
    assert counted() == [second, *others]
    with ContestFolder(copied).alone():
        assert lacoc(*words, second)[0] == 0
    assert counted() == [second, *others]
    assert lacoc("contest", "withdraw", "Eve", "--yes", "--contest", copied)[0] == 0
    assert second not in counted()


@pytest.mark.long
def test_one_changed_entry_costs_its_own_games(tmp_path: Path) -> None:
    """In a new contest with the same records, only the games of a changed entry are played."""
    bots = dict([*BOTS.items()][:4])
    one = small_contest.enter(tmp_path / "one", ALL_PLAY_ALL, bots)
    assert small_contest.play(one) == 6
    two = small_contest.enter(tmp_path / "two", ALL_PLAY_ALL, {**bots, "Ann": "straight"})
    shutil.copytree(one.parent / "records", two.parent / "records")
    assert small_contest.play(two) == 3


@pytest.mark.parametrize(
    "how", [pytest.param(signal.SIGTERM, marks=pytest.mark.long), signal.SIGKILL]
)
def test_a_contest_that_was_stopped_goes_on(played: Path, tmp_path: Path, how: int) -> None:
    """A contest that was stopped or killed plays only the games without a record.

    Its tables are the same as in an undisturbed contest.
    """
    file = small_contest.enter(tmp_path / "stopped")
    records = file.parent / "records"
    words = ["contest", "run", "contest.toml", "--headless", "--jobs", "1", "--json"]
    run = Lacoc(*words, cwd=file.parent)
    until(lambda: [*records.glob("*.mcap")])
    os.kill(run.pid, how)
    run.wait(LIMIT_S)
    there = {path.name: path.stat().st_mtime_ns for path in records.glob("*.mcap")}
    assert 0 < len(there) < games(played)
    assert small_contest.play(file) == games(played) - len(there)
    assert [name for name, at in there.items() if (records / name).stat().st_mtime_ns != at] == []
    assert tables(organiser.sheet(file)) == tables(organiser.sheet(played / "contest.toml"))


@pytest.mark.long
def test_a_killed_worker_costs_only_its_game(played: Path, tmp_path: Path) -> None:
    """If worker processes are killed, their games are played again.

    The tables are the same as in an undisturbed contest.
    """
    file = small_contest.enter(tmp_path / "killed")
    where = ContestFolder(file)
    kills = 3

    def changed(_: object) -> None:
        nonlocal kills
        workers = [psutil.Process(pid) for pid in pool.processes]
        busy = [one for one in workers if sum(one.cpu_times()[:2]) > 0.3]
        if kills and busy:
            kills -= 1
            busy[0].kill()

    with FactStore(where.facts) as store, Pool(2) as pool:
        organiser.prepare(where, store)
        play_contest(where, store, pool, "planner", changed, lambda _: None)
    assert kills < 3
    assert tables(organiser.sheet(file)) == tables(organiser.sheet(played / "contest.toml"))


def test_a_broken_bot_stops_no_other_team(played: Path, tmp_path: Path) -> None:
    """A bot with a mistake stops only its own games; the error names the team and the mistake.

    When the team is disqualified, the contest can be played to its end.
    """
    file = small_contest.enter(tmp_path / "broken")
    bad = tmp_path / "your_bot.py"
    bad.write_text("def bot(sheet, seat):\n    return lambda frame: 1 / 0\n")
    organiser.enter(file, "Eve", None, str(bad), "")
    with pytest.raises(
        UserError,
        match=r"^Eve: The bot your_bot\.py stopped .*\(your_bot\.py:2\): .* by zero\.\nGames",
    ):
        small_contest.play(file)
    decided = [match.decided for match in organiser.sheet(file).stages[0].matches]
    assert decided.count(False) == 1
    organiser.take_out(file, "Eve", "broken bot", disqualified=True)
    small_contest.play(file)
    view = organiser.sheet(file).stages[0]
    assert all(match.decided for match in view.matches)
    assert [row.team for row in view.tables[0].rows][-1] == "Eve"


def test_a_team_may_leave_before_the_draw_and_in_the_middle(tmp_path: Path) -> None:
    """A team that leaves before the draw is not drawn; one that leaves later loses open matches."""
    file = small_contest.enter(tmp_path / "left", CONTEST + SWISS)
    organiser.take_out(file, "Eve", "ill", disqualified=False)
    where = ContestFolder(file)

    def changed(contest: Contest) -> None:
        if any(view.stage.drawn[1:] for view in contest.stages):  # the second round is drawn
            organiser.take_out(file, "Bob", "gone home", disqualified=False)

    with FactStore(where.facts) as store:
        organiser.prepare(where, store)
        play_contest(where, store, Here(), "planner", changed, lambda _: None)
    view = organiser.sheet(file).stages[0]
    assert "Eve" not in view.stage.entries
    of_bob = [match for match in view.matches if "Bob" in match.teams]
    assert [match.how for match in of_bob] == ["played", "walkover"]


def test_a_game_to_be_replayed_is_another_game(copied: Path) -> None:
    """A game that the organiser orders to be replayed is played again and has a new record."""
    where = ContestFolder(copied)
    with FactStore(where.facts) as store:
        last = next(fact for fact in reversed(store.facts()) if isinstance(fact, Played))
        names = ("pairing", "game", "teams")
        what = {name: getattr(last, name) for name in names}
        store.append(new(Replay, reason="the net was down", **what))
    assert small_contest.play(copied) == 1
    with FactStore(where.facts) as store:
        again = store.facts()[-1]
    assert isinstance(again, Played)
    assert {name: getattr(again, name) for name in names} == what
    assert again.record != last.record


def test_void_games_are_played_again_and_at_last_drawn(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A void game is played again; if the fourth attempt is void too, the game is a draw."""
    one = FINAL.replace('after = "swiss"\nteams = 2\ngames = 3\n', "extra_games = 0\n")
    file = small_contest.enter(tmp_path / "void", CONTEST + one)
    for team in [*BOTS][2:]:
        organiser.take_out(file, team, "ill", disqualified=False)

    def void(path: Path) -> Summary | None:
        found = summary(path)
        return found and msgspec.structs.replace(found, winner="void")

    monkeypatch.setattr("lacoc_server.contest.headless.play.summary", void)
    assert small_contest.play(file) == 4
    with FactStore(ContestFolder(file).facts) as store:
        played = [fact for fact in store.facts() if isinstance(fact, Played)]
        decision = store.facts()[-1]
    assert [fact.outcome for fact in played] == ["void"] * 3
    assert len({fact.record for fact in played}) == 3
    assert isinstance(decision, Replaced)
    assert decision.outcome == "draw"
    assert organiser.sheet(file).stages[0].matches[0].how == "seed"


def test_replays_that_people_ordered_are_no_void_games(
    copied: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A game replayed three times by order may then be void three times, like any other game."""
    where = ContestFolder(copied)
    with FactStore(where.facts) as store:
        last = next(fact for fact in reversed(store.facts()) if isinstance(fact, Played))
        what = {name: getattr(last, name) for name in ("pairing", "game", "teams")}
        for number in range(3):
            result = {"scores": last.scores, "outcome": last.outcome, "record": f"{number}.mcap"}
            store.append(new(Replay, reason="the net was down", **what))
            store.append(new(Played, **what, **result))
        store.append(new(Replay, reason="the net was down", **what))

    def void(path: Path) -> Summary | None:
        found = summary(path)
        return found and msgspec.structs.replace(found, winner="void")

    monkeypatch.setattr("lacoc_server.contest.headless.play.summary", void)
    small_contest.play(copied)
    with FactStore(where.facts) as store:
        ends = [
            fact.outcome
            for fact in store.facts()
            if isinstance(fact, Played | Replaced)
            and (fact.pairing, fact.game) == (last.pairing, last.game)
        ]
    assert ends[-4:] == ["void", "void", "void", "draw"]


BAD = {
    "Hangs": "def brain(frame):\n    while True: pass\n",
    "Raises": "def brain(frame):\n    return 1 // 0\n",
    "Wrong": "from lacoc_arenas.bot import Key\ndef brain(frame):\n    return Key(1, 9)\n",
}


def enter_bad(folder: Path, good: int) -> Path:
    """Enter good bots, and three bad ones.

    One hangs, one raises an error, and one presses only keys that nobody has.
    """
    bots = {f"Good {number}": "straight" for number in range(good)}
    short = ALL_PLAY_ALL.replace("duration_s = 2.6", "duration_s = 1.0")
    file = small_contest.enter(folder, short, bots)
    for team, brain in BAD.items():
        bot = folder / f"{team.lower()}_bot.py"
        bot.write_text(f"{brain}def bot(sheet, seat):\n    return brain\n")
        organiser.enter(file, team, None, str(bot), "")
    return file


def check_bad(file: Path, said: str, told: list[str]) -> None:
    """Check that all others were played, and that each bad bot is told by its own name."""
    matches = organiser.sheet(file).stages[0].matches
    assert len(matches) == 15
    for match in matches:
        assert match.decided == (not {"Hangs", "Raises"} & {*match.teams}), match.teams
    lines = said.splitlines()
    assert len(lines) == 3
    (hangs,) = [line for line in lines if line.startswith("Hangs: ")]
    assert re.search(
        r"The bot hangs_bot\.py did not answer \(hangs_bot\.py:2\): it computed", hangs
    )
    (raises,) = [line for line in lines if line.startswith("Raises: ")]
    assert re.search(r"The bot raises_bot\.py stopped .* \(raises_bot\.py:2\): ZeroDiv", raises)
    assert lines[-1].startswith("Games that can't be played: 9; all others are played.")
    (wrong,) = told
    assert re.match(r"Wrong: \d+ keys were refused, because the gait does not have them", wrong)


@pytest.mark.long
def test_bad_bots_stop_no_other_game(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of six bots one hangs, one raises, one presses wrong keys: the contest ends by itself.

    All other games are played, and each of the three is told by its team and its file.
    """
    monkeypatch.setattr(time_limit, "MOST", time_limit.Most(5.0, 0.2, 60.0, 60.0))
    file = enter_bad(tmp_path, good=3)
    told: list[str] = []
    with pytest.raises(UserError) as failed:
        organiser.play_headless(
            file,
            "planner",
            Here(),
            lambda done, there: None,
            lambda what: told.append(render(what)),
        )
    check_bad(file, str(failed.value), told)


@pytest.mark.long(minutes=1)
def test_bad_bots_stop_no_other_game_in_processes(tmp_path: Path) -> None:
    """The command ends by itself too, with the limits as they are and in worker processes.

    Each game of the bot that hangs takes the 10 s of processor time that a bot may take.
    """
    file = enter_bad(tmp_path, good=1)
    run = Lacoc("contest", "run", "contest.toml", "--headless", "--jobs", "2", cwd=tmp_path)
    assert run.wait(10 * LIMIT_S) != 0
    assert sum(match.decided for match in organiser.sheet(file).stages[0].matches) == 1
