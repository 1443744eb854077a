"""A pairing: two places that meet, each with the source of its team."""

import msgspec


class Source(msgspec.Struct, frozen=True, tag_field="source", omit_defaults=True):
    """Where the team of a place comes from."""


class Entrant(Source, frozen=True, tag="entry"):
    """A team of the draw."""

    team: str


class WinnerOf(Source, frozen=True, tag="winner"):
    """The winner of an earlier pairing."""

    pairing: str


class LoserOf(Source, frozen=True, tag="loser"):
    """The loser of an earlier pairing."""

    pairing: str


class Bye(Source, frozen=True, tag="bye"):
    """Nobody; whoever meets nobody goes on without a match."""


AnySource = Entrant | WinnerOf | LoserOf | Bye


class Pairing(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """Two places that meet in a stage."""

    id: str
    """Names the pairing in the contest, such as "finals:w1.3"."""
    section: str
    """Part of the stage: a group ("a"), "w", "l" or "f" of a knockout, "r" of a Swiss stage."""
    round: int
    """Round in its section, from 1."""
    sources: tuple[AnySource, AnySource]
    """The first place sits left in game 1, unless the format balances sides by what was played."""
    winner_place: int | None = None
    """Final place of the winner, if the pairing decides it."""
    loser_place: int | None = None
    """Best place of those who leave the stage in this round."""
    loser_goes_on: bool = False
    """True: the loser has another match; teams leave here only if nobody wins."""
    only_if_second_won: str = ""
    """A pairing; this one is played only if the second place won there."""
