"""Finds references that a reader of the repository can't follow: `python docs/references.py`.

It looks at all that the sources and the pages of the repository cite: files, sections, decisions,
links, benchmarks and campaigns with their options, and targets of make. It prints what does not
exist. The exit code is 1 if there is any.
"""

import re
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]
READ = (".py", ".ts", ".tsx", ".css", ".md", ".toml", ".yaml", ".yml", ".sh", "Makefile", "run")
"""Ends of the names of the files whose text is searched."""

CITED_FILE = re.compile(r"(?<![\w/.@*{}%-])((?:[\w.-]+/)*[\w-]+\.(?:md|py|tsx?))\b(?![\w(*{-])")
SECTION = re.compile(r"(docs/[\w/-]+\.md) (\d+(?:\.\d+)?)\b(?! (?:MB|kB|lines))")
DECISION = re.compile(r"\b[Dd]ecision (\d+)\b")
LINK = re.compile(r"\]\(([^)#\s]*)(?:#([\w-]+))?\)")
MODULE = re.compile(r"(?<![\w./])((?:benchmarks|tests\.campaigns)(?:\.[a-z_]+)+)((?: [\w./=-]+)*)")
"""A module that `python -m` runs or that code imports, and the words after it."""
TARGET = re.compile(r"`make ([a-z-]+)")
ISSUE = re.compile(r"(?<![\w/-])[Ii]ssue #?\d+")
RULE = re.compile(r"(?<![\w/.])[Rr]ules (\d(?:\.\d)?)\b")
"""Code and tests cite docs/rules.md in this way."""

OF_READERS = {
    *("my_bot.py", "your_bot.py", "pilot_bot.py", "helper.py", "learned_bot.py"),
    *("walker.py", "mujoco.py"),
}
"""Files that a page or a message asks its reader to write, or that a test writes."""


@cache
def tracked() -> frozenset[str]:
    """Return the repository's files: those that git knows, and those that it would add."""
    words = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    return frozenset(subprocess.check_output(words, cwd=ROOT, text=True).splitlines())


@cache
def names() -> frozenset[str]:
    """Return every end of a tracked path, as a text may cite it: "court/pace.py" and "pace.py"."""
    return frozenset(
        "/".join(parts[start:])
        for parts in (path.split("/") for path in tracked())
        for start in range(len(parts))
    )


@cache
def headings(page: str) -> frozenset[str]:
    """Return the numbers and anchors of a page's headings."""
    found = set()
    for title in re.findall(r"^#+ (.+)$", (ROOT / page).read_text(encoding="utf-8"), re.MULTILINE):
        if number := re.match(r"(\d+(?:\.\d+)?)\.? ", title):
            found.add(number[1])
        kept = re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
        found.add(kept)
    return frozenset(found)


def missing(path: str, line: str) -> Iterator[str]:
    """Yield a sentence for each thing that a line of a file cites and that does not exist."""
    for name in CITED_FILE.findall(line):
        known = name in names() or (ROOT / path).parent.joinpath(name).is_file()
        if not known and name not in OF_READERS:
            yield f"there is no {name}"
    for page, number in SECTION.findall(line):
        if page in tracked() and number not in headings(page):
            yield f"{page} has no section {number}"
    for number in DECISION.findall(line):
        if not any(name.startswith(f"docs/decisions/{int(number):04}-") for name in tracked()):
            yield f"there is no decision {number}"
    for module, words in MODULE.findall(line):
        yield from missing_module(module, words)
    for target in TARGET.findall(line):
        if target not in targets():
            yield f"the Makefile has no target {target}"
    for what in ISSUE.findall(line):
        yield f"{what!r} is not in the repository"
    for number in RULE.findall(line):
        if number not in headings("docs/rules.md"):
            yield f"docs/rules.md has no section {number}"
    if path.endswith(".md"):
        yield from missing_links(path, line)


def missing_module(name: str, words: str) -> Iterator[str]:
    """Yield a sentence if there is no such module, or one for each option that it does not have."""
    path = name.replace(".", "/")
    found = next((one for one in (f"{path}.py", f"{path}/__main__.py") if one in tracked()), None)
    if found is None:
        if not any(one.startswith(f"{path}/") for one in tracked()):
            yield f"there is no module {name}"
        return
    text = (ROOT / found).read_text(encoding="utf-8")
    for option in re.findall(r" --([a-z-]+)", words):
        if not re.search(rf"\b{option.replace('-', '_')}=", text):
            yield f"{name} has no option --{option}"


@cache
def targets() -> frozenset[str]:
    """Return the targets of the Makefile."""
    text = (ROOT / "Makefile").read_text(encoding="utf-8")
    return frozenset(re.findall(r"^([a-z-]+):", text, re.MULTILINE))


def missing_links(path: str, line: str) -> Iterator[str]:
    """Yield a sentence for each link of a line that leads nowhere."""
    for target, anchor in LINK.findall(line):
        if target.startswith(("http:", "https:", "mailto:")):
            continue
        found = (ROOT / path).parent.joinpath(target).resolve() if target else ROOT / path
        if not found.exists():
            yield f"the link {target} leads nowhere"
        elif anchor and anchor not in headings(str(found.relative_to(ROOT))):
            yield f"{target or path} has no heading #{anchor}"


def main() -> int:
    """Print every reference that leads nowhere; return 1 if there is any."""
    found = 0
    for path in sorted(tracked()):
        file = ROOT / path
        if not path.endswith(READ) or not file.is_file() or file == Path(__file__).resolve():
            continue
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), start=1):
            for what in missing(path, line):
                found += 1
                print(f"{path}:{number}: {what}")
    return min(found, 1)


if __name__ == "__main__":
    sys.exit(main())
