"""The interface of a format, which says who meets whom in a stage, and how its teams are ranked."""

from collections.abc import Collection, Mapping
from typing import Protocol

import msgspec

from lacoc_server.contest.league.facts import StageSettings
from lacoc_server.contest.league.matches import ContestMatch
from lacoc_server.contest.league.pairing import Bye, Entrant, Pairing
from lacoc_server.contest.league.standings import Table, counted, standings

Pair = tuple[str, ...]
"""The left team and the right team of a pairing that is drawn; a team alone has a bye."""


class Stage(msgspec.Struct, frozen=True, kw_only=True):
    """What is fixed of a stage once it is drawn: settings, teams, and the rounds drawn so far."""

    name: str
    settings: StageSettings
    entries: tuple[str, ...]
    """The teams by seeding, the best first."""
    drawn: tuple[tuple[Pair, ...], ...] = ()
    """The rounds that were drawn, in a format that draws rounds one by one."""

    def id(self, section: str, round_number: int, number: int) -> str:
        """Return the id of a pairing, from its section, its round and its number there, from 1."""
        return f"{self.name}:{section}{round_number}.{number}"

    def order(self, usual: tuple[str, ...]) -> tuple[str, ...]:
        """Return the codes that rank the teams: points and the plan's tie-breaks.

        If the plan names no tie-breaks, the codes are `usual`.
        """
        return ("points", *self.settings.tie_breaks) if self.settings.tie_breaks else usual


class Format(Protocol):
    """How a stage is played: who meets whom, and how teams are ranked; pure."""

    settings: frozenset[str]
    """The names of the settings that it reads, such as "rounds"."""
    decisive: bool
    """True: a match must have a winner."""
    balanced: bool
    """True: the team that sat left less often sits left. False: the pairing says who sits left."""

    def pairings(self, stage: Stage) -> tuple[Pairing, ...]:
        """Return all pairings that are fixed so far; their ids are made by `Stage.id`.

        Each comes after the pairings from which its teams come.
        """

    def rounds(self, stage: Stage) -> int:
        """Return the largest number of rounds that are drawn one by one; 0: none is."""

    def is_decided(
        self, stage: Stage, matches: Mapping[str, ContestMatch], gone: Collection[str]
    ) -> bool:
        """Return whether the stage ends before all its rounds are drawn.

        This is called only when all matches of the drawn rounds are decided and rounds are left.
        `gone` has the teams that have left the contest.
        """

    def next_round(
        self, stage: Stage, matches: Mapping[str, ContestMatch], gone: Collection[str]
    ) -> tuple[Pair, ...]:
        """Pair the teams for the next round, without those in `gone`, which have left the contest.

        This is called only when all earlier rounds are decided.
        """

    def tables(
        self, stage: Stage, matches: Mapping[str, ContestMatch], last: Collection[str]
    ) -> tuple[Table, ...]:
        """Rank the teams, in a table for each group.

        Args:
            stage: the stage.
            matches: its matches by the pairing's id.
            last: teams that are ranked last, whatever they won.
        """


class _AllRounds:
    """Base of formats: all rounds are played, unless the format has an `is_decided` of its own."""

    def is_decided(
        self, stage: Stage, matches: Mapping[str, ContestMatch], gone: Collection[str]
    ) -> bool:
        """Return False: a stage of this format never ends early."""
        return False


class DrawnAtOnce(_AllRounds):
    """Base of the formats whose draw fixes all rounds at once."""

    def rounds(self, stage: Stage) -> int:
        """Return 0: no round is drawn later."""
        return 0

    def next_round(
        self, stage: Stage, matches: Mapping[str, ContestMatch], gone: Collection[str]
    ) -> tuple[Pair, ...]:
        """Return no pairs: there is no round to draw."""
        return ()


class DrawnByRound(_AllRounds):
    """Base of the formats whose rounds are drawn one by one, and which have a single table."""

    order: tuple[str, ...]
    """Codes that rank the teams, unless the plan names tie-breaks."""

    def pairings(self, stage: Stage) -> tuple[Pairing, ...]:
        """Return the pairings of the rounds that are drawn."""
        return tuple(
            Pairing(
                id=stage.id("r", number, order),
                section="r",
                round=number,
                sources=(Entrant(pair[0]), Entrant(pair[1]) if len(pair) == 2 else Bye()),
            )
            for number, pairs in enumerate(stage.drawn, 1)
            for order, pair in enumerate(pairs, 1)
        )

    def tables(
        self, stage: Stage, matches: Mapping[str, ContestMatch], last: Collection[str]
    ) -> tuple[Table, ...]:
        """Rank all teams in one table."""
        found = counted(matches.values())
        return (standings(stage.entries, found, stage.order(self.order), last),)
