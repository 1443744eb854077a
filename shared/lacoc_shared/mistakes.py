"""Errors about something that a user gave to LACOC, with sentences that help to correct it.

There are two families. `FileRefused` carries every mistake in a file, each with its place: a file
is refused as a whole (rules 2), so all its mistakes are listed at once. `UserError` has one
sentence or several that say what was found and what to do; the command line prints them and exits
with code 2. Both carry phrases (`lacoc_shared.words`), which are rendered in the language of the
process; a plain text is shown as it is.
"""

import codecs
import json
import os
import unicodedata
from collections.abc import Callable

import msgspec

from lacoc_shared.words import Phrase, render, say

ESCAPED = "lacoc-escaped"
r"""Error handler of `str.encode`: characters that an encoding lacks become escape codes.

A character becomes its JSON escape (`\u30c1`), so that a line of JSON stays valid. A byte of a file
name that is not UTF-8 becomes its number, such as `\x98`.
"""


FILES_REFUSED = "note.files-refused"
"""Code of the note that a join succeeded, but its files were refused."""
_NOTED = 3  # notes are read in passing; a refused join lists all mistakes


class Mistake(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """One mistake in a file, with its place."""

    file: str
    """Name of the file, as the user knows it."""
    found: Phrase | str
    """What was found there; a text is quoted from the file."""
    expected: Phrase | str
    """What should be there, or what to do."""
    row: int | None = None
    """Number of the row (in a text file: line), counted from 1."""
    column: int | None = None
    """Number of the cell in the row, counted from 1."""
    joint: int | None = None
    """Joint id, 0-17 for six legs (rules 1)."""
    leg: str | None = None
    """Label of the joint's leg, such as "R,F"."""
    field: str | None = None
    """Name of the entry, in a file with named entries (a robot file)."""

    @property
    def place(self) -> str:
        """The place of the mistake in words: "row 3, column 7, joint 5 (L,F)"."""
        return render(say("plain.sentences", sentences=self._places()))

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
        """Return the mistake with `found` and `expected` as text in the language of the process."""
        found, expected = render(self.found), render(self.expected)
        return msgspec.structs.replace(self, found=found, expected=expected)

    def __str__(self) -> str:
        return render(self.phrase)


class FileRefused(ValueError):
    """One file or several are refused as a whole; `mistakes` lists what is wrong with them."""

    def __init__(self, mistakes: list[Mistake]) -> None:
        super().__init__("\n".join(map(str, mistakes)))
        self.mistakes = mistakes

    def notes(self) -> tuple[Phrase, ...]:
        """Return notes for a contestant whose join succeeded, but whose new files were refused.

        The first note says how many mistakes there are. The others are the first few mistakes.
        """
        first = (mistake.phrase for mistake in self.mistakes[:_NOTED])
        return (say("note.files-refused", count=len(self.mistakes)), *first)


class UserError(Exception):
    """Raised for a mistake that a user can correct; the message says how.

    Args:
        said: what was found and what to do, a sentence for each mistake; a plain text if the table
            has no phrase for it yet.
    """

    def __init__(self, *said: Phrase | str) -> None:
        super().__init__(*said)
        self.said = said

    @property
    def phrase(self) -> Phrase:
        """The message of the error as one phrase."""
        if len(self.said) > 1:
            return say("plain.sentences", sentences=self.said)
        (only,) = self.said or ("",)
        return only if isinstance(only, Phrase) else say("plain.text", text=only)

    def each(self, put: Callable[[Phrase | str], Phrase]) -> "UserError":
        """Return an error whose sentences are those of this one, each changed by `put`.

        So a caller can add a place to each sentence, such as the name of a file.
        """
        return UserError(*map(put, self.said))

    def __str__(self) -> str:
        return "\n".join(map(render, self.said))


class Gathered:
    """Gathers mistakes, so that a user learns of all of them at once.

    A block `with gathered:` may raise `UserError`. The error is noted, and the program goes on
    after the block. `check` then raises everything that was noted as one error.
    """

    def __init__(self) -> None:
        self._said: list[Phrase | str] = []

    def __enter__(self) -> None:
        pass

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> bool:
        if not isinstance(error, UserError):
            return False
        self._said += error.said
        return True

    def check(self) -> None:
        """Raise the errors that were noted, as one error; do nothing if there are none.

        Raises:
            UserError: if any error was noted.
        """
        if self._said:
            raise UserError(*self._said)


def printable(text: str, longest: int = 40) -> str:
    """Shorten a text from outside and make it safe for a terminal, to quote it in a message.

    An unusual space or an invisible mark is replaced by its name, any other unprintable character
    by U+FFFD.
    """
    safe = "".join(c if c.isprintable() else _named(c) for c in text[:longest])
    return safe if len(text) <= longest else f"{safe}…"


def _named(character: str) -> str:
    if unicodedata.category(character) in ("Zs", "Cf"):
        return f"<{unicodedata.name(character, 'invisible mark').lower()}>"
    return "\N{REPLACEMENT CHARACTER}"


def text_of(name: str | os.PathLike[str]) -> str:
    r"""Turn a file name or a command-line word into text that can be sent and stored.

    The system gives names as bytes. Python keeps bytes that are not UTF-8 as characters that no
    encoding accepts; this function writes the number of each such byte, such as `\x98`.
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
