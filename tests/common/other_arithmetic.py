"""Runs code with other arithmetic: the C library's functions for older processors."""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

OTHER_ARITHMETIC = {
    "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-FMA_Usable,-FMA4_Usable,-AVX2_Usable"
}
"""Environment variables that make glibc use its functions for older processors."""

_CALL = """
import json, sys, tests
from importlib import import_module
module, name, arguments = json.loads(sys.argv[1])
print(json.dumps(getattr(import_module(module), name)(*arguments)))
"""


def elsewhere(function: Callable[..., Any], *arguments: Any) -> Any:
    """Call a function of a module with `OTHER_ARITHMETIC`, in a process of its own.

    Args:
        function: the function; what it prints must not be JSON.
        arguments: its arguments, which JSON can tell.

    Returns:
        What the function returns, as JSON tells it.
    """
    module = function.__module__
    if module == "__main__":
        module = sys.modules["__main__"].__spec__.name  # type: ignore[union-attr]
    done = subprocess.run(
        [sys.executable, "-c", _CALL, json.dumps((module, function.__name__, arguments))],
        env={**os.environ, **OTHER_ARITHMETIC},
        cwd=Path(__file__).parents[2],
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    return json.loads(done.stdout)
