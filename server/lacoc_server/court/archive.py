"""The records of matches that are over: closed and packed beside the beat.

A disk may need seconds until it holds what was written, and the next match is open by then.
"""

import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from lacoc_server.court.log import CourtLog
from lacoc_shared.record.matches import unpacked
from lacoc_shared.record.pack import pack_in_background
from lacoc_shared.record.writer import RecordWriter


class Archive:
    """Where the records of a court go.

    Args:
        folder: where they lie; None: nothing is recorded.
        court: whose they are.
        log: told what the disk says of a match that is over, and when no record can be packed.
    """

    def __init__(self, folder: Path | None, court: str, log: CourtLog) -> None:
        self._folder = folder
        self._court = court
        self._log = log
        self._aside = ThreadPoolExecutor(1, "archive")
        self._packing: list[subprocess.Popen[bytes]] = []

    def pack(self, match_id: str) -> None:
        """Pack what an earlier court left; `match_id` is the match that is on."""
        self._aside.submit(self._pack, match_id)

    def take(self, match_id: str, writer: RecordWriter | None) -> None:
        """Finish the record of a match that is over; its end is written at once."""
        if writer is None:
            return
        writer.end()
        self._aside.submit(self._put_away, match_id, writer)

    def close(self) -> None:
        """Wait until all records are as they will stay."""
        self._aside.shutdown()
        for packing in self._packing:
            packing.wait()

    def _put_away(self, match_id: str, writer: RecordWriter) -> None:
        try:
            writer.close()
            self._log.disk(match_id, writer.sync_trouble)
        except OSError as error:
            self._log.not_packed(match_id, error)
        self._pack(match_id)

    def _pack(self, match_id: str) -> None:
        """Pack the matches that are over, in a process of its own.

        What can't be packed now waits for the next time: the end of a match or a court's start.
        """
        if self._folder is None:
            return
        self._packing = [one for one in self._packing if one.poll() is None]
        try:
            if match_ids := unpacked(self._folder, self._court):
                self._packing.append(pack_in_background(self._folder, match_ids))
        except OSError as error:
            self._log.not_packed(match_id, error)
