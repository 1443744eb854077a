"""The command `lacoc`: how it finds its commands and how it reports their errors."""

import os
import subprocess
import sys
from collections.abc import Callable
from importlib.metadata import EntryPoint
from pathlib import Path
from types import SimpleNamespace

import pytest

from lacoc_shared import __version__
from lacoc_shared.command import cli, installing, plugins

COMMANDS = {
    "play": """
        import typer
        app = typer.Typer()
        @app.command()
        def run(name: str = typer.Option("x", help="A name.")) -> None:
            '''Take your seat.'''
            print("playing as", name)
    """,
    "serve": """
        import mujoco, typer
        app = typer.Typer()
    """,
    "tag": """
        import typer
        app = typer.Typer(help="Brought by another package.")
        @app.command()
        def hide() -> None:
            '''Hide.'''
        @app.command()
        def seek() -> None:
            '''Seek.'''
            print("found")
    """,
    "late": """
        import typer
        app = typer.Typer()
        @app.command()
        def run() -> None:
            '''Import late.'''
            import mujoco
    """,
    "wrong": """
        raise RuntimeError("no such planet")
    """,
    "fails": """
        import typer
        from lacoc_shared.mistakes import FileRefused, Mistake, UserError
        app = typer.Typer()
        @app.command()
        def run(how: str) -> None:
            '''Fail in some way.'''
            if how == "user":
                raise UserError("No [court] here: start one with 'lacoc serve'.")
            if how == "file":
                raise FileRefused([
                    Mistake(file="a.txt", row=3, column=7, joint=5, leg="L,F", found="[x]",
                            expected="a number"),
                    Mistake(file="a.txt", row=9, found="12 angles", expected="18 angles"),
                ])
            if how == "stop":
                raise KeyboardInterrupt
            how.encode()  # as a message or a file takes it
            raise ZeroDivisionError(how)
    """,
    "many": """
        from lacoc_shared.command.cli import lazy_group
        app = lazy_group("lacoc.commands.many", help="Many things.")
        @app.command()
        def own() -> None:
            '''One of its own.'''
    """,
}


@pytest.fixture
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Replace the installed commands by the commands in `COMMANDS`, and hide MuJoCo."""
    import textwrap

    for name, source in COMMANDS.items():
        (tmp_path / f"fake_{name}.py").write_text(textwrap.dedent(source))
        monkeypatch.delitem(sys.modules, f"fake_{name}", raising=False)
    groups = {
        "lacoc.commands": COMMANDS,
        "lacoc.commands.many": {"tag": ""},
    }

    def entry_points(group: str) -> list[EntryPoint]:
        return [EntryPoint(name, f"fake_{name}:app", group) for name in groups.get(group, {})]

    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(plugins, "entry_points", entry_points)
    monkeypatch.setitem(sys.modules, "mujoco", None)  # as if it were not installed


@pytest.fixture
def lacoc(
    installed: None, capsys: pytest.CaptureFixture[str]
) -> Callable[..., tuple[int, str, str]]:
    """Give a function that runs the command line and returns exit code, output and error output."""

    def run(*args: str) -> tuple[int, str, str]:
        try:
            code: object = cli.main(args)
        except SystemExit as stop:
            code = stop.code
        out, err = capsys.readouterr()
        assert isinstance(code, int)
        return code, out, err

    return run


Lacoc = Callable[..., tuple[int, str, str]]


def test_help_lists_every_command_what_a_contestant_needs_first(lacoc: Lacoc) -> None:
    """Help begins with the contestant's commands and ends with the commands of other packages."""
    code, out, _ = lacoc("--help")

    assert code == 0
    order = ["Play", "play", "Take your seat.", "Run a contest", "serve", "other packages", "tag"]
    places = [out.index(word) for word in order]
    assert places == sorted(places)
    assert installing.command("server") in " ".join(out.split())
    assert "no such planet" in out


class OwnEntry(EntryPoint):
    """An entry point of this package, as far as it can be asked."""

    dist = SimpleNamespace(name="lacoc")


def test_help_lists_own_commands_without_importing_them(
    lacoc: Lacoc, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of this package's commands, help tells what they are for and which extra they lack."""
    entries = {
        "lacoc.commands": [
            OwnEntry("play", "fake_play:app", "lacoc.commands"),
            OwnEntry("serve", "fake_serve:app", "lacoc.commands"),
            EntryPoint("tag", "fake_tag:app", "lacoc.commands"),
        ]
    }
    monkeypatch.setattr(plugins, "entry_points", lambda group: entries.get(group, []))
    plugins._installed.cache_clear()
    monkeypatch.setenv("COLUMNS", "200")

    code, out, _ = lacoc("--help")

    assert code == 0
    assert not {"fake_play", "fake_serve"} & {*sys.modules}
    assert "Hold a seat and steer your robot with the keyboard. " in out
    assert 'records the match. (needs the extra "server")' in out
    assert "Brought by another package." in out
    assert out.count(installing.command("server")) == 1
    assert lacoc("play") == (0, "playing as x\n", "")
    plugins._installed.cache_clear()


def test_a_command_is_imported_when_it_is_asked_for(lacoc: Lacoc) -> None:
    """Running a command imports no other command."""
    assert lacoc("play", "--name", "Ant") == (0, "playing as Ant\n", "")
    assert "fake_play" in sys.modules
    assert "fake_tag" not in sys.modules


def test_groups_and_lazy_groups_nest(lacoc: Lacoc) -> None:
    """A plugin with several commands is a group, and a group may have plugins of its own."""
    assert lacoc("tag", "seek") == (0, "found\n", "")
    assert lacoc("many", "tag", "seek") == (0, "found\n", "")
    assert lacoc("many", "own") == (0, "", "")
    _, out, _ = lacoc("many", "--help")
    assert "One of its own." in out
    assert "Brought by another package." in out
    assert "--install-completion" not in out


def test_a_wrong_command_suggests_the_nearest(lacoc: Lacoc) -> None:
    """For an unknown command, the error suggests the one with the nearest name."""
    code, out, err = lacoc("pley")

    assert code == 2
    assert out == ""
    assert "pley" in err
    assert "'play'" in err


@pytest.mark.parametrize("args", [("serve",), ("serve", "--court", "x"), ("serve", "--help")])
def test_a_missing_extra_is_one_line(lacoc: Lacoc, args: tuple[str, ...]) -> None:
    """If MuJoCo is missing, a command that needs MuJoCo says in one line how to install it.

    The arguments of the command, such as `--help`, make no difference.
    """
    code, out, err = lacoc(*args)

    assert (code, out) == (2, "")
    install = installing.command("server")
    assert err == f"Error: Needs mujoco, which is not installed. To install it, run: {install}\n"


def test_a_missing_extra_found_late_is_the_same_line(lacoc: Lacoc) -> None:
    """A command that imports MuJoCo only when it runs also says in one line how to install it."""
    code, _, err = lacoc("late")

    assert code == 2
    assert installing.command("server") in err
    assert err.count("\n") == 1


def test_a_user_error_is_one_line_and_code_2(lacoc: Lacoc) -> None:
    """A UserError is printed unchanged as one line of the error output, with exit code 2."""
    assert lacoc("fails", "user") == (
        2,
        "",
        "Error: No [court] here: start one with 'lacoc serve'.\n",
    )


def test_a_word_that_is_no_text_is_one_line_and_code_2(lacoc: Lacoc) -> None:
    """An argument that is not UTF-8 is refused in one line with exit code 2."""
    code, out, err = lacoc("fails", os.fsdecode(b"Ants\x98"))
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert r"Ants\x98" in err
    assert "is not valid UTF-8 text" in err


def test_a_refused_file_is_a_table_and_code_2(lacoc: Lacoc) -> None:
    """Rules 2: a refused file's mistakes are printed as a table, a row for each."""
    code, out, err = lacoc("fails", "file")

    assert (code, out) == (2, "")
    assert "2 mistakes" in err
    first = next(line for line in err.splitlines() if "[x]" in line)
    cells = [cell.strip() for cell in first.strip("│").split("│")]
    assert cells == ["a.txt", "3", "7", "5", "L,F", "[x]", "a number"]
    assert "18 angles" in err
    assert "entry" not in err  # no mistake has one


def test_ctrl_c_is_silent(lacoc: Lacoc) -> None:
    """Ctrl-C ends a command without output, with exit code 130."""
    assert lacoc("fails", "stop") == (130, "", "")


def test_what_nobody_foresaw_is_a_traceback(lacoc: Lacoc) -> None:
    """A bug in a command, or a package that can't be imported, gives a traceback."""
    with pytest.raises(ZeroDivisionError):
        lacoc("fails", "bug")
    with pytest.raises(RuntimeError, match="no such planet"):
        lacoc("wrong", "--any", "thing")


def test_version(lacoc: Lacoc) -> None:
    """`--version` prints the version and imports no command."""
    assert lacoc("--version") == (0, f"lacoc {__version__}\n", "")
    assert not any(name in sys.modules for name in ("fake_play", "fake_tag", "fake_many"))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("lacoc cont", "contest"),
        ("lacoc contest in", "init"),
        ("lacoc contest init --ar", "--arena"),
    ],
)
def test_the_shell_completes(words: str, expected: str) -> None:
    """The shell completes commands, subcommands and options."""
    environment = {
        **os.environ,
        "_LACOC_COMPLETE": "complete_bash",
        "COMP_WORDS": words,
        "COMP_CWORD": str(words.count(" ")),
    }
    done = subprocess.run(
        [sys.executable, "-m", "lacoc_shared"],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )

    assert expected in done.stdout.split()


@pytest.mark.slow
def test_a_reader_who_has_gone_is_no_error() -> None:
    """Output into a pipe that is closed, as by `head -1`, gives no error message."""
    reader, writer = os.pipe()
    os.close(reader)
    try:
        done = subprocess.run(
            [sys.executable, "-m", "lacoc_shared", "--version"],
            stdout=writer,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    finally:
        os.close(writer)

    assert done.stderr == ""


COMMANDS_THAT_PRINT = [
    ["--version"],
    ["--help"],
    ["gait", "convert", "--help"],
    ["robot", "list"],
    ["robot", "list", "--json"],
    ["docs", "contest"],
    ["simulate", "nearest", "straight", "--seconds", "1"],
]


@pytest.mark.slow
@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="a device of Linux")
@pytest.mark.parametrize(
    ("words", "unbuffered"),
    [
        *((words, "") for words in COMMANDS_THAT_PRINT[-2:]),
        *(pytest.param(words, "", marks=pytest.mark.long) for words in COMMANDS_THAT_PRINT[:-2]),
        (["robot", "list"], "1"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else value,
)
@pytest.mark.parametrize(
    ("stream", "why"),
    [(">/dev/full", "No space left on device"), (">&-", "Bad file descriptor")],
)
def test_output_that_can_not_be_written_is_one_sentence(
    words: list[str], stream: str, why: str, unbuffered: str
) -> None:
    """Full or closed output ends a command with one sentence and exit code 2, not a traceback."""
    done = subprocess.run(
        ["sh", "-c", f'exec "$@" {stream}', "sh", sys.executable, "-m", "lacoc_shared", *words],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONUNBUFFERED": unbuffered},
    )

    assert done.stderr.strip() == f"Error: The output can't be written: {why}"
    assert done.returncode == 2


@pytest.mark.slow
def test_closed_streams_do_not_catch_what_goes_into_files(tmp_path: Path) -> None:
    """A command that has nothing to print works with all three streams closed."""
    if sys.platform == "win32":
        pytest.skip("a shell of POSIX")
    command = [sys.executable, "-m", "lacoc_shared", "gait", "sample", str(tmp_path)]
    done = subprocess.run(["sh", "-c", 'exec "$@" <&- >&- 2>&-', "sh", *command], check=False)

    assert done.returncode == 0
    assert [one.name for one in tmp_path.iterdir()] == ["Loco-data.xlsx"]


@pytest.mark.slow
def test_no_colours_in_a_pipe() -> None:
    """Output into a pipe has no escape sequences."""
    done = subprocess.run(
        [sys.executable, "-m", "lacoc_shared", "contest", "check", "none.toml"],
        capture_output=True,
        text=True,
        check=False,
    )

    assert done.returncode == 2
    assert "none.toml" in done.stderr
    assert "\x1b" not in done.stderr
