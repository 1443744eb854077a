"""The role of this machine in a contest: its office, a copy of it, or a former office.

Facts may be appended only in the office's folder. The file with the role is beside the facts, so
every program that appends facts reads it first.
"""

from pathlib import Path
from typing import Literal

import msgspec

from lacoc_shared.command.replacing import write
from lacoc_shared.mistakes import UserError, text_of
from lacoc_shared.words import say


class Machine(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """The role of this machine in a contest, and the addresses of machines with other roles."""

    role: Literal["office", "copy", "retired"] = "office"
    """office: the contest is run here. copy: another machine's office is copied here. retired: the
    office went on at another machine, and no more facts are appended here."""
    office: str = ""
    """For a copy: address of the office that is copied."""
    known: tuple[str, ...] = ()
    """For an office: addresses of machines that were the office before, or have copied it."""
    copied_ms: int = 0
    """For a copy: the last time at which the whole copy was equal to the office's folder, in
    milliseconds since 1970, UTC; 0: never yet."""
    ends: bool = False
    """For a copy: whether the program that copies must end, because the office goes on at this
    machine."""


def path_of(facts: Path) -> Path:
    """Return the path of the file with this machine's role.

    Args:
        facts: path of the contest's facts.
    """
    return facts.with_suffix(".machine.json")


def read(path: Path) -> Machine:
    """Return this machine's role; if there is no file, it is the office.

    Raises:
        UserError: if the file can't be read.
    """
    try:
        return msgspec.json.decode(path.read_bytes(), type=Machine)
    except FileNotFoundError:
        return Machine()
    except (OSError, msgspec.MsgspecError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise UserError(say("command.cannot-read", path=text_of(path), why=why)) from None


def save(path: Path, machine: Machine) -> None:
    """Write this machine's role to its file.

    Raises:
        UserError: if the file can't be written.
    """
    try:
        write(path, msgspec.json.encode(machine), lasting=True)
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("command.cannot-write", path=text_of(path), why=why)) from None


def check_office(machine: Machine) -> None:
    """Check that a machine is its contest's office.

    Raises:
        UserError: if it is a copy or a former office; the message says what to do.
    """
    if machine.role == "copy":
        raise UserError(say("standby.is-copy", at=machine.office))
    if machine.role == "retired":
        raise Retired(say("standby.is-retired"))


class Retired(UserError):
    """The contest's office goes on at another machine; on this one it must not start again."""
