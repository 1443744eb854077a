"""All sentences for people: a code with its values, and one table with both languages.

A program says a `Phrase` (`say`); a page or a terminal renders it (`render`). No program
parses a sentence. The table is in `texts/*.toml`; docs/decisions/0016-words.md defines the
template language. Pure: `use` sets the language of a process from outside.
"""

from lacoc_shared.words.phrase import Phrase, Value, say
from lacoc_shared.words.render import LANGUAGES, counted, current, render, use
from lacoc_shared.words.table import faults

__all__ = ["LANGUAGES", "Phrase", "Value", "counted", "current", "faults", "render", "say", "use"]
