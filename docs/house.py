"""Counts the house: lines of code by kind, and words of documents.

    python docs/house.py

Only files that git knows count.
"""

import subprocess
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).parents[1]
_CLIENT = "client/web/src/"
_CAMPAIGNS = "tests/campaigns/"


def _lines(text: str) -> int:
    return text.count("\n")


def _words(text: str) -> int:
    return sum(any(sign.isalnum() for sign in word) for word in text.split())  # not lines of tables


def _is_product(name: str) -> bool:
    return name.startswith(("server/", "client/lacoc", "shared/", "robots/", "arenas/"))


KINDS: dict[str, tuple[Callable[[str], bool], Callable[[str], int]]] = {
    "product Python": (lambda n: _is_product(n) and n.endswith(".py"), _lines),
    "TypeScript": (lambda n: n.startswith(_CLIENT) and n.endswith((".ts", ".tsx")), _lines),
    "CSS": (lambda n: n.startswith(_CLIENT) and n.endswith(".css"), _lines),
    "words of the product": (lambda n: _is_product(n) and "/words/texts/" in n, _lines),
    "benchmarks": (lambda n: n.startswith("benchmarks/") and n.endswith(".py"), _lines),
    "tests": (lambda n: n.startswith("tests/") and n.endswith(".py"), _lines),
    "of them campaigns": (lambda n: n.startswith(_CAMPAIGNS) and n.endswith(".py"), _lines),
    "documents, words": (lambda n: n.endswith(".md"), _words),
}
"""By name: which files, and what is counted of each."""


def counted() -> dict[str, tuple[int, int]]:
    """Return for each kind how many files it has, and how many lines or words."""
    listed = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True
    )
    names = [name for name in listed.stdout.split("\0") if name and (ROOT / name).is_file()]
    found: dict[str, tuple[int, int]] = {}
    for kind, (belongs, count) in KINDS.items():
        own = [ROOT / name for name in names if belongs(name)]
        found[kind] = len(own), sum(count(path.read_text(encoding="utf-8")) for path in own)
    return found


if __name__ == "__main__":
    for kind, (files, number) in counted().items():
        print(f"{kind:22} {files:5} files {number:8,}")
