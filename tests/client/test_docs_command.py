"""The command `lacoc docs`: the pages about LACOC, without a checkout."""

import re
from pathlib import Path

import pytest

from lacoc_shared.command.cli import main

DOCS = Path(__file__).parents[2] / "docs"


def lacoc(*words: str) -> int:
    try:
        return main(words)
    except SystemExit as end:
        return int(end.code or 0)


def test_all_pages_are_listed_and_can_be_read(capsys: pytest.CaptureFixture[str]) -> None:
    """Every page of docs/ is in the list with its title, and is printed as it is."""
    assert lacoc("docs") == 0
    listed = dict(re.findall(r"^│ (\S+) +│ (.*?) +│$", capsys.readouterr().out, re.MULTILINE))

    pages = {file.stem: file for file in DOCS.glob("[a-z]*.md") if "." not in file.stem}
    assert {*listed} == {*pages}
    assert listed["contest"] == "The contest"
    for name, file in pages.items():
        assert lacoc("docs", name) == 0
        assert capsys.readouterr().out == file.read_text("utf-8") + "\n"


def test_a_page_is_in_the_language_of_the_user(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A page that exists in Japanese is shown in Japanese to whoever reads Japanese."""
    monkeypatch.setenv("LACOC_LANGUAGE", "ja")
    assert lacoc("docs", "rules") == 0
    assert capsys.readouterr().out.startswith((DOCS / "rules.ja.md").read_text("utf-8"))
    monkeypatch.setenv("LACOC_LANGUAGE", "en")
    assert lacoc("docs", "rules") == 0


def test_an_unknown_page_suggests_others(capsys: pytest.CaptureFixture[str]) -> None:
    """For a page that is not there, the error names the nearest ones; no path is opened."""
    assert lacoc("docs", "contst") == 2
    assert "contest" in capsys.readouterr().err
    assert lacoc("docs", "../README") == 2
