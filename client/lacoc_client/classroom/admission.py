"""Who may come into a class: class codes, nicknames, tokens and guesses."""

import re
import secrets
import unicodedata
from collections import OrderedDict

from lacoc_shared.mistakes import UserError
from lacoc_shared.network.allowance import Allowance
from lacoc_shared.words import say

_LETTERS = "ABCDEFGHJKLMNPQRSTUVWXYZ23456789"
"""Letters of class codes: none that looks like another one."""
_CODE_LENGTH = 6
_LONGEST_NAME = 20
_UNSEEN = re.compile(
    "[\u00ad\u034f\u115f\u1160\u17b4\u17b5\u180b-\u180f\u2800\u3164\ufe00-\ufe0f\uffa0"
    "\U0001d159\U000e0100-\U000e01ef]"
)
"""Signs that Python calls printable, but that nobody sees, as the Hangul filler. In an emoji one
of them is usual, so a name may have them; but they make no name, and no other name."""
_GUESSES_HZ, _GUESSES_BURST = 0.5, 20
"""Wrong codes of a machine that are answered at once."""
_LATER_S = 1.0
"""How long a page waits for the answer to a further wrong code. Even with 400 pages at a time a
machine would try codes for a month. The right code never waits: a class may share one address."""
_MOST_MACHINES = 1000


def new_code() -> str:
    """Make a random class code, such as "K7QM3X"."""
    return "".join(secrets.choice(_LETTERS) for _ in range(_CODE_LENGTH))


def read_code(text: str) -> str:
    """Return a typed class code in its usual form: "ｋ7q m3x" becomes "K7QM3X"."""
    wide = unicodedata.normalize("NFKC", text).upper()
    return "".join(letter for letter in wide if letter.isalnum())


def read_name(text: str) -> str:
    """Return a nickname without spaces at its ends and double spaces in it.

    Raises:
        UserError: if nothing of it can be seen, it is too long, or it has unprintable signs.
    """
    name = " ".join(unicodedata.normalize("NFC", text).split())
    if not _UNSEEN.sub("", name).strip() or len(name) > _LONGEST_NAME or not name.isprintable():
        raise UserError(say("class.bad-name", most=_LONGEST_NAME))
    return name


def same_name(name: str) -> str:
    """Return a form of a name in which names that look alike, as "Anna" and "ANNA", are equal."""
    seen = unicodedata.normalize("NFKC", _UNSEEN.sub("", name))
    return " ".join(seen.casefold().split())


class Guesses:
    """Slows a machine down that shows wrong codes, so that it can't try them all."""

    def __init__(self) -> None:
        self._machines: OrderedDict[str, Allowance] = OrderedDict()

    def wait_s(self, machine: str, now_s: float) -> float:
        """Count a wrong code; return how long its answer must wait [s].

        Args:
            machine: address of the machine that sent the code.
            now_s: time on a clock that never goes back [s].
        """
        allowance = self._machines.setdefault(machine, Allowance(_GUESSES_HZ, _GUESSES_BURST))
        self._machines.move_to_end(machine)
        if len(self._machines) > _MOST_MACHINES:
            self._machines.popitem(last=False)
        return 0.0 if allowance.take(1, now_s) else _LATER_S
