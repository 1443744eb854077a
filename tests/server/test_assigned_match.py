"""Tests of an assigned match: the office fixes its teams, and only the office opens the next."""

import msgspec
import pytest
from stage import LEFT, QUICK, RIGHT, Stage, decide, join, setup

from lacoc_server.court import unjudged
from lacoc_server.court.assigning import staying
from lacoc_server.match.match import Match
from lacoc_shared import decisions as d
from lacoc_shared.codec import decode, encode
from lacoc_shared.contest.tokens import new_token_hash
from lacoc_shared.inputs import THE_COURT, JoinSeat
from lacoc_shared.messages import Done, Refusal, SentFile
from lacoc_shared.messages.office import WAITING, Assigned, AssignedSeat
from lacoc_shared.record.schema import Setup
from lacoc_shared.seat import Phase
from lacoc_shared.words import say

SEATS = ("left", "right")
HASHES = {team: new_token_hash(team) for team in ("Ants", "Bees", "Cats")}
OTHER = SentFile("other.txt", b"x")


def assigned(left: str = "Ants", right: str = "Bees", call: str = "c1") -> Assigned:
    seats = []
    for index, team in enumerate((left, right)):
        one = join(index)
        seats.append(
            AssignedSeat(
                id=SEATS[index],
                team=team,
                token_hashes=(HASHES[team],),
                robot=one.robot,
                postures=one.postures,
                locomotion=one.locomotion,
            )
        )
    return Assigned(call=call, fixture=say("fixture.final", stage=None), seats=tuple(seats))


def stage_of(what: Assigned, start: str = "referee") -> Stage:
    """Return a stage whose match the office assigned."""
    stage = Stage("othello", {"match": QUICK["match"] | {"start": start}})
    whole = msgspec.structs.replace(stage.match.setup, assigned=what)
    stage.match = Match(whole, stage._make)
    return stage


def test_the_teams_are_known_before_they_join() -> None:
    """Sheet and result name the teams of an assigned match before anybody has joined."""
    stage = stage_of(assigned())
    stage.beat()
    sheet = stage.match.sheet()
    assert (sheet.call, sheet.fixture) == ("c1", say("fixture.final", stage=None))
    assert [(seat.team, seat.robot) for seat in sheet.seats] == [("Ants", ""), ("Bees", "")]
    stage.decide(d.Abort())
    assert stage.match.result().teams == ("Ants", "Bees")


@pytest.mark.parametrize(
    "wrong",
    [
        join(LEFT, "Bees"),
        join(RIGHT, "Ants"),
        msgspec.structs.replace(join(LEFT), locomotion=OTHER),
        msgspec.structs.replace(join(LEFT), postures=None, locomotion=None),
    ],
)
def test_a_join_with_other_teams_or_files_is_refused(wrong: JoinSeat) -> None:
    """A match itself refuses a join with a team or files that are not assigned.

    So a replay differs from a record in which such a join was forged.
    """
    stage = stage_of(assigned())
    seat = SEATS[wrong.seat]
    assert stage.send(wrong) == Refusal(say("refused.other-match", seat=seat), again=True)
    assert stage.send(join(LEFT)) == Done()


def test_a_match_that_waits_allows_no_decision() -> None:
    """While the court waits for the office, no decision is legal and nobody can join."""
    stage = stage_of(WAITING)
    stage.beat()
    assert set(stage.match.legality().values()) == {say("why.waits-for-office")}
    assert isinstance(stage.send(join(LEFT)), Refusal)
    assert stage.match.is_over


@pytest.mark.parametrize("phase", [Phase.OFFICIAL, Phase.VOID])
def test_only_the_office_opens_the_next_match(phase: Phase) -> None:
    """In OFFICIAL and VOID of an assigned match, the decision `next` is not legal."""
    stage = stage_of(assigned()).to(phase)
    assert stage.match.legality()["next"] == say("why.office-opens-next")
    assert stage.match.is_over


def test_a_match_without_a_referee_waits_after_its_result() -> None:
    """A court decides `official` in an assigned match without a referee, but never `next`."""
    stage = stage_of(assigned(), start="ready").to_playing()
    stage.until(Phase.PLAYING)
    stage.decide(d.Clock(-3600.0))
    assert stage.phase is Phase.FINISHED
    stage.beat(*unjudged.decisions(stage.match, list))
    assert stage.phase is Phase.OFFICIAL
    stage.run(1000)
    assert unjudged.decisions(stage.match, list) == []


def test_a_halt_by_a_referee_lasts_until_a_referee_resumes() -> None:
    """A court without a referee ends its own halts by itself, but not that of a person."""
    stage = stage_of(assigned(), start="ready").to_playing()
    stage.until(Phase.PLAYING)

    def play_for(beats: int) -> Phase:
        for _ in range(beats):
            stage.beat(*unjudged.decisions(stage.match, lambda: [True, True]))
        return stage.phase

    stage.beat(decide(d.Halt(), by=THE_COURT))
    assert stage.phase is Phase.HALTED
    assert play_for(500) is Phase.PLAYING
    stage.decide(d.Halt())
    assert play_for(500) is Phase.HALTED
    stage.decide(d.Resume())
    assert play_for(500) is Phase.PLAYING


def test_teams_that_play_on_keep_their_seats_with_the_new_files() -> None:
    """A team that is assigned its seat again keeps it, and gets its files of the new match.

    If the seat was opened with another token, even a team of the same name does not keep it.
    """
    sat = [
        msgspec.structs.replace(join(LEFT), token_hash=HASHES["Ants"]),
        msgspec.structs.replace(join(RIGHT), token_hash=HASHES["Bees"]),
    ]
    following = assigned("Ants", "Cats")
    left = msgspec.structs.replace(following.seats[0], locomotion=OTHER)
    following = msgspec.structs.replace(following, seats=(left, following.seats[1]))
    assert staying(sat, following, SEATS) == [msgspec.structs.replace(sat[0], locomotion=OTHER)]
    assert staying(sat, assigned("Bees", "Ants"), SEATS) == []
    assert staying([join(LEFT)], assigned(), SEATS) == []


def test_a_setup_of_an_older_record_is_read() -> None:
    """A setup can be read without the entry `assigned`; with it, decoding undoes encoding."""
    old = encode({"court": "main", "match": 1, "arena": "a", "settings": {}, "limits": {}})
    assert decode(old, Setup).assigned is None
    new = msgspec.structs.replace(setup("othello"), assigned=assigned())
    assert decode(encode(new), Setup) == new
