"""All sentences for people: a program sends a code with values, and one table has the words.

A program makes a `Phrase` (`say`); a page or a terminal puts it into words (`render`). No program
takes a sentence apart. The table, in English and Japanese, is in `texts/*.toml`; docs/words.md
defines the template language. `use` sets the language of a process.
"""

from lacoc_shared.words.phrase import Phrase, Value, say
from lacoc_shared.words.render import LANGUAGES, current, render, use
from lacoc_shared.words.table import faults

__all__ = ["LANGUAGES", "Phrase", "Value", "current", "faults", "render", "say", "use"]
