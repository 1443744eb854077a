"""A pairing: two places that meet, each with the source of its team."""

import msgspec


class Source(msgspec.Struct, frozen=True, tag_field="source", omit_defaults=True):
    """Where the team of a place in a pairing comes from."""


class Entrant(Source, frozen=True, tag="entry"):
    """The team of a place is one that the draw puts there."""

    team: str


class WinnerOf(Source, frozen=True, tag="winner"):
    """The team of a place is the winner of an earlier pairing."""

    pairing: str


class LoserOf(Source, frozen=True, tag="loser"):
    """The team of a place is the loser of an earlier pairing."""

    pairing: str


class Bye(Source, frozen=True, tag="bye"):
    """No team: the place stays empty, so the other team goes on without a match."""


AnySource = Entrant | WinnerOf | LoserOf | Bye


class Pairing(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """Two places that meet in a stage."""

    id: str
    """Names the pairing in the contest, such as "finals:w1.3"."""
    section: str
    """Part of the stage: a group ("a"); winners' bracket ("w"), losers' bracket ("l"), finals ("f")
    or match for third place ("p") of a knockout; "r" if rounds are drawn one by one."""
    round: int
    """Round within its section, from 1."""
    sources: tuple[AnySource, AnySource]
    """Sources of the first and the second place. The first place sits left in game 1, unless the
    format is `balanced`."""
    winner_place: int | None = None
    """Final rank of the winner in the stage; None: this pairing does not decide it."""
    loser_place: int | None = None
    """Best final rank of the teams that leave the stage in this round; None: the stage is no
    knockout."""
    loser_goes_on: bool = False
    """True: the loser has another match. So teams leave the stage here only if nobody wins."""
    only_if_second_won: str = ""
    """Id of another pairing: this one is played only if the team in the second place of that one
    wins it. "": always."""
