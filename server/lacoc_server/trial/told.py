"""The most important figures of a trial, with names and values as texts for people."""

from lacoc_server.trial.figures import Figures
from lacoc_shared.words import Phrase, say

SHOWN_NAMES = {
    "speed_mm_s": say("trial.figure-speed"),
    "drift_deg_s": say("trial.figure-drift"),
    "stable_share": say("trial.figure-stable"),
    "margin_mm": say("trial.figure-margin"),
    "slip_ratio": say("trial.figure-slip-ratio"),
    "belly_share": say("trial.figure-belly"),
}
"""Names for people of the figures that a search may make worse, by their names in `Figures`."""


def told(figures: Figures) -> tuple[tuple[Phrase, str], ...]:
    """Return the names and values of the most important figures, with units, in a fixed order."""
    return (
        (say("trial.figure-speed"), _number(figures.speed_mm_s, "mm/s")),
        (say("trial.figure-lateral"), _number(figures.lateral_mm_s, "mm/s")),
        (say("trial.figure-drift"), _number(figures.drift_deg_s, "deg/s", 2)),
        (say("trial.figure-stable"), f"{100 * figures.stable_share:.0f} %"),
        (say("trial.figure-margin"), _number(figures.margin_mm, "mm")),
        (say("trial.figure-slip"), _number(figures.slip_mm_s, "mm/s")),
        (say("trial.figure-slip-ratio"), _number(figures.slip_ratio, "", 2)),
        (say("trial.figure-cost"), _number(figures.cost_of_transport, "", 1)),
        (say("trial.figure-clearance"), _number(figures.clearance_mm, "mm")),
        (say("trial.figure-belly"), f"{100 * figures.belly_share:.0f} %"),
        (say("trial.figure-upright"), _number(figures.upright, "", 2)),
        (say("trial.figure-duty"), "  ".join(f"{share:.2f}" for share in figures.duty)),
        (
            say("trial.figure-cycles"),
            f"{figures.cycles} × {figures.cycle_s:.2f} s" if figures.cycle_s else "–",
        ),
    )


def _number(value: float | None, unit: str, digits: int = 1) -> str:
    return "–" if value is None else f"{value:.{digits}f} {unit}".rstrip()
