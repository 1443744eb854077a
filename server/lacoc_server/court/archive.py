"""Closes and packs the records of finished matches, while the court goes on with the next match.

To pack a record is to make one file of its segments. A disk may need seconds until it has stored
what was written. So this is done on another thread, and in another process.
"""

import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from lacoc_server.court.log import CourtLog
from lacoc_shared.record.matches import unpacked
from lacoc_shared.record.pack import pack_in_background
from lacoc_shared.record.recorder import Recorder


class RecordArchive:
    """Closes and packs the records of one court; to pack is to make one file of all segments.

    Args:
        folder: folder of the records; None: nothing is recorded.
        court: name of the court.
        log: receives disk errors of finished matches, and records that can't be packed.
    """

    def __init__(self, folder: Path | None, court: str, log: CourtLog) -> None:
        self._folder = folder
        self._court = court
        self._log = log
        self._aside = ThreadPoolExecutor(1, "archive")
        self._packing: list[subprocess.Popen[bytes]] = []

    def pack(self, match_id: str) -> None:
        """Make one file of each record that an earlier court of this name left in segments.

        Only matches that are finished are packed.

        Args:
            match_id: the open match; the log names it if something can't be packed.
        """
        self._aside.submit(self._pack, match_id)

    def take(self, match_id: str, writer: Recorder | None) -> None:
        """Write the end of a match's record now; then close it and make one file of its segments.

        The end is written on the caller's thread, all else on another one.

        Do nothing if the match has no record.
        """
        if writer is None:
            return
        writer.end()
        self._aside.submit(self._put_away, match_id, writer)

    def close(self) -> None:
        """Wait until all records of finished matches are closed, and packing them has ended."""
        self._aside.shutdown()
        for packing in self._packing:
            packing.wait()

    def _put_away(self, match_id: str, writer: Recorder) -> None:
        try:
            writer.close()
            self._log.disk(match_id, writer.sync_trouble)
        except OSError as error:
            self._log.not_packed(match_id, error)
        self._pack(match_id)

    def _pack(self, match_id: str) -> None:
        """Make one file of the segments of each finished match's record, in a separate process.

        If this fails for a record, it is tried again when the next match ends or the court is
        started again.
        """
        if self._folder is None:
            return
        self._packing = [one for one in self._packing if one.poll() is None]
        try:
            if match_ids := unpacked(self._folder, self._court):
                self._packing.append(pack_in_background(self._folder, match_ids))
        except OSError as error:
            self._log.not_packed(match_id, error)
