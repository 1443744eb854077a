"""Makes the messages that describe a map of gaits, or six gaits to choose from.

A map of gaits is a grid that keeps the best gait of each cell.
"""

from collections.abc import Iterator

import numpy as np

from lacoc_server.studio.coach.coach import cell_changes
from lacoc_server.studio.coach.table import Angles
from lacoc_server.studio.coach.trials import Task
from lacoc_server.studio.styles.gait_map import Mapped
from lacoc_server.studio.styles.style import WAYS, Styles
from lacoc_server.studio.styles.variants import Varied
from lacoc_server.trial.figures import Figures
from lacoc_shared.studio import GaitDifference, MapCell, MapReply, OtherGait, VariantsReply

_SEEN = 0.4
"""Smallest difference in a `Way` that students are told of [steps]; less can hardly be seen."""


def map_reply(task: Task, key: int, found: Mapped) -> MapReply:
    """Make the message that describes a map of gaits."""
    grid, styles = found.archive.grid, Styles(task.robot, task.table)
    return MapReply(
        key=key,
        speeds_mm_s=grid.speeds_mm_s,
        arousals_mm_s=grid.arousals_mm_s,
        cells=tuple(
            MapCell(
                speed=place.speed,
                arousal=place.arousal,
                gait=other_gait(task, styles, elite.angles_deg, elite.figures),
            )
            for place, elite in sorted(found.archive.elites.items())
        ),
        own=grid.place(found.own),
        before=vars(found.own),
        trials=found.trials,
        cancelled=found.stopped,
    )


def variants_reply(task: Task, key: int, found: Varied) -> VariantsReply:
    """Make the message with the gaits from which a student can choose."""
    styles = Styles(task.robot, task.table)
    return VariantsReply(
        key=key,
        variants=tuple(other_gait(task, styles, *one) for one in found.variants),
        trials=found.trials,
        cancelled=found.stopped,
    )


def other_gait(task: Task, styles: Styles, table: Angles, figures: Figures) -> OtherGait:
    """Describe a gait that was found, and how it differs from the student's own."""
    own = task.table.angles_deg
    return OtherGait(
        table=table,
        changes=cell_changes(task.table, own, table),
        differences=tuple(_differences(styles, own, table)),
        figures=vars(figures),
    )


def _differences(styles: Styles, own: Angles, table: Angles) -> Iterator[GaitDifference]:
    """Yield how a table looks different from the student's own, the most visible way first."""
    steps = styles.look(table) - styles.look(own)
    for index in np.argsort(-abs(steps), kind="stable"):
        if abs(steps[index]) >= _SEEN:
            yield GaitDifference(way=WAYS[index], steps=round(float(steps[index]), 2))
