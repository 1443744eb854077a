"""Checks values of a file that a person wrote, and says in sentences which of them are wrong."""

import re
from typing import Any, Literal, TypeVar, get_args, get_origin, get_type_hints

import msgspec

from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, say

T = TypeVar("T")

_EXPECTED = re.compile(
    r"Expected `(\w+)(?: \| null)?`(?:, got `(\w+)`| (of length )?([<>]=?) (.+))?"
)
_WORD = re.compile(r"Invalid enum value '(.*)'")
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


def convert(value: Any, kind: type[T], where: str) -> T:
    """Convert a value of a contest file to its type, and check it.

    Args:
        value: what was read from TOML.
        kind: the type that it should have.
        where: its place in the file, such as "court.main"; "": the whole file.

    Raises:
        UserError: if it is wrong, with a sentence for each wrong entry.
    """
    wrong: list[Phrase] = []
    left_out: set[str] = set()
    while True:
        given = value if not left_out else {k: v for k, v in value.items() if k not in left_out}
        try:
            converted = msgspec.convert(given, kind)
        except msgspec.ValidationError as error:
            place, what = place_and_words(error, kind)
        else:
            if wrong:
                raise UserError(*wrong)
            return converted
        # msgspec names one wrong entry. It is left out, so that the next one is found.
        code, entry = "", place.partition(".")[0]
        if isinstance(what, Phrase) and not place and "entry" in what.values:
            code, entry = what.code, str(what.values["entry"])
        if code != "value.missing-entry" or entry not in left_out:
            at = ".".join(filter(None, (where, place)))
            known = getattr(kind, "__struct_fields__", ()) if code else None
            wrong.append(say("contest.bad-entry", where=at or None, error=what, known=known))
        if not isinstance(given, dict) or entry not in given:
            raise UserError(*wrong)
        left_out.add(entry)


def place_and_words(error: msgspec.ValidationError, kind: Any = None) -> tuple[str, Phrase | str]:
    """Return which entry of a table is wrong, and what is expected there.

    Args:
        error: raised by `msgspec.convert` for a table read from TOML.
        kind: the type that the table should have, from which possible words are found; None: it is
            not known.

    Returns:
        The place of the entry, such as "match.duration_s", or "" for the whole table; and what was
        expected: a phrase if one is known, else msgspec's own words.
    """
    what, _, place = str(error).partition(" - at `$")
    place = place.rstrip("`").lstrip(".")
    if (word := _WORD.fullmatch(what)) is not None:
        return place, say("value.not-possible", found=word[1], known=_choices(kind, place))
    return place, _words(what)


def _choices(kind: Any, place: str) -> list[str]:
    """Return the words that an entry may have as its value; an empty list if they are not known.

    Args:
        kind: the type of the whole table.
        place: place of the entry in the table, such as "match.start".
    """
    for name in place.split("."):
        fields = get_type_hints(kind) if isinstance(kind, type) else {}
        kind = fields.get(name)
    kinds = (kind, *get_args(kind))  # the entry may be optional
    return [word for one in kinds if get_origin(one) is Literal for word in get_args(one)]


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
