"""The command `lacoc`.

Subcommands are the entries of an entry-point group. Those of LACOC are imported only when they are
called; `listing` has the help's lines about them. So a contestant's machine needs no package that
only a court needs, a third party adds a command by installing a package, and `lacoc --version` is
quick.

An entry names a `typer.Typer`. With one command in it, the entry becomes that command; with
several, a group of commands. Commands raise `UserError` and `FileRefused`; this module turns
them into words on the screen and an exit code.
"""

import sys
from collections import UserDict
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib.metadata import EntryPoint
from typing import Annotated, Any, ClassVar, NamedTuple

import typer
from rich.markup import escape
from typer.core import TyperCommand, TyperGroup

from lacoc_shared import __version__, words
from lacoc_shared.command import help as help_text
from lacoc_shared.command import installing, language, listing, plugins, screen, streams
from lacoc_shared.command.listing import ListedCommand, Listing
from lacoc_shared.mistakes import FileRefused, UserError, printable, text_of
from lacoc_shared.words import render, say

WRONG_USE = 2
"""Exit code for a mistake that the user can correct."""
INTERRUPTED = 130
"""Exit code after Ctrl-C."""

_COMPLETION = {"install_completion", "show_completion"}  # options of the outermost command only


class _Unloaded(NamedTuple):
    """An entry point whose command was not imported yet.

    This class makes such entry points recognisable. Their own class can't, because another package
    may replace the class of all entry points.
    """

    entry: EntryPoint


class _Commands(UserDict[str, Any]):
    """A mapping from names to commands; a command is imported when it is first read."""

    def __init__(
        self, own: Mapping[str, Any], entries: Mapping[str, EntryPoint], listed: Listing
    ) -> None:
        self._listing = listed
        self._only_lists = False
        order = [*(name for name in listed if name in entries), *entries]
        super().__init__({**own, **{name: _Unloaded(entries[name]) for name in order}})

    def __getitem__(self, name: str) -> Any:
        command = super().__getitem__(name)
        listed = self._listing.get(name)
        if isinstance(command, _Unloaded):
            if self._only_lists and listed is not None and _is_ours(command.entry):
                return _listed(name, listed)
            command = self.data[name] = _load(command.entry)
            panel = listing.OTHERS if listed is None else listed.panel
            if panel and any(one.panel for one in self._listing.values()):
                command.rich_help_panel = help_text.in_words(panel)
        return command

    @contextmanager
    def only_list(self) -> Iterator[None]:
        """Return stand-ins for LACOC's commands, and import none of them, until the block ends."""
        self._only_lists = True
        try:
            yield
        finally:
            self._only_lists = False


class LazyGroup(TyperGroup):
    """A group whose commands are the entries of an entry-point group; see `lazy_group`."""

    entry_points: ClassVar[str]
    listing: ClassVar[Listing] = {}

    def __init__(self, **attributes: Any) -> None:
        super().__init__(**attributes)
        entries = plugins.installed(self.entry_points)
        self.commands: _Commands = _Commands(self.commands, entries, self.listing)

    def list_commands(self, ctx: Any) -> list[str]:
        """Return the names of all commands, in the order of the help; imports none of them."""
        return list(self.commands)

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Print the help of the group; import only commands of other packages."""
        self.epilog = listing.advice(self.listing)
        with self.commands.only_list():
            super().format_help(ctx, formatter)

    def shell_complete(self, ctx: Any, incomplete: str) -> list[Any]:
        """List the completions of a word for the shell; import only commands of other packages."""
        with self.commands.only_list():
            return super().shell_complete(ctx, incomplete)


def lazy_group(entry_points: str, help: str, listing: Listing | None = None) -> typer.Typer:
    """Make a group of commands; those of LACOC are imported only when they are called.

    Args:
        entry_points: name of the entry-point group; each entry names a `typer.Typer`.
        help: what the group is for; lists of groups show its first line.
        listing: what the help says of LACOC's own commands, in their order; other packages'
            commands follow in alphabetical order.
    """
    cls = type("_Group", (LazyGroup,), {"entry_points": entry_points, "listing": listing or {}})
    app = typer.Typer(
        cls=cls,
        help=help,
        no_args_is_help=True,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback()(lambda: None)
    return app


def _is_ours(entry: EntryPoint) -> bool:
    return entry.dist is not None and entry.dist.name == "lacoc"


def _listed(name: str, listed: ListedCommand) -> TyperCommand:
    """Make a stand-in for a command that was not imported; lists of commands show it."""
    panel = help_text.in_words(listed.panel) or None
    return TyperCommand(name, help=listed.in_words(), rich_help_panel=panel)


def _load(entry: EntryPoint) -> Any:
    try:
        command: Any = typer.main.get_command(entry.load())
    except Exception as error:
        command = _broken(error)  # a broken command must not hide the others
    command.name = entry.name
    _prepare_help(command)
    command.params = [param for param in command.params if param.name not in _COMPLETION]
    return command


def _prepare_help(command: Any) -> None:
    """Translate a command's help, and join its lines, which then break at the terminal's width."""
    if command.help:
        paragraphs = command.help.split("\n\n")
        command.help = "\n\n".join(" ".join(paragraph.split()) for paragraph in paragraphs)
    help_text.translate(command)
    subcommands = getattr(command, "commands", {})
    loaded = subcommands.data if isinstance(subcommands, _Commands) else subcommands
    for subcommand in loaded.values():
        if not isinstance(subcommand, _Unloaded):  # others follow when they are loaded
            _prepare_help(subcommand)


def _broken(error: Exception) -> TyperCommand:
    """Make a stand-in for a command that can't be imported; running it shows the error."""

    def fail() -> None:
        raise error

    return TyperCommand(
        None,
        callback=fail,
        help=escape(_missing_extra(error) or render(say("command.broken", error=str(error)))),
        add_help_option=False,
        context_settings={"allow_extra_args": True, "ignore_unknown_options": True},
    )


def _missing_extra(error: Exception) -> str | None:
    """Return how to install a missing package, such as MuJoCo; None for any other error."""
    module = (error.name or "").partition(".")[0] if isinstance(error, ImportError) else ""
    if module not in installing.EXTRA_OF:
        return None
    install = installing.command(installing.EXTRA_OF[module])
    return render(say("command.missing-package", package=module, install=install))


def _print_version(wanted: bool) -> None:
    if wanted:
        screen.show(f"lacoc {__version__}")
        raise typer.Exit


def _options(
    context: typer.Context,
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Show the version and exit."
        ),
    ] = False,
) -> None:
    if context.invoked_subcommand is None:
        for role in (
            say("start.contestant"),
            say("start.referee"),
            say("start.organiser"),
            say("start.teacher"),
            say("start.science"),
            say("start.more"),
        ):
            screen.show(role)


app = lazy_group(
    "lacoc.commands",
    help="The online contest for walking robots: design a gait, meet in a three-minute match.\n\n"
    "New here? See a match with 'lacoc demo', then walk your own with 'lacoc practice'.",
    listing=listing.COMMANDS,
)
app.callback(invoke_without_command=True, no_args_is_help=False)(_options)


def main(args: Sequence[str] | None = None) -> int:
    """Run the command `lacoc`.

    Args:
        args: the words after `lacoc`; None takes those of this process.

    Returns:
        The exit code: 0 done, 2 a mistake that the user can correct, 130 Ctrl-C.

    Raises:
        SystemExit: with the exit code, if the command-line library ends the command: one of these,
            or the command's own, such as 1.
        Exception: any other error; it is a bug and is shown with its traceback.
    """
    words.use(language.of_process())
    streams.open_all()
    screen.accept_any_text()
    screen.show_crashes(sys.stderr)
    try:
        try:
            command = typer.main.get_command(app)
            _prepare_help(command)
            help_text.translate_typer()
            command.main(args=args, prog_name="lacoc")
        finally:
            sys.stdout.flush()
    except BrokenPipeError:
        streams.drop_output()  # a reader that has closed the pipe is no error
    except streams.OutputFailed as error:
        streams.drop_output()
        screen.error(say("command.no-output", why=error.strerror))
        return WRONG_USE
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
    return 0


def _no_text(error: UnicodeEncodeError) -> str:
    """Return the message that a file name or argument can't be sent or stored: it is no text."""
    return render(say("command.no-text", text=printable(text_of(error.object))))
