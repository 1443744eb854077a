"""Everything that LACOC says to people: a code and its values, and one table of both languages.

A program says a `Phrase` (`say`); a page or a terminal renders it (`render`). Nobody reads a
sentence back into meaning. The table is in `texts/*.toml`; docs/decisions/0016-words.md states
the template language. Pure: the language of a process is set from outside (`use`).
"""

from lacoc_shared.words.phrase import Phrase, Value, say
from lacoc_shared.words.render import LANGUAGES, counted, current, render, use
from lacoc_shared.words.table import faults

__all__ = ["LANGUAGES", "Phrase", "Value", "counted", "current", "faults", "render", "say", "use"]
