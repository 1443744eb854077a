"""Makes a second machine the office of a contest, from its copy of the office's folder."""

import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path

import msgspec

from lacoc_server.contest.kept import machine
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.machine import Machine, Retired
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.facts import AnyFact, Called, generation
from lacoc_server.contest.league.timetable.calling import is_open_call
from lacoc_server.contest.standby.door import with_segments
from lacoc_server.contest.standby.messages import KnockAsk, OfficeThere
from lacoc_server.contest.standby.other import NotThere, Other, OtherToken
from lacoc_server.contest.standby.sealing import Sealing
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.files import segment_paths
from lacoc_shared.record.reader import Record
from lacoc_shared.words import Phrase, say

_COPIER_S = 10.0
"""Longest wait for the copying program to end [s]."""
_LOOK_S = 0.05
_LEFT = ".left"
"""Ending that is added to names of segments whose match no fact mentions."""


def begin_copying(where: ContestFolder) -> None:
    """Allow a program to copy another machine's office into this folder.

    It was forbidden if somebody began to make this machine the office.

    Raises:
        UserError: if the file with this machine's role can't be read or written.
    """
    found = machine.read(where.machine)
    if found.ends:
        machine.save(where.machine, msgspec.structs.replace(found, ends=False))


def take_over(file: Path) -> Phrase | None:
    """Make this machine the office of a contest, from its copy of another machine's folder.

    Args:
        file: the contest file.

    Returns:
        A phrase that says how old the copy is; None: this machine has taken over already.

    Raises:
        Retired: if the office of this folder went on at another machine.
        UserError: if there is no whole copy here, or the office that is copied still answers.
    """
    where = ContestFolder(file)
    found = machine.read(where.machine)
    if found.role == "retired":
        raise Retired(say("standby.is-retired"))
    if found.role == "office" and _generation(where):
        return None
    if found.role == "office" or where.contest.standby is None:
        raise UserError(say("standby.no-copy", file=str(file)))
    if not found.copied_ms:
        raise UserError(say("standby.not-whole", at=found.office))
    with Other(found.office, Sealing(where.contest.secrets.standby)) as other:
        _check_gone(other)
    with _alone(where), FactStore(where.facts) as store:
        found = machine.read(where.machine)
        set_aside(ContestFolder(file).records, store.facts())  # the file may have just been copied
        store.take_over()
        machine.save(where.machine, Machine(known=(found.office,)))
    age_s = (time.time_ns() // 1_000_000 - found.copied_ms) / 1000
    return say("standby.takes-over", at=found.office, seconds=f"{age_s:.1f}")


def _check_gone(other: Other) -> None:
    """Check that the office on the other machine does not answer.

    Raises:
        UserError: if it answers.
    """
    try:
        other.ask(KnockAsk(generation=0), OfficeThere)
    except (NotThere, OtherToken):
        return
    raise UserError(say("standby.office-is-there", at=other.address))


@contextmanager
def _alone(where: ContestFolder) -> Iterator[None]:
    """End the program that copies into this folder; until the block ends, let no other one begin.

    Raises:
        UserError: if another program holds the folder.
    """
    with ExitStack() as held:
        end_s = time.monotonic() + _COPIER_S
        while True:
            found = machine.read(where.machine)
            if not found.ends:  # the program that copies may have written its own last step
                machine.save(where.machine, msgspec.structs.replace(found, ends=True))
            try:
                held.enter_context(where.alone())
                break
            except UserError:
                if time.monotonic() > end_s:
                    raise
                time.sleep(_LOOK_S)
        yield


def set_aside(records: Path, facts: Sequence[AnyFact]) -> None:
    """Rename the records of unfinished matches whose calls are not among the facts.

    The other machine called these matches after its facts were last copied. No court may go on with
    them, because this machine's office would not take their results.

    Args:
        records: folder of the records.
        facts: the facts.
    """
    calls = {fact.id for fact in facts if isinstance(fact, Called)}
    for match_id in with_segments(records):
        segments = segment_paths(records, match_id)
        try:
            assigned = Record.read(segments).header.setup.assigned
        except UserError:  # there is no header yet; courts pass such a record over
            continue
        if assigned is None or is_open_call(assigned.call):
            continue
        if assigned.call not in calls:
            for segment in segments:
                segment.rename(segment.with_name(segment.name + _LEFT))


def _generation(where: ContestFolder) -> int:
    with FactStore(where.facts) as store:
        return generation(store.facts())
