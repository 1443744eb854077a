"""Keep a copy of an office's folder on a second machine."""

import time
from typing import TYPE_CHECKING, Annotated

import typer

from lacoc_server.commands.contest.setting_up import FILE, FileToRead
from lacoc_shared.command import child, options, screen
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.address import endpoint
from lacoc_shared.words import Phrase, render, say

if TYPE_CHECKING:
    from lacoc_server.contest.standby.following import CopyState

_PAUSE_S = 0.2
"""Time between two requests to the office [s]."""
_SHOWN_S = 1.0
_SILENT_S = 5.0
"""If the office has not answered for this long [s], a warning says that it is gone."""


def standby(
    file: FileToRead = FILE,
    of: Annotated[
        str | None,
        typer.Option(
            "--of",
            metavar="ADDRESS",
            help="Address of the office's machine; by default the one in the contest file.",
        ),
    ] = None,
    json: options.Json = False,
) -> None:
    """Keep a copy of all that the office keeps on this machine, so that it can go on here.

    Copy the contest file and its secrets file (contest.secrets.json) to a folder of its own on this
    machine, and run this command there; it waits for the office, copies what is missing, and says
    how old the copy is. Everything is encrypted with a token of the secrets file.

    If the office's machine is gone: 'lacoc contest run --take-over' goes on here, with the same
    links. If the other machine comes back, its office ends.
    """
    from lacoc_server.contest.kept.folder import ContestFolder
    from lacoc_server.contest.standby.following import CopyingEnded, Follower
    from lacoc_server.contest.standby.other import NotThere, Other
    from lacoc_server.contest.standby.sealing import Sealing
    from lacoc_server.contest.standby.taking_over import begin_copying

    where = ContestFolder(file)
    if where.contest.standby is None:
        raise UserError(say("standby.no-table", file=str(file)))
    address = endpoint(of) if of else where.contest.standby.office
    where.contest.secrets.check_copied()
    sealing = Sealing(where.contest.secrets.standby)
    # The folder is released first: a connection to a machine that is gone closes slowly.
    with Other(address, sealing) as other, where.alone():
        begin_copying(where)
        with (
            Follower(where, other, screen.warn) as follower,
            screen.stderr.status("") as line,
        ):
            teller = _CopyTeller(address, json)
            while True:
                try:
                    teller.copied(follower.step())
                except NotThere:
                    teller.nobody()
                except CopyingEnded:
                    break
                except UserError as error:  # whatever it is, it may be right a moment later
                    teller.failed(error.phrase)
                line.update(teller.line)
                time.sleep(_PAUSE_S)
    screen.note(say("standby.ended"))
    raise typer.Exit(child.NOT_AGAIN)


class _CopyTeller:
    """Prints how old the copy is, and each new problem with copying.

    Args:
        address: address of the office.
        json: whether to print a line of JSON once a second.
    """

    def __init__(self, address: str, json: bool) -> None:
        self._address = address
        self._json = json
        self._copy: CopyState | None = None
        self._heard_s = time.monotonic()
        self._is_told = False
        self._trouble: Phrase | None = None
        self._printed_s = 0.0

    def copied(self, copy: "CopyState") -> None:
        """Take note that copying succeeded, and of how much the copy has now."""
        if self._is_told or self._copy is None:
            screen.note(say("standby.there", at=self._address))
        self._copy, self._heard_s = copy, time.monotonic()
        self._is_told, self._trouble = False, None
        self._print()

    def nobody(self) -> None:
        """Take note that the office does not answer."""
        if not self._is_told and time.monotonic() - self._heard_s > _SILENT_S:
            self._is_told = True
            if self._copy is None:
                screen.warn(say("standby.waits", at=self._address))
            else:
                screen.warn(say("standby.gone", at=self._address, seconds=self._age))
        self._print()

    def failed(self, why: Phrase) -> None:
        """Take note of an error; print it if it differs from the last one."""
        if why != self._trouble:
            self._trouble = why
            screen.warn(why)
        self._print()

    @property
    def line(self) -> str:
        """The status line of a terminal: the age and the contents of the copy."""
        if self._copy is None:
            return render(say("standby.waits", at=self._address))
        facts, records, unfinished = self._copy[1:]
        return render(
            say(
                "standby.copied",
                seconds=self._age,
                facts=facts,
                records=records,
                open=unfinished,
            )
        )

    @property
    def _age(self) -> str:
        """Age of the copy [s]; "-" if the copy was never complete."""
        if self._copy is None or not self._copy.at_ms:
            return "-"
        return f"{time.time() - self._copy.at_ms / 1000:.1f}"

    def _print(self) -> None:
        now_s = time.monotonic()
        if self._json and self._copy is not None and now_s - self._printed_s >= _SHOWN_S:
            self._printed_s = now_s
            screen.print_json({"kind": "copy", "age_s": self._age, **self._copy._asdict()})
