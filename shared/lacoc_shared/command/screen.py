"""Prints the output of the command line on two consoles.

Results go to standard output and all other messages to standard error, so that a pipe carries
results only. Colours and tables are for terminals. In a pipe a line is never wrapped, because a
program reads it.
"""

import contextlib
import faulthandler
import io
import json
import sys
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TextIO

import msgspec
from rich.console import Console, RenderableType
from rich.table import Table
from rich.text import Text

from lacoc_shared.mistakes import ESCAPED, Mistake, text_of
from lacoc_shared.words import Phrase, render, say

if TYPE_CHECKING:
    from rich.progress import Progress

_UNLIMITED = 10_000  # characters in a line that only a program reads


def _console(stderr: bool) -> Console:
    console = Console(highlight=False, stderr=stderr)
    if not console.is_terminal:
        console.width = _UNLIMITED
    return console


def accept_any_text() -> None:
    """Let standard output and standard error accept every character.

    A terminal of Japanese Windows can't show "ö", and a file name may contain bytes that are not
    text. Such a character is written as an escape code, so that no name crashes a program.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=ESCAPED)


def show_crashes(stream: TextIO | None) -> None:
    """Write every thread's stack to a stream (None: standard error) if the process crashes."""
    with contextlib.suppress(io.UnsupportedOperation, RuntimeError):  # no stream, or no file
        faulthandler.enable(stream or sys.stderr)


stdout = _console(stderr=False)
stderr = _console(stderr=True)


def show(what: RenderableType | Phrase, to: Console | None = None) -> None:
    """Print a text, a phrase or a table.

    Args:
        what: a plain string is printed as it is; square brackets are not markup.
        to: the console; None: standard output.
    """
    if isinstance(what, Phrase):
        what = render(what)
    console = to or stdout
    if isinstance(what, Table) and not console.is_terminal:
        with console.capture() as drawn:
            console.print(what)
        # One long cell must not pad the lines of all others.
        what = "\n".join(line.rstrip() for line in drawn.get().splitlines())
    console.print(Text(what) if isinstance(what, str) else what)


def note(what: Phrase | str) -> None:
    """Print a remark about the result, such as the name of a file that was written."""
    show(Text(render(what), style="dim"), stderr)


def warn(what: Phrase | str) -> None:
    """Print a warning that something may not be as the user expects."""
    show(Text.assemble((render(say("command.note")), "bold yellow"), render(what)), stderr)


def error(what: Phrase | str) -> None:
    """Print why the command stops; several mistakes have a line each."""
    show(Text.assemble((render(say("command.error")), "bold red"), (render(what), "red")), stderr)


def refused(mistakes: Sequence[Mistake]) -> None:
    """Print how many mistakes were found in files, and a table of all of them."""
    error(say("command.mistakes", count=len(mistakes)))
    show(mistakes_table(mistakes), stderr)


def mistakes_table(mistakes: Sequence[Mistake]) -> Table:
    """Make a table of mistakes, without the columns that no mistake uses."""
    columns: tuple[tuple[Phrase, Callable[[Mistake], Any]], ...] = (
        (say("fact.file"), lambda m: m.file),
        (say("fact.row"), lambda m: m.row),
        (say("fact.column"), lambda m: m.column),
        (say("fact.joint"), lambda m: m.joint),
        (say("fact.leg"), lambda m: m.leg),
        (say("fact.entry"), lambda m: m.field),
        (say("fact.found"), lambda m: render(m.found)),
        (say("fact.expected"), lambda m: render(m.expected)),
    )
    used = [(title, get) for title, get in columns if any(get(m) is not None for m in mistakes)]
    listed = table(*(title for title, _ in used))
    for mistake in mistakes:
        cells = (get(mistake) for _, get in used)
        listed.add_row(*(Text("" if cell is None else str(cell)) for cell in cells))
    return listed


def table(*titles: Phrase) -> Table:
    """Make a table with titles of its columns, and no rows yet."""
    return Table(*map(render, titles))


def print_json(value: Any) -> None:
    """Print a value as one line of JSON.

    It may contain plain values, tuples and messages; bytes are written as base64.
    """
    sys.stdout.write(json_line(value) + "\n")
    sys.stdout.flush()


def json_line(value: Any) -> str:
    """Return a value as one line of JSON; `text_of` rewrites names that are not UTF-8."""
    try:
        return msgspec.json.encode(value).decode()
    except UnicodeEncodeError:
        plain = msgspec.to_builtins(value, str_keys=True)
        return json.dumps(_encodable(plain), ensure_ascii=False, separators=(",", ":"))


def _encodable(value: Any) -> Any:
    match value:
        case str():
            return text_of(value)
        case Mapping():
            return {text_of(key): _encodable(item) for key, item in value.items()}
        case list() | tuple():
            return [*map(_encodable, value)]
    return value


def results_only() -> contextlib.AbstractContextManager[object]:
    """In the block, what other people's code prints goes to standard error, such as a bot's."""
    return contextlib.redirect_stdout(sys.stderr)


def progress() -> "Progress":
    """Make progress bars on standard error, one for each task; they disappear at the end."""
    from rich.progress import (  # half of the time that the other imports take
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeRemainingColumn,
    )

    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        console=stderr,
        transient=True,
    )
