"""Packs the segments of a finished match into one compressed, indexed file.

A court starts `python -m lacoc_shared.record.pack FOLDER MATCH_ID...` as another process, because
packing takes longer than a beat.
"""

import subprocess
import sys
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

from lacoc_shared.command import keep
from lacoc_shared.command.holding import hold
from lacoc_shared.command.priority import give_way
from lacoc_shared.mistakes import UserError
from lacoc_shared.record import files
from lacoc_shared.record.packed import Message, PackedFile
from lacoc_shared.record.reader import Record
from lacoc_shared.record.stream import Stop, walk_bytes
from lacoc_shared.words import say


def pack(segments: Sequence[Path], out: Path) -> None:
    """Join the segments of a match into one compressed file, then remove them.

    The file gets its name when it is complete and on the disk. If a file of this name exists
    already, an earlier packing was interrupted; then the file is only checked and the segments are
    removed. The segments are removed only if the file, read again, has all of their messages.
    Meanwhile all segments are locked.

    Args:
        segments: the segments in their order.
        out: the packed file.

    Raises:
        UserError: if a segment is locked or can't be read to its end, or if the file can't be
            written or differs from the segments; all segments stay.
    """
    try:
        with ExitStack() as held:
            for segment in segments:
                if not hold(held.enter_context(segment.open("rb+"))):
                    raise UserError(say("pack.busy", file=str(segment)))
            if out.exists():
                _compare(*_messages(segments), out)
            else:
                messages = _whole_match(segments, out)
                with PackedFile(out) as file:
                    file.add_all(messages)
                    file.complete()
                    _compare(messages, None, file.unfinished)
        for segment in segments:  # closed by now: Windows removes no open file
            segment.unlink(missing_ok=True)
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("pack.no-room", file=str(out), why=why)) from None


def write_packed(messages: Sequence[Message], out: Path) -> None:
    """Write all messages of a record into one packed file.

    The file gets its name when it is complete and on the disk.

    Args:
        messages: all messages of a record, in order.
        out: the file.

    Raises:
        UserError: if there is such a file already, or it or its folder can't be made.
    """
    if out.exists():
        raise UserError(say("record.exists", file=str(out)))
    keep.make_folder(out.parent)
    try:
        with PackedFile(out) as file:
            file.add_all(messages)
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("command.cannot-write", path=str(out), why=why)) from None


def read_messages(paths: Sequence[Path]) -> list[Message]:
    """Read all messages of a record from its files, up to the first damage."""
    return _messages(paths)[0]


def pack_in_background(folder: Path, match_ids: Sequence[str]) -> subprocess.Popen[bytes]:
    """Join the segments of each match into one file, in another process; Ctrl-C does not end it.

    Raises:
        OSError: if the system can't start another process.
    """
    return subprocess.Popen(
        [sys.executable, "-m", __name__, str(folder), *match_ids],
        stdin=subprocess.DEVNULL,
        start_new_session=True,
    )


def _whole_match(segments: Sequence[Path], out: Path) -> list[Message]:
    """Read all messages of a match from its segments.

    Raises:
        UserError: if the segments can't be read to their end. Then they must not be removed,
            because the rest of them would be lost.
    """
    messages: list[Message] = []
    record = Record.read(segments, lambda *message: messages.append(message))
    if record.cut:
        raise UserError(say("pack.not-packed", file=str(out), cut=record.cut))
    return messages


def copy_in_background(segments: Sequence[Path], out: Path) -> subprocess.Popen[bytes]:
    """Copy a match, as far as it is recorded, into one packed file; its segments stay.

    Another process does this.

    Raises:
        OSError: if the system can't start another process.
    """
    return subprocess.Popen(
        [sys.executable, "-m", __name__, "--copy", str(out), *map(str, segments)],
        stdin=subprocess.DEVNULL,
        start_new_session=True,
    )


def _compare(wanted: Sequence[Message], wrong: Stop | None, packed: Path) -> None:
    """Check that a packed file has all messages of the segments, so that these can be removed.

    If an earlier packing was interrupted while it removed segments, only the last segments of the
    match are still there.

    Args:
        wanted: the messages of the segments.
        wrong: the fault at the end of the last segment; None: there is none.
        packed: the packed file.

    Raises:
        UserError: if a message is not in the packed file, or if this file or the last segment is
            damaged.
    """
    found, found_wrong = _messages([packed])
    if found_wrong or wrong or found[max(0, len(found) - len(wanted)) :] != wanted:
        raise UserError(say("pack.differs", file=str(packed)))


def _messages(paths: Sequence[Path]) -> tuple[list[Message], Stop | None]:
    """Read the messages of some files, and the fault at the end of the last file, if any."""
    found: list[Message] = []
    wrong: Stop | None = None
    for path in paths:
        wrong = walk_bytes(path, lambda *message: found.append(message))
    return found, wrong


def main(folder: str, *match_ids: str) -> int:
    """Join the segments of each match in a folder into one file; return the exit code.

    With "--copy" in place of the folder, the other arguments are the path of a packed file and the
    segments of one match. The segments are packed into that file, and stay.
    """
    if folder == "--copy":
        return _copy(*map(Path, match_ids))
    code = 0
    for match_id in match_ids:
        segments = files.segment_paths(Path(folder), match_id)
        try:
            if not segments:
                raise UserError(say("pack.no-segments", match=match_id, folder=str(folder)))
            pack(segments, files.packed_path(Path(folder), match_id))
        except UserError as error:
            print(error, file=sys.stderr)
            code = 2
    return code


def _copy(out: Path, *segments: Path) -> int:
    try:
        with PackedFile(out) as file:
            file.add_all(_messages(segments)[0])
    except (UserError, OSError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    give_way()  # the next match is running
    sys.exit(main(*sys.argv[1:]))
