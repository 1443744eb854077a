"""Puts into words what msgspec says about a wrong value of a file that a person wrote."""

import re

import msgspec

from lacoc_shared.words import Phrase, say

_EXPECTED = re.compile(
    r"Expected `(\w+)(?: \| null)?`(?:, got `(\w+)`| (of length )?([<>]=?) (.+))?"
)
_ENTRY = re.compile(r"Object (contains unknown|missing required) field `(.+)`")
_KINDS = {
    "float": say("robot.number"),
    "int": say("value.whole-number"),
    "bool": say("robot.flag"),
    "str": say("value.text"),
    "array": say("value.list"),
    "object": say("value.table"),
    "datetime": say("value.date"),
    "date": say("value.date"),
    "time": say("value.date"),
}


def place_and_words(error: msgspec.ValidationError) -> tuple[str, Phrase | str]:
    """Return where a value is wrong and what should be there.

    Args:
        error: raised by `msgspec.convert` for a table read from TOML.

    Returns:
        The place, such as "match.duration_s", or "" for the whole table; and what was expected, as
        a phrase where one is known, else in msgspec's own words.
    """
    what, _, place = str(error).partition(" - at `$")
    return place.rstrip("`").lstrip("."), _words(what)


def _words(what: str) -> Phrase | str:
    if (entry := _ENTRY.fullmatch(what)) is not None:
        if entry[1] == "contains unknown":
            return say("value.no-entry", entry=entry[2])
        return say("value.missing-entry", entry=entry[2])
    found = _EXPECTED.fullmatch(what)
    if found is None or found[1] not in _KINDS:
        return what
    kind, got, is_length, sign, bound = found.groups()
    expected = _KINDS[kind]
    if sign is not None:
        limit = _limit(sign, bound.removesuffix(".0"))
        if is_length:
            return say("value.length", kind=expected, limit=limit)
        return say("value.limited", kind=expected, limit=limit)
    if got == "str" and kind in ("float", "int", "bool"):
        return say("value.quoted", kind=expected)
    found_kind = say("value.decimal-number") if got == "float" else _KINDS.get(got)
    return say("value.expected", kind=expected, found=found_kind)


def _limit(sign: str, bound: str) -> Phrase:
    match sign:
        case ">=":
            return say("value.least", bound=bound)
        case ">":
            return say("value.above", bound=bound)
        case "<=":
            return say("value.most", bound=bound)
        case _:
            return say("value.below", bound=bound)
