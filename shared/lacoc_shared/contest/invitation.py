"""A client's access to a court, and its file: an invitation.

An organiser gives one to each person (`lacoc contest keys` makes them). It holds all that
a command needs: court, address, seat and token, and the certificate that proves the
court's identity. The user's network password is derived from the token, so each person
has only one secret.
"""

from pathlib import Path
from typing import Literal, Self

import msgspec

from lacoc_shared import seal
from lacoc_shared.contest.toml_text import BadToml, read_toml
from lacoc_shared.keyspace import Keys
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.access_rules import Credentials
from lacoc_shared.network.address import endpoint
from lacoc_shared.words import Phrase, say

Role = Literal["seat", "referee", "gateway", "spectators"]

_MAX_BYTES = 1 << 16


class Access(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Address and proof of identity for a client; an invitation file has just these entries."""

    court: str
    connect: str
    """Address of the court."""
    stand_in: str = ""
    """Address at which the court goes on if the machine at `connect` is gone; "": none."""
    role: Role = "spectators"
    seat: str = ""
    """The seat's name; "" for every other role."""
    token: str = ""
    """The person's secret; "" for spectators."""
    ca: str = ""
    """Certificate (PEM) of the authority that signs the court's; "": a court without keys."""

    def __repr__(self) -> str:
        return f"Access(user={self.user!r}, connect={self.connect!r})"

    @property
    def addresses(self) -> list[str]:
        """Where to look for the court: the first address that answers is used."""
        return [self.connect, self.stand_in] if self.stand_in else [self.connect]

    @property
    def user(self) -> str:
        """User name on the network, such as "main.left"."""
        return f"{self.court}.{self.seat if self.role == 'seat' else self.role}"

    @property
    def credentials(self) -> Credentials | None:
        """Network credentials; None for a court without keys."""
        if not self.ca:
            return None
        return Credentials(self.user, seal.password(self.user, self.token), self.ca)

    def watching(self) -> Self:
        """Return the access of a spectator to the same court."""
        return msgspec.structs.replace(self, role="spectators", seat="", token="")

    def of_seat(self, seat: str, token: str) -> Self:
        """Return the access of a seat at the same court."""
        return msgspec.structs.replace(self, role="seat", seat=seat, token=token)

    def of_referee(self, token: str) -> Self:
        """Return the access of a referee to the same court."""
        return msgspec.structs.replace(self, role="referee", seat="", token=token)

    def of_gateway(self, token: str) -> Self:
        """Return the access of a gateway to the same court."""
        return msgspec.structs.replace(self, role="gateway", seat="", token=token)


def read_invitation(path: Path) -> Access:
    """Read an invitation.

    Raises:
        UserError: if it can't be read, or is not an invitation.
    """
    try:
        access = msgspec.convert(read_toml(path.read_bytes(), _MAX_BYTES), Access)
        Keys(access.court)
        protocol = "tls" if access.ca else "tcp"
        connect = endpoint(access.connect, protocol)
        stand_in = access.stand_in and endpoint(access.stand_in, protocol)
        return msgspec.structs.replace(access, connect=connect, stand_in=stand_in)
    except (OSError, BadToml, msgspec.ValidationError, UserError) as error:
        if isinstance(error, UserError):
            wrong = say("contest.invitation-wrong", path=str(path), why=error.phrase)
            raise UserError(wrong) from None
        why: Phrase | str = str(error)
        if isinstance(error, BadToml):
            why = error.phrase
        elif isinstance(error, OSError):
            why = error.strerror or str(error)
        raise UserError(say("contest.invitation-unreadable", path=str(path), why=why)) from None


def invitation_text(access: Access, contest: str) -> str:
    """Return the text of an invitation file (TOML).

    Args:
        access: the entries of the invitation.
        contest: the contest's name.
    """
    whose = f"seat {access.seat}" if access.role == "seat" else access.role
    known = "Everybody may have it." if not access.token else "It is for one: show it to nobody."
    lines = [f"# {_one_line(contest)}: invitation of court {access.court} for {whose}. {known}"]
    for name, value in msgspec.structs.asdict(access).items():
        if value:
            # A JSON string is also a TOML string; a certificate is easier to read in lines.
            text = f'"""\n{value}"""' if name == "ca" else msgspec.json.encode(value).decode()
            lines.append(f"{name} = {text}")
    return "\n".join([*lines, ""])


def _one_line(text: str) -> str:
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())
