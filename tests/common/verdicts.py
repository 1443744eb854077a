"""Verifies records, and tells as JSON what this process found."""

from pathlib import Path
from typing import Any

from lacoc_server.journal.replay import verify
from lacoc_server.journal.verdict import Verdict
from lacoc_server.world import arithmetic
from lacoc_shared.record.reader import Record
from lacoc_shared.words import render


def verdict(record: Record, **options: Any) -> Verdict:
    """Verify a record and return the verdict; check that the progress, in beats, always grows."""
    *beats, found = verify(record, **options)
    assert beats == sorted(set(beats))
    assert isinstance(found, Verdict)
    return found


def told(path: str) -> dict[str, Any]:
    """Verify a record in this process; return its name, and the verdict's kind and distance."""
    found = verdict(Record.read(Path(path)), processes=1)
    return {
        "name": Path(path).name,
        "kind": found.kind.value,
        "distance": found.distance,
        "text": render(found.said),
    }


def fingerprint() -> dict[str, str]:
    """Return the arithmetic of this process."""
    return dict(arithmetic.here())
