"""Tests of the archive: it closes a finished match's record and logs an error of the disk."""

import os
from pathlib import Path

import pytest
from structlog.testing import capture_logs

from lacoc_server.court.archive import RecordArchive
from lacoc_server.court.log import CourtLog
from lacoc_shared.record.schema import FORMAT, Header, Setup
from lacoc_shared.record.writer import RecordWriter

pytestmark = pytest.mark.usefixtures("loud")

MATCH = "main-20260501-100000-001"
HEADER = Header(
    format=FORMAT,
    match_id=MATCH,
    segment=1,
    first_beat=0,
    started="2026-05-01T10:00:00+00:00",
    versions={},
    setup=Setup(court="main", match=1, match_id=MATCH, arena="othello", settings={}, limits={}),
)


def said(folder: Path, writer: RecordWriter) -> list[str]:
    """Let an archive finish a match's record; return the lines that this adds to the log."""
    with capture_logs() as lines:
        archive = RecordArchive(folder, "main", CourtLog("main"))
        archive.take(MATCH, writer)
        archive.close()
    assert all((line["match_id"], line["kind"]) == (MATCH, "record") for line in lines)
    return [line["event"] for line in lines]


@pytest.mark.long
def test_a_match_that_the_disk_has_is_no_line(tmp_path: Path) -> None:
    """A record that reaches the disk adds no line to the log."""
    assert said(tmp_path, RecordWriter(tmp_path, HEADER)) == []


def test_the_last_that_a_disk_said_is_logged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """If the disk reports an error for a finished match, the log tells the organiser."""
    writer = RecordWriter(tmp_path, HEADER)

    def fails(descriptor: int) -> None:
        raise OSError(5, "Input/output error")

    monkeypatch.setattr(os, "fsync", fails)
    assert any("reports: Input/output error" in line for line in said(tmp_path, writer))
