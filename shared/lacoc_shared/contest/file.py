"""The contest file: courts, addresses, tokens, limits (docs/operations.md).

An organiser writes it once ('lacoc contest init'). A court is started from it, and a client that
has it needs no address and no token. Every setting can also be given on the command line or in the
environment, which take precedence: `options` reads both, and `entrances` looks up in this file what
is still None.
"""

import itertools
import math
import re
from collections.abc import Iterable
from datetime import datetime
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from lacoc_shared.contest.health_limits import HealthLimits
from lacoc_shared.contest.tokens import new_token
from lacoc_shared.contest.toml_text import BadToml, read_toml
from lacoc_shared.contest.wrong_value import convert
from lacoc_shared.keyspace import Keys
from lacoc_shared.messages.desk import Replays
from lacoc_shared.mistakes import Gathered, UserError, printable
from lacoc_shared.network.address import (
    ANY_HOST,
    check_protocols,
    collisions,
    endpoint,
    free_beside,
    own_address,
)
from lacoc_shared.network.address import host as address_host
from lacoc_shared.network.public import PublicAddress
from lacoc_shared.seat import Colour, Pattern
from lacoc_shared.words import Phrase, say

_NO_NAME = "Contest"
MAIN = "main"
"""Name of the court if none is given."""
LOOPBACK = "127.0.0.1:7447"
"""Default address on which a court listens and to which a client connects."""

Token = Annotated[str, msgspec.Meta(min_length=12, max_length=64)]


class Holder(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A place at a court: a seat, or the referee's desk. Whoever knows its token holds it."""

    token: Token


class SeatHolder(Holder, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A seat of a court, with the look of its team's robot."""

    colour: Colour | None = None
    """The team's own colour; None: the colour of the seat in the arena file."""
    pattern: Pattern | None = None

    @property
    def look(self) -> dict[str, str]:
        """The colour and pattern that the team has chosen."""
        both = {"colour": self.colour, "pattern": self.pattern}
        return {name: own for name, own in both.items() if own}


class Court(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A court: all that is needed to start it or to reach it."""

    arena: str
    """Name of an installed arena, or the path of an arena's folder."""
    listen: Annotated[tuple[str, ...], msgspec.Meta(min_length=1)] = (LOOPBACK,)
    """Addresses on which the court listens."""
    connect: str = ""
    """Address for clients; "": the first of `listen`."""
    elsewhere: str = ""
    """Address of another machine that runs the court; "": the office's machine runs it. If the
    other machine is gone, the office runs the court at `listen`, and clients find it at `connect`.
    """
    seat: dict[str, SeatHolder] = {}
    """Holders by the seat's name in the arena."""
    referee: Holder
    settings: dict[str, Any] = {}
    """Entries that replace those of the arena file."""
    input_delay: Literal["none", "equal"] = "none"
    """Whether keys are delayed until the links of all seats have the same delay."""
    input_delay_max_ms: Annotated[int, msgspec.Meta(ge=20, le=1000)] = 400
    """Largest delay that is added to make links equal; a link slower than this stays slower."""

    @property
    def most_delay_ms(self) -> int:
        """Largest delay that is added to make links equal [ms]; 0: none is added."""
        return self.input_delay_max_ms if self.input_delay == "equal" else 0

    @property
    def host(self) -> str:
        """Host for clients; "" if the court listens on all addresses and `connect` has no host."""
        found = address_host(self.connect or self.listen[0])
        return "" if found in ANY_HOST else found

    @property
    def own_listen(self) -> tuple[str, ...]:
        """Addresses at which the court listens on its own machine, which may be elsewhere."""
        return (_any_host(self.elsewhere),) if self.elsewhere else self.listen

    @property
    def looks(self) -> dict[str, dict[str, str]]:
        """The teams' own colours and patterns, by seat."""
        return {seat: holder.look for seat, holder in self.seat.items()}

    def address(self, any_host: str = "127.0.0.1") -> str:
        """Return the address to which a client connects.

        Args:
            any_host: the host to name if the court listens on all addresses of its machine.
        """
        return self.elsewhere or self._address_here(any_host)

    def stand_in(self, any_host: str = "127.0.0.1") -> str:
        """Return the address to which a client connects if the court's machine is gone.

        Args:
            any_host: as in `address`.

        Returns:
            The address; "" if the court is not run elsewhere.
        """
        return self._address_here(any_host) if self.elsewhere else ""

    def _address_here(self, any_host: str) -> str:
        address = self.connect or self.listen[0]
        if self.host:
            return address
        protocol, port = address.partition("/")[0], address.rpartition(":")[2]
        return f"{protocol}/{any_host}:{port}"


class Standby(Holder, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A second machine keeps a copy of all that the office keeps, and the contest can go on there.

    All copies are encrypted with a key that is made from the token. The token itself is never sent.
    """

    office: str
    """Address of the office's machine, where the second one copies."""

    @property
    def listen(self) -> str:
        """Address at which the office lets the second machine copy."""
        return _any_host(self.office)


class Contest(msgspec.Struct, frozen=True, kw_only=True):
    """A contest file, checked."""

    name: str = _NO_NAME
    recordings: Path = Path("recordings")
    """Folder of the records."""
    robot: str = "hexapod"
    """Robot of a team that sends no robot file: an installed robot's name, or a file."""
    limits: dict[str, float] = {}
    """Limits for robots, by name, where they differ from the defaults (rules 1)."""
    health: HealthLimits = HealthLimits()
    """Limits beyond which a match should be played again."""
    replays: Replays = "at-once"
    """From when everybody may see the records, which hold the gaits of both teams."""
    public: PublicAddress = PublicAddress()
    """How everybody reaches the pages, and the certificate of pages and courts."""
    office: Holder | None = None
    """Whoever assigns matches to the courts; None: each court opens its matches itself."""
    standby: Standby | None = None
    """The second machine; None: there is none."""
    courts: dict[str, Court]
    stages: dict[str, dict[str, Any]] = {}
    """The stages in their order, as they stand in the file (docs/contest.md)."""
    least_rest_s: float = 0.0
    """Shortest time between two matches of a team."""
    entries_close: datetime | None = None
    """From then on no team can enter, and files change only with a reason; None: after the first
    draw."""

    @property
    def own_host(self) -> str:
        """Host of this machine for others: with a certificate the name of the pages, if it has one.

        A public certificate has that name, and no IP address.
        """
        return (self.public.host if self.public.pair else "") or own_address()

    @property
    def given_name(self) -> str:
        """The name that the organiser gave the contest; "" if none."""
        return "" if self.name == _NO_NAME else self.name

    @property
    def asked(self) -> str:
        """The court that teams ask where they play: the first one on the office's machine."""
        here = (name for name, court in self.courts.items() if not court.elsewhere)
        return next(here, next(iter(self.courts)))

    def court(self, name: str | None = None) -> tuple[str, Court]:
        """Return a court and its name; without a name, the only court.

        Raises:
            UserError: if there is no such court, or more than one to choose from.
        """
        if name is None and len(self.courts) == 1:
            return next(iter(self.courts.items()))
        if name not in self.courts:
            courts = [*self.courts]
            if name is None:
                raise UserError(say("contest.which-court", contest=self.name, courts=courts))
            raise UserError(say("contest.no-court", contest=self.name, court=name, courts=courts))
        return name, self.courts[name]


def sheet_path(path: Path) -> Path:
    """Return where the newest sheet of a contest is: beside its contest file."""
    return path.resolve().with_suffix(".json")


def facts_path(path: Path) -> Path:
    """Return where the database of a contest's facts is: beside its contest file."""
    return path.resolve().with_suffix(".db")


def load(path: Path) -> Contest:
    """Read a contest file; relative paths in it start from its own folder.

    Raises:
        UserError: if it can't be read, or if entries are wrong; the message names each of them.
    """
    try:
        return loads(path.read_bytes(), path)
    except FileNotFoundError as error:
        why = error.strerror or str(error)
        raise UserError(say("contest.no-file", file=str(path), why=why)) from None
    except OSError as error:
        raise _cannot_read(path, error.strerror or str(error)) from None


def loads(data: bytes, path: Path) -> Contest:
    """Read the bytes of a contest file; the file itself need not exist yet.

    Args:
        data: the bytes.
        path: path of the file, for messages; relative paths in the file start at its folder.

    Raises:
        UserError: if entries are wrong; the message names each of them.
    """
    try:
        table = read_toml(data)
    except BadToml as error:
        if found := _CLOSE_LINE.match(error.line):
            wrong = _not_a_time(found[1])
            raise UserError(say("contest.wrong", file=str(path), wrong=wrong)) from None
        raise _cannot_read(path, error.phrase) from None
    try:
        return _contest(table, path.resolve().parent)
    except UserError as error:
        raise wrong_entries(path, error) from None


def wrong_entries(path: Path, error: UserError) -> UserError:
    """Return an error whose sentences begin with the name of the contest file."""
    return error.each(lambda wrong: say("contest.wrong", file=str(path), wrong=wrong))


def wrong_in(table: str, error: UserError) -> UserError:
    """Return an error whose sentences begin with the name of a table in the contest file."""
    return error.each(lambda wrong: say("contest.in", where=table, wrong=wrong))


def throwaway(
    arena: str,
    seats: Iterable[str] = ("left", "right"),
    listen: tuple[str, ...] = (LOOPBACK,),
    name: str = MAIN,
) -> Contest:
    """Make a contest of one court with fresh tokens, for a court started without a file."""
    court = Court(
        arena=arena,
        listen=tuple(map(endpoint, listen)),
        seat={seat: SeatHolder(token=new_token()) for seat in seats},
        referee=Holder(token=new_token()),
    )
    return Contest(name="throw-away", courts={name: court})


def _cannot_read(path: Path, why: Phrase | str) -> UserError:
    return UserError(say("contest.unreadable", file=str(path), why=why))


_CLOSE_LINE = re.compile(r"\s*entries_close\s*=\s*([^#]*)")


def _not_a_time(found: str) -> Phrase:
    where = "contest.entries_close"
    return say("contest.not-a-time", where=where, found=printable(found.strip()))


_PathText = Annotated[str, msgspec.Meta(pattern="^[^\\x00]*$")]


class _General(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    name: str = _NO_NAME
    recordings: _PathText = "recordings"
    robot: str = "hexapod"
    replays: Replays = "at-once"
    pages: str = ""
    certificate: _PathText | None = None
    private_key: _PathText | None = None
    authority: _PathText | None = None
    proxies: tuple[str, ...] = ()
    least_rest_s: Annotated[float, msgspec.Meta(ge=0, le=86_400)] = 0.0
    entries_close: datetime | None = None


class _File(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    contest: dict[str, Any] = {}
    limits: dict[str, Any] = {}
    health: dict[str, Any] = {}
    office: dict[str, Any] | None = None
    standby: dict[str, Any] | None = None
    court: Annotated[dict[str, Any], msgspec.Meta(min_length=1)]
    stage: dict[str, dict[str, Any]] = {}


def _contest(table: dict[str, Any], folder: Path) -> Contest:
    file = convert(table, _File, "")
    found = Gathered()
    general, entries = _General(), dict(file.contest)
    with found:
        _check_time(entries)
    with found:
        general = convert(entries, _General, "contest")
    public = PublicAddress()
    with found:
        public = _public(general, folder)
    robot = general.robot
    with found:
        robot = _beside(folder, general.robot)
    courts = {}
    for name, entry in file.court.items():
        with found:
            courts[name] = _court(name, entry, folder, public.protocol)
    limits = {}
    for name, value in file.limits.items():
        with found:
            limits[name] = _limit(name, value)
    health = HealthLimits()
    with found:
        health = convert(file.health, HealthLimits, "health")
    office = None
    with found:
        office = None if file.office is None else convert(file.office, Holder, "office")
    standby = None
    with found:
        standby = None if file.standby is None else _standby(file.standby, office, courts)
    found.check()
    _check_ports(courts)
    if office is not None:
        _check_office(office, courts)
    elif far := [name for name, court in courts.items() if court.elsewhere]:
        raise UserError(say("contest.elsewhere-without-office", court=far[0]))
    return Contest(
        name=general.name,
        recordings=folder / general.recordings,
        robot=robot,
        limits=limits,
        health=health,
        replays=general.replays,
        public=public,
        office=office,
        standby=standby,
        courts=courts,
        stages=file.stage,
        least_rest_s=general.least_rest_s,
        entries_close=general.entries_close,
    )


def _public(general: _General, folder: Path) -> PublicAddress:
    certificate, private_key, authority = (
        None if name is None else folder / Path(name).expanduser()
        for name in (general.certificate, general.private_key, general.authority)
    )
    try:
        return PublicAddress.of(general.pages, certificate, private_key, general.proxies, authority)
    except UserError as error:
        raise wrong_in("contest", error) from None


def _check_time(entries: dict[str, Any]) -> None:
    """Check the time in [contest]; a wrong one is removed from the entries."""
    close = entries.get("entries_close")
    try:
        msgspec.convert(close, datetime | None)
    except msgspec.ValidationError:
        del entries["entries_close"]
        found = f'"{close}"' if isinstance(close, str) else str(close)
        raise UserError(_not_a_time(found)) from None


def _court(name: str, table: Any, folder: Path, protocol: str) -> Court:
    where = f"court.{name}"
    entries = convert(table, dict[str, Any], where)
    found = Gathered()
    holders = {}
    with found:
        seats = convert(entries.get("seat", {}), dict[str, Any], f"{where}.seat")
        for seat, holder in seats.items():
            with found:
                holders[seat] = convert(holder, SeatHolder, f"{where}.seat.{seat}")
    court = None
    with found:
        court = convert({**entries, "seat": {}}, Court, where)
    found.check()
    assert court is not None
    tokens = [court.referee.token, *(holder.token for holder in holders.values())]
    if len(set(tokens)) < len(tokens):
        raise UserError(say("contest.same-tokens", where=where))
    try:
        Keys(name)
        listen = tuple(endpoint(one, protocol) for one in court.listen)
        connect = court.connect and endpoint(court.connect, protocol)
        elsewhere = court.elsewhere and endpoint(court.elsewhere, protocol)
        reached = [*listen, *filter(None, (connect, elsewhere))]
        check_protocols(reached, encrypted=protocol == "tls")
        return msgspec.structs.replace(
            court,
            arena=_beside(folder, court.arena),
            listen=listen,
            connect=connect,
            elsewhere=elsewhere,
            seat=holders,
        )
    except UserError as error:
        raise wrong_in(where, error) from None


def _check_office(office: Holder, courts: dict[str, Court]) -> None:
    if office.token in _tokens(courts):
        raise UserError(say("contest.same-tokens", where="office"))


def _standby(table: dict[str, Any], office: Holder | None, courts: dict[str, Court]) -> Standby:
    found = convert(table, Standby, "standby")
    try:
        found = msgspec.structs.replace(found, office=endpoint(found.office))
        check_protocols([found.office], encrypted=False)
    except UserError as error:
        raise wrong_in("standby", error) from None
    if office is None:
        raise UserError(say("contest.standby-without-office"))
    if found.token in {office.token, *_tokens(courts)}:  # those are sent, and can be overheard
        raise UserError(say("contest.same-tokens", where="standby"))
    for name, court in courts.items():
        for at in collisions([found.listen], court.listen):
            raise UserError(say("contest.standby-port", court=name, at=at))
    return found


def _tokens(courts: dict[str, Court]) -> set[str]:
    holders = (one for court in courts.values() for one in (court.referee, *court.seat.values()))
    return {holder.token for holder in holders}


def _any_host(address: str) -> str:
    """Return an address at all addresses of a machine, with the port of another address."""
    protocol, port = address.partition("/")[0], address.rpartition(":")[2]
    return f"{protocol}/{ANY_HOST[0]}:{port}"


def _check_ports(courts: dict[str, Court]) -> None:
    """Check that no two courts of a machine share a port.

    Two courts with different `connect` hosts are on two machines.
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


def _limit(name: str, value: Any) -> float:
    number = convert(value, float, f"limits.{name}")
    if not math.isfinite(number):
        raise UserError(say("contest.not-finite", where=f"limits.{name}", number=str(number)))
    return number


def _beside(folder: Path, name: str) -> str:
    """Return an installed name unchanged; resolve a path from the contest file's folder."""
    is_path = "/" in name or "." in name or "\\" in name
    try:
        return str((folder / Path(name).expanduser()).resolve()) if is_path else name
    except (ValueError, RuntimeError, OSError):  # a NUL, an unknown user, a loop of links
        raise UserError(say("contest.no-path", path=name[:80])) from None
