"""The table of all sentences: for each code its values and the templates in both languages."""

import tomllib
from collections.abc import Iterator, Mapping
from functools import cache
from importlib import resources
from importlib.resources.abc import Traversable

import msgspec

from lacoc_shared.words.phrase import Phrase, Value

FILES = (
    "general",
    "match",
    "referee",
    "contestant",
    "health",
    "files",
    "network",
    "gateway",
    "studio",
    "phases",
    "class",
    "tournament",
    "league",
    "contest",
    "office",
    "film",
    "commands",
    "environments",
)
ON_PAGES = FILES[:-3]
"""All files but the last three, which have only sentences for terminals and programs."""


class Wording(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The entry of a sentence in the table: its values, and its words in both languages."""

    en: str
    ja: str
    values: dict[str, str] = {}
    """Kind of each value: text, number, phrase, list or any; with "?" it may be None."""


@cache
def table(files: tuple[str, ...] = FILES) -> Mapping[str, Wording]:
    """Read the table of words: a mapping from each code to its entry."""
    entries: dict[str, Wording] = {}
    folder = resources.files("lacoc_shared.words") / "texts"
    for file in files:
        for code, entry in read(folder / f"{file}.toml").items():
            if code in entries:
                raise ValueError(f"the code {code} is in the table twice")
            entries[code] = entry
    return entries


def read(file: Traversable) -> Mapping[str, Wording]:
    """Read one TOML file of the table of words: a mapping from each code to its entry."""
    return {
        f"{subject}.{name}": msgspec.convert(entry, Wording)
        for subject, codes in tomllib.loads(file.read_text(encoding="utf-8")).items()
        for name, entry in codes.items()
    }


def faults(phrase: Phrase) -> list[str]:
    """List how a phrase differs from its entry in the table of words.

    Tests use it to check the phrases that programs send.
    """
    return list(_faults(phrase))


def _faults(phrase: Phrase) -> Iterator[str]:
    entry = table().get(phrase.code)
    if entry is None:
        yield f"there is no code {phrase.code}"
        return
    if wrong := sorted(entry.values.keys() ^ phrase.values.keys()):
        yield f"{phrase.code} lacks or has too many: {', '.join(wrong)}"
    for name, value in phrase.values.items():
        kind = entry.values.get(name, "any")
        if not _is(value, kind):
            yield f"{phrase.code}: {name} is {value!r}, which is no {kind}"
        for one in value if isinstance(value, tuple) else (value,):
            if isinstance(one, Phrase):
                yield from _faults(one)


def _is(value: Value, kind: str) -> bool:
    if kind.endswith("?"):
        return value is None or _is(value, kind[:-1])
    match kind:
        case "text":
            return isinstance(value, str)
        case "number":
            return isinstance(value, int | float) and not isinstance(value, bool)
        case "phrase":  # or a text: not all senders use phrases, and an error of a disk is a text
            return isinstance(value, Phrase | str)
        case "list":
            return isinstance(value, tuple)
    return kind == "any"
