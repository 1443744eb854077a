"""Where the files of a contest are: beside its contest file."""

import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from lacoc_arenas.arena import Arena
from lacoc_server.contest.kept import machine
from lacoc_server.contest.kept.entries import EntryFolder
from lacoc_server.contest.kept.plans import game, open_stage, plans
from lacoc_shared.command.holding import hold
from lacoc_shared.contest import file as contests
from lacoc_shared.gait.tables import Level
from lacoc_shared.mistakes import UserError, text_of
from lacoc_shared.words import say


class RunsAlready(UserError):
    """Another process runs the contest."""


class ContestFolder:
    """The files of a contest.

    Args:
        file: its contest file.

    Raises:
        UserError: if the contest file can't be read, or has a mistake.
    """

    def __init__(self, file: Path) -> None:
        self.file = file
        self.contest = contests.load(file)
        self.plans = plans(self.contest, file)
        """The stages in the order of the contest file, without the open stage."""
        self.open_stage = open_stage(self.contest, file)
        """The stage of open matches; None: there is none."""
        self.folder = folder = file.resolve().parent
        """Folder of the contest file; paths in the file start there."""
        self.facts = contests.facts_path(file)
        """File of the database of facts."""
        self.sheet = contests.sheet_path(file)
        """File of the newest sheet, for pages."""
        self.applications = folder / f"{file.stem}.applications.db"
        """File of the entries that wait for the organiser."""
        self.secrets = contests.secrets_path(file)
        """File of all tokens."""
        self.port = contests.port_path(file)
        """File with the last port of the pages; there is none if the contest file sets the port."""
        self.contacts = folder / f"{file.stem}.contacts.json"
        """File that says how to reach the teams."""
        self.published = contests.published_path(file).absolute()
        """Folder of the published contest, which may not exist yet; absolute, as people read it."""
        self.event_code = folder / f"{file.stem}.code.txt"
        """File of the event code; there is none until the code is changed."""
        self.stand_ins = folder / f"{file.stem}.stand-ins.txt"
        """File with the courts that run here because their own machine was lost, a name a line."""
        self.machine = machine.path_of(self.facts)
        """File with this machine's role in the contest; if there is none, it is the office."""
        self._lock = folder / f"{file.stem}.lock"
        self.entries = EntryFolder(
            (folder / contests.ENTRIES).resolve()
        )  # the organiser may have linked it
        self.records = self.contest.recordings

    @contextmanager
    def alone(self) -> Iterator[None]:
        """Until the block ends, keep all other processes from running the contest.

        The lock also ends if this process is killed.

        Raises:
            RunsAlready: if another process runs the contest.
            UserError: if the folder can't be written.
        """
        try:
            lock = self._lock.open("ab")
        except OSError as error:
            why = error.strerror or str(error)
            path = text_of(self._lock)
            raise UserError(say("command.cannot-write", path=path, why=why)) from None
        with lock:
            if not hold(lock):
                raise RunsAlready(say("contest.runs-already", file=text_of(self.file)))
            yield

    @property
    def games(self) -> list[Arena]:
        """The arenas of all stages but the open one; those with equal name and levels share one."""
        found: dict[tuple[str, tuple[Level, ...]], Arena] = {}
        for plan in self.plans:
            arena = game(plan, self.folder)
            found.setdefault((plan.arena, arena.match.open_levels), arena)
        return [*found.values()]


def file_hash(path: Path) -> str:
    """Return the hash of a file, hexadecimal.

    Raises:
        OSError: if it can't be read.
    """
    with path.open("rb") as file:
        return hashlib.file_digest(file, lambda: hashlib.blake2b(digest_size=16)).hexdigest()


def hash_of(data: bytes) -> str:
    """Return the hash of bytes, hexadecimal.

    `file_hash` gives the same for a file of these bytes.
    """
    return hashlib.blake2b(data, digest_size=16).hexdigest()
