"""Tests of whole matches by commands; courts, bots and spectators are processes."""

import json
import os
import signal
import subprocess
import time
from pathlib import Path
from typing import Any

import msgspec
import pytest
from court_process import CourtProcess, OpenCourt
from stage import Stage
from waiting import LIMIT_S

from lacoc_client.commands.referee import _default_name, _rescored, _show_reply
from lacoc_client.play.asking import NoAnswer
from lacoc_client.play.referee import RefereeClient
from lacoc_shared.command import cli
from lacoc_shared.decisions import DECISIONS, Adjust
from lacoc_shared.messages import DecisionReply
from lacoc_shared.seat import Phase
from lacoc_shared.words import render, say

pytestmark = pytest.mark.slow


class Referee:
    """`lacoc referee` at a court; it runs in the test's process, which saves time."""

    def __init__(self, court: CourtProcess, capsys: pytest.CaptureFixture[str]) -> None:
        self._where = court.where()
        self._token = court.referee
        self._capsys = capsys
        self.decided: set[str] = set()

    def run(self, *words: str) -> tuple[int, str, str]:
        """Run `lacoc referee`; return its exit code, standard output and standard error."""
        self._capsys.readouterr()
        try:
            code = cli.main(["referee", *words, *self._where])
        except SystemExit as stop:
            code = int(stop.code or 0)
        shown = self._capsys.readouterr()
        return code, shown.out, shown.err

    def decide(self, *words: str) -> dict[str, Any]:
        """Make a decision as soon as it is legal, and return the court's reply."""
        self.decided.add(words[0])
        common = ("--reason", "a test", "--by", "kim", "--wait", "20", "--json", "--yes")
        code, out, err = self.run(*words, *common, "--token", self._token)
        assert code == 0, err  # it may say that it waits
        reply: dict[str, Any] = json.loads(out)
        return reply

    def outlook(self, *words: str) -> dict[str, Any]:
        """Ask what would happen if play went on."""
        code, out, err = self.run("outlook", *words, "--json", "--token", self._token)
        assert (code, err) == (0, "")
        seen: dict[str, Any] = json.loads(out)
        return seen

    def refused(self, *words: str) -> str:
        """Ask for a decision that the court refuses, and return the court's reason."""
        yes = () if words[0] == "outlook" else ("--yes",)
        code, out, err = self.run(*words, *yes, "--token", self._token)
        assert (code, out) == (2, "")
        assert err.count("Error: ") == 1
        return " ".join(err.split())


def test_the_referee_has_every_decision(
    open_court: OpenCourt, capsys: pytest.CaptureFixture[str]
) -> None:
    """The referee makes every decision except `ready`, from lobby to next match (rules 4.1)."""
    court = open_court("--arena", "othello", "--seconds", "30", "--speed", "4")
    referee = Referee(court, capsys)
    assert "Now the match is in the lobby; nobody has joined the left seat" in referee.refused(
        "start"
    )
    court.bots()

    assert referee.decide("start")["text"] == "play begins in 3 seconds."
    assert referee.decide("freeze", "left", "60")["scores"] == [18, 18]
    referee.decide("unfreeze", "left")
    referee.decide("restart", "right")
    assert "it is possible only while the match is halted" in referee.refused("outlook")
    referee.decide("halt")
    seen = referee.outlook("--seconds", "2", "--restart", "left")
    assert (seen["seconds"], seen["before"], seen["phase"]) == (2.0, [18, 18], "PLAYING")
    assert "not both" in referee.refused("outlook", "--take-back", "1", "--restart", "left")
    assert "give a reason" in referee.refused("adjust", "left", "2")
    taken = referee.decide("adjust", "left", "-2")
    assert taken["scores"] == [16, 18]
    assert "reason is too long" in referee.refused("adjust", "left", "2", "--reason", "長" * 1400)
    code, _, err = referee.run("adjust", "left", "9" * 30, "--reason", "x")
    assert (code, "less than or equal to 1000000" in " ".join(err.split())) == (2, True)
    assert 'there is no seat "middle"' in referee.refused("adjust", "middle", "1", "--reason", "x")
    assert referee.decide("set", "A1", "neutral")["scores"] == [15, 18]
    tried = referee.decide("take-back", str(taken["event"]), "--dry-run")
    assert (tried["event"], tried["scores"]) == (None, [17, 18])
    assert referee.decide("take-back", str(taken["event"]))["scores"] == [17, 18]
    assert referee.decide("clock", "0.5")["text"] == "0.5 seconds added to the match."
    referee.decide("resume")
    referee.decide("halt")
    assert "Go" not in referee.refused("official")
    referee.decide("declare", "left")
    assert "the result is official: " in referee.decide("official")["text"]
    referee.decide("next")
    referee.decide("abort")
    referee.decide("next")
    assert referee.decided == set(DECISIONS) - {"ready"}  # see the next test


def test_a_change_of_the_score_says_the_new_score_before() -> None:
    """Whoever changes a score by hand reads the score before and after it."""
    stage = Stage("othello").to(Phase.HALTED)
    asked = _rescored(Adjust("right", -5), stage.frame, stage.match.sheet())
    assert asked is not None
    assert render(asked) == "Ants 18 : 18 Bees becomes Ants 18 : 13 Bees. Do it?"
    assert _rescored(Adjust("middle", 1), stage.frame, stage.match.sheet()) is None


def test_a_dry_run_lists_what_would_change(capsys: pytest.CaptureFixture[str]) -> None:
    """`--dry-run` prints that nothing is done, and lists each event that would change."""
    changes = (
        say("change.vanishes", kind="strike", marker="flag18"),
        say("change.appears", kind="capture", marker="corner0"),
    )
    what = say("struck.event", kind="strike", marker="flag18", team="Ants")
    score = say("score.two", left="Ants", points=5, conceded=0, right="Bees")
    done = say("decision.took-back", what=what, score=score)
    tried = DecisionReply(beat=900, said=done, scores=(5, 0), changes=changes)
    _show_reply(tried)
    _show_reply(msgspec.structs.replace(tried, changes=()))
    first = [
        "Dry run: nothing is done. This is what would be done:",
        "  The strike of flag 18 by Ants is taken back: Ants 5 : 0 Bees.",
    ]
    assert capsys.readouterr().out.splitlines() == [
        *first,
        "  removed: strike of flag 18",
        "  new: capture of corner 0",
        "The score would be 5 : 0",
        *first,
        "  No other event changes.",
        "The score would be 5 : 0",
    ]


@pytest.mark.parametrize(
    ("account", "named"), [("kim", "kim"), ("root", "referee"), ("admin", "referee")]
)
def test_a_referee_has_a_name(account: str, named: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without --by, a decision has the account's name; "root" and the like become "referee"."""
    monkeypatch.setenv("LOGNAME", account)
    assert _default_name() == named


def test_ready_for_a_contestant_who_cannot(
    open_court: OpenCourt, capsys: pytest.CaptureFixture[str]
) -> None:
    """The referee says ready for a contestant; `status` lists legal decisions, `log` the events."""
    court = open_court("--arena", "othello")
    referee = Referee(court, capsys)
    person = court.start(
        *("play", "--terminal", "--name", "Slow Hands", *court.where("left")), stdin=subprocess.PIPE
    )
    referee.decide("ready", "left")

    code, out, _ = referee.run("status", "--json")
    status = json.loads(out)
    assert code == 0
    assert status["phase"] == "LOBBY"
    assert [seat["ready"] for seat in status["seats"]] == [True, False]
    assert status["health"]["decisions"]["abort"] is None
    missing = status["health"]["decisions"]["start"]["values"]["missing"]
    assert {"code": "why.nobody-in-seat", "values": {"seat": "right"}} in missing
    code, out, _ = referee.run("status")
    assert "Slow Hands" in out
    assert "commands/s" in out
    code, out, _ = referee.run("log", "--json")
    events = [json.loads(line) for line in out.splitlines()]
    assert [event["kind"] for event in events] == ["phase", "join", "decision", "ready"]
    assert [event["number"] for event in events] == [1, 2, 3, 4]
    code, out, _ = referee.run("log")
    assert "Slow Hands is set to ready. Reason: a test" in out
    assert person.poll() is None


def test_a_waiting_referee_does_nothing_twice(
    open_court: OpenCourt, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """`lacoc referee` repeats no decision whose answer was lost; the court may have made it."""
    court = open_court("--arena", "othello")
    decide, asked = RefereeClient.decide, []

    def lose_the_answer(*args: Any) -> None:
        asked.append(decide(*args))
        raise NoAnswer("Court 'main' does not answer.")

    monkeypatch.setattr(RefereeClient, "decide", lose_the_answer)
    said = Referee(court, capsys).refused("abort", "--wait", "20", "--reason", "a test")
    assert 'see whether "abort" was done.' in said
    assert len(asked) == 1


def test_a_waiting_referee_gives_up_in_time(
    open_court: OpenCourt, capsys: pytest.CaptureFixture[str]
) -> None:
    """After the time of --wait the command gives up and prints the court's last reason."""
    court = open_court("--arena", "othello")
    reason = Referee(court, capsys).refused("official", "--wait", "0.7")

    assert (
        'The decision "official" is still not possible after 0.7 s: '
        "it is possible only while the match is" in reason
    )


@pytest.mark.long
def test_bots_play_match_after_match(
    open_court: OpenCourt, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """Bots play a match, which `watch` shows, and say ready for the next match by themselves."""
    court = open_court("--arena", "othello", "--seconds", "6", "--speed", "4")
    court.bots("planner", "nearest")
    watch = court.start("watch", "--json", "--hz", "5", *court.where())
    text = court.start("watch", "--terminal", *court.where())
    referee = Referee(court, capsys)
    referee.decide("start")
    referee.decide("official")
    out, _ = watch.communicate(timeout=LIMIT_S)
    lines = [json.loads(line) for line in out.splitlines()]
    events = [line for line in lines if line["type"] == "event"]
    frames = [line for line in lines if line["type"] == "frame"]

    assert watch.returncode == 0
    assert [event["number"] for event in events] == [*range(1, len(events) + 1)]
    assert events[-2]["text"].startswith("Referee kim: the result is official")
    assert events[-1]["said"]["code"] == "event.official"
    assert [seat["team"] for seat in frames[-1]["seats"]] == ["planner", "nearest"]
    assert frames[-1]["phase"] == "OFFICIAL"
    assert (frames[-1]["clock_s"], frames[-1]["left_s"]) == (6.0, 0.0)
    assert len(frames[-1]["markers"]) == 36
    played = [frame for frame in frames if frame["phase"] == "PLAYING"]
    assert played[-1]["poses"]["left"]["x_m"] > played[0]["poses"]["left"]["x_m"] + 0.1
    shown, _ = text.communicate(timeout=LIMIT_S)
    assert "Referee kim: the result is official" in shown.splitlines()[-3]
    assert "OFFICIAL" in shown.splitlines()[-1]

    referee.decide("next")
    referee.decide("start")  # the bots have said ready again
    referee.decide("abort")
    referee.decide("next")
    _a_ghost_plays_the_record_again(court, referee, tmp_path)


def _a_ghost_plays_the_record_again(court: CourtProcess, referee: Referee, folder: Path) -> None:
    """Let a ghost take the left seat and press the keys of the first match's record again."""
    record = _packed(folder / "recordings", "*-001.mcap")
    court.start("bot", f"ghost:{record}:left", *court.where("left"), stdout=subprocess.DEVNULL)
    deadline_s = time.monotonic() + 60
    teams: list[str] = []
    while "planner's ghost" not in teams:
        assert time.monotonic() < deadline_s
        teams = [seat["team"] for seat in json.loads(referee.run("status", "--json")[1])["seats"]]
    referee.decide("start")
    referee.decide("official")


def _packed(folder: Path, name: str) -> Path:
    """Wait until another process has packed a match's record, and return the record's path."""
    deadline_s = time.monotonic() + 60
    while not (found := [*folder.glob(name)]):
        assert time.monotonic() < deadline_s, [*folder.iterdir()]
        time.sleep(0.1)
    return found[0]


def test_a_bot_ends_when_its_seat_is_taken(open_court: OpenCourt) -> None:
    """A bot says that a newer join has taken its seat, and exits with 2."""
    court = open_court("--arena", "othello")
    first = court.start("bot", "straight", *court.where("left"))
    assert first.stdout is not None
    assert "holds the left seat" in first.stdout.readline()
    court.start("bot", "straight", *court.where("left"), stdout=subprocess.DEVNULL)
    out, _ = first.communicate(timeout=LIMIT_S)

    assert first.returncode == 2
    assert "The seat is lost: another window or computer has taken it over." in out


def test_a_bot_says_that_its_court_is_silent(open_court: OpenCourt) -> None:
    """A bot prints one line when its court falls silent, and one when the court is back."""
    court = open_court("--arena", "othello")
    bot = court.start("bot", "straight", *court.where("left"))
    assert bot.stdout is not None
    lines = iter(bot.stdout.readline, "")
    assert any("holds the left seat" in line for line in lines)
    os.kill(court.process.pid, signal.SIGSTOP)
    try:
        said = next(line for line in lines if line.startswith("Connection: "))
    finally:
        os.kill(court.process.pid, signal.SIGCONT)
    assert "the court has sent nothing for" in said
    assert next(lines) == "The court is back.\n"


def test_a_bot_leaves_when_it_is_asked_to_end(
    open_court: OpenCourt, capsys: pytest.CaptureFixture[str]
) -> None:
    """A bot that is asked to end in the lobby leaves its seat and exits with 0."""
    court = open_court("--arena", "othello")
    bot = court.start("bot", "straight", *court.where("left"))
    assert bot.stdout is not None
    assert "holds the left seat" in bot.stdout.readline()
    bot.terminate()
    bot.communicate(timeout=LIMIT_S)

    assert bot.returncode == 0
    _, out, _ = Referee(court, capsys).run("log", "--json")
    assert json.loads(out.splitlines()[-1])["kind"] == "leave"


def test_a_student_s_bot_is_a_file(open_court: OpenCourt, tmp_path: Path) -> None:
    """`lacoc bot my_bot.py` calls the file's function `bot` with sheet and seat."""
    (tmp_path / "my_bot.py").write_text(
        "def bot(sheet, seat):\n"
        "    print('made for', sheet.seats[seat].id, flush=True)\n"
        "    return lambda frame: None\n"
    )
    court = open_court("--arena", "practice")
    bot = court.start("bot", "my_bot.py", *court.where("solo"))
    assert bot.stdout is not None
    lines = iter(bot.stdout.readline, "")

    assert any("made for solo" in line for line in lines)
