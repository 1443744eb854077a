"""A client's access to a court: where the court is, how it proves its name, and who asks."""

from collections.abc import Sequence
from typing import Self

import msgspec


class Access(msgspec.Struct, frozen=True, kw_only=True):
    """Address of a court, and proof of identity for a client."""

    court: str
    connect: str
    """Address of the court."""
    others: tuple[str, ...] = ()
    """Further addresses at which the court, or another one of the event, may be."""
    seat: str = ""
    """The seat's name; "": not known yet, or none."""
    token: str = ""
    """The person's secret; "" for spectators."""
    authority: str = ""
    """Certificate (PEM) of a private authority that vouches for the court; "": public ones only."""

    def __repr__(self) -> str:
        return f"Access(court={self.court!r}, seat={self.seat!r}, connect={self.connect!r})"

    @property
    def addresses(self) -> list[str]:
        """Where to look for the court: the first address that answers is used."""
        return [self.connect, *self.others]

    def watching(self) -> Self:
        """Return the access of a spectator to the same court."""
        return msgspec.structs.replace(self, seat="", token="")

    def with_others(self, addresses: Sequence[str]) -> Self:
        """Return this access with these further addresses."""
        return msgspec.structs.replace(self, others=tuple(addresses))

    def of_seat(self, seat: str, token: str) -> Self:
        """Return the access of a seat at the same court."""
        return msgspec.structs.replace(self, seat=seat, token=token)

    def of_referee(self, token: str) -> Self:
        """Return the access of a referee to the same court."""
        return msgspec.structs.replace(self, seat="", token=token)
