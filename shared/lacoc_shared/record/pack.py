"""Packs the segments of a match that is over into one compressed, indexed file.

A court starts `python -m lacoc_shared.record.pack FOLDER MATCH_ID` beside itself: packing
takes longer than a beat.
"""

import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from mcap.writer import Writer

from lacoc_shared import __version__
from lacoc_shared.mistakes import UserError
from lacoc_shared.record import files
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import BEAT_NS, KINDS, PROFILE
from lacoc_shared.record.stream import walk


def pack(segments: Sequence[Path], out: Path) -> None:
    """Make one file of the segments of a match, then remove them.

    The file appears under its name when it is whole and on the disk, so a file that is there
    already holds these segments: packing was interrupted after that, and only goes on.

    Args:
        segments: the segments in their order.
        out: the packed file.

    Raises:
        UserError: if a segment can't be read to its end or the file can't be written; all
            segments stay.
    """
    unfinished = out.with_name(f"{out.name}.part")
    try:
        if not out.exists():
            if cut := Record.read(segments).cut:  # what can't be read now must not be lost for ever
                raise UserError(f"{out} was not packed, and its segments are kept. {cut}")
            _write(segments, unfinished)
            unfinished.rename(out)
            files.sync_folder(out.parent)
        for segment in segments:
            segment.unlink()
    except OSError as error:
        unfinished.unlink(missing_ok=True)
        raise UserError(
            f"The record {out} can't be packed: {error.strerror}. Its segments are kept: make "
            "room on the disk and pack them again."
        ) from None


def pack_in_background(folder: Path, match_id: str) -> subprocess.Popen[bytes]:
    """Pack a match in a process of its own, which a Ctrl-C for this one does not stop."""
    return subprocess.Popen(
        [sys.executable, "-m", __name__, str(folder), match_id],
        stdin=subprocess.DEVNULL,
        start_new_session=True,
    )


def _write(segments: Sequence[Path], path: Path) -> None:
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(profile=PROFILE, library=f"lacoc {__version__}")
        channels = {
            topic: writer.register_channel(topic, "msgpack" if kind else "", 0)
            for topic, kind in KINDS.items()
        }
        counts = dict.fromkeys(KINDS, 0)

        def add(topic: str, beat: int, data: bytes, message: Any) -> None:
            time_ns = beat * BEAT_NS
            writer.add_message(channels[topic], time_ns, data, time_ns, counts[topic])
            counts[topic] += 1

        for segment in segments:
            walk(segment, add)
        writer.finish()
        file.flush()
        os.fsync(file.fileno())


def main(folder: str, match_id: str) -> int:
    """Pack a match of a folder; the exit code says whether it worked."""
    if hasattr(os, "nice"):
        os.nice(10)  # the next match is running
    segments = files.segment_paths(Path(folder), match_id)
    try:
        if not segments:
            raise UserError(f"There are no segments of match {match_id} in {folder}.")
        pack(segments, files.packed_path(Path(folder), match_id))
    except UserError as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
