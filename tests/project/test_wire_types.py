"""The types and constants that are generated for the pages match the Python code."""

import runpy
from pathlib import Path

WEB = Path(__file__).parents[2] / "client" / "web"


def test_the_pages_have_the_courts_types_and_words() -> None:
    """The generated files are up to date, so that pages read each field in its right place."""
    maker = runpy.run_path(str(WEB / "make_wire.py"))
    behind = [str(p) for p, made in maker["FILES"].items() if p.read_text("utf-8") != made()]
    assert not behind, "run: python client/web/make_wire.py"
