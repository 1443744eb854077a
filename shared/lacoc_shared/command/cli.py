"""The command `lacoc`.

Subcommands are the entries of an entry-point group, each imported when it is asked for
(or when help lists them all): so a contestant's machine needs nothing of the court's,
a third party adds a command by installing a package, and `lacoc --version` is quick.

An entry names a `typer.Typer`; one with a single command is that command, any other is
a group. Commands raise `UserError` and `FileRefused`; here alone they become words on
the screen and an exit code.
"""

import os
import sys
from collections import UserDict
from collections.abc import Mapping, Sequence
from importlib.metadata import EntryPoint
from typing import Annotated, Any, ClassVar

import typer
from rich.markup import escape
from typer.core import TyperCommand, TyperGroup

from lacoc_shared import __version__, words
from lacoc_shared.command import language, plugins, screen
from lacoc_shared.mistakes import FileRefused, UserError, printable, text_of

WRONG_USE = 2
"""Exit code: something that a person can put right."""
INTERRUPTED = 130
"""Exit code: Ctrl-C."""

Panels = Mapping[str, tuple[str, ...]]
"""Heading of the help -> the commands below it, in order."""

_PANELS: Panels = {
    "Play": ("demo", "practice", "play", "watch"),
    "Prepare your robot": ("gait", "robot"),
    "Run a contest": ("contest", "serve", "web", "referee", "doctor"),
    "Study and develop": ("replay", "simulate", "bot"),
}
_OTHERS = "Commands of other packages"
_EXTRAS = {"mujoco": "server", "cryptography": "server"}
"""What the base install leaves out -> the extra that has it."""
_COMPLETION = {"install_completion", "show_completion"}  # options of the outermost command alone


class _Commands(UserDict[str, Any]):
    """Commands by name; an entry point becomes a command when it is first looked at."""

    def __init__(self, own: Mapping[str, Any], entries: Mapping[str, EntryPoint], panels: Panels):
        self._panel = {name: panel for panel, names in panels.items() for name in names}
        order = [*(name for name in self._panel if name in entries), *entries]
        super().__init__({**own, **{name: entries[name] for name in order}})

    def __getitem__(self, name: str) -> Any:
        command = super().__getitem__(name)
        if isinstance(command, EntryPoint):
            command = self.data[name] = _load(command)
            if self._panel:
                command.rich_help_panel = self._panel.get(name, _OTHERS)
        return command


class LazyGroup(TyperGroup):
    """A group that finds its commands in an entry-point group; see `lazy_group`."""

    entry_points: ClassVar[str]
    panels: ClassVar[Panels] = {}

    def __init__(self, **attributes: Any) -> None:
        super().__init__(**attributes)
        entries = plugins.installed(self.entry_points)
        self.commands = _Commands(self.commands, entries, self.panels)

    def list_commands(self, ctx: Any) -> list[str]:
        """Names of all commands, in the order of the help; imports none of them."""
        return list(self.commands)


def lazy_group(entry_points: str, help: str, panels: Panels | None = None) -> typer.Typer:
    """Make a group of commands that are imported when they are asked for.

    Args:
        entry_points: name of the entry-point group; each entry names a `typer.Typer`.
        help: what the group is for; its first line is shown where groups are listed.
        panels: headings of the help and the commands below each, in order; without them the
            commands stand in alphabetical order.
    """
    cls = type("_Group", (LazyGroup,), {"entry_points": entry_points, "panels": panels or {}})
    app = typer.Typer(
        cls=cls,
        help=help,
        no_args_is_help=True,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback()(lambda: None)
    return app


def _load(entry: EntryPoint) -> Any:
    try:
        command: Any = typer.main.get_command(entry.load())
    except Exception as error:
        command = _broken(error)  # it must not hide the other commands
    command.name = entry.name
    _join_lines(command)
    command.params = [param for param in command.params if param.name not in _COMPLETION]
    return command


def _join_lines(command: Any) -> None:
    """Let help break its lines where the terminal is full, not where the source does."""
    if command.help:
        paragraphs = command.help.split("\n\n")
        command.help = "\n\n".join(" ".join(paragraph.split()) for paragraph in paragraphs)
    subcommands = getattr(command, "commands", {})
    loaded = subcommands.data if isinstance(subcommands, _Commands) else subcommands
    for subcommand in loaded.values():
        if not isinstance(subcommand, EntryPoint):  # it has its turn when it is loaded
            _join_lines(subcommand)


def _broken(error: Exception) -> TyperCommand:
    """A command in the place of one that can't be imported; it tells why when it is run."""

    def fail() -> None:
        raise error

    return TyperCommand(
        None,
        callback=fail,
        help=escape(_missing_extra(error) or f"Can't be loaded: {error}"),
        add_help_option=False,
        context_settings={"allow_extra_args": True, "ignore_unknown_options": True},
    )


def _missing_extra(error: Exception) -> str | None:
    """How to install what is missing, if the base install leaves it out on purpose."""
    module = (error.name or "").partition(".")[0] if isinstance(error, ImportError) else ""
    if module not in _EXTRAS:
        return None
    return f'Needs {module}, which is not installed: pip install "lacoc[{_EXTRAS[module]}]"'


def _print_version(wanted: bool) -> None:
    if wanted:
        screen.show(f"lacoc {__version__}")
        raise typer.Exit


def _options(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Show the version and exit."
        ),
    ] = False,
) -> None:
    pass


app = lazy_group(
    "lacoc.commands",
    help="The online contest for walking robots: design a gait, meet in a three-minute match.\n\n"
    "New here? See a match with 'lacoc demo', then walk your own with 'lacoc practice'.",
    panels=_PANELS,
)
app.callback()(_options)


def main(args: Sequence[str] | None = None) -> int:
    """Run the command line.

    Args:
        args: the words after `lacoc`; those of this process if None.

    Returns:
        The exit code: 0 done, 2 a mistake that a person can put right, 130 Ctrl-C.

    Raises:
        SystemExit: with such a code, where the command-line library ends the command.
        Exception: what nobody foresaw: a bug, shown with its traceback.
    """
    words.use(language.of_process())
    screen.accept_any_text()
    screen.show_crashes(sys.stderr)
    try:
        typer.main.get_command(app).main(args=args, prog_name="lacoc")
    except UserError as error:
        screen.error(str(error))
        return WRONG_USE
    except FileRefused as error:
        screen.refused(error.mistakes)
        return WRONG_USE
    except ImportError as error:
        sentence = _missing_extra(error)
        if sentence is None:
            raise
        screen.error(sentence)
        return WRONG_USE
    except UnicodeEncodeError as error:
        screen.error(_no_text(error))
        return WRONG_USE
    except KeyboardInterrupt:
        return INTERRUPTED
    finally:
        _flush()
    return 0


def _no_text(error: UnicodeEncodeError) -> str:
    """Say which name or word of the system can't be sent or stored, because it is no text."""
    return (
        f"'{printable(text_of(error.object))}' holds bytes that are not text in UTF-8. "
        "Rename the file or folder, or write the word again."
    )


def _flush() -> None:
    """Write what is left, so that a reader who has gone is no error at the very end."""
    try:
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
