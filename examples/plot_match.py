"""Draw the paths and the score of a match: `python examples/plot_match.py RECORD match.svg`.

It needs nothing but LACOC: it writes the lines of an SVG file itself. docs/notebook.md shows the
picture.
"""

import sys
from pathlib import Path
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

from lacoc_shared.mistakes import UserError
from lacoc_shared.record import notebook

COLOURS = ("#0072b2", "#d55e00")
SIZE_PX = 360
MARGIN_PX = 48
LEGEND_PX = 24
JUMP_M = 0.1
MOST_LINES = 8
STEPS = (1, 2, 5, 10, 20, 50, 100)


def picture(match: notebook.MatchArrays) -> str:
    """Return an SVG with the paths of the robots on the left and their points on the right."""
    wide = 2 * SIZE_PX + 3 * MARGIN_PX
    high = SIZE_PX + 2 * MARGIN_PX + LEGEND_PX
    paths = _paths(match, MARGIN_PX, MARGIN_PX)
    points = _points(match, SIZE_PX + 2 * MARGIN_PX, MARGIN_PX)
    teams = _teams(match, MARGIN_PX, high - MARGIN_PX + LEGEND_PX)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {high}" '
        f'font-family="sans-serif" font-size="13">'
        f'<rect width="{wide}" height="{high}" fill="white"/>{paths}{points}{teams}</svg>\n'
    )


def _paths(match: notebook.MatchArrays, left: float, top: float) -> str:
    """Draw the floor from above: markers, and each robot's path while play was on."""
    reach_m = 1.1 * max(1.0, float(np.abs(match.marker_position_m).max(initial=0.0)))
    scale = SIZE_PX / (2 * reach_m)
    parts = [_frame(left, top, "paths [m]", f"{-reach_m:.1f}", f"{reach_m:.1f}")]
    for x_m, y_m in match.marker_position_m:
        x, y = left + (x_m + reach_m) * scale, top + (reach_m - y_m) * scale
        parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="#ddd"/>')
    for robot, colour in zip(match.robots, COLOURS, strict=False):
        path_m = robot.position_m[match.playing, :2]
        path_m = path_m[np.isfinite(path_m).all(axis=1)]
        # A robot that was put back to its start did not walk there: another line begins.
        steps_m = np.linalg.norm(np.diff(path_m, axis=0), axis=1)
        for walk_m in np.split(path_m, np.flatnonzero(steps_m > JUMP_M) + 1):
            x, y = (
                left + (walk_m[::5, 0] + reach_m) * scale,
                top + (reach_m - walk_m[::5, 1]) * scale,
            )
            parts.append(_line(x, y, colour))
    return "".join(parts)


def _points(match: notebook.MatchArrays, left: float, top: float) -> str:
    """Draw the score over the clock, from the fewest points of a seat to the most."""
    clock_s, score = match.clock_s[match.playing], match.score[match.playing]
    last_s = max(1.0, float(clock_s.max(initial=0.0)))
    least = int(score.min()) if score.size else 0
    most = max(least + 1, int(score.max(initial=least)))
    step = next((one for one in STEPS if (most - least) / one <= MOST_LINES), most - least)
    least = least // step * step
    most = -(-most // step) * step
    parts = [_frame(left, top, "points", "0", f"{last_s:.0f} s")]
    for points in range(least, most + 1, step):
        y_line = top + (most - points) / (most - least) * SIZE_PX
        parts.append(
            f'<path d="M{left} {y_line:.1f}h{SIZE_PX}" stroke="#ddd"/>'
            f'<text x="{left - 6}" y="{y_line + 4:.1f}" fill="#555" text-anchor="end">{points}'
            "</text>"
        )
    for seat, (_, colour) in enumerate(zip(match.robots, COLOURS, strict=False)):
        x = left + clock_s / last_s * SIZE_PX
        y = top + (most - score[:, seat]) / (most - least) * SIZE_PX
        turns = np.flatnonzero(np.diff(score[:, seat], prepend=-1, append=-1))
        kept = np.unique(np.clip(np.concatenate([turns, turns - 1]), 0, max(0, len(x) - 1)))
        if len(x):
            parts.append(_line(x[kept], y[kept], colour))
    return "".join(parts)


def _teams(match: notebook.MatchArrays, left: float, y: float) -> str:
    """Name the teams below the drawings, each beside a line of its colour."""
    parts = []
    for seat, (robot, colour) in enumerate(zip(match.robots, COLOURS, strict=False)):
        x = left + seat * (SIZE_PX + MARGIN_PX)
        name = escape(f"{robot.seat}: {robot.team}")
        parts.append(
            f'<path d="M{x} {y - 4}h20" stroke="{colour}" stroke-width="3"/>'
            f'<text x="{x + 28}" y="{y}">{name}</text>'
        )
    return "".join(parts)


def _frame(left: float, top: float, title: str, least: str, most: str) -> str:
    bottom = top + SIZE_PX
    return (
        f'<rect x="{left}" y="{top}" width="{SIZE_PX}" height="{SIZE_PX}" fill="none" '
        f'stroke="#888"/><text x="{left}" y="{top - 10}">{escape(title)}</text>'
        f'<text x="{left}" y="{bottom + 18}" fill="#555">{least}</text>'
        f'<text x="{left + SIZE_PX}" y="{bottom + 18}" fill="#555" text-anchor="end">{most}</text>'
    )


def _line(x: NDArray[np.float64], y: NDArray[np.float64], colour: str) -> str:
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True))
    return f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.5"/>'


def main() -> None:
    """Read the record that the command line names, and write the picture."""
    if len(sys.argv) != 3:
        sys.exit("python examples/plot_match.py RECORD match.svg")
    out = Path(sys.argv[2])
    if out.suffix.lower() != ".svg":
        sys.exit(f"The picture is an SVG file, so its name must end in .svg: {out} does not.")
    try:
        match = notebook.read(sys.argv[1])
    except UserError as error:
        sys.exit(str(error))
    try:
        out.write_text(picture(match), encoding="utf-8")
    except OSError as error:
        sys.exit(f"Cannot write {out}: {error.strerror}.")


if __name__ == "__main__":
    main()
