"""`lacoc docs`: read the pages about LACOC, which are installed with it."""

from difflib import get_close_matches
from pathlib import Path
from typing import Annotated

import typer
from rich.markdown import Markdown

from lacoc_shared import words
from lacoc_shared.command import screen
from lacoc_shared.command.documents import folder, translated
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

app = typer.Typer()


@app.command(name="docs")
def docs_command(
    page: Annotated[
        str | None,
        typer.Argument(
            metavar="PAGE",
            help="The page, such as 'contest'; without it, the names of all pages are listed.",
        ),
    ] = None,
) -> None:
    """Read the pages about LACOC: rules, files, a contest day, bots, security."""
    # Not the index of the checkout, README, and not translations, such as rules.ja.
    pages = {
        file.stem: file
        for file in sorted(folder().glob("*.md"))
        if file.stem.islower() and "." not in file.stem
    }
    if page is None:
        listed = screen.table(say("fact.page"), say("fact.what"))
        for name in pages:
            listed.add_row(name, _title(translated(name, words.current())))
        screen.show(listed)
        return
    name = page.removesuffix(".md")
    if name not in pages:
        near = get_close_matches(name, pages) or [*pages]
        raise UserError(say("command.no-page", page=page[:40], pages=near))
    text = translated(name, words.current()).read_text("utf-8")
    screen.show(Markdown(text) if screen.stdout.is_terminal else text)


def _title(file: Path) -> str:
    with file.open(encoding="utf-8") as lines:
        return next(lines, "").lstrip("# ").strip()
