"""The desk of a court for teams that ask where they play."""

import time

import pytest
from court_stub import CourtStub
from waiting import LIMIT_S

from lacoc_client.play.asking import NotNow, Patience
from lacoc_client.play.team_way import TeamWay
from lacoc_server.doors.team_desk import TeamDesk
from lacoc_shared import seal
from lacoc_shared.codec import encode
from lacoc_shared.contest.access import Access
from lacoc_shared.contest.tokens import new_token
from lacoc_shared.keyspace import COMMAND_MAX_BYTES
from lacoc_shared.messages import Refusal
from lacoc_shared.messages.office import Where, Whereabouts
from lacoc_shared.words import Phrase, faults, say

SALT = bytes(16)
TOKENS = {team: new_token() for team in ("Ants", "Bees", "Crabs")}


def waits(team: str) -> Whereabouts:
    return Whereabouts(team=team, state="waits", said=say("team.awaits-draw"))


@pytest.fixture
def desk() -> TeamDesk:
    """Give a desk that knows from the office where three teams are."""
    desk = TeamDesk()
    desk.tell({seal.hash_token(token, SALT): waits(team) for team, token in TOKENS.items()})
    return desk


def ask(desk: TeamDesk, token: str) -> Whereabouts | Refusal:
    return desk.where(encode(Where(token=token)))


def test_each_team_hears_of_itself(desk: TeamDesk) -> None:
    """A team's token gives what the office told about this team, and about no other."""
    for team, token in TOKENS.items():
        assert ask(desk, token) == waits(team)
    assert not desk.refused


def test_a_guess_opens_nothing(desk: TeamDesk) -> None:
    """10,001 guesses are refused and counted, even hashes of tokens and tokens cut by a letter."""
    for _ in range(9_990):
        assert isinstance(ask(desk, new_token()), Refusal)
    for token in ("", "Ants", *[seal.hash_token(token, SALT) for token in TOKENS.values()] * 2):
        found = ask(desk, token)
        assert isinstance(found, Refusal)
        assert (found.why, found.again) == (say("refused.no-team-token"), False)
    for token in TOKENS.values():
        assert isinstance(ask(desk, token[:-1]), Refusal)
    assert desk.refused == {"wrong-token": 10_001}


@pytest.mark.parametrize(
    "payload", [b"", b"\xc1", encode({"token": 7}), encode({"token": "x" * COMMAND_MAX_BYTES})]
)
def test_what_is_no_question_is_refused(desk: TeamDesk, payload: bytes) -> None:
    """Bytes that are no question, or that are too many, are refused, and the refusal is counted."""
    found = desk.where(payload)
    assert isinstance(found, Refusal)
    assert faults(found.why) == []
    assert desk.refused == {"bad-bytes": 1}


def test_before_the_office_has_told_anything() -> None:
    """Before the office has told anything, a refusal says that the question may be asked again."""
    found = ask(TeamDesk(), TOKENS["Ants"])
    assert isinstance(found, Refusal)
    assert (found.why, found.again) == (say("refused.office-is-silent"), True)


def test_the_newest_word_counts(desk: TeamDesk) -> None:
    """What the office tells replaces what it told before, also if its hashes have another salt."""
    salt = bytes(range(16))
    desk.tell({seal.hash_token(TOKENS["Ants"], salt): waits("Ants")})
    assert ask(desk, TOKENS["Ants"]) == waits("Ants")
    assert isinstance(ask(desk, TOKENS["Bees"]), Refusal)


def test_who_comes_before_the_office_waits_for_it(court: CourtStub) -> None:
    """A team whose court knows nothing yet is told so once, and led on when the office speaks."""
    access = Access(court="main", connect=court.address, token=TOKENS["Ants"])
    told: list[Phrase] = []
    there = Whereabouts(team="Ants", state="court", said=say("team.awaits-draw"), call="a call")

    def tell(said: Phrase) -> None:
        told.append(said)
        court.teams.tell({seal.hash_token(TOKENS["Ants"], SALT): there})

    with TeamWay(
        access, any_court=False, patience=Patience(None), tell=tell, stopping=lambda: False
    ) as way:
        assert way.next() == there
    assert told == [say("refused.office-is-silent"), there.said]


def test_who_gave_a_time_waits_no_longer(court: CourtStub) -> None:
    """With a longest wait, the refusal of a court that knows nothing ends the program."""
    access = Access(court="main", connect=court.address, token=TOKENS["Ants"])
    with (
        pytest.raises(NotNow),
        TeamWay(
            access, any_court=False, patience=Patience(0.1), tell=print, stopping=lambda: False
        ),
    ):
        pass


def test_a_team_that_plays_no_more_waits_until_the_contest_is_over(court: CourtStub) -> None:
    """A decision may bring back a team that had played its last match; only the end ends it.

    What was decided about its match is told once.
    """
    news = say("team.news", what=say("decided.no-show", match="Final", team="Bees"), reason=None)
    answers = [
        Whereabouts(team="Ants", state="out", said=say("team.out", place=None)),
        Whereabouts(
            team="Ants", state="court", said=say("team.awaits-draw"), call="a call", news=news
        ),
        Whereabouts(team="Ants", state="over", said=say("team.over", place=None)),
    ]
    told: list[Phrase] = []

    def tell(said: Phrase) -> None:
        told.append(said)
        if answers:
            court.teams.tell({seal.hash_token(TOKENS["Ants"], SALT): answers.pop(0)})

    tell(say("team.awaits-draw"))
    access = Access(court="main", connect=court.address, token=TOKENS["Ants"])
    with TeamWay(
        access, any_court=False, patience=Patience(None), tell=tell, stopping=lambda: False
    ) as way:
        there = way.next()
        assert there is not None
        way.played(there.call)
        assert way.next() is None
    codes = [one.code for one in told[1:]]
    assert codes == ["team.out", "team.news", "team.awaits-draw", "team.over"]


def test_a_team_asks_another_court_when_its_own_is_gone() -> None:
    """A bot or a terminal with a link goes on when the court that it asked has been killed."""
    ends_s = time.monotonic() + LIMIT_S
    told = {seal.hash_token(TOKENS["Ants"], SALT): waits("Ants")}
    there = Whereabouts(team="Ants", state="court", said=say("team.awaits-draw"), call="a call")
    with CourtStub(court="south") as south:
        with CourtStub(court="north") as north:
            north.teams.tell(told)
            south.teams.tell(told)
            access = Access(
                court="north",
                connect=north.address,
                others=(south.address,),
                token=TOKENS["Ants"],
            )
            way = TeamWay(
                access,
                any_court=True,
                patience=Patience(LIMIT_S),
                tell=lambda _: None,
                stopping=lambda: time.monotonic() > ends_s,
            )
        south.teams.tell(dict.fromkeys(told, there))
        with way:
            try:
                assert way.next() == there
            except KeyboardInterrupt:
                pytest.fail("it still asks the court that is gone")
