"""Plays a fork of a record, and writes it as a record of its own."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from lacoc_server.journal.journal import Journal
from lacoc_server.journal.replay import resume
from lacoc_server.match.match import Beat, Match
from lacoc_server.simulate.forks.line import REFEREE, ForkChange, ForkLine
from lacoc_server.simulate.forks.origin import ForkSource, stem
from lacoc_shared.inputs import Decide, Input
from lacoc_shared.messages import DecisionReply, Refusal
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.packed import PackedWriter
from lacoc_shared.record.schema import ForkChanges, Result
from lacoc_shared.seat import Phase
from lacoc_shared.words import Phrase, say


@dataclass(frozen=True)
class Forked:
    """A fork that was played."""

    result: Result
    phase: Phase
    """The phase in which the fork ended; play is over in FINISHED and later ones."""
    beats: int
    """Beats that the fork played itself."""
    decided_beat: int | None
    """Beat with the decisions of the change; None: it had none."""
    changes: tuple[Phrase, ...]
    """Events that a take-back removed or made new."""
    left_out: int
    """How many recorded take-backs the fork left out (`ForkLine.left_out`)."""
    record: Path | None
    """The fork's record; None: none was wanted."""


def fork(
    source: ForkSource,
    beat: int,
    change: ForkChange | None = None,
    *,
    changes: ForkChanges | None = None,
    match_id: str = "fork",
    folder: Path | None = None,
    seconds: float | None = None,
    arena: Path | None = None,
) -> Forked:
    """Go on with a recorded match from one of its beats.

    Args:
        source: the record.
        beat: first beat that the fork plays itself, at most the one after the record's last.
        change: how the fork differs from the record; None: it has the same inputs.
        changes: the same change, as the fork's record describes it; None: the record does not.
        match_id: id of the fork.
        folder: folder of the fork's record; None: none is written.
        seconds: how long the fork goes on at most [s]; but it goes on until its change is made.
            None: until play ends.
        arena: folder of the arena, if it is not installed.

    Raises:
        UserError: if the record has no such beat, if it can't be proven up to there on this
            machine (`journal.replay.resume`), if the match would refuse the change, or if the
            fork's record exists already, or it or its folder can't be made.
    """
    before = stem(source, beat, match_id, changes)
    match = resume(before.record, folder=arena).match
    # The fork's own beats are one more segment of the record that it goes on from.
    segment = before.record.headers[-1].segment + 1
    packed = partial(PackedWriter, before=before.messages)
    journal = Journal(match, folder, segment, writer=packed)
    try:
        while match.beats < beat - 1:  # beats in which nothing was recorded
            journal.beat()
        forked = _played(source, journal, change or ForkChange(), seconds)
        journal.close()
    except BaseException:  # Ctrl-C too: the fork can be played again
        journal.leave()
        raise
    return forked


def _check_phase(match: Match, change: ForkChange) -> None:
    """Check that new players can take over seats in the present phase of the match.

    Raises:
        UserError: if the match has not begun, or play is over.
    """
    if change.players and not (match.has_begun and match.phase is not Phase.FINISHED):
        raise UserError(say("fork.not-in-play", beat=match.beats + 1, phase=match.phase.word))


def _played(
    source: ForkSource,
    journal: Journal,
    change: ForkChange,
    seconds: float | None,
) -> Forked:
    match, first = journal.match, journal.match.beats + 1
    _check_phase(match, change)
    line = ForkLine(source.record, match, change, seconds)
    changes: list[Phrase] = []
    for _, replies in _beats(line, journal):
        for reply in replies:
            changes += reply.changes
    return Forked(
        match.result(),
        match.phase,
        match.beats + 1 - first,
        line.decided_beat,
        tuple(changes),
        line.left_out,
        None if journal.writer is None else journal.writer.path,
    )


def _beats(line: ForkLine, journal: Journal) -> Iterator[tuple[Beat, list[DecisionReply]]]:
    """Play a fork; yield each beat with the replies to the decisions that the fork adds.

    Raises:
        UserError: if the match refuses one of these decisions.
    """
    while True:
        inputs = line.inputs()
        beat, _ = journal.beat(inputs)
        yield beat, _replies(inputs, beat)
        line.see(beat.frame)
        if line.is_over:
            return


def _replies(inputs: list[Input], beat: Beat) -> list[DecisionReply]:
    found: list[DecisionReply] = []
    for item, outcome in zip(inputs, beat.outcomes, strict=True):
        if isinstance(item, Decide) and item.by == REFEREE:
            if isinstance(outcome, Refusal):
                raise UserError(say("fork.refused", beat=beat.frame.beat, why=outcome.why))
            assert isinstance(outcome, DecisionReply)
            found.append(outcome)
    return found
