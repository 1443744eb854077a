"""The pages' TypeScript types are those of the Python structs."""

import runpy
from pathlib import Path

WEB = Path(__file__).parents[2] / "client" / "web"


def test_the_pages_types_are_those_of_the_court() -> None:
    """A field that one side knows and the other does not would be read in the wrong place."""
    maker = runpy.run_path(str(WEB / "make_wire.py"))
    assert maker["TARGET"].read_text(encoding="utf-8") == maker["wire_types"](), (
        "run: python client/web/make_wire.py"
    )
