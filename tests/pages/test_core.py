"""Tests of the pages' source: its pure parts run in Node, and the linter checks its layers."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from chromium import WEB, npm
from page_node import NODE_OF_PAGES

pytestmark = pytest.mark.slow

_LEAGUE = Path(__file__).parents[1] / "league"
"""Has modules that the cases' own programs import."""
CASES = sorted(Path(__file__).with_name("core").glob("*.test.mjs"))
EDITED = [case for case in CASES if case.name == "design_shared.test.mjs"]
"""Cases in which the environment says how often four pages edit one table."""


@pytest.mark.slow(minutes=0.2)
@pytest.mark.parametrize(
    ("cases", "edits"),
    [(CASES, 200), pytest.param(EDITED, 1000, marks=pytest.mark.long(minutes=1))],
    ids=["all", "many edits"],
)
def test_the_pure_parts_of_the_pages(cases: list[Path], edits: int) -> None:
    """All cases in tests/pages/core pass in Node; the output names each case that fails."""
    assert cases
    done = subprocess.run(
        [*NODE_OF_PAGES, "--test", "--test-isolation=none", *cases],
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
        env={
            **os.environ,
            "PYTHON": sys.executable,
            "PYTHONPATH": str(_LEAGUE),
            "EDITS": str(edits),
        },
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.long
def test_a_broken_layer_and_a_circle_are_found(tmp_path: Path) -> None:
    """The linter refuses an import from a higher layer, and a circle of imports (also of types)."""
    shutil.copytree(WEB / "src", tmp_path / "src")
    shutil.copy(WEB / "biome.json", tmp_path)
    wrong = {
        "core/keys.ts": 'export type { SeatMark } from "../ui/score";',
        "core/walk.ts": 'export const words = () => import("../i18n/words");',
        "i18n/words.ts": 'export type { CameraName } from "../scene/View";',
        "scene/tags.ts": 'export { t } from "../i18n";',
        "ui/screen.ts": 'export { View } from "../scene/View";',
        "core/colours.ts": 'export type { Court } from "./court";',
    }
    for name, line in wrong.items():
        with (tmp_path / "src" / name).open("a") as file:
            file.write(f"{line}\n")
    lint = ["exec", "--", "biome", "lint", "--max-diagnostics=none", "--reporter=github"]
    with pytest.raises(RuntimeError) as refused:
        npm(*lint, f"--config-path={tmp_path}", str(tmp_path / "src"))
    found = str(refused.value)
    for name, line in wrong.items():
        rule = "noImportCycles" if name == "core/colours.ts" else "noRestrictedImports"
        assert re.search(rf"{rule},file=[^,]*src/{name},", found), (name, line, found)
