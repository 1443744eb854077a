"""The types and constants that are generated for the pages match the Python code."""

import runpy
from pathlib import Path

import pytest

from lacoc_shared.words.table import read
from lacoc_shared.words.template import holes

WEB = Path(__file__).parents[2] / "client" / "web"


def test_the_pages_have_the_courts_types_and_words(monkeypatch: pytest.MonkeyPatch) -> None:
    """The generated files are up to date, so that pages read each field in its right place."""
    monkeypatch.syspath_prepend(WEB)
    maker = runpy.run_path(str(WEB / "make_wire.py"))
    behind = [str(p) for p, made in maker["FILES"].items() if p.read_text("utf-8") != made()]
    assert not behind, "run: python client/web/make_wire.py"


def test_the_pages_own_messages_fit_in_both_languages() -> None:
    """Each message of the pages has a text in both languages, with the same values in it."""
    messages = [entry for file in (WEB / "texts").glob("*.toml") for entry in read(file).items()]
    assert len(messages) > 1000
    for code, entry in messages:
        values = [
            {hole.name for part in holes(text) for hole in part} for text in (entry.en, entry.ja)
        ]
        assert bool(entry.en) == bool(entry.ja), code
        assert values[0] == values[1], code
