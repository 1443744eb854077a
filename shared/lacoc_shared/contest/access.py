"""How a client reaches a court: the court's addresses and certificate, and the client's token."""

from typing import Self

import msgspec


class Access(msgspec.Struct, frozen=True, kw_only=True):
    """How a client reaches a court, and the token that the client shows there."""

    court: str
    connect: str
    """Address of the court."""
    others: tuple[str, ...] = ()
    """Further addresses at which this court, or another court of the event, may be found."""
    seat: str = ""
    """Id of the seat; "": the seat is not known yet, or the client has none."""
    token: str = ""
    """The person's secret; "" for spectators."""
    authority: str = ""
    """Certificate (PEM) of a private authority that signed the court's certificate; "": only public
    authorities are trusted."""

    def __repr__(self) -> str:
        return f"Access(court={self.court!r}, seat={self.seat!r}, connect={self.connect!r})"

    @property
    def addresses(self) -> list[str]:
        """All addresses at which to look for the court; the first one that answers is used."""
        return [self.connect, *self.others]

    def watching(self) -> Self:
        """Return how a spectator reaches the same court, without a token."""
        return msgspec.structs.replace(self, seat="", token="")

    def of_seat(self, seat: str, token: str) -> Self:
        """Return how a player with this token reaches a seat at the same court."""
        return msgspec.structs.replace(self, seat=seat, token=token)

    def of_referee(self, token: str) -> Self:
        """Return how a referee with this token reaches the same court."""
        return msgspec.structs.replace(self, seat="", token=token)
