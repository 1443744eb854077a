"""Help that a student understands: every command and every option says what it is for."""

import re
import tomllib
from collections.abc import Iterator
from importlib import resources
from pathlib import Path
from typing import Any

import pytest
import typer

from lacoc_shared import words
from lacoc_shared.command import cli, listing, plugins
from lacoc_shared.command import help as help_text

ROOT: Any = typer.main.get_command(cli.app)


def walk(command: Any, path: tuple[str, ...]) -> Iterator[tuple[str, Any]]:
    """Yield a command and all commands below it, each with its name as it is typed."""
    yield " ".join(path), command
    for name in command.list_commands(None) if hasattr(command, "list_commands") else ():
        yield from walk(command.get_command(None, name), (*path, name))


COMMANDS = dict(walk(ROOT, ("lacoc",)))


def test_all_commands_of_the_contest_are_there() -> None:
    """All commands that the help groups into panels exist."""
    assert {name.split()[1] for name in COMMANDS if " " in name} >= {*listing.COMMANDS}


@pytest.mark.parametrize(
    ("group", "listed"), [("lacoc", listing.COMMANDS), ("lacoc replay", listing.REPLAY)]
)
def test_the_listing_has_the_first_paragraph_of_each_command(
    group: str, listed: listing.Listing
) -> None:
    """A list of commands, which imports none of them, says what each command's own help says."""
    own = {name: COMMANDS[f"{group} {name}"].help.partition("\n\n")[0] for name in listed}

    assert {name: one.summary for name, one in listed.items()} == own


def test_all_own_commands_are_listed() -> None:
    """The listings have every command that this package has by entry point."""
    groups = {"lacoc.commands": listing.COMMANDS, "lacoc.commands.replay": listing.REPLAY}
    for group, listed in groups.items():
        assert {entry.name for entry in plugins.installed(group).values()} == {*listed}


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
    """`--help` shows words in square brackets, which rich could take for styles."""
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


TYPER = re.compile(r"Usage|Options|Arguments|Commands|\[required|\[default|\[env var|\[OPTIONS")
SENTENCE = re.compile(r"[A-Za-z]+ [a-z]{2,} [a-z]+ [a-z]{2,}")


def texts_of_help() -> set[str]:
    """Return every English text in the help of all commands."""
    found = {listing.OTHERS, listing.NEEDS, listing.LACKS}
    found |= {one.panel for one in listing.COMMANDS.values()}
    for command in COMMANDS.values():
        for part in (command, *command.params):
            found |= {getattr(part, "help", None) or "", getattr(part, "rich_help_panel", "") or ""}
    return found - {""}


def english_left(shown: str) -> list[str]:
    """Return the lines of a Japanese help that have an English sentence or a word from typer."""
    return [line for line in shown.splitlines() if TYPER.search(line) or SENTENCE.search(line)]


def japanese_help(name: str, capsys: pytest.CaptureFixture[str]) -> str:
    """Return what a command prints with --help in Japanese."""
    with pytest.raises(SystemExit):
        cli.main([*name.split()[1:], "--help"])
    return capsys.readouterr().out


@pytest.fixture
def japanese(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Set the language to Japanese and the terminal to 200 columns; later, go back to English."""
    monkeypatch.setenv("LACOC_LANGUAGE", "ja")
    monkeypatch.setenv("COLUMNS", "200")
    yield
    words.use("en")
    help_text.translate_typer()


def test_the_table_of_help_has_the_texts_of_the_commands() -> None:
    """The table of help has each English text of the commands once, and no other text."""
    file = resources.files("lacoc_shared.words") / "texts" / "help.toml"
    pairs = tomllib.loads(file.read_text("utf-8"))["text"]
    english = {pair["en"] for pair in pairs}

    assert texts_of_help() - english == set(), "add them, with their Japanese"
    assert english - texts_of_help() == set(), "no command says them any more"
    assert len(english) == len(pairs)


@pytest.mark.usefixtures("japanese")
def test_help_in_japanese_has_no_english_line(capsys: pytest.CaptureFixture[str]) -> None:
    """The Japanese help of every command has no English sentence and no English word of typer."""
    for name in COMMANDS:
        assert english_left(japanese_help(name, capsys)) == [], name


@pytest.mark.usefixtures("japanese")
def test_an_english_line_is_found(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The check for English lines notices a text, or a word of typer, without a translation."""
    whole = help_text.japanese()
    for text in ("Say ready for a contestant who cannot.", "Options"):
        rest = {en: ja for en, ja in whole.items() if en != text}
        monkeypatch.setattr(help_text, "japanese", lambda rest=rest: rest)
        assert english_left(japanese_help("lacoc referee ready", capsys)) != [], text


@pytest.mark.usefixtures("japanese")
@pytest.mark.parametrize(
    ("typed", "said"),
    [
        ("gait chek", "'chek' というコマンドはありません。もしかして：check"),
        ("gait check --robto x", "--robto というオプションはありません。もしかして：--robot"),
        ("gait convert", "'A' を指定してください。"),
        ("demo --seconds x", "'--seconds' の値が正しくありません：数を指定してください。"),
    ],
)
def test_a_mistake_in_the_use_is_told_in_japanese(
    typed: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """A wrong command line is reported in Japanese if this language is set."""
    with pytest.raises(SystemExit):
        cli.main(typed.split())
    assert said in capsys.readouterr().err


def test_after_japanese_comes_english_again(capsys: pytest.CaptureFixture[str]) -> None:
    """After a change to Japanese and back, help is in English as before."""
    before = japanese_help("lacoc gait check", capsys)
    words.use("ja")
    help_text.translate_typer()
    words.use("en")
    assert japanese_help("lacoc gait check", capsys) == before


FOLDER = Path(__file__).parents[2]
PAGES = [*sorted(FOLDER.glob("README*.md")), *sorted((FOLDER / "docs").glob("*.md"))]
CODE = re.compile(r"```(?!mermaid)\w*\n(.*?)```|`([^`\n]+)`", re.DOTALL)


def cited(text: str) -> Iterator[list[str]]:
    """Yield each command in a page's code blocks and code spans, as its words after "lacoc"."""
    for block, span in CODE.findall(text):
        for line in (block or span).splitlines():
            if found := re.search(r"(?:^|[\s/\\])lacoc((?: [^\s|#]+)*)", line):
                yield found[1].split()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(FOLDER)))
def test_a_page_names_commands_that_exist(page: Path) -> None:
    """Every command and option in the code of the READMEs and of docs/*.md exists."""
    text = page.read_text("utf-8").replace("`lacoc password`", "")  # bytes of the protocol
    for cited_words in cited(text):
        name = "lacoc"
        typed = [word for word in cited_words if word != "LINK"]
        for word in typed:
            if f"{name} {word}" not in COMMANDS:
                break
            name += f" {word}"
        rest = typed[len(name.split()) - 1 :]
        if rest and (usual := getattr(COMMANDS[name], "usual", None)):
            name += f" {usual}"
        is_group = hasattr(COMMANDS[name], "list_commands")
        known = {
            opt for param in COMMANDS[name].params for opt in param.opts + param.secondary_opts
        }
        wrong = [word for word in rest if word.startswith("--") and word.split("=")[0] not in known]
        assert not wrong, f"{name} {' '.join(rest)}"
        assert not is_group or not rest or rest[0].startswith("-"), f"{name} {' '.join(rest)}"


def test_readers_on_windows_are_told_how() -> None:
    """The README of each language says how to install and start on Windows, without `make`."""
    for name in ("README.md", "README.ja.md"):
        text = (FOLDER / name).read_text("utf-8")
        assert "PowerShell" in text
        assert ".venv\\Scripts\\lacoc demo" in text


@pytest.mark.parametrize("language", words.LANGUAGES)
def test_without_words_each_role_sees_where_to_begin(
    language: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """`lacoc` alone prints at most 12 lines, and only commands and pages that exist."""
    monkeypatch.setenv("LACOC_LANGUAGE", language)
    monkeypatch.setenv("COLUMNS", "80")
    with pytest.raises(SystemExit) as stop:
        cli.main([])
    words.use("en")
    help_text.translate_typer()
    lines = capsys.readouterr().out.splitlines()
    assert stop.value.code == 0
    assert len(lines) <= 12
    named = [name for line in lines for name in re.findall(r"lacoc (\w+(?: \w+)?)", line)]
    assert len(named) >= 9
    for name in named:
        first, _, second = name.partition(" ")
        assert f"lacoc {first}" in COMMANDS
        assert second in ("", "python") or f"lacoc {name}" in COMMANDS or not second.islower()
