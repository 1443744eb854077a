"""Finds the language of the user at this terminal."""

import locale
import os
import sys
from collections.abc import Mapping

from lacoc_shared.words import LANGUAGES
from lacoc_shared.words.render import Language

_VARIABLES = ("LACOC_LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG")
_JAPANESE = 0x11
"""The lower bits of a Windows language number that mean Japanese."""


def of_process(environment: Mapping[str, str] | None = None) -> Language:
    """Find the language of the user at this terminal.

    The first of LACOC_LANGUAGE, LC_ALL, LC_MESSAGES and LANG that is set decides. If none is set,
    the language of the Windows menus decides, or the locale of another system.

    Args:
        environment: variables of the process; None reads them from the system.

    Returns:
        The language; English if LACOC has no texts in the language that was found.
    """
    variables = os.environ if environment is None else environment
    named = next((variables[name] for name in _VARIABLES if variables.get(name)), None)
    return _spoken(_of_system() if named is None else named)


def _spoken(name: str) -> Language:
    """Return the language that a name such as "ja_JP.UTF-8" or Windows' "Japanese_Japan" means."""
    short = name[:2].lower()
    return next((language for language in LANGUAGES if language == short), "en")


def _of_system() -> str:
    if sys.platform == "win32":
        import ctypes

        number = int(ctypes.windll.kernel32.GetUserDefaultUILanguage())
        return "ja" if number & 0x3FF == _JAPANESE else "en"
    return locale.getlocale()[0] or ""
