"""Finds the pages about LACOC, which are installed with it."""

from pathlib import Path

import lacoc_shared


def folder() -> Path:
    """Return the folder of the pages: in the installed package, else in the checkout."""
    package = Path(lacoc_shared.__file__).parent
    installed = package / "docs"
    return installed if installed.is_dir() else package.parents[1] / "docs"


def translated(name: str, language: str) -> Path:
    """Return the file of a page about LACOC in a language; if not translated, in English.

    Args:
        name: name of the page, such as "rules".
        language: the language, such as "ja".
    """
    other = folder() / f"{name}.{language}.md"
    return other if other.exists() else folder() / f"{name}.md"
