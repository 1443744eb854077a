"""The records of finished matches: closed and packed on another thread than the court's loop.

A disk may need seconds until it has stored what was written. By then the next match is open.
"""

import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from lacoc_server.court.log import CourtLog
from lacoc_shared.record.matches import unpacked
from lacoc_shared.record.pack import pack_in_background
from lacoc_shared.record.recorder import Recorder


class RecordArchive:
    """Closes and packs the records of one court.

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
        """Pack the records of finished matches that an earlier court of this name left.

        Args:
            match_id: the open match; the log names it if something can't be packed.
        """
        self._aside.submit(self._pack, match_id)

    def take(self, match_id: str, writer: Recorder | None) -> None:
        """Write the end of a match's record now; close and pack the record on another thread.

        Do nothing if the match has no record.
        """
        if writer is None:
            return
        writer.end()
        self._aside.submit(self._put_away, match_id, writer)

    def close(self) -> None:
        """Wait until all records are closed and packed."""
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
        """Pack the records of all finished matches of the court, in a separate process.

        A record that can't be packed now is tried again when the next match ends or the court is
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
