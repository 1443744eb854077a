"""Parses templates, the sentences in the table of words: text, holes for values, and clauses.

    {team}               the value as it is
    {seconds:.1}         a number with this many decimals
    {points:+}           a number with its sign
    {left_s:clock}       seconds as minutes and seconds: 0:38
    {n:plural disc|discs}  the first word for 1 or -1, else the second; without the number
    {names:or}           a list joined with "or" (or `and`); without a format, with commas
    {name:quoted}        in the quotation marks of the language
    {disc:marker}        a marker's name as pictures show it: c2r3 is disc C4
    {seat:seat.*}        a program's word, shown as the sentence of code "seat." plus the word
    <because of {why}>   a clause: shown only if all its values are there

Several formats of one hole are separated by commas: `{phases:phase.*,or}`.
"""

import re
from dataclasses import dataclass
from functools import lru_cache

_PIECE = re.compile(r"\{(\w+)(?::([^{}<>]*))?\}|([<>])|([^{}<>]+)")
_FORMAT = re.compile(r"\.\d|\+|clock|marker|or|and|quoted|plural [^|,]*\|[^|,]*|[a-z][a-z-]*\.\*")


class BadTemplate(ValueError):
    """Raised when a template in the table of words is not valid."""


@dataclass(frozen=True)
class Hole:
    """A place in a template into which a value is put."""

    name: str
    formats: tuple[str, ...]


@dataclass(frozen=True)
class Clause:
    """A part of a template that is left out if one of its values is missing."""

    parts: tuple[str | Hole, ...]


Part = str | Hole | Clause


@lru_cache(maxsize=2048)
def parse(text: str) -> tuple[Part, ...]:
    """Parse a template of the table of words.

    Raises:
        BadTemplate: if the text is no valid template. A test parses every template of the table.
    """
    parts: list[Part] = []
    clause: list[str | Hole] | None = None
    end = 0
    for match in _PIECE.finditer(text):
        if match.start() != end:
            break
        end = match.end()
        name, formats, bracket, words = match.groups()
        if bracket:
            if (clause is None) == (bracket == ">"):
                raise BadTemplate(f"a clause begins or ends where it can't: {text}")
            if clause is not None:
                parts.append(Clause(tuple(clause)))
            clause = [] if bracket == "<" else None
            continue
        part = words or Hole(name, _formats(formats, text))
        (parts if clause is None else clause).append(part)
    if end != len(text) or clause is not None:
        raise BadTemplate(f"a bracket is open or alone: {text}")
    return tuple(parts)


def holes(text: str) -> tuple[list[Hole], list[Hole]]:
    """List the holes of a template: those outside of clauses, and those in clauses."""
    parts = parse(text)
    inside = [hole for part in parts if isinstance(part, Clause) for hole in part.parts]
    return [p for p in parts if isinstance(p, Hole)], [p for p in inside if isinstance(p, Hole)]


def _formats(text: str | None, template: str) -> tuple[str, ...]:
    formats = tuple(text.split(",")) if text is not None else ()
    for one in formats:
        if not _FORMAT.fullmatch(one):
            raise BadTemplate(f"there is no format {one!r}: {template}")
    return formats
