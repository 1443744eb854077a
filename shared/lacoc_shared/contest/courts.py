"""The tables of a contest file about machines: one for each court, one for a second machine."""

import itertools
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from lacoc_shared.contest.wrong_value import convert
from lacoc_shared.keyspace import KeySpace
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.address import (
    ANY_HOST,
    DEFAULT_PORT,
    check_protocols,
    collisions,
    endpoint,
    free_beside,
)
from lacoc_shared.network.address import host as address_host
from lacoc_shared.words import say

LOOPBACK = f"127.0.0.1:{DEFAULT_PORT}"
"""Default address on which a court listens and to which a client connects."""


class ContestCourt(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A court of the contest file: everything that is needed to start it or to reach it."""

    arena: str = "othello"
    """Name of an installed arena, or the path of an arena's folder."""
    listen: Annotated[tuple[str, ...], msgspec.Meta(min_length=1)] = (LOOPBACK,)
    """Addresses at which the court listens; by default a port of its own on its machine."""
    connect: str = ""
    """Address for clients; "": the first of `listen`."""
    elsewhere: str = ""
    """Address of another machine that runs the court; "": the office's machine runs it. If the
    other machine is gone, the office runs the court at `listen`, and clients find it at `connect`.
    """
    settings: dict[str, Any] = {}
    """Entries that replace those of the arena file."""
    input_delay: Literal["none", "equal"] = "none"
    """Whether keys are delayed until the links of all seats have the same delay."""
    input_delay_max_ms: Annotated[int, msgspec.Meta(ge=20, le=1000)] = 400
    """Largest delay that is added to make links equal; a link slower than this stays slower."""

    @property
    def most_delay_ms(self) -> int:
        """Largest delay that is added to make links equal [ms]; 0: links are not made equal."""
        return self.input_delay_max_ms if self.input_delay == "equal" else 0

    @property
    def host(self) -> str:
        """Host name at which clients reach the court if the office's machine runs it.

        "" if the court listens at all addresses and `connect` has no host.
        """
        found = address_host(self.connect or self.listen[0])
        return "" if found in ANY_HOST else found

    @property
    def own_listen(self) -> tuple[str, ...]:
        """Addresses at which the court listens on the machine that usually runs it."""
        return (_any_host(self.elsewhere),) if self.elsewhere else self.listen

    def address(self, any_host: str = "127.0.0.1") -> str:
        """Return the address at which a client connects to the court.

        Args:
            any_host: the host to put into the address if the court listens at all addresses of its
                machine.
        """
        return self.elsewhere or self._address_here(any_host)

    def stand_in(self, any_host: str = "127.0.0.1") -> str:
        """Return the clients' address for the case that the office's machine runs this court.

        This happens when the machine that usually runs the court is gone.

        Args:
            any_host: as in `address`.

        Returns:
            The address; "" if the court does not run elsewhere.
        """
        return self._address_here(any_host) if self.elsewhere else ""

    def _address_here(self, any_host: str) -> str:
        address = self.connect or self.listen[0]
        if self.host:
            return address
        protocol, port = address.partition("/")[0], address.rpartition(":")[2]
        return f"{protocol}/{any_host}:{port}"


class Standby(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The second machine: it copies all files of the office, so that the office can go on there.

    Copies are encrypted with a key that is made from a token, which itself is never sent.
    """

    office: str
    """Address of the office's machine, from which the second machine copies."""

    @property
    def listen(self) -> str:
        """Address at which the office lets the second machine copy its files."""
        return _any_host(self.office)


def wrong_in(table: str, error: UserError) -> UserError:
    """Return an error that has the name of a contest file's table before each of its sentences."""
    return error.each(lambda wrong: say("contest.in", where=table, wrong=wrong))


def read_court(name: str, table: Any, number: int, folder: Path, protocol: str) -> ContestCourt:
    """Read the table of a court in a contest file.

    Args:
        name: the court's name.
        table: the court's table in the file.
        number: its index among the courts, which chooses the port of a court without `listen`.
        folder: the contest file's folder.
        protocol: protocol of addresses that name none: "tls" in a contest with a certificate.

    Raises:
        UserError: if entries are wrong; the message names each of them.
    """
    where = f"court.{name}"
    entries = convert(table, dict[str, Any], where)
    usual = {"listen": [f"127.0.0.1:{DEFAULT_PORT + number}"]}
    court = convert(usual | entries, ContestCourt, where)
    try:
        KeySpace(name)
        listen = tuple(endpoint(one, protocol) for one in court.listen)
        connect = court.connect and endpoint(court.connect, protocol)
        elsewhere = court.elsewhere and endpoint(court.elsewhere, protocol)
        reached = [*listen, *filter(None, (connect, elsewhere))]
        check_protocols(reached, encrypted=protocol == "tls")
        return msgspec.structs.replace(
            court,
            arena=beside(folder, court.arena),
            listen=listen,
            connect=connect,
            elsewhere=elsewhere,
        )
    except UserError as error:
        raise wrong_in(where, error) from None


def read_standby(table: Any) -> Standby:
    """Read the table of the second machine in a contest file.

    Raises:
        UserError: if an entry is wrong.
    """
    found = convert(table, Standby, "standby")
    try:
        found = msgspec.structs.replace(found, office=endpoint(found.office))
        check_protocols([found.office], encrypted=False)
    except UserError as error:
        raise wrong_in("standby", error) from None
    return found


def check_ports(courts: dict[str, ContestCourt], standby: Standby | None) -> None:
    """Check that no two programs of a machine share a port.

    Two courts with different `connect` hosts are on two machines.

    Raises:
        UserError: if two programs share a port.
    """
    taken = [at for court in courts.values() for at in court.listen]
    for (first, one), (second, other) in itertools.combinations(courts.items(), 2):
        apart = one.connect and other.connect and one.host != other.host
        for at in () if apart else collisions(other.listen, one.listen):
            free = free_beside(at, taken)
            raise UserError(say("contest.same-port", court=second, other=first, at=at, free=free))
        if one.elsewhere and one.elsewhere == other.elsewhere:
            raise UserError(
                say("contest.same-machine", court=second, other=first, at=one.elsewhere)
            )
    for name, court in courts.items():
        for at in [] if standby is None else collisions([standby.listen], court.listen):
            raise UserError(say("contest.standby-port", court=name, at=at))


def beside(folder: Path, name: str) -> str:
    """Return the full path for a path in the contest file; leave an installed name unchanged.

    Args:
        folder: folder of the contest file.
        name: an installed name; or a path, which has a slash or a point.

    Raises:
        UserError: if the system can't read the path.
    """
    is_path = "/" in name or "." in name or "\\" in name
    try:
        return str(in_folder(folder, name).resolve()) if is_path else name
    except (ValueError, RuntimeError, OSError):  # a NUL, a loop of links
        raise _no_path(name) from None


def in_folder(folder: Path, name: str) -> Path:
    """Return the full path for a path in the contest file; links in it stay links.

    Args:
        folder: folder of the contest file.
        name: the path; "~" is a user's own folder.

    Raises:
        UserError: if there is no such user.
    """
    try:
        return folder / Path(name).expanduser()
    except RuntimeError:
        raise _no_path(name) from None


def _no_path(name: str) -> UserError:
    return UserError(say("contest.no-path", path=name[:80]))


def _any_host(address: str) -> str:
    """Return an address with the same protocol and port, but for all addresses of a machine."""
    protocol, port = address.partition("/")[0], address.rpartition(":")[2]
    return f"{protocol}/{ANY_HOST[0]}:{port}"
