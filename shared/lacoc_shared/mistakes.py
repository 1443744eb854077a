"""What is wrong with something a person gave us, said so that they can mend it.

Two families. `FileRefused` carries every mistake of a file, each with its place: a
file is refused whole (rules 2), so all its mistakes are listed at once.
`UserError` is one sentence that says what was found and what to do; the command
line prints it and exits with code 2. Both carry phrases (`lacoc_shared.words`), which become
words in the language of the process; a plain text is shown as it is.
"""

import codecs
import json
import os
import unicodedata

import msgspec

from lacoc_shared.words import Phrase, render, say

ESCAPED = "lacoc-escaped"
r"""Error handler of `str.encode`: what an encoding lacks is written as numbers.

A character becomes what JSON has for it (`\u30c1`), so that a line of JSON stays one. A byte of
a file name that is not UTF-8 becomes `\x98`.
"""


class Mistake(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """One mistake in a file, with its place."""

    file: str
    """Name of the file as the person knows it."""
    found: Phrase | str
    """What stands there; a text is quoted from the file."""
    expected: Phrase | str
    """What should stand there, or what to do."""
    row: int | None = None
    """Row (text file: line) counted from 1."""
    column: int | None = None
    """Cell in the row counted from 1."""
    joint: int | None = None
    """Joint id, 0-17 for six legs (rules 1)."""
    leg: str | None = None
    """Label of the joint's leg, such as "R,F"."""
    field: str | None = None
    """Name of the entry, where a file has named entries (a robot file)."""

    @property
    def place(self) -> str:
        """Say the place: "row 3, column 7, joint 5 (L,F)"."""
        return ", ".join(map(render, self._places()))

    def _places(self) -> list[Phrase | str]:
        places: list[Phrase | str | None] = [
            None if self.row is None else say("place.row", row=self.row),
            None if self.column is None else say("place.column", column=self.column),
            self.field,
            None if self.joint is None else say("place.joint", joint=self.joint, leg=self.leg),
        ]
        return [place for place in places if place]

    @property
    def phrase(self) -> Phrase:
        """The whole mistake as one phrase."""
        return say(
            "mistake.line",
            file=self.file,
            place=self._places(),
            found=self.found,
            expected=self.expected,
        )

    def in_words(self) -> "Mistake":
        """Return the mistake in the language of the process: for output that programs read."""
        found, expected = render(self.found), render(self.expected)
        return msgspec.structs.replace(self, found=found, expected=expected)

    def __str__(self) -> str:
        return render(self.phrase)


class FileRefused(ValueError):
    """A file is refused whole; `mistakes` lists everything that is wrong with it."""

    def __init__(self, mistakes: list[Mistake]) -> None:
        super().__init__("\n".join(map(str, mistakes)))
        self.mistakes = mistakes


class UserError(Exception):
    """Something a person can put right; the message says how.

    Args:
        said: what was found and what to do; a text for what is not in the table yet.
    """

    def __init__(self, said: Phrase | str = "") -> None:
        super().__init__(said)
        self.said = said

    @property
    def phrase(self) -> Phrase:
        """What was said, as a phrase."""
        return self.said if isinstance(self.said, Phrase) else say("plain.text", text=self.said)

    def __str__(self) -> str:
        return render(self.said)


def printable(text: str, longest: int = 40) -> str:
    """Make somebody else's text short and safe on a terminal, as a mistake may quote it.

    A space that is no plain one, or a mark that nobody sees, is written as its name.
    """
    safe = "".join(c if c.isprintable() else _named(c) for c in text[:longest])
    return safe if len(text) <= longest else f"{safe}…"


def _named(character: str) -> str:
    if unicodedata.category(character) in ("Zs", "Cf"):
        return f"<{unicodedata.name(character, 'invisible mark').lower()}>"
    return "\N{REPLACEMENT CHARACTER}"


def text_of(name: str | os.PathLike[str]) -> str:
    r"""Turn a file name or a word of the command line into text that can be sent and stored.

    The system gives names as bytes, and Python keeps those that are not UTF-8 as characters
    that no encoding takes. Here each such byte becomes `\x98`.
    """
    return os.fspath(name).encode("utf-8", ESCAPED).decode()


def _escape(error: UnicodeError) -> tuple[str, int]:
    assert isinstance(error, UnicodeEncodeError)
    return "".join(map(_as_number, error.object[error.start : error.end])), error.end


def _as_number(character: str) -> str:
    code = ord(character)
    if 0xDC80 <= code <= 0xDCFF:  # how Python keeps a byte that is not UTF-8
        return f"\\x{code - 0xDC00:02x}"
    return json.dumps(character)[1:-1]


codecs.register_error(ESCAPED, _escape)
