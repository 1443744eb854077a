"""Single and double knockout: each pairing names the earlier pairings from which its teams come."""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

import msgspec

from lacoc_server.contest.league.formats.format import DrawnAtOnce, Stage
from lacoc_server.contest.league.matches import ContestMatch
from lacoc_server.contest.league.pairing import AnySource, Bye, Entrant, LoserOf, Pairing, WinnerOf
from lacoc_server.contest.league.standings import Standing, Table, counted, standings

ORDER = ("seed",)
"""The tie-break of a knockout's table: teams that went out in the same round share a rank."""
_LEVEL = ("difference", "seed")
"""The ways to decide a match that is level in games; tie-breaks have the same codes."""


class Knockout(DrawnAtOnce):
    """A bracket. Whoever loses is out, or gets a second chance in the losers' bracket."""

    decisive = True
    balanced = True

    def __init__(self, *, double: bool) -> None:
        """Make the format.

        Args:
            double: True: a team is out after two defeats.
        """
        self.double = double
        self.settings = frozenset({"games", "extra_games", "reset" if double else "third_place"})

    def pairings(self, stage: Stage) -> tuple[Pairing, ...]:
        """Return all pairings of the bracket."""
        if len(stage.entries) < 2:
            return ()
        return tuple(double_bracket(stage) if self.double else single_bracket(stage))

    def tables(
        self, stage: Stage, matches: Mapping[str, ContestMatch], last: Collection[str]
    ) -> tuple[Table, ...]:
        """Rank the teams by the round in which they went out; first come those that are not out."""
        places = _places(matches.values())
        rows = standings(stage.entries, counted(matches.values()), ORDER, last).rows
        rows = tuple(sorted(rows, key=lambda row: (row.out, places.get(row.team, 0))))
        decided = {(match.winner, match.loser): match.how for match in _last(matches.values())}
        ranked: list[Standing] = []
        best = 2 if _has_no_winner(matches.values(), places) else 1
        for number, row in enumerate(rows, 1):
            before = ranked[-1] if ranked else None
            tied = before is not None and (places.get(row.team, 0), row.out) == (
                places.get(before.team, 0),
                before.out,
            )
            rank = before.rank if before is not None and tied else max(number, best)
            how = decided.get((before.team, row.team), "") if before is not None else ""
            code = how if how in _LEVEL else ""
            ranked.append(msgspec.structs.replace(row, rank=rank, shares=False, decided_by=code))
        return (Table(section="", tie_breaks=ORDER, rows=tuple(ranked)),)


def _last(matches: Iterable[ContestMatch]) -> Iterator[ContestMatch]:
    """Yield the decided matches that settle the winner's final place, such as the final itself."""
    for match in matches:
        if match.pairing.winner_place and match.state == "decided":
            yield match


def _has_no_winner(matches: Iterable[ContestMatch], places: Mapping[str, int]) -> bool:
    """Return whether the final is decided, and nobody has won it: no team came, or it is void."""
    finals = [match for match in matches if match.pairing.winner_place == 1]
    return bool(finals) and all(match.decided for match in finals) and 1 not in places.values()


def _places(matches: Collection[ContestMatch]) -> dict[str, int]:
    """Return the final places that are settled, by team."""
    resets = {match.pairing.only_if_second_won: match for match in matches}
    places: dict[str, int] = {}
    for match in matches:
        reset = resets.get(match.pairing.id)
        if match.state != "decided" or (reset is not None and reset.state != "off"):
            continue
        if match.pairing.winner_place and match.winner:
            places[match.winner] = match.pairing.winner_place
        if match.pairing.loser_place:
            places.update(dict.fromkeys(_leaving(match), match.pairing.loser_place))
    return places


def _leaving(match: ContestMatch) -> list[str]:
    """Return the teams that leave the stage when this decided match is over."""
    if not match.winner:
        leaving = match.teams
    elif match.pairing.loser_goes_on:
        return []
    else:
        leaving = (match.loser, None)
    return [team for team in leaving if team]


def seeded(entries: Sequence[str]) -> list[AnySource]:
    """Place the teams in a bracket, so that the best two can meet only in the final.

    The best four can meet only in the semi-finals or later, and so on for eight and more. The list
    has a team or a bye for each place of round 1: as many as the next power of two. The best teams
    have the byes.
    """
    order = [0]
    while len(order) < len(entries):
        size = 2 * len(order)
        order = [place for seed in order for place in (seed, size - 1 - seed)]
    return [Entrant(entries[seed]) if seed < len(entries) else Bye() for seed in order]


def single_bracket(stage: Stage) -> Iterator[Pairing]:
    """Yield the pairings of a single knockout, round by round."""
    places = seeded(stage.entries)
    size = len(places)
    yield from _winners(stage, places, lambda number: size // 2**number + 1, final_place=1)
    if stage.settings.third_place and size >= 4:
        semi = size.bit_length() - 2
        yield Pairing(
            id=stage.id("p", 1, 1),
            section="p",
            round=1,
            sources=(LoserOf(stage.id("w", semi, 1)), LoserOf(stage.id("w", semi, 2))),
            winner_place=3,
            loser_place=4,
        )


def _winners(
    stage: Stage,
    places: Sequence[AnySource],
    loser_place: Callable[[int], int],
    final_place: int | None,
    loser_goes_on: bool = False,
) -> Iterator[Pairing]:
    """Yield the pairings of the winners' bracket, round by round."""
    sources, number = list(places), 1
    while len(sources) > 1:
        pairs = list(zip(sources[::2], sources[1::2], strict=True))
        for order, pair in enumerate(pairs, 1):
            yield Pairing(
                id=stage.id("w", number, order),
                section="w",
                round=number,
                sources=pair,
                winner_place=final_place if len(pairs) == 1 else None,
                loser_place=loser_place(number),
                loser_goes_on=loser_goes_on,
            )
        sources = [WinnerOf(stage.id("w", number, order)) for order in range(1, len(pairs) + 1)]
        number += 1


def double_bracket(stage: Stage) -> Iterator[Pairing]:
    """Yield the pairings of a double knockout: winners' bracket, losers' bracket, finals.

    In odd rounds of the losers' bracket, the teams that are still in it meet each other. In even
    rounds they meet the teams that just fell from the winners' bracket. These are reordered
    (`_turned`), so that with up to 64 teams no two meet again in the first half of the losers'
    bracket.
    """
    places = seeded(stage.entries)
    last = len(places).bit_length() - 1
    yield from _winners(stage, places, lambda number: _fall(number, last), None, True)
    finalist: AnySource = LoserOf(stage.id("w", 1, 1))
    if last > 1:
        yield from _losers(stage, last)
        finalist = WinnerOf(stage.id("l", 2 * (last - 1), 1))
    champion = WinnerOf(stage.id("w", last, 1))
    final = stage.id("f", 1, 1)
    yield Pairing(
        id=final, section="f", round=1, sources=(champion, finalist), winner_place=1, loser_place=2
    )
    if stage.settings.reset:
        yield Pairing(
            id=stage.id("f", 2, 1),
            section="f",
            round=2,
            sources=(LoserOf(final), WinnerOf(final)),
            winner_place=1,
            loser_place=2,
            only_if_second_won=final,
        )


def _fall(number: int, last: int) -> int:
    """Return the final place of a team that loses its first match in the losers' bracket.

    Args:
        number: round of the winners' bracket from which the team fell.
        last: number of rounds of the winners' bracket.
    """
    if number > 1:
        return (1 << (last - number + 1)) + 1
    return 2 if last == 1 else 3 * (1 << (last - 2)) + 1


def _losers(stage: Stage, last: int) -> Iterator[Pairing]:
    """Yield the pairings of the losers' bracket; the winners' bracket has `last` rounds."""
    out = 2**last  # places that are still open
    sources: list[AnySource] = [
        LoserOf(stage.id("w", 1, order)) for order in range(1, 2 ** (last - 1) + 1)
    ]
    for number in range(1, 2 * (last - 1) + 1):
        if number % 2:
            pairs = list(zip(sources[::2], sources[1::2], strict=True))
        else:
            fell = number // 2 + 1
            falling = [LoserOf(stage.id("w", fell, order)) for order in range(1, len(sources) + 1)]
            pairs = list(zip(_turned(falling, fell), sources, strict=True))
        out -= len(pairs)
        for order, pair in enumerate(pairs, 1):
            yield Pairing(
                id=stage.id("l", number, order),
                section="l",
                round=number,
                sources=pair,
                loser_place=out + 1,
            )
        sources = [WinnerOf(stage.id("l", number, order)) for order in range(1, len(pairs) + 1)]


def _turned(falling: Sequence[AnySource], number: int) -> list[AnySource]:
    """Reorder the losers of a round of the winners' bracket, so that teams seldom meet again.

    Losers of an even round are reversed; of an odd round, the two halves are swapped.
    """
    half = len(falling) // 2
    return [*reversed(falling)] if number % 2 == 0 else [*falling[half:], *falling[:half]]


SINGLE = Knockout(double=False)
DOUBLE = Knockout(double=True)
