"""Tests of open matches: whoever has the token of a seat plays, at a court that has no game."""

import subprocess
import time
from pathlib import Path
from typing import Any

import pytest
import small_contest
from lacoc_process import contest_run, started
from msgspec.structs import replace
from ports import free_port
from stage import QUICK, join, setup
from waiting import LIMIT_S, until

from lacoc_client.play.controller import Controller, Hold
from lacoc_client.play.team_way import where
from lacoc_robots.library import sample_gait_files
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.plans import OpenStage
from lacoc_server.contest.league.timetable.calling import (
    LOST_MS,
    GameEnd,
    SeenCourt,
    calls,
    is_open_call,
)
from lacoc_server.contest.live.open_matches import OpenMatches
from lacoc_server.journal.journal import Journal
from lacoc_server.match.match import Match
from lacoc_server.world.world import World
from lacoc_shared.contest.file import load, port_path
from lacoc_shared.contest.tokens import new_token_hash
from lacoc_shared.messages import Done, Refusal
from lacoc_shared.messages.office import Whereabouts, open_match
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import open_client
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import Phase
from lacoc_shared.words import Phrase, say

STAGE = OpenStage("othello", {}, {}, ("left", "right"))
ADDRESSES = {"red": "tcp/127.0.0.1:1", "blue": "tcp/127.0.0.1:2"}


class Answer:
    """The answer to an assignment; None: there is none yet."""

    answer: Done | Refusal | None = None

    def take(self) -> Done | Refusal | None:
        return self.answer


class Link:
    """Stands in for the connection to a court; it keeps what is assigned."""

    court = "red"

    def __init__(self) -> None:
        self.call: str | None = None
        self.phase: Phase | None = None
        self.assigned: list[str] = []
        self.answer = Answer()

    def assign(self, call: str, fixture: Phrase, seats: tuple[Any, ...], **_: Any) -> Answer:
        assert fixture == say("fixture.open")
        assert [(seat.id, seat.team) for seat in seats] == [("left", ""), ("right", "")]
        self.assigned.append(call)
        self.answer = Answer()
        return self.answer


def token_of(court: str, seat: str) -> str:
    return f"the token of {seat} at {court}"


def test_a_court_that_waits_gets_an_open_match_once() -> None:
    """As long as the court does not have it, the same call is sent again; then it is left alone."""
    link, matches = Link(), OpenMatches(STAGE, token_of)
    matches.look(link, 10)  # type: ignore[arg-type]
    assert link.assigned == [], "what the court has is not known yet"
    link.call = ""
    for now_s in (20, 20.1, 25):
        matches.look(link, now_s)  # type: ignore[arg-type]
    assert len(link.assigned) == 1, "the first request is not answered yet"
    link.answer.answer = Refusal(say("plain.text", text="not now"), again=True)
    matches.look(link, 30)  # type: ignore[arg-type]
    (call,) = {*link.assigned}
    assert len(link.assigned) == 2
    assert is_open_call(call)
    link.answer.answer, link.call = Done(), call
    for link.phase in (Phase.LOBBY, Phase.PLAYING, Phase.FINISHED):
        matches.look(link, 90)  # type: ignore[arg-type]
    assert len(link.assigned) == 2


def test_a_result_stays_for_ten_seconds() -> None:
    """Then the next open match follows, with another call; it does so after any match."""
    link, matches = Link(), OpenMatches(STAGE, token_of)
    for call, phase in (("open.1", Phase.OFFICIAL), ("f12", Phase.VOID)):
        link.call, link.phase, link.assigned = call, phase, []
        now_s = 100 if call == "f12" else 20
        for later_s in (0, 5, 9.9):
            matches.look(link, now_s + later_s)  # type: ignore[arg-type]
        assert link.assigned == []
        matches.look(link, now_s + 10)  # type: ignore[arg-type]
        (found,) = link.assigned
        assert is_open_call(found)
        assert found != call
        link.answer.answer = Done()


def test_a_refusal_is_told_once() -> None:
    """The organiser reads why a court can't open it; the office asks again and again."""
    told: list[Phrase] = []
    link, matches = Link(), OpenMatches(STAGE, token_of, told.append)
    link.call = ""
    why = say("plain.text", text="other seats")
    for now_s in (20, 30, 40):
        matches.look(link, now_s)  # type: ignore[arg-type]
        link.answer.answer = Refusal(why)
    assert len(link.assigned) == 3
    assert told == [say("news.open-refused", court="red", why=why)]


def test_each_seat_is_told_where_it_is() -> None:
    """A seat is open while its court has an open match; else its holder waits."""
    seen = {"red": SeenCourt(1, "open.1"), "blue": SeenCourt(1, "f12")}
    found = dict(OpenMatches(STAGE, token_of).whereabouts(seen, ADDRESSES))
    assert list(found) == [token_of(court, seat) for court in seen for seat in STAGE.seats]
    red = found[token_of("red", "right")]
    assert (red.state, red.court, red.seat, red.call) == ("court", "red", "right", "open.1")
    assert (red.address, red.team, red.open) == (ADDRESSES["red"], "", True)
    blue = found[token_of("blue", "left")]
    assert (blue.state, blue.court, blue.address, blue.open) == ("waits", "blue", "", True)


def test_games_go_before_open_matches_that_have_not_begun() -> None:
    """A court with an open match gets a game unless the match is played."""
    from cup import NOW_MS, Cup

    seen = {
        "begun": SeenCourt(NOW_MS, "open.1", begun=True),
        "waits": SeenCourt(NOW_MS, "open.2"),
        "gone": SeenCourt(NOW_MS - LOST_MS),
        "over": SeenCourt(NOW_MS, "open.3", begun=True, ended=GameEnd((0, 0), "draw", "r.mcap")),
    }
    assert [one.court for one in calls(Cup().contest, seen, NOW_MS, 0)] == ["waits", "over"]


OPEN = '[stage.friendly]\nformat = "open"\n'


@pytest.mark.parametrize(
    ("stages", "said"),
    [
        (OPEN + "teams = 4\n", r"stage\.friendly.*no entry \"teams\".*format, arena, settings"),
        (OPEN + 'arena = "chess"\n', r'no arena "chess"'),
        (OPEN + OPEN.replace("friendly", "other"), "Only one stage can be open"),
        (OPEN + '[stage.cup]\nformat = "swiss"\nafter = "friendly"\n', "friendly"),
    ],
)
def test_mistakes_in_an_open_stage_are_told(tmp_path: Path, stages: str, said: str) -> None:
    """It has a game and its settings, and nothing follows from it."""
    file = tmp_path / "contest.toml"
    file.write_text(f"[court.main]\n{stages}")
    with pytest.raises(UserError, match=said):
        ContestFolder(file)


def record_open_match(folder: Path) -> Path:
    """Record a short open match in a folder of a contest's records; return the file."""
    tokens = {seat: [new_token_hash(seat)] for seat in ("left", "right")}
    made = replace(
        setup("othello", QUICK),
        match_id="20260501-100000-main-001",
        assigned=open_match(tokens, "open.1"),
    )
    journal = Journal(Match(made, World), folder)
    journal.beat([join(0), join(1)])
    for _ in range(10):
        journal.beat()
    journal.close()
    assert journal.writer is not None
    return journal.writer.path


@pytest.mark.slow
def test_records_of_open_matches_are_in_nobodys_way(copied: Path) -> None:
    """A contest with their records is published without them, and follows from its facts."""
    copied.write_text(copied.read_text("utf-8") + OPEN, "utf-8")
    path = record_open_match(ContestFolder(copied).records)
    published = small_contest.publish(copied)
    assert not [one for one in published.rglob("*") if one.name == path.name]
    done = started(
        "contest", "verify", str(published), stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    said, _ = done.communicate(timeout=LIMIT_S)
    assert done.returncode in (0, 3), said
    assert path.exists()


CONTEST = """
[court.red]
listen = ["127.0.0.1:{port}"]
[stage.friendly]
format = "open"
settings.match = {{ duration_s = 1.0, countdown_s = 0.1, start = "ready" }}
"""


@pytest.mark.slow
@pytest.mark.long
def test_friends_play_match_after_match(tmp_path: Path) -> None:
    """Whoever has the link of a seat sits down with a name and files, and stays for the next one.

    The court tells each token where its seat is. The records name the call and the stage.
    """
    file = tmp_path / "contest.toml"
    file.write_text(CONTEST.format(port=free_port()))
    with contest_run(file, stderr=subprocess.DEVNULL) as run:
        opened = run.opened
        tokens = {seat: load(file).secrets.seat("red", seat) for seat in ("left", "right")}
        assert port_path(file).read_text() == opened["url"].rpartition(":")[2]
        links = opened["seats"]["red"]
        assert all(tokens[seat] in links[seat] for seat in tokens)
        with open_client([opened["courts"]["red"]]) as session:
            there = asked(session, tokens["left"])
            until(lambda: asked(session, tokens["left"]).state == "court")
            there = asked(session, tokens["left"])
            assert (there.open, there.seat, there.team) == (True, "left", "")
            players = [
                Controller(session, "red", seat, token, f"Team {seat}", **files())
                for seat, token in tokens.items()
            ]
            for player in players:
                player.join()
                player.ready()
            view = players[0].view
            first = view.sheet.match

            def see() -> bool:
                for player in players:
                    player.wait_frame(0.02)
                return True

            until(lambda: see() and view.frame and view.frame.phase == Phase.OFFICIAL)
            assert [seat.team for seat in view.sheet.seats] == ["Team left", "Team right"]
            until(lambda: see() and view.sheet.match == first + 1)
            until(lambda: see() and all(player.hold is Hold.HELD for player in players))
            assert [seat.team for seat in view.sheet.seats] == ["Team left", "Team right"]
            assert view.sheet.fixture == say("fixture.open")
    found = [*(tmp_path / "recordings").glob(f"*-red-00{first}.mcap")]
    assert len(found) == 1
    assigned = Record.read(found[0]).header.setup.assigned
    assert assigned is not None
    assert assigned.is_open
    assert is_open_call(assigned.call)


def asked(session: Any, token: str) -> Whereabouts:
    """Ask the court where a token plays, until it answers."""
    end_s = time.monotonic() + LIMIT_S
    while True:
        try:
            return where(session, "red", token)
        except UserError:
            assert time.monotonic() < end_s
            time.sleep(0.1)


def files() -> dict[str, Any]:
    postures, locomotion = sample_gait_files("hexapod")
    return {"postures": postures, "locomotion": locomotion}
