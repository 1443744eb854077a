"""The contest file: courts, addresses, stages, limits (docs/operations.md). It contains no secret.

An organiser writes it once ('lacoc contest init'). Courts, office and pages are started from it.
"""

import math
import re
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any

import msgspec

from lacoc_shared.contest.access import Access
from lacoc_shared.contest.courts import (
    ContestCourt,
    Standby,
    beside,
    check_ports,
    in_folder,
    read_court,
    read_standby,
    wrong_in,
)
from lacoc_shared.contest.health_limits import HealthLimits
from lacoc_shared.contest.secrets import Secrets
from lacoc_shared.contest.toml_text import BadToml, read_toml
from lacoc_shared.contest.wrong_value import convert
from lacoc_shared.messages.desk import Replays
from lacoc_shared.mistakes import Gathered, UserError, printable
from lacoc_shared.network.address import own_address
from lacoc_shared.network.public import PublicAddress
from lacoc_shared.words import Phrase, say

_NO_NAME = "Contest"
ENTRIES, PICTURE = "entries", "picture.webp"
"""Name of the folder with the files of all teams, and name of a team's picture in it."""
ENTRY_HASH = re.compile("[0-9a-f]{32}")
"""Matches the hash of a team's files, under which the files are kept."""
MAIN = "main"
"""Name of the only court, if the file gives none."""


class ContestFile(msgspec.Struct, frozen=True, kw_only=True):
    """The content of a contest file, after all its entries were checked."""

    name: str = _NO_NAME
    recordings: Path = Path("recordings")
    """Folder of the records."""
    robot: str = "hexapod"
    """Robot of a team that sends no robot file: an installed robot's name, or a file."""
    limits: dict[str, float] = {}
    """Limits for robots that differ from the defaults (rules 1), by name."""
    health: HealthLimits = HealthLimits()
    """Limits beyond which a match should be played again."""
    replays: Replays = "at-once"
    """When everybody may see the records, which contain the gaits of both teams."""
    cheers: bool = True
    """Whether people who watch may cheer."""
    public: PublicAddress = PublicAddress()
    """The address at which everybody reaches the pages, and the certificate of pages and courts."""
    standby: Standby | None = None
    """The second machine; None: there is none."""
    courts: dict[str, ContestCourt]
    stages: dict[str, dict[str, Any]] = {}
    """The stages in their order, as they stand in the file (docs/contest.md)."""
    least_rest_s: float = 0.0
    """Shortest time between two matches of a team."""
    entries_close: datetime | None = None
    """Time after which teams enter, and change files, only if the organiser gives a reason; None:
    entries close with the first draw."""
    secrets: Secrets
    """All tokens. They are in a file beside the contest file, never in it."""

    @property
    def own_host(self) -> str:
        """Host name or address by which others reach this machine.

        With a certificate it is the host of the pages' address, because a public certificate is for
        this name. Without a certificate it is this machine's IP address.
        """
        return (self.public.host if self.public.pair else "") or own_address()

    @property
    def given_name(self) -> str:
        """The name that the organiser gave to the contest; "": the organiser gave no name."""
        return "" if self.name == _NO_NAME else self.name

    @property
    def closes_ms(self) -> int:
        """Time when entries close, in milliseconds since 1970 (UTC); 0: with the first draw."""
        return round(1000 * self.entries_close.timestamp()) if self.entries_close else 0

    @property
    def asked(self) -> str:
        """Name of the court that teams ask where they play: the first on the office's machine.

        If all courts run elsewhere, it is the first of them.
        """
        here = (name for name, court in self.courts.items() if not court.elsewhere)
        return next(here, next(iter(self.courts)))

    def court(self, name: str | None = None) -> tuple[str, ContestCourt]:
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

    def access(self, court: str) -> Access:
        """Return how a program on the office's machine reaches a court.

        Raises:
            UserError: if the authority's certificate can't be read.
        """
        entry = self.courts[court]
        authority = self.public.read_authority()
        others = tuple(filter(None, (entry.stand_in(),)))
        return Access(court=court, connect=entry.address(), others=others, authority=authority)


def sheet_path(path: Path) -> Path:
    """Return the path of a contest's newest sheet, beside the contest file."""
    return path.resolve().with_suffix(".json")


def published_path(file: Path) -> Path:
    """Return the folder in which the office publishes a contest.

    Args:
        file: the contest file, or its sheet.
    """
    return file.with_name(f"{file.stem}-published")


def picture_path(sheet: Path, files: str) -> Path | None:
    """Return the path of a team's picture; the file exists only if the team has a picture.

    None if the hash can't be one of a team's files.

    Args:
        sheet: the contest's sheet.
        files: hash of the team's files.
    """
    if not ENTRY_HASH.fullmatch(files):
        return None
    return sheet.parent / ENTRIES / files / PICTURE


def facts_path(path: Path) -> Path:
    """Return the path of the database with a contest's facts, beside the contest file."""
    return path.resolve().with_suffix(".db")


def port_path(path: Path) -> Path:
    """Return the path of the file with the port at which `contest run` last opened the pages."""
    path = path.resolve()
    return path.with_name(f"{path.stem}.port.txt")


def secrets_path(path: Path) -> Path:
    """Return the path of the file with all tokens of a contest, beside the contest file."""
    path = path.resolve()
    return path.with_name(f"{path.stem}.secrets.json")


def load(path: Path) -> ContestFile:
    """Read a contest file; relative paths in it start at its own folder.

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


def loads(data: bytes, path: Path) -> ContestFile:
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
        return _contest(table, path)
    except UserError as error:
        raise wrong_entries(path, error) from None


def wrong_entries(path: Path, error: UserError) -> UserError:
    """Return an error that has the contest file's name before each of its sentences."""
    return error.each(lambda wrong: say("contest.wrong", file=str(path), wrong=wrong))


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
    cheers: bool = True
    pages: str = ""
    certificate: _PathText | None = None
    private_key: _PathText | None = None
    authority: _PathText | None = None
    proxies: tuple[str, ...] = ()
    least_rest_s: Annotated[float, msgspec.Meta(ge=0, le=86_400)] = 0.0
    entries_close: datetime | None = None


class _ContestTables(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    contest: dict[str, Any] = {}
    limits: dict[str, Any] = {}
    health: dict[str, Any] = {}
    standby: dict[str, Any] | None = None
    court: Annotated[dict[str, Any], msgspec.Meta(min_length=1)]
    stage: dict[str, dict[str, Any]] = {}


def _contest(table: dict[str, Any], path: Path) -> ContestFile:
    folder = path.resolve().parent
    file = convert(table, _ContestTables, "")
    found = Gathered()
    general, entries = _General(), dict(file.contest)
    with found:
        _check_time(entries)
    with found:
        general = convert(entries, _General, "contest")
    public, robot = PublicAddress(), general.robot
    with found:
        public = _public(general, folder)
    recordings = folder
    with found:
        recordings = in_folder(folder, general.recordings)
    with found:
        robot = beside(folder, general.robot)
    courts = {}
    for number, (name, entry) in enumerate(file.court.items()):
        with found:
            courts[name] = read_court(name, entry, number, folder, public.protocol)
    limits = {}
    for name, value in file.limits.items():
        with found:
            limits[name] = _limit(name, value)
    health = HealthLimits()
    with found:
        health = convert(file.health, HealthLimits, "health")
    standby = None
    with found:
        standby = None if file.standby is None else read_standby(file.standby)
    found.check()
    check_ports(courts, standby)
    return ContestFile(
        name=general.name,
        recordings=recordings,
        robot=robot,
        limits=limits,
        health=health,
        replays=general.replays,
        cheers=general.cheers,
        public=public,
        standby=standby,
        courts=courts,
        stages=file.stage,
        least_rest_s=general.least_rest_s,
        entries_close=general.entries_close,
        secrets=Secrets(secrets_path(path)),
    )


def _public(general: _General, folder: Path) -> PublicAddress:
    try:
        certificate, private_key, authority = (
            None if name is None else in_folder(folder, name)
            for name in (general.certificate, general.private_key, general.authority)
        )
        return PublicAddress.of(general.pages, certificate, private_key, general.proxies, authority)
    except UserError as error:
        raise wrong_in("contest", error) from None


def _check_time(entries: dict[str, Any]) -> None:
    """Check the time when entries close, in the table [contest]; remove it if it is wrong."""
    close = entries.get("entries_close")
    try:
        time = msgspec.convert(close, datetime | None)
        if time is not None:
            time.astimezone(UTC)
    except (msgspec.ValidationError, ValueError, OverflowError, OSError):
        # No time, or one that is in no calendar in another time zone.
        del entries["entries_close"]
        found = f'"{close}"' if isinstance(close, str) else str(close)
        raise UserError(_not_a_time(found)) from None


def _limit(name: str, value: Any) -> float:
    number = convert(value, float, f"limits.{name}")
    if not math.isfinite(number):
        raise UserError(say("contest.not-finite", where=f"limits.{name}", number=str(number)))
    return number
