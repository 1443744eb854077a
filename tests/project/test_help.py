"""Help that a student understands: every command and every option says what it is for."""

import re
from collections.abc import Iterator
from typing import Any

import pytest
import typer

from lacoc_shared.command import cli

ROOT: Any = typer.main.get_command(cli.app)


def walk(command: Any, path: tuple[str, ...]) -> Iterator[tuple[str, Any]]:
    """Yield a command and all commands below it, each with its name as it is typed."""
    yield " ".join(path), command
    for name in command.list_commands(None) if hasattr(command, "list_commands") else ():
        yield from walk(command.get_command(None, name), (*path, name))


COMMANDS = dict(walk(ROOT, ("lacoc",)))


def test_all_commands_of_the_contest_are_there() -> None:
    """All commands that the help groups into panels exist."""
    expected = {name for names in cli._PANELS.values() for name in names}

    assert {name.split()[1] for name in COMMANDS if " " in name} >= expected


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_says_what_it_is_for(name: str) -> None:
    """A command's help begins with a sentence that is short enough for a list of commands."""
    text = COMMANDS[name].help or ""
    first = text.partition("\n\n")[0].replace("\n", " ")

    assert first.endswith((".", "!")), f"{name}: {first!r}"
    assert len(first) <= 110, f"{name}: {len(first)} characters"
    assert "can't be loaded" not in text.lower()


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_and_argument_has_help(name: str) -> None:
    """Every option and argument has a help text."""
    silent = [
        param.name
        for param in COMMANDS[name].params
        if not getattr(param, "hidden", False) and not (getattr(param, "help", "") or "").strip()
    ]
    assert silent == []


@pytest.mark.parametrize("name", COMMANDS)
def test_help_is_shown_as_it_is_written(
    name: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """`--help` shows words in square brackets, which could be taken for styles."""
    monkeypatch.setenv("COLUMNS", "100")
    with pytest.raises(SystemExit) as stop:
        cli.main([*name.split()[1:], "--help"])
    shown = capsys.readouterr().out

    assert stop.value.code == 0
    texts = [COMMANDS[name].help, *(getattr(p, "help", None) for p in COMMANDS[name].params)]
    words = re.sub(r"[│╭╮╰╯─]", " ", shown)
    compact = "".join(words.split())
    lost = [key for text in texts if text for key in re.findall(r"\[\w+\]", text)]
    assert [key for key in lost if key not in compact] == []
