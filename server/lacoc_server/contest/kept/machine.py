"""What this machine is to a contest: its office, a copy of it, or an office that goes on elsewhere.

Only the office's folder takes facts. The file is beside the facts, so every program that would
append something finds it.
"""

from pathlib import Path
from typing import Literal

import msgspec

from lacoc_shared.command.replacing import write
from lacoc_shared.mistakes import UserError, text_of
from lacoc_shared.words import say


class Machine(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """What a folder of a contest is."""

    role: Literal["office", "copy", "retired"] = "office"
    """copy: another machine's office is copied here. retired: the office goes on elsewhere, and
    this folder is what it was before."""
    office: str = ""
    """Of a copy: address of the office that is copied."""
    known: tuple[str, ...] = ()
    """Of an office: addresses of machines that were the office, or copy it now."""
    copied_ms: int = 0
    """Of a copy: when all of it was as it was at the office, in milliseconds since 1970, UTC; 0: it
    never was."""
    ends: bool = False
    """Of a copy: whether the program that copies shall end, because the office goes on here."""


def path_of(facts: Path) -> Path:
    """Return the file's path.

    Args:
        facts: path of the contest's facts.
    """
    return facts.with_suffix(".machine.json")


def read(path: Path) -> Machine:
    """Return what a machine is; without a file it is the office.

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
    """Write what a machine is.

    Raises:
        UserError: if it can't be written.
    """
    try:
        write(path, msgspec.json.encode(machine))
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("command.cannot-write", path=text_of(path), why=why)) from None


def check_office(machine: Machine) -> None:
    """Check that a machine is its contest's office.

    Raises:
        UserError: if it is not; the message says what to do.
    """
    if machine.role == "copy":
        raise UserError(say("standby.is-copy", at=machine.office))
    if machine.role == "retired":
        raise Retired(say("standby.is-retired"))


class Retired(UserError):
    """The contest's office goes on at another machine; here it must not be started again."""
