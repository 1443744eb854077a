"""Names of teams and students: which texts are allowed, and which names look alike."""

import re
import unicodedata
from collections.abc import Iterable
from functools import cache

_UNSEEN = re.compile(
    "[\u00ad\u034f\u115f\u1160\u17b4\u17b5\u180b-\u180f\u2800\u3164\ufe00-\ufe0f\uffa0"
    "\U0001d159\U000e0100-\U000e01ef]"
)
"""Signs that are printable for Python but can't be seen, such as the Hangul filler. A name may
contain them, because many emoji do. But a name must have other signs too, and names are compared
without these."""


def read_name(text: str, most: int) -> str | None:
    """Return a name in its usual form: no spaces at the ends, and never several in a row.

    Args:
        text: the name as somebody typed it.
        most: largest number of characters.

    Returns:
        The name; None if it is too long, has unprintable signs, or has only signs that can't be
        seen.
    """
    name = " ".join(unicodedata.normalize("NFC", text).split())
    can_be_seen = bool(_UNSEEN.sub("", name).strip())
    return name if can_be_seen and len(name) <= most and name.isprintable() else None


def same_name(name: str) -> str:
    """Return the form of a name that is equal for the same name, however it is written.

    Two names have equal forms if they differ only in capitals, widths or signs that can't be seen.
    """
    return " ".join(_plain(name).casefold().split())


def look_alike(one: str, other: str) -> bool:
    """Return whether people can't tell two names apart, on a screen or by ear.

    They are the same name, or they differ only in characters that look alike, such as the Latin B
    and the Cyrillic В (Unicode Technical Standard 39, 4).
    """
    forms = [{same_name(name), _skeleton(_plain(name))} for name in (one, other)]
    return bool(forms[0] & forms[1])


def told_apart(name: str, others: Iterable[str], side: str, most: int) -> str:
    """Return a name; if it looks like one of the others, with a word that tells it apart.

    Args:
        name: the name.
        others: the names that are shown beside it.
        side: the word that tells it apart, such as "left".
        most: largest number of characters.
    """
    if not any(look_alike(name, other) for other in others):
        return name
    added = f" ({side})"
    return name.removesuffix(added)[: most - len(added)].rstrip() + added


def _plain(name: str) -> str:
    return unicodedata.normalize("NFKC", _UNSEEN.sub("", name))


def _skeleton(name: str) -> str:
    prototypes = _prototypes()
    return "".join(prototypes.get(sign, sign) for sign in name)


@cache
def _prototypes() -> dict[str, str]:
    """Return for each character that looks like others the one that stands for all of them."""
    from confusable_homoglyphs.confusables import confusables_data  # a megabyte; few need it

    # The table has pairs in both directions. A character with one partner has that one's form; of
    # two characters that have only each other, both have the form of the first.
    alike = {sign: [one["c"] for one in others] for sign, others in confusables_data.items()}
    return {
        sign: partners[0]
        for sign, partners in alike.items()
        if len(partners) == 1 and (len(alike.get(partners[0], ())) > 1 or partners[0] < sign)
    }
