"""Puts phrases into words, in English or Japanese.

client/web/src/i18n/render.ts does the same; tests/shared/test_words.py checks that both agree. No
phrase raises an error here: an unknown code is shown with its values, a missing value as "?", and a
phrase that is nested too deep as its code alone.
"""

import math
import re
from decimal import ROUND_HALF_UP, Context, Decimal
from typing import Literal, get_args

from lacoc_shared.words.phrase import Phrase, Value
from lacoc_shared.words.table import table
from lacoc_shared.words.template import Clause, Hole, Part, parse

Language = Literal["en", "ja"]
LANGUAGES: tuple[Language, ...] = get_args(Language)

DEEPEST = 5
"""Deepest nesting of phrases; a deeper one is shown as its code."""
LONGEST_LIST = 100
LONGEST_TEXT = 2000
"""Most characters of a value that are shown."""
LARGEST = 1e15
"""A number whose size is this or more is shown as "?"."""
DECIMALS = 6
"""Decimals of a number if its template has no format for it; trailing zeros are left out."""

_CONTROLS = re.compile(
    "[\u0000-\u001f\u007f-\u009f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff\ufeff]"
)
_DISC = re.compile("c(1?[0-9]|2[0-5])r([0-9]{1,2})")
"""Matches the name of a disc: column and row, counted from 0. Columns are shown as letters."""
_NUMBERED = re.compile("(corner|flag)([0-9]{1,4})")
_EXACT = Context(prec=40)  # enough for LARGEST with DECIMALS
_current: Language = "en"


def use(language: Language) -> None:
    """Set the language of this process: the default of `render`."""
    global _current
    _current = language


def current() -> Language:
    """Return the language of this process; English if none was set."""
    return _current


def render(phrase: Phrase | str, language: Language | None = None) -> str:
    """Return the words of a phrase in a language.

    Args:
        phrase: the phrase; a plain text is returned unchanged.
        language: the language; None: that of the process.
    """
    if isinstance(phrase, str):
        return phrase
    return _rendered(phrase, language or _current, 0)


def _rendered(phrase: Phrase, language: Language, depth: int) -> str:
    entry = table().get(phrase.code)
    if entry is None or depth >= DEEPEST:
        return _unknown(phrase, depth)
    template = entry.ja if language == "ja" else entry.en

    def shown(part: Part) -> str:
        if isinstance(part, str):
            return part
        if isinstance(part, Clause):
            there = all(
                phrase.values.get(one.name) not in (None, "", ())
                for one in part.parts
                if isinstance(one, Hole)
            )
            return "".join(map(shown, part.parts)) if there else ""
        return _filled(phrase.values.get(part.name), part.formats, language, depth)

    return "".join(map(shown, parse(template)))


def _unknown(phrase: Phrase, depth: int) -> str:
    """Return the text of a phrase whose code is not in the table: the code and the values."""
    names = sorted(phrase.values, key=lambda name: name.encode("utf-16-be", "surrogatepass"))
    plain = (
        f"{_text(name)}: {_filled(phrase.values[name], (), 'en', DEEPEST)}"
        for name in names[:LONGEST_LIST]
    )
    values = ", ".join(plain) if depth < DEEPEST else ""
    return _text(phrase.code) + (f" ({values})" if values else "")


def _filled(value: Value, formats: tuple[str, ...], language: Language, depth: int) -> str:
    if isinstance(value, tuple | list):
        items = [_one(one, formats, language, depth) for one in value[:LONGEST_LIST]]
        comma = _word("join.comma", language)
        if len(items) < 2 or not {"or", "and"} & set(formats):
            return comma.join(items)
        last = _word("join.or" if "or" in formats else "join.and", language)
        return comma.join(items[:-1]) + last + items[-1]
    return _one(value, formats, language, depth)


def _one(value: Value, formats: tuple[str, ...], language: Language, depth: int) -> str:
    text = _plain(value, formats, language, depth)
    if "quoted" in formats:
        opening, _, closing = _word("quote.marks", language).partition(" ")
        return opening + text + closing
    return text


def _plain(value: Value, formats: tuple[str, ...], language: Language, depth: int) -> str:
    if isinstance(value, Phrase):
        return _rendered(value, language, depth + 1)
    if isinstance(value, bool):
        return _word("word.yes" if value else "word.no", language)
    if isinstance(value, int | float):
        return _number(value, formats)
    if isinstance(value, str):
        if "marker" in formats:
            return _marker(value, language)
        for one in formats:
            if one.endswith(".*") and (code := one[:-1] + value) in table():
                return _word(code, language)
        return _text(value)
    return "?"


def _marker(name: str, language: Language) -> str:
    """Return a marker's name as pictures show it; names of other games stay as they are."""
    if found := _DISC.fullmatch(name):
        column, row = map(int, found.groups())
        label = f"{chr(ord('A') + column)}{row + 1}"
        return _rendered(Phrase("marker.disc", {"label": label}), language, 0)
    if found := _NUMBERED.fullmatch(name):
        kind, number = found.groups()
        return _rendered(Phrase(f"marker.{kind}", {"number": number}), language, 0)
    return _text(name)


def _word(code: str, language: Language) -> str:
    entry = table()[code]
    return entry.ja if language == "ja" else entry.en


def _text(text: str) -> str:
    """Shorten a text from outside; replace characters that would disturb the words beside it."""
    short = text if len(text) <= LONGEST_TEXT else f"{text[:LONGEST_TEXT]}…"
    return _CONTROLS.sub("\N{REPLACEMENT CHARACTER}", short)


def _number(value: float, formats: tuple[str, ...]) -> str:
    plural = next((one for one in formats if one.startswith("plural ")), "")
    if plural:
        one, _, many = plural.removeprefix("plural ").partition("|")
        return one if abs(value) == 1 else many
    if not math.isfinite(value) or abs(value) >= LARGEST:
        return "?"
    if "clock" in formats:
        seconds = int(_fixed(abs(value), 0))
        return f"{'-' if value < 0 and seconds else ''}{seconds // 60}:{seconds % 60:02d}"
    digits = next((int(one[1:]) for one in formats if one[0] == "."), None)
    text = _fixed(abs(value), DECIMALS if digits is None else digits)
    if digits is None:
        text = text.rstrip("0").rstrip(".")
    if not text.strip("0."):
        return text
    return ("-" if value < 0 else "+" if "+" in formats else "") + text


def _fixed(value: float, digits: int) -> str:
    """Round a number half up, from its exact value, as JavaScript's `toFixed` does."""
    return str(Decimal(value).quantize(Decimal(1).scaleb(-digits), ROUND_HALF_UP, _EXACT))
