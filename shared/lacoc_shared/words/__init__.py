"""All sentences for people. A sentence is a code with values; one table has the words.

A program says a `Phrase` (`say`); a page or a terminal renders it (`render`). No program parses a
sentence. The table, in English and Japanese, is in `texts/*.toml`; docs/words.md
defines the template language. `use` sets the language of a process.
"""

from lacoc_shared.words.phrase import Phrase, Value, say
from lacoc_shared.words.render import LANGUAGES, current, render, use
from lacoc_shared.words.table import faults

__all__ = ["LANGUAGES", "Phrase", "Value", "current", "faults", "render", "say", "use"]
