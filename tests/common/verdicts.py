"""Verifies records for tests."""

from typing import Any

from lacoc_server.journal.replay import verify
from lacoc_server.journal.verdict import Verdict
from lacoc_shared.record.reader import Record


def verdict(record: Record, **options: Any) -> Verdict:
    """Verify a record and return the verdict; check that the progress, in beats, always grows."""
    *beats, found = verify(record, **options)
    assert beats == sorted(set(beats))
    assert isinstance(found, Verdict)
    return found
