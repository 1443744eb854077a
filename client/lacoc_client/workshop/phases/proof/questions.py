"""Makes the question that a phase asks before it is done, from the student's own table and trial.

Each function takes the evidence with which the work was done, and `turn`: how many questions of the
phase the student has answered wrong. After a wrong answer the question is another one.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from zlib import crc32

from lacoc_client.workshop.phases.evidence import Compared, Evidence, Guessed, TookStep, Tried
from lacoc_client.workshop.phases.facts import Difference, FootWay
from lacoc_client.workshop.phases.proof.numbers import foot_guesses
from lacoc_shared.gait.cells import leg_labels
from lacoc_shared.words import Phrase, say

_LEVELS = ("Root", "1st", "2nd")
_LINKS_MM = (15.0, 70.0, 70.0)
"""Lengths of the links of the workshop's robot [mm]."""
_MOST_CHOICES = 6
"""Most choices of a question about rows: a page sends the number of a choice as one digit."""
_FIRST_DEG, _SECOND_DEG = (10, 30, 40, 50), (-35, -20, 20, 35)
TURNS_DEG_S = 5.0
"""A robot that turns at least this fast counts as turning [deg/s] (docs/studio.md 7)."""

_OPPOSITE: dict[FootWay, FootWay] = {
    "forward": "back",
    "back": "forward",
    "up": "down",
    "down": "up",
    "out": "in",
    "in": "out",
}
_WAYS: dict[FootWay, Phrase] = {
    "forward": say("phases.way-forward"),
    "back": say("phases.way-back"),
    "up": say("phases.way-up"),
    "down": say("phases.way-down"),
    "out": say("phases.way-out"),
    "in": say("phases.way-in"),
}
_DIFFERENCES: dict[Difference, Phrase] = {
    "speed": say("phases.differs-speed"),
    "period": say("phases.differs-period"),
    "lift": say("phases.differs-lift"),
    "duty": say("phases.differs-duty"),
    "turning": say("phases.differs-turning"),
}


@dataclass(frozen=True)
class PhaseQuestion:
    """A question with choices."""

    name: str
    ask: Phrase
    choices: tuple[Phrase, ...]
    right: frozenset[int]
    """Indices of the right choices."""
    because: Phrase
    """An explanation of the right choices."""


def lesson_question(seen: Sequence[Evidence], turn: int) -> PhaseQuestion:
    """Ask where a foot is, at angles that depend on the student's answers in the lesson."""
    seed = crc32(repr((turn, [one for one in seen if isinstance(one, TookStep)])).encode())
    first = _FIRST_DEG[seed % len(_FIRST_DEG)]
    second = _SECOND_DEG[seed // len(_FIRST_DEG) % len(_SECOND_DEG)]
    l0, l1, l2 = _LINKS_MM
    sin_1, cos_1 = math.sin(math.radians(first)), math.cos(math.radians(first))
    sin_2, cos_2 = (f(math.radians(first + second)) for f in (math.sin, math.cos))
    r, z = l0 + l1 * cos_1 + l2 * sin_2, l1 * sin_1 - l2 * cos_2
    spots = (
        (r, z),
        (l0 + l1 * cos_1, l1 * sin_1 - l2),  # the shank hangs straight down
        (l0 + l1 * sin_1 + l2 * cos_2, l1 * cos_1 - l2 * sin_2),  # sine and cosine swapped
        (l0 + l1, -l2),  # as at 0 and 0
    )
    return _made(
        "spot",
        say("phases.ask-spot", first=first, second=second),
        [say("phases.spot", r_mm=round(r), z_mm=round(z)) for r, z in spots],
        1,
        say("phases.because-spot", first=first, shank=first + second, r_mm=r, z_mm=z),
        seed,
    )


def leg_question(seen: Sequence[Evidence], turn: int) -> PhaseQuestion:
    """Ask where a foot goes if a change is undone, or made on the opposite leg of the robot.

    The change is the last one for which the student guessed where the foot goes.
    """
    guess = foot_guesses(seen)[-1]
    joint, leg = _LEVELS[guess.level], _label(guess.of_legs, guess.leg)
    way = _WAYS.get(_main_way(guess), say("phases.way-still"))
    if turn % 2 == 0:
        return _ways(
            "other-side",
            say(
                "phases.ask-other-side",
                joint=joint,
                leg=leg,
                other=_label(guess.of_legs, guess.of_legs - 1 - guess.leg),
                before_deg=guess.before_deg,
                after_deg=guess.after_deg,
                way=way,
            ),
            [way for way in _WAYS if way in guess.was],
            say("phases.because-other-side", joint=joint),
        )
    return _ways(
        "change-back",
        say(
            "phases.ask-change-back",
            joint=joint,
            leg=leg,
            before_deg=guess.before_deg,
            after_deg=guess.after_deg,
            way=way,
        ),
        [_OPPOSITE[way] for way in _WAYS if way in guess.was],
        say("phases.because-change-back"),
    )


def tripod_question(seen: Sequence[Evidence], turn: int) -> PhaseQuestion:
    """Ask about the last trial: what its support margin means, or which feet carried the robot."""
    facts = _last_trial(seen).facts
    seed = len(seen)
    if turn % 2 == 0 and facts.margin_mm is not None:
        margin_mm = facts.margin_mm
        return _made(
            "margin",
            say("phases.ask-margin", margin_mm=margin_mm),
            [
                say("phases.margin-edge", margin_mm=margin_mm),
                say("phases.margin-height", margin_mm=margin_mm),
                say("phases.margin-slip", margin_mm=margin_mm),
                say("phases.margin-lift", margin_mm=margin_mm),
            ],
            1,
            say("phases.because-margin"),
            seed,
        )
    legs = len(facts.duty)
    stood = facts.stood
    sets = [stood, _others(stood, legs), _side(legs), tuple(range(legs))]
    return _made(
        "carry",
        say("phases.ask-carry"),
        [_feet(legs, one) for one in dict.fromkeys(sets)],
        1,
        say("phases.because-carry", feet=_names(legs, stood)),
        seed,
    )


def push_question(seen: Sequence[Evidence], turn: int) -> PhaseQuestion:
    """Ask which feet pushed the body in the last trial, or how they moved relative to the body."""
    facts = _last_trial(seen).facts
    legs, stood, seed = len(facts.duty), facts.stood, len(seen)
    if turn % 2 == 0:
        sets = [stood, _others(stood, legs), tuple(range(legs)), _side(legs)]
        return _made(
            "push",
            say("phases.ask-push", forward_mm=facts.forward_mm),
            [_feet(legs, one) for one in dict.fromkeys(sets)],
            1,
            say("phases.because-push", feet=_names(legs, stood)),
            seed,
        )
    return _made(
        "oars",
        say("phases.ask-oars", feet=_names(legs, stood)),
        [
            say("phases.way-back"),
            say("phases.way-forward"),
            say("phases.way-still"),
            say("phases.way-up"),
        ],
        1,
        say("phases.because-oars"),
        seed,
    )


def seam_question(seen: Sequence[Evidence], turn: int) -> PhaseQuestion:
    """Ask between which rows of a key its seam is, or which row is half a cycle after the first.

    The seam of a key is the step from its last row to its first.
    """
    trial = _last_trial(seen)
    rows = trial.rows or tuple(range(1, max(2, trial.facts.postures) + 1))
    first, last = rows[0], rows[-1]
    half = rows[len(rows) // 2]
    has_half = len(rows) % 2 == 0 and half != first
    if turn % 2 == 0 or not has_half:
        steps = [*dict.fromkeys([(last, first), *pairwise(rows)])][:_MOST_CHOICES]
        return _made(
            "seam",
            say("phases.ask-seam", rows=rows),
            [say("phases.from-row", row=row, to=to) for row, to in steps],
            1,
            say("phases.because-seam", row=last, to=first),
            len(seen),
        )
    others = [*dict.fromkeys((half, *rows))][:_MOST_CHOICES]
    return _made(
        "half",
        say("phases.ask-half", rows=rows, row=first),
        [say("phases.row", row=row) for row in others],
        1,
        say("phases.because-half", row=first, to=half, count=len(rows)),
        len(seen),
    )


def differs_question(seen: Sequence[Evidence], turn: int) -> PhaseQuestion:
    """Ask how the student's walk differs from the sample gait's, or how long its cycle lasts."""
    periods_s = [one.facts.cycle_s for one in seen if isinstance(one, Tried) and one.facts.cycle_s]
    compared = [one.differs for one in seen if isinstance(one, Compared)]
    differs = compared[-1] if compared else ()
    same = [one for one in _DIFFERENCES if one not in differs]
    if turn % 2 == 0 and differs and len(same) > 1:
        found = differs[len(seen) % len(differs)]
        return _made(
            "differs",
            say("phases.ask-differs"),
            [_DIFFERENCES[found], *(_DIFFERENCES[one] for one in same)],
            1,
            say("phases.because-differs", differs=tuple(_DIFFERENCES[one] for one in differs)),
            len(seen),
        )
    cycle_s = periods_s[-1] if periods_s else 1.0
    return _made(
        "period",
        say("phases.ask-period"),
        [say("phases.seconds", seconds=cycle_s * part) for part in (1.0, 0.5, 2.0, 4.0)],
        1,
        say("phases.because-period", seconds=cycle_s),
        len(seen),
    )


def keys_question(seen: Sequence[Evidence], turn: int) -> PhaseQuestion:
    """Ask which of the keys that the student has tried turns the robot to one side."""
    is_right = turn % 2 == 0
    sign = -1 if is_right else 1
    versions: dict[str, dict[str, float]] = {}
    for one in seen:
        if isinstance(one, Tried) and one.facts.keys[-1].startswith("B"):
            tried = versions[one.version] = versions.pop(one.version, {})
            tried[one.facts.keys[-1][1:]] = sign * one.facts.drift_deg_s
    # The version that was tried last, of those with such a key and another one.
    turns = next(
        (
            keys
            for keys in reversed(versions.values())
            if max(keys.values()) >= TURNS_DEG_S > min(keys.values())
        ),
        {},
    )
    found = [key for key, deg_s in turns.items() if deg_s >= TURNS_DEG_S]
    others = [key for key in turns if key not in found]
    return _made(
        "key-right" if is_right else "key-left",
        say("phases.ask-key-right") if is_right else say("phases.ask-key-left"),
        [say("phases.key", key=key) for key in (*found, *others)],
        len(found),
        say("phases.because-key", key=found[0] if found else ""),
        len(seen),
    )


def _made(
    name: str, ask: Phrase, choices: Sequence[Phrase], right: int, because: Phrase, seed: int
) -> PhaseQuestion:
    """Make a question from choices of which the first `right` are right.

    `seed` mixes their order.
    """
    order = sorted(range(len(choices)), key=lambda at: crc32(f"{name} {seed} {at}".encode()))
    return PhaseQuestion(
        name=name,
        ask=ask,
        choices=tuple(choices[at] for at in order),
        right=frozenset(place for place, at in enumerate(order) if at < right),
        because=because,
    )


def _ways(name: str, ask: Phrase, right: Sequence[FootWay], because: Phrase) -> PhaseQuestion:
    """Make a question about the direction of a foot; its choices are always in the same order."""
    places = frozenset(place for place, way in enumerate(_WAYS) if way in right)
    return PhaseQuestion(name, ask, tuple(_WAYS.values()), places, because)


def _main_way(guess: Guessed) -> FootWay:
    return next((way for way in _WAYS if way in guess.was[:1]), "still")


def _last_trial(seen: Sequence[Evidence]) -> Tried:
    return next(one for one in reversed(seen) if isinstance(one, Tried))


def _others(feet: Sequence[int], legs: int) -> tuple[int, ...]:
    return tuple(leg for leg in range(legs) if leg not in feet)


def _side(legs: int) -> tuple[int, ...]:
    return tuple(range(legs // 2))


def _feet(legs: int, feet: Sequence[int]) -> Phrase:
    return say("phases.feet", feet=_names(legs, feet))


def _names(legs: int, feet: Sequence[int]) -> tuple[str, ...]:
    return tuple(_label(legs, leg) for leg in feet)


def _label(legs: int, leg: int) -> str:
    labels = leg_labels(legs)
    return labels[leg] if 0 <= leg < len(labels) else str(leg)
