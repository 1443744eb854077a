"""Tests that a court plays what the office of its contest assigns, and nothing else."""

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from assigned import (
    FIXTURE,
    OFFICE,
    QUICK,
    WHISTLE,
    Office,
    entry,
    hash_of,
    new_call,
    office_of,
    token,
    write_office_contest,
)
from waiting import LIMIT_S

from lacoc_client.play.asking import NotNow
from lacoc_client.play.controller import Controller
from lacoc_client.play.referee import RefereeClient
from lacoc_client.play.team_way import where
from lacoc_server.contest.league.advice import advice
from lacoc_server.contest.live.court_link import CourtLink, Unanswered
from lacoc_server.contest.live.record_copy import RecordCopy
from lacoc_server.journal.replay import verify
from lacoc_server.journal.verdict import Verdict, VerdictKind
from lacoc_shared.command.child import NOT_AGAIN
from lacoc_shared.decisions import Abort, Declare, Halt, Next, Official, Start
from lacoc_shared.keyspace import ASSIGN_MAX_BYTES, COMMAND_MAX_BYTES, DECISION_MAX_BYTES, KeySpace
from lacoc_shared.messages import Done, Refusal, SentFile
from lacoc_shared.messages.office import EARLIER_OFFICE, WAITING, Whereabouts
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import NoReply, open_client
from lacoc_shared.record.files import segment_paths
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import Phase
from lacoc_shared.words import say

LONGER = {"match": QUICK["match"] | {"duration_s": 20.0}}
REFEREED = {"match": {"countdown_s": 0.1, "duration_s": 600.0}}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("office")


@pytest.fixture(scope="module")
def office(folder: Path) -> Iterator[Office]:
    """Run a court at twenty times real time; give the office's side of it to all tests here."""
    contest = write_office_contest(folder / "contest.toml")
    with office_of(contest, folder / "recordings", "--speed", "20") as office:
        yield office


@pytest.fixture
def waiting(office: Office) -> Office:
    """Make the court wait for the office; return the office's side of this court."""
    office.until(lambda: office.link.call is not None)
    with suppress(UserError):  # it is over, or there is none
        referee(office).decide(Abort(), "the test has ended", "Kubota")
    if call := office.link.call:
        assert office.answer(lambda: office.link.withdraw(call, official=True)) == Done()
    office.until(lambda: office.link.call == "")
    return office


def referee(office: Office) -> RefereeClient:
    return RefereeClient(office.session, "main", WHISTLE)


def why_not(controller: Controller) -> str:
    """Check that a join is refused, and return the code of the reason."""
    with pytest.raises(UserError) as error:
        controller.join()
    return error.value.phrase.code


def record(folder: Path, match_id: str) -> Record:
    return Record.read(sorted((folder / "recordings").glob(f"{match_id}*.mcap")))


def test_a_court_waits_for_the_office(waiting: Office) -> None:
    """Without an assignment the court says that it waits; joins and decisions are refused."""
    sheet = waiting.link.sheet
    assert sheet is not None
    assert (sheet.call, sheet.fixture) == ("", WAITING.fixture)
    with pytest.raises(NotNow) as error:
        waiting.controller("left", "Ants").join()
    assert error.value.phrase == say("refused.waits-for-office")
    for decision in (Abort(), Next()):
        with pytest.raises(UserError) as refused:
            referee(waiting).decide(decision, "a test", "Kubota")
        assert refused.value.phrase.values["why"] == say("why.waits-for-office")


def test_teams_play_what_is_assigned(waiting: Office, folder: Path) -> None:
    """Two teams play an assigned match without a referee; the office gets the result.

    The sheet has call, fixture and teams before anybody joins, and the record is proven. The court
    shows the result until the next assignment, which may have another arena.
    """
    call = waiting.assign("Ants", "Bees")
    sheet = waiting.link.sheet
    assert sheet is not None
    assert (sheet.call, sheet.fixture) == (call, FIXTURE)
    assert [seat.team for seat in sheet.seats] == ["Ants", "Bees"]
    assert sheet.settings["match"]["duration_s"] == QUICK["match"]["duration_s"]
    players = waiting.plays("Ants", "Bees")
    result, match = waiting.result, sheet.match
    assert (result.call, result.teams) == (call, ("Ants", "Bees"))
    assert result.outcome in ("left", "right", "draw")
    waiting.until(lambda: players[0].wait_frame(0.1) is not None)
    assert waiting.link.sheet is not None
    assert (waiting.link.sheet.match, waiting.link.phase) == (match, Phase.OFFICIAL)
    other = waiting.assign("Cats", "Dogs", arena="flag-strike")
    assert waiting.link.sheet.arena == "flag-strike"
    assert why_not(players[0]) == "refused.other-match"
    played = record(folder, result.match_id)
    assert played.header.setup.assigned is not None
    assert played.header.setup.assigned.call == call
    assert played.result is not None
    assert (played.result.teams, played.result.scores) == (result.teams, result.scores)
    assert played.result.official == result.outcome
    assert "health.late-beat" in [reason.code for reason in result.advice]
    assert result.advice == advice(played.events)
    *_, verdict = verify(played)
    assert isinstance(verdict, Verdict)
    assert verdict.kind is VerdictKind.SAME
    waiting.until(lambda: waiting.link.call == other)


def test_only_the_tokens_of_the_match_open_its_seats(waiting: Office) -> None:
    """Strangers and the referee open no seat; a team at the wrong seat is told the right one."""
    waiting.assign("Ants", "Bees")
    assert why_not(waiting.controller("left", "strangers")) == "refused.wrong-token"
    left = Controller(waiting.session, "main", "left", WHISTLE, "Ants")
    assert why_not(left) == "refused.wrong-token"
    with pytest.raises(NotNow) as error:
        waiting.controller("left", "Bees").join()
    assert error.value.phrase == say("refused.other-seat", team="Bees", seat="right")


def test_frozen_files_win(waiting: Office) -> None:
    """A team plays with the files that the office froze; a note says that others are not used."""
    waiting.assign(entry("left", "Ants", "quadruped"), "Bees")
    other = SentFile("my.txt", b"not even a gait")
    left = waiting.controller("left", "Ants", postures=other)
    assert left.join() == (say("note.files-frozen"),)
    right = waiting.controller("right", "Bees")
    assert right.join() == ()
    waiting.until(lambda: bool(waiting.link.sheet and waiting.link.sheet.seats[1].robot))
    assert waiting.link.sheet is not None
    seats = [(seat.team, seat.robot) for seat in waiting.link.sheet.seats]
    assert seats == [("Ants", "Quadruped"), ("Bees", "Hexapod")]


def test_the_same_call_twice_opens_one_match(waiting: Office) -> None:
    """A repeated call changes nothing; once the court has another call, the old one is refused."""
    call = waiting.assign("Ants", "Bees")
    left = waiting.controller("left", "Ants")
    left.join()
    assert waiting.asks("Ants", "Bees", call) == Done()
    assert left.view.sheet.call == call
    left.ready()
    waiting.assign("Cats", "Dogs")
    assert waiting.refusal("Ants", "Bees", call=call).why == say("refused.call-is-over", call=call)


def test_a_match_that_has_not_begun_is_withdrawn(waiting: Office, folder: Path) -> None:
    """The office withdraws a match that has not begun; its record says that it is void."""
    call = waiting.assign("Ants", "Bees", arena_settings=REFEREED)
    assert waiting.link.sheet is not None
    match_id = waiting.link.sheet.match_id
    assert waiting.withdraw(new_call()) == Done()
    waiting.until(lambda: waiting.link.call == call)
    assert waiting.withdraw(call) == Done()
    waiting.until(lambda: waiting.link.call == "")
    withdrawn = record(folder, match_id).result
    assert withdrawn is not None
    assert withdrawn.official == "void"


def test_a_match_that_is_played_goes_on(waiting: Office) -> None:
    """While a match is played the office can neither replace nor withdraw it.

    The official result is the referee's ruling, and only the office opens the next match.
    """
    call = waiting.assign("Ants", "Bees", arena_settings=REFEREED)
    judge = referee(waiting)
    waiting.plays("Ants", "Bees", until=lambda: waiting.link.phase is Phase.READY)
    judge.decide(Start(), "", "Kubota")
    waiting.phase(Phase.PLAYING)
    refusal = waiting.refusal("Cats", "Dogs")
    assert (refusal.why.code, refusal.again) == ("refused.match-is-played", True)
    answer = waiting.withdraw(call)
    assert isinstance(answer, Refusal)
    assert answer.why.code == "refused.match-is-played"
    judge.decide(Halt(), "", "Kubota")
    judge.decide(Declare("right"), "a test", "Kubota")
    judge.decide(Official(), "", "Kubota")
    waiting.until(lambda: waiting.link.result is not None)
    assert (waiting.result.outcome, waiting.result.call) == ("right", call)
    with pytest.raises(UserError) as error:
        judge.decide(Next(), "", "Kubota")
    assert error.value.phrase.values["why"] == say("why.office-opens-next")


def test_a_match_that_no_longer_counts_ends_in_play(waiting: Office, folder: Path) -> None:
    """The office can end a match that is played; it is void, and its log and record say why."""
    call = waiting.assign("Ants", "Bees", arena_settings=LONGER)
    waiting.plays("Ants", "Bees", until=lambda: waiting.link.phase is Phase.PLAYING)
    sheet = waiting.link.sheet
    assert sheet is not None
    why = say("recalled.moved")
    assert waiting.answer(lambda: waiting.link.withdraw(call, begun=True, why=why)) == Done()
    waiting.until(lambda: waiting.link.call == "")
    played = record(folder, sheet.match_id)
    assert played.result is not None
    assert played.result.official == "void"
    decided = [event.data["reason"] for event in played.events if event.kind == "decision"]
    moved = {"code": "recalled.moved"}
    assert decided == [{"code": "reason.office-takes-match", "values": {"why": moved}}]


def test_a_void_match_has_a_result_too(waiting: Office) -> None:
    """If a referee aborts a match, the office gets the result "void" with the call and teams."""
    call = waiting.assign("Ants", "Bees", arena_settings=REFEREED)
    referee(waiting).decide(Abort(), "nobody came", "Kubota")
    waiting.until(lambda: waiting.link.result is not None)
    assert (waiting.result.call, waiting.result.outcome) == (call, "void")
    assert waiting.result.teams == ("Ants", "Bees")


def test_a_team_that_plays_again_in_its_seat_keeps_it(waiting: Office) -> None:
    """A team that is assigned its seat again keeps its session; a replaced team's session ends."""
    waiting.assign("Ants", "Bees")
    players = waiting.plays("Ants", "Bees")
    call = waiting.assign("Ants", "Cats", arena_settings=REFEREED)
    waiting.until(lambda: players[0].wait_frame(0.1) is not None)
    players[0].ready()
    with pytest.raises(UserError) as error:
        players[1].ready()
    assert error.value.phrase.code == "refused.other-match"
    right = waiting.controller("right", "Cats")
    right.join()
    right.ready()
    waiting.go_on([players[0], right], until=lambda: waiting.link.phase is Phase.READY)
    waiting.until(lambda: waiting.link.call == call)


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"arena": "no-such-arena"}, "refused.assigned-arena"),
        ({"arena": "/tmp"}, "refused.assigned-arena"),
        ({"arena": "practice"}, "refused.assigned-seats"),
        ({"arena_settings": {"match": {"duration_s": "long"}}}, "refused.assigned-arena"),
        ({"limits": {"no_such_limit": 1.0}}, "refused.assigned-arena"),
        ({"limits": {"legs_max": 4.0}}, "refused.assigned-files"),
    ],
)
def test_what_can_not_be_played_is_refused(
    waiting: Office, changes: dict[str, object], code: str
) -> None:
    """The court refuses an unfit arena, wrong settings and limits, and files that break a limit."""
    assert waiting.refusal("Ants", "Bees", **changes).why.code == code
    waiting.until(lambda: waiting.link.call == "")


def test_mistakes_in_frozen_files_are_told(waiting: Office) -> None:
    """A refusal of frozen files names the team, and the file of each mistake."""
    wrong = entry("right", "Bees", postures=SentFile("bees.txt", b"Num of Posture\t1\n0 Key\t1"))
    refusal = waiting.refusal("Ants", wrong)
    assert refusal.why.code == "refused.assigned-files"
    assert refusal.why.values["team"] == "Bees"
    assert {mistake.file for mistake in refusal.mistakes} == {"bees.txt"}


@pytest.mark.long
def test_a_record_is_copied_while_it_is_written(
    waiting: Office, folder: Path, tmp_path: Path
) -> None:
    """A copy is the beginning of the record; after the match it is all of it, and packed."""
    waiting.assign("Ants", "Bees", arena_settings=LONGER)
    sheet = waiting.link.sheet
    assert sheet is not None
    copy = RecordCopy(tmp_path, "main")
    copy.want(sheet.match_id)
    beats = {0}

    def step() -> bool:
        waiting.link.poll()
        copy.step(waiting.link)
        with suppress(UserError):  # not even its first message is whole
            beats.add(len(Record.read(segment_paths(tmp_path, sheet.match_id)).frames))
        return waiting.link.result is not None

    waiting.plays("Ants", "Bees", until=step)
    assert not copy.is_whole
    assert waiting.answer(lambda: waiting.link.withdraw(sheet.call, official=True)) == Done()

    def is_whole() -> bool:
        step()
        return copy.is_whole

    waiting.until(is_whole)
    name = f"{sheet.match_id}.mcap"
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert (tmp_path / name).read_bytes() == (folder / "recordings" / name).read_bytes()
    assert len(beats) > 2


def test_a_court_that_is_told_to_retire_ends_for_good(tmp_path: Path) -> None:
    """The court ends with the exit code after which nobody starts it again; its match stays.

    An earlier office can't tell it to, and notices that there is a later one.
    """
    contest = write_office_contest(tmp_path / "contest.toml")
    with office_of(contest, tmp_path / "recordings") as office:
        office.assign("Ants", "Bees")
        later = CourtLink(office.session, "main", OFFICE, generation=1)
        assert later.withdraw(new_call()).wait() == Done()
        assert not later.is_superseded
        assert office.link.retire().wait() == Refusal(EARLIER_OFFICE, again=True)
        assert office.link.is_superseded
        with suppress(NoReply):
            later.retire().wait()
        assert office.process.wait(LIMIT_S) == NOT_AGAIN
    assert [*(tmp_path / "recordings").glob("*.live.mcap")]


def test_strangers_are_refused_and_counted(waiting: Office) -> None:
    """A wrong token is refused and counted; a message that is too large gets no answer."""
    stranger = CourtLink(waiting.session, "main", "the token of nobody")
    before = waiting.link.health
    assert before is not None
    seats = [entry("left", "Ants"), entry("right", "Bees")]
    answer = stranger.assign(new_call(), FIXTURE, seats).wait()
    assert answer == Refusal(say("refused.no-office-token"))
    assert stranger.withdraw(new_call()).wait() == answer
    assert stranger.copy("20260101-100000-main-001", {}).wait() == answer
    assert stranger.retire().wait() == answer
    session, keys = waiting.session, waiting.link._keys
    for key, most in (
        (keys.office("assign"), ASSIGN_MAX_BYTES),
        (keys.request("left", "try"), COMMAND_MAX_BYTES),
        (keys.outlook, DECISION_MAX_BYTES),
    ):
        with pytest.raises(NoReply):
            session.ask(key, bytes(most + 1), 0.5)
    large = {"token": "x", "more": bytes(ASSIGN_MAX_BYTES - 100)}
    answer = stranger._ask("assign", large, Done).wait()  # type: ignore[arg-type]
    assert answer == Refusal(say("refused.no-office-token"))
    counted = before.dropped.get("wrong-token", 0) + 5

    def told() -> bool:
        health = waiting.link.health
        return health is not None and health.dropped.get("wrong-token", 0) == counted

    waiting.until(told)
    waiting.until(lambda: waiting.link.call == "")


def test_a_link_without_a_court_says_that_there_is_no_answer(office: Office) -> None:
    """A request to a court that does not exist gives `Unanswered`; the link has no call."""
    link = CourtLink(office.session, "nowhere", "any token of an office")
    assert link.withdraw("a-call").wait() is Unanswered.NO_ANSWER
    link.poll()
    assert (link.is_there, link.call, link.phase, link.result) == (False, None, None, None)


@pytest.mark.long
def test_a_killed_court_goes_on_with_its_call(tmp_path: Path) -> None:
    """After kill -9 in play, a court reads its call, teams, tokens and files from the record.

    The match is played to its end, and its record is proven.
    """
    contest = write_office_contest(tmp_path / "contest.toml")
    settings = {"match": {"countdown_s": 0.1, "duration_s": 6.0, "start": "ready"}}
    teams = (entry("left", "Ants", "quadruped"), entry("right", "Bees"))
    records = tmp_path / "recordings"
    with office_of(contest, records, "--speed", "4") as office:
        call = office.assign(*teams, arena_settings=settings)
        assert office.link.sheet is not None
        match_id = office.link.sheet.match_id
        office.until(lambda: office.link.missing == ("Ants", "Bees"))
        office.plays("Ants", "Bees", until=lambda: (office.link.clock_s or 0) > 1)
        assert office.link.phase is Phase.PLAYING
        assert office.link.missing == ()
        office.process.kill()
        office.process.wait()
    with office_of(contest, records, "--speed", "4") as office:
        office.until(lambda: office.link.call == call)
        assert office.asks(*teams, call=call) == Done()
        office.phase(Phase.HALTED)
        assert why_not(office.controller("left", "strangers")) == "refused.wrong-token"
        office.plays("Ants", "Bees")
        result, sheet = office.result, office.link.sheet
        assert (result.call, result.match_id, result.teams) == (call, match_id, ("Ants", "Bees"))
        assert sheet is not None
        assert [seat.robot for seat in sheet.seats] == ["Quadruped", "Hexapod"]
    *_, verdict = verify(record(tmp_path, match_id))
    assert isinstance(verdict, Verdict)
    assert verdict.kind is VerdictKind.SAME


@pytest.mark.long
def test_a_court_that_is_closed_goes_on_with_its_call(tmp_path: Path) -> None:
    """A court that is ended in an assigned match goes on with it at the next start.

    If the court is ended after the match, it shows the result again, so that the office gets it.
    """
    contest = write_office_contest(tmp_path / "contest.toml")
    with office_of(contest, tmp_path / "recordings", "--speed", "10") as office:
        call = office.assign("Ants", "Bees", arena="flag-strike")
    with office_of(contest, tmp_path / "recordings", "--speed", "10") as office:
        office.until(lambda: office.link.phase is Phase.LOBBY)
        assert office.link.sheet is not None
        assert (office.link.sheet.call, office.link.sheet.arena) == (call, "flag-strike")
        office.plays("Ants", "Bees")
        result = office.result
    recorded = record(tmp_path, result.match_id).result
    with office_of(contest, tmp_path / "recordings", "--speed", "10") as office:
        office.until(lambda: office.link.result is not None)
        assert office.result == result
        assert office.asks("Ants", "Bees", call=call) == Done()
        office.assign("Cats", "Dogs")
    assert recorded is not None
    assert record(tmp_path, result.match_id).result == recorded


def test_a_team_asks_where_it_plays(waiting: Office) -> None:
    """A court answers a team with what the office said about this team.

    Nobody else can answer for the court. A client that offers to answer such questions receives
    none, so it collects no token.
    """
    keys = KeySpace("main")
    there = Whereabouts(team="Ants", state="waits", said=say("team.awaits-draw"))
    assert waiting.link.tell({hash_of("Ants"): there}).wait() == Done()
    thief = CourtLink(waiting.session, "main", "a guess").tell({hash_of("Ants"): there}).wait()
    assert isinstance(thief, Refusal)
    with open_client(waiting.session.endpoints) as forger:
        desks = [forger.desk(key, 8) for key in (keys.where, keys.office("*"), "lacoc/*/where")]
        forger.ask(keys.sheet)  # answered after all of the above
        with open_client(waiting.session.endpoints) as team:
            for _ in range(20):
                assert where(team, "main", token("Ants")) == there
            with pytest.raises(UserError) as error:
                where(team, "main", token("Bees"))
        assert error.value.phrase == say("refused.no-team-token")
        assert [desk.take() for desk in desks] == [None, None, None]
