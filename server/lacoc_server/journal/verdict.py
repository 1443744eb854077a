"""The verdict on a record, from all that its verification found."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

from lacoc_server.journal.section import BOUND, FRAME_FIELDS, Difference, SectionFinding
from lacoc_server.world import arithmetic
from lacoc_shared.record.schema import Header
from lacoc_shared.words import Phrase, say

_ORDER = ("frame-missing", *FRAME_FIELDS)
"""Names of the differences that are listed first, in this order; all others follow."""


class VerdictKind(StrEnum):
    """The three verdicts on a record."""

    SAME = "same"
    """Every recorded bit is the same as the bit computed from the inputs."""
    OTHER_ARITHMETIC = "other-arithmetic"
    """Rules and result agree with the inputs; poses differ only in their last bits."""
    DIFFERS = "differs"
    """The record does not agree with the match computed from its inputs."""


@dataclass(frozen=True)
class Verdict:
    """The result of the verification of a record."""

    kind: VerdictKind
    beats: int
    """Number of beats judged again."""
    frames: int
    """Number of frames compared."""
    sections: int
    """Sections that were simulated again."""
    said: Phrase
    """The verdict, for people."""
    differs_at: int | None = None
    """First beat that differs; None: no beat does."""
    distance: float = 0.0
    """Largest distance of a section's poses from the record [m, rad]; 0 for the kind `DIFFERS`."""
    worst: tuple[int, int] | None = None
    """First and last beat of the section with this distance; None: no section has other bits, or
    the kind is `DIFFERS`.
    """

    @property
    def same(self) -> bool:
        """True if the record agrees with its inputs, with this or another arithmetic."""
        return self.kind is not VerdictKind.DIFFERS


def conclude(
    headers: Sequence[Header],
    beats: int,
    frames: int,
    judged: Iterable[Difference | None],
    findings: Sequence[SectionFinding],
    other_model: Difference | None = None,
    bound: float = BOUND,
) -> Verdict:
    """Make the verdict on a record from all that its verification found.

    Bits may differ only where a segment was recorded with another arithmetic, or does not name its
    arithmetic.

    Args:
        headers: headers of the record's segments.
        beats: number of beats judged.
        frames: number of frames compared.
        judged: differences found by judging the match again; entries that are None are ignored.
        findings: result of each section's simulation.
        other_model: the first model whose bits differ on this machine; None: no model differs.
        bound: largest distance that another arithmetic may reach [m, rad].
    """
    found = [difference for difference in judged if difference is not None]
    found += [
        decisive
        for finding in findings
        if (decisive := finding.beyond if may_differ(headers, finding) else finding.bits)
    ]
    if found:
        first = min(difference.beat for difference in found)
        names = {name for difference in found if difference.beat == first for name in difference[1]}
        ranked = sorted(names, key=_rank)
        said = say("verdict.differs", beat=first, differs=ranked)
        return Verdict(VerdictKind.DIFFERS, beats, frames, len(findings), said, first)
    others = [finding for finding in findings if finding.bits is not None]
    if not others and other_model is None:
        return Verdict(VerdictKind.SAME, beats, frames, len(findings), say("verdict.same"))
    worst = max(others, key=lambda finding: finding.distance, default=None)
    said = say("verdict.other-arithmetic")
    if worst is not None:
        said = say(
            "verdict.other-arithmetic-in",
            others=len(others),
            sections=len(findings),
            first=worst.first_beat,
            last=worst.last_beat,
            distance=f"{worst.distance:.1e}",
            bound=f"{bound:g}",
        )
    return Verdict(
        VerdictKind.OTHER_ARITHMETIC,
        beats,
        frames,
        len(findings),
        said,
        distance=worst.distance if worst else 0.0,
        worst=(worst.first_beat, worst.last_beat) if worst else None,
    )


def may_differ(headers: Sequence[Header], finding: SectionFinding) -> bool:
    """Return whether the recorded bits of a section may differ from those computed here.

    They may if some of its beats were recorded with another arithmetic, or an unnamed one.
    """
    here = arithmetic.here()
    ends = [header.first_beat for header in headers[1:]] + [finding.last_beat + 1]
    return not all(
        arithmetic.same(here, header.arithmetic)
        for header, end in zip(headers, ends, strict=True)
        if header.first_beat <= finding.last_beat and end > finding.first_beat
    )


def other_arithmetic(record: Mapping[str, str], here: Mapping[str, str]) -> Phrase | None:
    """Name the machines of a record and of its replay; return None if both give the same bits."""
    if not record:
        return say("verdict.no-arithmetic")
    if arithmetic.same(record, here):
        return None
    there, this = (
        ", ".join(of[name] for name in ("processor", "libc", "system") if name in of)
        for of in (record, here)
    )
    return say("verdict.machines", there=there, here=this)


def _rank(name: str) -> tuple[int, str]:
    return (_ORDER.index(name) if name in _ORDER else len(_ORDER), name)
