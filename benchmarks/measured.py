"""Writes docs/measured.md from measured.toml: `python -m benchmarks.measured`.

With `--check` it writes nothing, and exits with 1 if the page is not what it would write.
"""

import sys
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from arguments import arguments

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "measured.md"
DATA = Path(__file__).with_name("measured.toml")
_HEAD = """\
# Measured
All figures, each with its command (`benchmarks.X` and `tests.campaigns.X` are `python -m` and that\
 name) and the date on which it was written down. "Idle": two cores that did nothing else; "busy": \
others used them too, so trust ratios, not times. See also [facts](facts.md) and \
[mutation testing](mutation.md).

`python -m benchmarks.measured` writes this page from \
[measured.toml](../benchmarks/measured.toml): change a figure there.
"""
_COLUMNS = ("what", "command", "figure", "machine, notes", "date")


def page() -> str:
    """Return the text of docs/measured.md, made from measured.toml."""
    lines = [_HEAD]
    for section in tomllib.loads(DATA.read_text(encoding="utf-8"))["section"]:
        lines += [f"## {section['title']}", _row(_COLUMNS), "|" + "---|" * len(_COLUMNS)]
        lines += [_row(_cells(figure)) for figure in section["figure"]]
        lines.append("")
    return "\n".join(lines)


def _cells(figure: dict[str, Any]) -> list[str]:
    command = figure["command"]
    each = [command] if isinstance(command, str) else command
    told = "; ".join(f"`{one}`" for one in each)
    return [figure["what"], told, figure["figure"], figure.get("machine", ""), str(figure["date"])]


def _row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |".replace("|  |", "| |")


def main() -> None:
    """Write the page, or check it."""
    options = arguments(__doc__, check=(False, "write nothing; exit with 1 if the page differs"))
    if not options.check:
        PAGE.write_text(page(), encoding="utf-8")
    elif PAGE.read_text(encoding="utf-8") != page():
        sys.exit(f"{PAGE.name} differs from {DATA.name}: run python -m benchmarks.measured")


if __name__ == "__main__":
    main()
