"""Groups what pages say: their own messages, and the phrases of programs.

A page loads its groups in one language. What only commands say is in none of them.
"""

import json
from collections import Counter
from functools import cache
from pathlib import Path

from lacoc_shared.words.render import Language
from lacoc_shared.words.table import ON_PAGES, Wording, read, table

_TEXTS = Path(__file__).parent / "texts"

GROUPS: dict[str, tuple[str, ...]] = {
    "every": (
        "general",
        "match",
        "referee",
        "contestant",
        "gateway",
        "league",
        "contest",
    ),
    "play": (),
    "seldom": ("files", "network"),
    "referee": ("health",),
    "replay": (),
    "design": ("studio", "phases"),
    "class": ("class", "tournament"),
    "contest": (),
    "office": ("office",),
    "leg": (),
}
"""Group of pages' messages -> the files of programs' phrases that a page loads with it."""
SELDOM = ("forked", "gateway", "refused")
"""First parts of codes ("gateway" in "gateway.fault"). Their texts are shown so seldom that a page
loads them only when it needs one."""


@cache
def texts() -> dict[str, dict[str, Wording]]:
    """Return what pages say, by group and code.

    Raises:
        ValueError: if two entries have the same code.
    """
    said = {group: table(files) for group, files in GROUPS.items()}
    assert sorted(sum(GROUPS.values(), ())) == sorted(ON_PAGES)
    own = {file.stem: read(file) for file in sorted(_TEXTS.glob("*.toml"))}
    every = [code for part in (*said.values(), *own.values()) for code in part]
    if twice := sorted(code for code, times in Counter(every).items() if times > 1):
        raise ValueError(f"several entries have the code {', '.join(twice)}")
    found = {group: {**own.get(group, {}), **said[group]} for group in GROUPS}
    for code in [code for code in said["every"] if code.partition(".")[0] in SELDOM]:
        found["seldom"][code] = found["every"].pop(code)
    return found


def as_json(group: str, language: Language) -> str:
    """Return the words of a group in one language, by code, as a page loads them."""
    entries = {code: getattr(entry, language) for code, entry in texts()[group].items()}
    return json.dumps(entries, ensure_ascii=False, indent=2) + "\n"
