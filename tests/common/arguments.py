"""The command line of a campaign or a benchmark."""

import argparse
import sys
from collections.abc import Iterable
from typing import Any


def arguments(text: str | None, what: Iterable[str] = (), **options: Any) -> argparse.Namespace:
    """Read the options of the module that `python -m` runs.

    Args:
        text: the module's docstring, which the help shows.
        what: if any, the first argument must be one of these words.
        options: by its name, the default of each option, or a pair of it and a help text. A type
            instead of a default: there is none, so None. False: a flag.
    """
    module = sys.modules["__main__"].__spec__
    parser = argparse.ArgumentParser(
        prog=f"python -m {module.name.removesuffix('.__main__')}" if module else None,
        description=text,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    if words := [*what]:
        parser.add_argument("what", choices=words)
    for name, told in options.items():
        default, help_text = told if isinstance(told, tuple) else (told, None)
        flag = f"--{name.replace('_', '-')}"
        if default is False:
            parser.add_argument(flag, action="store_true", help=help_text)
        elif isinstance(default, type):
            parser.add_argument(flag, type=default, help=help_text)
        else:
            parser.add_argument(flag, type=type(default), default=default, help=help_text)
    return parser.parse_args()
