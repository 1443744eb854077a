"""Parts of a court's records for the office, which keeps a copy on its own machine.

The office says how much of each file it has; the court answers with the next part. So neither side
has to remember the progress of the other, and a restart of either loses nothing.
"""

from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path

from lacoc_shared.keyspace import COPY_PART_BYTES
from lacoc_shared.messages import Refusal
from lacoc_shared.messages.office import Copied, Copy
from lacoc_shared.record.files import packed_path, segment_paths
from lacoc_shared.record.matches import MatchName
from lacoc_shared.words import say

Part = Copied | Refusal


class Copying:
    """Reads parts of the records of one court, for an `OfficeDesk`.

    Args:
        folder: folder of the records.
        court: the court's name.
        aside: calls a function on another thread than the beat's.
    """

    def __init__(
        self, folder: Path, court: str, aside: Callable[[Callable[[], Part]], Future[Part]]
    ) -> None:
        self._folder = folder
        self._court = court
        self._aside = aside

    def __call__(self, request: Copy) -> Callable[[], Part | None]:
        """Begin to read part of a record; return a function that returns None until it is read."""
        future = self._aside(lambda: self._read(request))
        return lambda: future.result() if future.done() else None

    def _read(self, request: Copy) -> Part:
        name = MatchName.parse(request.match_id)
        if name is None or name.court != self._court:
            return Refusal(say("refused.other-record", match=request.match_id[:80]))
        try:
            return next_part(self._folder, request.match_id, request.have)
        except OSError as error:  # packing has just removed a segment, or the disk fails
            why = error.strerror or str(error)
            return Refusal(say("refused.no-part", match=request.match_id, why=why), again=True)


def next_part(folder: Path, match_id: str, have: dict[str, int]) -> Copied:
    """Read the first part of a match's record that the office does not have yet.

    Args:
        folder: folder of the records.
        match_id: the match.
        have: number of bytes of each file that the office has, by name of the file.

    Raises:
        OSError: if a file can't be read.
    """
    packed = packed_path(folder, match_id)
    is_packed = packed.exists()
    for path in [packed] if is_packed else segment_paths(folder, match_id):
        size, offset = path.stat().st_size, have.get(path.name, 0)
        if offset < size:
            with path.open("rb") as file:
                file.seek(offset)
                data = file.read(min(COPY_PART_BYTES, size - offset))
            return Copied(file=path.name, offset=offset, data=data)
    return Copied(is_whole=is_packed)
