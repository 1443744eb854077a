"""Tests of core/rulings.ts, which finds the referee's rulings in the events of a match."""

import json
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from stage import Stage

from lacoc_shared import decisions as d
from lacoc_shared.codec import encode
from lacoc_shared.seat import Phase as P

RULINGS = Path(__file__).parents[2] / "client" / "web" / "src" / "core" / "rulings.ts"
_AS_PAGE = (
    "--experimental-transform-types",
    "--disable-warning=ExperimentalWarning",
    f"--import={Path(__file__).parent / 'core' / 'page.mjs'}",
)
SCRIPT = """
import { readFileSync } from "node:fs";
const rulings = await import("%s");
const events = JSON.parse(readFileSync(0, "utf8"));
console.log(JSON.stringify({
  corrections: rulings.corrections(events).map(({ number }) => number),
  declared: rulings.declaration(events)?.data.reason ?? null,
  halted: rulings.whyHalted(events)?.data.reason ?? null,
  played: rulings.playedTicks(events),
}));
"""


def shown(stage: Stage) -> dict[str, Any]:
    """Return the rulings that core/rulings.ts finds in a match's events."""
    node = shutil.which("node", path=str(Path(sys.executable).parent)) or shutil.which("node")
    if node is None:
        pytest.skip("no Node: pip install --group web")
    import msgpack

    events = [msgpack.unpackb(encode(event)) for event in stage.events]
    done = subprocess.run(
        [node, *_AS_PAGE, "--input-type=module", "-e", SCRIPT % RULINGS.as_uri()],
        input=json.dumps(events),
        capture_output=True,
        text=True,
        check=True,
    )
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def test_corrections_that_stand_and_how_long_was_played() -> None:
    """A correction that was taken back is not listed; changing the clock adds no time of play."""
    stage = Stage().to(P.PLAYING)
    stage.run(100)
    stage.decide(d.Clock(90.0), "a pause")
    stage.decide(d.Adjust("left", 1), "a slip")
    slip = stage.numbers("decision")[-1]
    stage.decide(d.Halt(), "lights out")
    assert shown(stage)["halted"] == "lights out"
    stage.run(50)
    stage.decide(d.TakeBack(slip), "it was right")
    stage.decide(d.Set("c0r0", "neutral"), "count again")
    stands = stage.numbers("decision")[-1]
    stage.decide(d.Declare("right"), "a foul")
    assert stage.phase is P.FINISHED
    assert shown(stage) == {
        "corrections": [stands],
        "declared": "a foul",
        "halted": "lights out",
        "played": stage.match.ticks,
    }
