"""Draws a robot's legs with their joint ids in a terminal, to point at joints (workshop 3-1)."""

from collections.abc import Collection, Sequence

from rich.text import Text

from lacoc_shared.gait.cells import LEG_LABELS
from lacoc_shared.gait.tables import JOINTS_PER_LEG, leg_and_level
from lacoc_shared.mistakes import Mistake
from lacoc_shared.words import render, say

_LIT = "bold reverse red"


def joint_picture(labels: Sequence[str], lit: Collection[int]) -> Text:
    """Draw a robot from above, its front at the top, with the joint ids of each leg.

    Args:
        labels: leg labels, clockwise from the right front; their number is even.
        lit: ids of the joints to highlight.
    """
    legs, half = len(labels), len(labels) // 2
    wide = max(map(len, labels))
    lines = [Text(render(say("gait.picture-front")), style="dim")]
    for row in range(half):
        left, right = legs - 1 - row, row
        corners = ("┐", "┌") if row == 0 else ("┘", "└") if row == half - 1 else ("┤", "├")
        lines.append(
            Text.assemble(
                f"  {labels[left]:<{wide}}  ",
                *_ids(left, legs, lit, outward=-1),
                (f" ─{corners[0]}   {corners[1]}─ ", "dim"),
                *_ids(right, legs, lit, outward=1),
                f"  {labels[right]}",
            )
        )
    lines.append(Text(render(say("gait.picture-levels")), style="dim"))
    return Text("\n").join(lines)


def labels_of(mistakes: Sequence[Mistake]) -> tuple[str, ...] | None:
    """Guess the legs of a robot from the joints and leg labels that mistakes name.

    Return the leg labels of the first robot with 6, 4 or 8 legs that fits all mistakes; None if
    there is no such robot, or if no mistake names a joint.
    """
    named = [(one.joint, one.leg) for one in mistakes if one.joint is not None]
    for legs, labels in sorted(LEG_LABELS.items(), key=lambda item: item[0] != 6):
        if named and all(
            joint < legs * JOINTS_PER_LEG and labels[leg_and_level(joint, legs)[0]] == leg
            for joint, leg in named
        ):
            return labels
    return None


def _ids(leg: int, legs: int, lit: Collection[int], outward: int) -> list[tuple[str, str]]:
    """List the joint ids of a leg as they are drawn, from left to right, each with its style.

    Args:
        leg: index of the leg.
        legs: number of legs.
        lit: ids of the joints to highlight.
        outward: 1 if the joint at the body comes first, -1 if it comes last.
    """
    joints = [leg + legs * level for level in range(JOINTS_PER_LEG)][::outward]
    parts: list[tuple[str, str]] = []
    for joint in joints:
        parts += [(f"{joint:>2}", _LIT if joint in lit else ""), (" ", "")]
    return parts[:-1]
