"""The help of the commands in the language of the user.

The source has the help in English, where typer reads it. `words/texts/help.toml` is a table with
the Japanese of each English text, also of typer's own words, such as "Options". For English the
table is not read. A text that is not in the table, such as that of another package, stays English.
"""

import tomllib
from collections.abc import Callable, Mapping
from difflib import get_close_matches
from functools import cache, partial
from importlib import resources
from typing import Any

from lacoc_shared import words

_TITLES = (
    "DEPRECATED_STRING",
    "DEFAULT_STRING",
    "ENVVAR_STRING",
    "REQUIRED_LONG_STRING",
    "ARGUMENTS_PANEL_TITLE",
    "OPTIONS_PANEL_TITLE",
    "COMMANDS_PANEL_TITLE",
    "ERRORS_PANEL_TITLE",
    "ABORTED_TEXT",
    "RICH_HELP",
)
"""Names of the variables in typer's module `rich_utils` that have typer's own words."""
_TEXT = "_make_rich_text"
"""Name of the function in `rich_utils` that makes a text for a table."""
_ERROR = "rich_format_error"
"""Name of the function in `rich_utils` that shows a mistake in the use of a command."""
_english: dict[str, Any] = {}
"""The original values of all names in `rich_utils` that this module replaces; at first empty."""


@cache
def japanese() -> Mapping[str, str]:
    """Read the table of the help: a mapping from each English text to its Japanese."""
    file = resources.files("lacoc_shared.words") / "texts" / "help.toml"
    table = tomllib.loads(file.read_text(encoding="utf-8"))
    return {pair["en"]: pair["ja"] for pair in table["text"] + table["typer"]}


def in_words(text: str) -> str:
    """Return a text of the help of commands in the language of this process."""
    return text if words.current() == "en" else japanese().get(text, text)


def summary_in_words(text: str) -> str:
    """Return the first paragraph of a command's help in the language of this process."""
    if words.current() == "en":
        return text
    first = (whole for en, whole in japanese().items() if en.partition("\n\n")[0] == text)
    return next(first, text).partition("\n\n")[0]


def translate(command: Any) -> None:
    """Put the help of a command and its parameters into the language of this process."""
    if words.current() == "en":
        return
    for part in (command, *command.params):
        for name in ("help", "rich_help_panel", "options_metavar", "subcommand_metavar"):
            if isinstance(text := getattr(part, name, None), str):
                setattr(part, name, in_words(text))
    command.context_class = _context(command.context_class)
    if hasattr(command, "resolve_command"):
        command.resolve_command = partial(_resolved, command, command.resolve_command)


def translate_typer() -> None:
    """Put typer's own words into the language of this process."""
    if words.current() == "en" and not _english:
        return
    from typer import rich_utils  # heavy; no command in English needs it here

    if not _english:
        # A version of typer that lacks one of them shows that part in English.
        names = (*_TITLES, _TEXT, _ERROR)
        _english.update({n: getattr(rich_utils, n) for n in names if hasattr(rich_utils, n)})
    for name in _english.keys() & set(_TITLES):
        setattr(rich_utils, name, in_words(_english[name]))
    for name, change in ((_TEXT, _folded), (_ERROR, _explained)):
        if name not in _english:
            continue
        own = _english[name]
        setattr(rich_utils, name, own if words.current() == "en" else partial(change, own))


def _folded(make: Callable[..., Any], **what: Any) -> Any:
    """Call `make`, typer's function that makes a text; allow line breaks anywhere in the text.

    Japanese has no spaces. So a table would take a line for one long word, and cut off its end.
    """
    text = make(**what)
    text.overflow = "fold"
    return text


@cache
def _context(base: Any) -> Any:
    """Derive, from a click context class, one whose help is in the language of this process."""

    class Formatter(base.formatter_class):  # type: ignore[misc]
        def write_usage(self, prog: str, args: str = "", prefix: str | None = None) -> None:
            super().write_usage(prog, args, in_words("Usage: ") if prefix is None else prefix)

    class Context(base):  # type: ignore[misc]
        formatter_class = Formatter

        def __init__(self, command: Any, *args: Any, **settings: Any) -> None:
            super().__init__(command, *args, **settings)
            if option := command.get_help_option(self):
                option.help = in_words(option.help)

    return Context


def _resolved(group: Any, resolve: Callable[..., Any], ctx: Any, args: list[str]) -> Any:
    """Find the command that the first word names in a group; report if there is no such command."""
    name = args[0]
    if not name.startswith("-") and group.get_command(ctx, name) is None:
        near = get_close_matches(name, group.list_commands(ctx))
        ctx.fail(sentence("No such command '{}'.", name) + _suggested(near))
    return resolve(ctx, args)


def _explained(show: Callable[[Any], None], error: Any) -> None:
    """Show a mistake in the use of a command, in the process's language if possible."""
    message = error.message
    hint = error.param.get_error_hint() if getattr(error, "param", None) else ""
    match type(error).__name__:
        case "NoSuchOption":
            message = sentence("No such option: {}", error.option_name)
            message += _suggested(sorted(error.possibilities or ()))
        case "MissingParameter":
            message = sentence("Missing {}.", hint)
        case "BadParameter" if hint:
            message = sentence("Invalid value for {}: {}", hint, in_words(message))
    error.format_message = lambda: message
    show(error)


def sentence(text: str, *values: str) -> str:
    """Return a sentence of the help in the process's language, with values for its "{}"."""
    return in_words(text).format(*values)


def _suggested(names: list[str]) -> str:
    return sentence("Did you mean {}?", ", ".join(names)) if names else ""
