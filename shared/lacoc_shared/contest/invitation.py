"""Who somebody is at a court, and the small file that says it: an invitation.

An organiser hands one to each person (`lacoc contest keys` makes them). It holds all that
a command needs to get in: court, address, seat and token, and the certificate by which
the court is known. The user's password for the network comes from the token, so one
secret a person is enough.
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
    """Where a client goes, and what proves who it is; an invitation file holds just this."""

    court: str
    connect: str
    """Address of the court."""
    role: Role = "spectators"
    seat: str = ""
    """The seat it holds; "" for everybody else."""
    token: str = ""
    """"" for spectators."""
    ca: str = ""
    """Certificate (PEM) of the authority that vouches for the court; "": a court without keys."""

    def __repr__(self) -> str:
        return f"Access(user={self.user!r}, connect={self.connect!r})"

    @property
    def user(self) -> str:
        """The network's name for it, such as "main.left"."""
        return f"{self.court}.{self.seat if self.role == 'seat' else self.role}"

    @property
    def credentials(self) -> Credentials | None:
        """For the network; None for a court without keys."""
        if not self.ca:
            return None
        return Credentials(self.user, seal.password(self.user, self.token), self.ca)

    def watching(self) -> Self:
        """The same way for somebody who only watches."""
        return msgspec.structs.replace(self, role="spectators", seat="", token="")

    def of_seat(self, seat: str, token: str) -> Self:
        """The same way for a seat's holder."""
        return msgspec.structs.replace(self, role="seat", seat=seat, token=token)

    def of_referee(self, token: str) -> Self:
        """The same way for a referee."""
        return msgspec.structs.replace(self, role="referee", seat="", token=token)

    def of_gateway(self, token: str) -> Self:
        """The same way for a gateway."""
        return msgspec.structs.replace(self, role="gateway", seat="", token=token)


def read_invitation(path: Path) -> Access:
    """Read an invitation.

    Raises:
        UserError: if it can't be read, or is none.
    """
    try:
        access = msgspec.convert(read_toml(path.read_bytes(), _MAX_BYTES), Access)
        Keys(access.court)
        connect = endpoint(access.connect, "tls" if access.ca else "tcp")
        return msgspec.structs.replace(access, connect=connect)
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
    """Write an invitation.

    Args:
        access: what it says.
        contest: the contest's name.
    """
    whose = f"seat {access.seat}" if access.role == "seat" else access.role
    known = "Everybody may have it." if not access.token else "It is for one: show it to nobody."
    lines = [f"# {_one_line(contest)}: invitation of court {access.court} for {whose}. {known}"]
    for name, value in msgspec.structs.asdict(access).items():
        if value:
            # A JSON string is a TOML string as well; a certificate is better read in lines.
            text = f'"""\n{value}"""' if name == "ca" else msgspec.json.encode(value).decode()
            lines.append(f"{name} = {text}")
    return "\n".join([*lines, ""])


def _one_line(text: str) -> str:
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())
