"""Writes the bodies and legs of the sample robots for the page /leg."""

import json
import math

from msgspec.structs import asdict

from lacoc_robots.library import find_robot
from lacoc_robots.robot_file import read_robot
from lacoc_server.studio.facts import leg_shape

SAMPLES = ("hexapod", "long-legs", "quadruped", "octopod")
"""The sample robots, the workshop's first."""


def samples() -> str:
    """Return the robots in millimetres and degrees: the text of src/core/leg/samples.gen.ts."""
    robots = ",\n".join(f"  {json.dumps(name)}: {_sample(name)}" for name in SAMPLES)
    return (
        "// Made by client/web/make_wire.py from the robot files; not edited by hand.\n\n"
        'import type { SampleRobot } from "./leg";\n\n'
        f"export const SAMPLES: Readonly<Record<string, SampleRobot>> = {{\n{robots},\n}};\n"
    )


def _sample(name: str) -> str:
    """Write a robot, with a line for each leg."""
    file, content = find_robot(name)
    robot = read_robot(content, file)
    legs = (asdict(leg_shape(leg)) for leg in robot.legs)
    lines = (
        f'    "name": {json.dumps(robot.name)}',
        f'    "size_mm": {json.dumps([round(1000 * side, 6) for side in robot.size_m])}',
        '    "legs": [\n' + "".join(f"      {json.dumps(leg)},\n" for leg in legs) + "    ]",
        f'    "start_deg": {[round(math.degrees(angle), 9) for angle in robot.start_posture]}',
    )
    return "{\n" + ",\n".join(lines) + "\n  }"
