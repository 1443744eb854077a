"""The pages' generated types and constants match the Python code."""

import runpy
from pathlib import Path

WEB = Path(__file__).parents[2] / "client" / "web"


def test_the_pages_have_the_courts_types_and_words() -> None:
    """A field that one side knows and the other does not would be read in the wrong place."""
    maker = runpy.run_path(str(WEB / "make_wire.py"))
    behind = [str(p) for p, made in maker["FILES"].items() if p.read_text("utf-8") != made()]
    assert not behind, "run: python client/web/make_wire.py"
