"""The words that start Node so that it loads the pages' modules, except those that draw."""

import sys
from pathlib import Path

NODE = Path(sys.executable).with_name("node")
"""Node of this Python environment: an older Node on the path does not read TypeScript."""
NODE_OF_PAGES = [
    *(NODE, "--experimental-transform-types", "--disable-warning=ExperimentalWarning"),
    *("--import", Path(__file__).with_name("core") / "page.mjs"),
]
