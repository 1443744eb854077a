"""Tests of standings: matches are counted, and ties are broken by codes, in their order."""

import pytest

from lacoc_server.contest.league.standings import Counted, standings
from lacoc_shared.mistakes import UserError

ABCD = ("a", "b", "c", "d")


def won(winner: str, loser: str, score: int = 1, against: int = 0) -> Counted:
    return Counted((winner, loser), (score, against), 0)


def drawn(one: str, other: str, each: int = 0) -> Counted:
    return Counted((one, other), (each, each), None)


CIRCLE = [won("a", "b", 3), won("b", "c", 2), won("c", "a", 4), *(won(one, "d") for one in "abc")]
"""a, b and c beat each other in a circle, and each of them beats d."""


@pytest.mark.parametrize(
    ("matches", "order", "ranked", "ranks"),
    [
        ([], ("points",), "abcd", "1111"),
        ([won("d", "a")], ("points",), "dabc", "1222"),
        ([won("c", "b"), drawn("a", "d")], ("points",), "cadb", "1224"),
        (
            [drawn("b", "d"), won("d", "a"), won("b", "a"), won("d", "b")],
            ("points", "direct"),
            "dbac",
            "1233",
        ),
        (
            [won("b", "a"), won("a", "c", 9), won("b", "d", 9), won("a", "d")],
            ("points", "direct"),
            "bacd",
            "1233",
        ),
        (CIRCLE, ("points", "direct"), "abcd", "1114"),
        (CIRCLE, ("points", "direct", "difference"), "cabd", "1224"),
        (CIRCLE, ("points", "direct", "scored"), "cabd", "1234"),
        ([drawn("b", "c", 7), drawn("a", "d", 2)], ("points", "scored"), "bcad", "1133"),
        ([won("b", "a"), drawn("c", "a"), drawn("c", "d")], ("points", "wins"), "bcad", "1233"),
        (
            [won("b", "a"), drawn("c", "d"), drawn("d", "c")],
            ("points", "fewest-lost"),
            "bcda",
            "1114",
        ),
        ([won("a", "c"), won("b", "d"), won("d", "c")], ("points", "buchholz"), "bdac", "1134"),
        ([won("a", "c"), won("b", "d"), won("d", "c")], ("points", "sonneborn"), "badc", "1224"),
    ],
)
def test_order(matches: list[Counted], order: tuple[str, ...], ranked: str, ranks: str) -> None:
    """Each tie-break orders teams that earlier ones left equal; the rest share a rank."""
    found = standings(ABCD, matches, order)

    assert "".join(row.team for row in found.rows) == ranked
    assert "".join(str(row.rank) for row in found.rows) == ranks
    assert [row.shares for row in found.rows] == [ranks.count(rank) > 1 for rank in ranks]
    assert found.tie_breaks == (*order, "seed")
    assert standings(ABCD, matches[::-1], order) == found


def test_bye_counts_as_a_win_and_own_points_as_opponent() -> None:
    """A bye gives two points; Buchholz counts it as an opponent with as many points as the team."""
    bye = Counted(("a",), (0,), 0, played=False)

    row = standings(ABCD, [bye, won("b", "a")], ("points", "buchholz")).rows[0]

    assert (row.team, row.won, row.lost, row.points) == ("a", 1, 1, 2)
    assert row.tie_breaks[:2] == (2, 2 + 2)


def test_disqualified_are_last() -> None:
    """A disqualified team is ranked last, whatever it has won."""
    found = standings(ABCD, [won("a", "b"), won("a", "c")], ("points",), last=["a"])

    assert [row.team for row in found.rows] == ["b", "c", "d", "a"]
    assert [row.out for row in found.rows] == [False, False, False, True]


def test_unknown_code() -> None:
    """An unknown tie-break is refused, and the error names it."""
    with pytest.raises(UserError, match="chance"):
        standings(ABCD, [], ("points", "chance"))


def test_each_rank_says_what_decided_it() -> None:
    """A row names the code that ranks its team below the one above; "seed": all were equal."""
    matches = [
        Counted(("A", "B"), (5, 5), None),
        Counted(("C", "D"), (9, 1), 0),
        Counted(("E", "F"), (2, 1), 0),
    ]
    table = standings("ABCDEF", matches, ("points", "difference"), last=("F",))
    assert [(row.team, row.decided_by) for row in table.rows] == [
        ("C", ""),
        ("E", "difference"),
        ("A", "points"),
        ("B", "seed"),
        ("D", "points"),
        ("F", ""),
    ]
