"""Tests of what facts mean for matches, brackets and the schedule."""

import itertools
from copy import copy
from random import Random

import pytest

from lacoc_server.contest.league.contest import Changes, Contest, changes, compute, next_round
from lacoc_server.contest.league.facts import (
    AnyFact,
    Called,
    Disqualified,
    Drawn,
    Entered,
    FilesChanged,
    Moved,
    NoShow,
    Planned,
    Played,
    Recalled,
    Replaced,
    Replay,
    RoundDrawn,
    StageSettings,
    Voided,
    Withdrawn,
    decode,
    encode,
)
from lacoc_server.contest.league.fixture import standing
from lacoc_server.contest.league.formats.format import Stage
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.formats.knockout import double_bracket, single_bracket
from lacoc_server.contest.league.formats.round_robin import groups
from lacoc_server.contest.league.matches import ContestMatch
from lacoc_server.contest.league.pairing import Entrant, WinnerOf
from lacoc_server.contest.league.timetable.schedule import assign
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import render, say

FIRST = "s:w1.1"
SCORE = {"scores": (0, 1), "outcome": "right"}


class Facts(list[AnyFact]):
    """A list of facts; `add` gives each its number, and a time of one second more."""

    def __init__(self, how: str, teams: str, **settings: object) -> None:
        super().__init__()
        for team in teams:
            self.add(Entered, team=team, files="f")
        self.add(Planned, stage="s", format=how, settings=StageSettings(**settings))
        self.add(Drawn, stage="s", entries=tuple(teams))

    def add(self, kind: type[AnyFact], **values: object) -> "Facts":
        number = len(self)
        self.append(kind(id=f"f{number}", number=number, **{"at_ms": 1000 * number, **values}))
        return self

    def play(self, pairing: str, game: int, left: str, right: str, *scores: int) -> "Facts":
        outcome = "draw" if scores[0] == scores[1] else "left" if scores[0] > scores[1] else "right"
        return self.add(
            Played, pairing=pairing, game=game, teams=(left, right), scores=scores, outcome=outcome
        )

    @property
    def contest(self) -> Contest:
        return compute(self, FORMATS)

    def match(self, pairing: str = FIRST) -> ContestMatch:
        (found,) = (one for one in self.contest.stage("s").matches if one.pairing.id == pairing)
        return found


ABOUT = {"pairing": FIRST, "teams": ("a", "b"), "reason": "why"}


def test_best_of_three_swaps_sides_and_ends_early() -> None:
    """Teams swap sides after each game; a team that wins two games of three needs no third."""
    facts = Facts("single-knockout", "ab", games=3)
    assert facts.match().next_seats == ("a", "b")
    facts.play(FIRST, 1, "a", "b", 3, 1)
    assert (facts.match().next_game, facts.match().next_seats) == (2, ("b", "a"))
    facts.play(FIRST, 2, "b", "a", 0, 5)
    match = facts.match()
    assert (match.winner, match.loser, match.how, match.scores) == ("a", "b", "played", (8, 1))
    assert facts.contest.stage("s").over


@pytest.mark.parametrize(
    ("games", "winner", "how"),
    [
        ([(1, 1), (4, 3)], "b", "extra"),
        ([(1, 1), (2, 2)], "a", "seed"),
        ([(2, 0)], "a", "played"),
    ],
)
def test_a_level_match_of_a_knockout(games: list[tuple[int, int]], winner: str, how: str) -> None:
    """After a draw an extra game decides; if that is a draw too, the better seed wins."""
    facts = Facts("single-knockout", "ab")
    for number, scores in enumerate(games, 1):
        seats = ("a", "b") if number % 2 else ("b", "a")
        facts.play(FIRST, number, *seats, *scores)
    assert (facts.match().winner, facts.match().how) == (winner, how)


def test_a_corrected_game_keeps_its_record() -> None:
    """What was played stays to be seen, with court and time, whatever a decision says of it."""
    facts = Facts("single-knockout", "ab")
    game = {"pairing": FIRST, "game": 1, "teams": ("a", "b")}
    facts.add(Called, court="north", at_ms=7000, **game)
    late = (say("health.late-beat", late_ms=300.0, most_ms=200.0),)
    facts.add(Played, scores=(3, 1), outcome="left", record="x.mcap", advice=late, **game)
    assert [counted.advice for counted in facts.match().games] == [late]
    facts.add(Replaced, **ABOUT, game=1, **SCORE)
    (counted,) = facts.match().games
    assert counted.advice == (), "the organiser has decided"
    assert (counted.scores, counted.record) == ((0, 1), "x.mcap")
    assert (counted.court, counted.began_ms) == ("north", 7000)
    assert counted.ruled, "the result is not what was played"
    facts.add(Replay, **ABOUT, game=1)
    facts.add(Replaced, **ABOUT, game=1, **SCORE)
    (counted,) = facts.match().games
    assert (counted.record, counted.court) == ("", ""), "it was to be played again"
    facts.add(Replay, **ABOUT, game=1)
    facts.add(Played, scores=(0, 0), outcome="void", record="y.mcap", **game)
    facts.add(Replaced, **ABOUT, game=1, **SCORE)
    assert facts.match().games[0].record == "y.mcap", "the referee had halted it for good"


def test_teams_are_named_as_they_sat_in_the_first_game() -> None:
    """From game to game teams change sides, and people read them in one order."""
    facts = Facts("single-knockout", "abcd", games=3, third_place=True)
    assert facts.match().seated == ("a", "d")
    facts.play(FIRST, 1, "d", "a", 3, 1)
    assert (facts.match().next_seats, facts.match().seated) == (("a", "d"), ("d", "a"))
    assert render(standing(facts.match())) == "d 1 : 0 a"
    facts.play(FIRST, 2, "a", "d", 3, 1)
    assert facts.match().seated == ("d", "a")
    waiting = facts.match("s:w2.1")
    assert waiting.seated == waiting.teams


def test_a_place_of_a_bracket_says_that_a_level_match_decided_it() -> None:
    """Third place and final tell by which tie-break they were decided; other places tell none."""
    facts = Facts("single-knockout", "abcd", third_place=True, extra_games=0)
    facts.play(FIRST, 1, "a", "d", 1, 0).play("s:w1.2", 1, "b", "c", 1, 0)
    facts.play("s:p1.1", 1, "c", "d", 2, 2).play("s:w2.1", 1, "b", "a", 1, 0)
    (table,) = facts.contest.stage("s").tables
    assert [(row.team, row.rank, row.decided_by) for row in table.rows] == [
        ("b", 1, ""),
        ("a", 2, ""),
        ("c", 3, ""),
        ("d", 4, "seed"),
    ]


@pytest.mark.parametrize("void", [True, False])
def test_a_final_that_nobody_wins_has_no_winner(void: bool) -> None:
    """If nobody came to the final, or it is void, both finalists are second."""
    facts = Facts("single-knockout", "abcd", third_place=True)
    facts.play(FIRST, 1, "a", "d", 1, 0).play("s:w1.2", 1, "b", "c", 1, 0)
    facts.play("s:p1.1", 1, "c", "d", 2, 1)
    final = {"pairing": "s:w2.1", "reason": "why"}
    if void:
        facts.add(Voided, teams=("a", "b"), **final)
    else:
        facts.add(NoShow, team="a", opponent="b", **final)
        facts.add(NoShow, team="b", opponent="a", **final)
    (table,) = facts.contest.stage("s").tables
    ranks = {row.team: row.rank for row in table.rows}
    assert ranks == {"a": 2, "b": 2, "c": 3, "d": 4}


def test_difference_decides_before_the_seed() -> None:
    """If both teams have won a game and there is no extra one, the difference of points decides."""
    facts = Facts("single-knockout", "ab", games=2, extra_games=0)
    facts.play(FIRST, 1, "a", "b", 1, 0).play(FIRST, 2, "b", "a", 5, 0)
    assert (facts.match().winner, facts.match().how) == ("b", "difference")


@pytest.mark.parametrize(
    ("decision", "winner", "how", "state"),
    [
        (
            (Replaced, {**ABOUT, "game": 1, "scores": (0, 1), "outcome": "right"}),
            "b",
            "played",
            "decided",
        ),
        ((Replay, {**ABOUT, "game": 1}), None, "", "open"),
        ((Voided, ABOUT), "", "void", "decided"),
        ((NoShow, {"pairing": FIRST, "team": "b"}), "a", "played", "decided"),
        ((Withdrawn, {"team": "a"}), "a", "played", "decided"),
    ],
)
def test_decisions_about_a_played_match(
    decision: tuple[type[AnyFact], dict[str, object]], winner: str, how: str, state: str
) -> None:
    """A decision replaces, reopens or voids a result; a team that leaves later keeps its win."""
    facts = Facts("single-knockout", "ab").play(FIRST, 1, "a", "b", 2, 0)
    facts.add(decision[0], **decision[1])
    match = facts.match()
    assert (match.winner, match.how, match.state) == (winner, how, state)


@pytest.mark.parametrize(
    ("leaving", "winner"),
    [
        ([(Withdrawn, {"team": "a"})], "b"),
        ([(Disqualified, {"team": "b"})], "a"),
        ([(NoShow, {"pairing": FIRST, "team": "b"})], "a"),
        ([(NoShow, {"pairing": FIRST, "team": team}) for team in "ab"], ""),
    ],
)
def test_a_team_that_is_not_there_loses(
    leaving: list[tuple[type[AnyFact], dict[str, object]]], winner: str
) -> None:
    """A team that withdraws, is disqualified or does not appear loses its open match."""
    facts = Facts("single-knockout", "ab")
    for kind, values in leaving:
        facts.add(kind, **values)
    assert (facts.match().winner, facts.match().how) == (winner, "walkover")


def test_the_first_of_two_results_counts() -> None:
    """A void game is played again: its first result that is not void counts, the others do not."""
    facts = Facts("single-knockout", "ab")
    facts.add(Played, pairing=FIRST, game=1, teams=("a", "b"), scores=(0, 0), outcome="void")
    assert facts.match().next_game == 1
    facts.play(FIRST, 1, "a", "b", 2, 0).play(FIRST, 1, "a", "b", 0, 2)
    assert facts.match().winner == "a"
    why = [one.why.code for one in facts.contest.unused]
    assert why == ["league.result-void", "league.result-replaced"]


@pytest.mark.parametrize(
    ("more", "codes"),
    [
        ([(Voided, {})], ["league.match-void"]),
        ([(Replay, {"game": 1})], ["league.result-again"]),
        ([(Replaced, {"game": 1, **SCORE})], ["league.result-replaced"]),
        ([(Replaced, {"game": 2, **SCORE})], ["league.result-unneeded"]),
        ([(Replaced, {"game": 1, **SCORE}), (Replay, {"game": 1})], ["league.result-again"] * 2),
        (
            [(Replay, {"game": 1}), (Replaced, {"game": 2, **SCORE})],
            ["league.result-again", "league.result-early"],
        ),
    ],
)
def test_why_a_result_of_a_group_is_not_used(
    more: list[tuple[type[AnyFact], dict[str, object]]], codes: list[str]
) -> None:
    """Each result or decision that changes nothing is told with its own reason."""
    match = "s:a1.1"
    facts = Facts("round-robin", "ab").play(match, 1, "a", "b", 2, 0)
    for kind, values in more:
        facts.add(kind, pairing=match, teams=("a", "b"), reason="x", **values)
    assert [one.why.code for one in facts.contest.unused] == codes


def test_a_corrected_semi_final_reopens_the_final() -> None:
    """If a semi-final is corrected, the result of the old final is unused and the final is open."""
    facts = Facts("single-knockout", "abcd")
    facts.play("s:w1.1", 1, "a", "d", 2, 0).play("s:w1.2", 1, "b", "c", 2, 0)
    facts.play("s:w2.1", 1, "a", "b", 2, 0)
    before = facts.contest
    assert before.stage("s").ranking[:2] == ("a", "b")
    facts.add(
        Replaced,
        pairing="s:w1.1",
        game=1,
        teams=("a", "d"),
        scores=(0, 1),
        outcome="right",
        reason="x",
    )
    final = facts.match("s:w2.1")
    assert ({*final.teams}, final.state) == ({"d", "b"}, "open")
    assert [one.why.code for one in facts.contest.unused] == [
        "league.result-replaced",
        "league.other-teams",
    ]
    what = changes(before, facts.contest)
    assert [now.pairing.id for _, now in what.matches] == ["s:w1.1", "s:w2.1"]
    assert ("s", "a", 1, 3) in what.ranks
    assert changes(before, before) == Changes(matches=(), ranks=(), leaving=())


def test_double_knockout_plays_a_second_final_only_if_it_must() -> None:
    """A team from the losers' bracket must win two finals; the other team needs one."""
    facts = Facts("double-knockout", "abc")
    facts.play("s:w1.2", 1, "b", "c", 1, 0).play("s:w2.1", 1, "a", "b", 1, 0)
    facts.play("s:l2.1", 1, "b", "c", 1, 0)
    once = copy(facts)
    once.play("s:f1.1", 1, "a", "b", 1, 0)
    assert once.contest.stage("s").over
    assert [row.team for row in once.contest.stage("s").tables[0].rows] == ["a", "b", "c"]

    facts.play("s:f1.1", 1, "b", "a", 1, 0)
    assert not facts.contest.stage("s").over
    facts.play("s:f2.1", 1, "b", "a", 1, 0)
    assert facts.contest.stage("s").over
    assert [(row.team, row.rank) for row in facts.contest.stage("s").tables[0].rows] == [
        ("b", 1),
        ("a", 2),
        ("c", 3),
    ]


@pytest.mark.parametrize("teams", [2, 3, 5, 8, 13, 200])
@pytest.mark.parametrize("bracket", [single_bracket, double_bracket])
def test_brackets_name_only_earlier_pairings(teams: int, bracket: object) -> None:
    """A bracket has the right number of pairings; each takes teams from seeds or earlier ones."""
    stage = Stage(
        name="s", settings=StageSettings(), entries=tuple(f"t{number}" for number in range(teams))
    )
    known: set[str] = set()
    for pairing in bracket(stage):
        for source in pairing.sources:
            assert getattr(source, "pairing", None) in {None, *known}
        assert pairing.id not in known
        known.add(pairing.id)
    size = 1 << (teams - 1).bit_length()
    assert len(known) == (size - 1 if bracket is single_bracket else 2 * size - 1)


def test_groups_are_dealt_in_snake_order() -> None:
    """Seeds are dealt to the groups a to c, then back from c to a, and so on."""
    stage = Stage(name="s", settings=StageSettings(groups=3), entries=tuple("abcdefgh"))
    assert groups(stage) == {"a": ("a", "f", "g"), "b": ("b", "e", "h"), "c": ("c", "d")}


def test_a_drawn_swiss_round_stays() -> None:
    """A correction does not change the pairs of Swiss rounds that were drawn."""
    facts = Facts("swiss", "abcd", rounds=2)
    for number in (1, 2):
        pairs = next_round(facts.contest, "s", FORMATS)
        facts.add(RoundDrawn, stage="s", round=number, pairs=pairs)
        for order, (left, right) in enumerate(pairs, 1):
            facts.play(f"s:r{number}.{order}", 1, left, right, 1, 0)
    before = [match.teams for match in facts.contest.stage("s").matches]
    assert {*map(frozenset, before)} >= {frozenset("ac"), frozenset("bd")}
    facts.add(Voided, pairing="s:r1.1", teams=before[0], reason="x")
    assert [match.teams for match in facts.contest.stage("s").matches] == before
    with pytest.raises(UserError, match="No round"):
        next_round(facts.contest, "s", FORMATS)


def test_a_match_is_moved_to_another_court_or_time() -> None:
    """The newest move of a match counts; the other matches keep their order."""
    facts = Facts("round-robin", "abcd")
    one, other = assign(facts.contest, ["x", "y"], now_ms=0)
    facts.add(Moved, pairing=other.pairing, before=one.pairing)
    assert [(a.pairing, a.court) for a in assign(facts.contest, ["x", "y"], 0)] == [
        (other.pairing, "x"),
        (one.pairing, "y"),
    ]
    facts.add(Moved, pairing=other.pairing, court="y", not_before_ms=500)
    assert [(a.pairing, a.court) for a in assign(facts.contest, ["x", "y"], 0)] == [
        (one.pairing, "x")
    ]
    assert [(a.pairing, a.court) for a in assign(facts.contest, ["x", "y"], 500)] == [
        (one.pairing, "x"),
        (other.pairing, "y"),
    ]
    assert not facts.contest.unused


def test_schedule() -> None:
    """Games go to free courts in order; teams rest between matches, not between games."""
    facts = Facts("round-robin", "abcd", games=2)
    given = assign(facts.contest, ["x", "y", "z"], now_ms=0)
    assert [one.court for one in given] == ["x", "y"]

    one = given[0]
    facts.add(Called, pairing=one.pairing, game=1, teams=one.teams, court="x")
    assert [two.teams for two in assign(facts.contest, ["x", "y"], 0)] == [given[1].teams]
    facts.play(one.pairing, 1, *one.teams, 1, 0)
    now_ms = facts[-1].at_ms
    again = assign(facts.contest, ["x"], now_ms, 60_000)
    assert [(two.pairing, two.game) for two in again] == [(one.pairing, 2)]
    facts.play(one.pairing, 2, *again[0].teams, 1, 0)
    after = assign(facts.contest, ["x", "y"], facts[-1].at_ms, 60_000)
    assert [two.pairing for two in after] == [given[1].pairing]

    facts.add(Called, pairing=given[1].pairing, game=1, teams=given[1].teams, court="y")
    facts.add(Recalled, pairing=given[1].pairing, game=1)
    assert facts.contest.running == ()


@pytest.mark.parametrize(
    ("kind", "values", "code"),
    [
        (Entered, {"team": "a"}, "league.entered-twice"),
        (Withdrawn, {"team": "z"}, "league.unknown-team"),
        (FilesChanged, {"team": "z", "files": "g", "reason": "x"}, "league.unknown-team"),
        (Planned, {"stage": "s", "format": "swiss"}, "league.drawn-already"),
        (Drawn, {"stage": "s", "entries": ("a", "b")}, "league.drawn-already"),
        (Drawn, {"stage": "t", "entries": ("a", "b")}, "league.not-planned"),
        (RoundDrawn, {"stage": "t", "round": 1, "pairs": ()}, "league.not-drawn"),
        (RoundDrawn, {"stage": "s", "round": 2, "pairs": ()}, "league.other-round"),
        (RoundDrawn, {"stage": "s", "round": 1, "pairs": (("a", "z"),)}, "league.wrong-pairs"),
        (NoShow, {"pairing": "s:r9.9", "team": "a"}, "league.unknown-pairing"),
    ],
)
def test_facts_that_change_nothing(
    kind: type[AnyFact], values: dict[str, object], code: str
) -> None:
    """A fact that does not fit is not used, and is listed with the reason."""
    facts = Facts("swiss", "abcd").add(kind, **values)
    assert [one.why.code for one in facts.contest.unused] == [code]


def test_wrong_facts_are_refused() -> None:
    """Two facts with one id, an unknown format and wrong JSON are refused."""
    facts = Facts("swiss", "ab")
    with pytest.raises(UserError, match="f0"):
        compute([*facts, Entered(id="f0", number=0, team="other")], FORMATS)
    with pytest.raises(UserError, match="chess"):
        _ = Facts("chess", "ab").contest
    data = encode(facts)
    assert decode(data) == tuple(facts)
    for wrong in (
        b"",
        b"[]",
        b"{}",
        data[:-1],
        data.replace(b'"version":1', b'"version":2'),
        data.replace(b'"entered"', b'"stolen"'),
    ):
        with pytest.raises(UserError):
            decode(wrong)


def test_every_team_meets_every_other() -> None:
    """A round robin of any size has each pair once, with sides that differ by at most one."""
    for teams in range(2, 12):
        names = tuple(f"t{number}" for number in range(teams))
        stage = Stage(name="s", settings=StageSettings(), entries=names)
        pairings = FORMATS["round-robin"].pairings(stage)
        met = [frozenset(source.team for source in pairing.sources) for pairing in pairings]
        assert {*met} == {frozenset(pair) for pair in itertools.combinations(names, 2)}
        assert len(met) == len({*met})
        for name in names:
            sides = [
                [one.team for one in pairing.sources].index(name)
                for pairing in pairings
                if name in [one.team for one in pairing.sources]
            ]
            assert abs(2 * sum(sides) - len(sides)) <= 1


@pytest.mark.parametrize("teams", [8, 16, 32, 64])
def test_losers_meet_again_late(teams: int) -> None:
    """In the first half of the losers' bracket no two teams meet again (30 random contests)."""
    names = tuple(f"t{number}" for number in range(teams))
    stage = Stage(name="s", settings=StageSettings(), entries=names)
    half = teams.bit_length() - 2  # of the rounds of the losers' bracket
    for seed in range(30):
        random = Random(seed)
        won: dict[str, str] = {}
        lost: dict[str, str] = {}
        met: set[frozenset[str]] = set()
        for pairing in double_bracket(stage):
            pair = [
                source.team
                if isinstance(source, Entrant)
                else (won if isinstance(source, WinnerOf) else lost)[source.pairing]
                for source in pairing.sources
            ]
            if pairing.section == "l" and pairing.round <= half:
                assert frozenset(pair) not in met
            met.add(frozenset(pair))
            random.shuffle(pair)
            won[pairing.id], lost[pairing.id] = pair
