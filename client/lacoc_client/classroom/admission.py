"""Who may come into a class: nicknames."""

import re
import unicodedata

from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_LONGEST_NAME = 20
_UNSEEN = re.compile(
    "[\u00ad\u034f\u115f\u1160\u17b4\u17b5\u180b-\u180f\u2800\u3164\ufe00-\ufe0f\uffa0"
    "\U0001d159\U000e0100-\U000e01ef]"
)
"""Signs that are printable for Python but can't be seen, such as the Hangul filler. A name may
contain them, because many emoji do; but a name needs other signs too, and is compared without
them."""


def read_name(text: str) -> str:
    """Return a nickname without spaces at its ends; within it, several spaces become one.

    Raises:
        UserError: if nothing of it can be seen, it is too long, or it has unprintable signs.
    """
    name = " ".join(unicodedata.normalize("NFC", text).split())
    if not _UNSEEN.sub("", name).strip() or len(name) > _LONGEST_NAME or not name.isprintable():
        raise UserError(say("class.bad-name", most=_LONGEST_NAME))
    return name


def same_name(name: str) -> str:
    """Return the form of a name that is compared with the forms of other names.

    Two names have equal forms if they differ only in capitals, widths or signs that can't be seen.
    """
    seen = unicodedata.normalize("NFKC", _UNSEEN.sub("", name))
    return " ".join(seen.casefold().split())
