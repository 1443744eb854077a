"""`python -m benchmarks.forks`: does a fork without a change equal its record, bit for bit?

Plays short matches with bots, and forks half of them with a change, so that records with a
referee's decisions are among them. Each record is then forked at some beats. The benchmark compares
every frame, input, event, touch and result with the record, and proves each fork.

It also takes back each event of the record: the dry run at the end of the match, and a fork in
which the event is taken back right after it happened, must give the same scores. For that the halt
must change no path, so it falls in a beat in which nobody pressed a key.
"""

import random
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from arguments import arguments
from bot_matches import ARENAS, BOTS, bot_match
from verdicts import verdict

from lacoc_server.journal.replay import resume
from lacoc_server.journal.verdict import VerdictKind
from lacoc_server.simulate.forks.fork import fork
from lacoc_server.simulate.forks.jobs import ForkJob, play_fork
from lacoc_server.simulate.forks.line import ForkChange
from lacoc_server.simulate.forks.origin import ForkSource, read_source
from lacoc_shared.decisions import TakeBack
from lacoc_shared.inputs import Decide
from lacoc_shared.messages import DecisionReply
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record


class _Same(NamedTuple):
    forks: int
    frames: int
    different: int


def main() -> int:
    """Play, fork and compare; return 0 if nothing differs."""
    options = arguments(
        __doc__,
        records=20,
        beats=(10, "forks of each record"),
        seconds=(8.0, "of play, each record"),
        seed=1,
    )
    chance = random.Random(options.seed)
    all_same: list[_Same] = []
    agreed = asked = 0
    with tempfile.TemporaryDirectory() as folder:
        for number in range(options.records):
            source = _record(Path(folder), number, options.seconds, chance)
            same = _compare(source, Path(folder), options.beats, chance)
            good, of = _take_backs(source)
            all_same.append(same)
            agreed, asked = agreed + good, asked + of
            print(source.match_id, same, f"take-backs: {good} of {of} agree", flush=True)
    different = sum(same.different for same in all_same)
    print(
        f"{len(all_same)} records, {sum(same.forks for same in all_same)} forks, "
        f"{sum(same.frames for same in all_same)} frames: {different} forks differ; "
        f"{agreed} of {asked} take-backs agree with the dry run"
    )
    return int(different > 0 or agreed < asked)


def _record(folder: Path, number: int, seconds: float, chance: random.Random) -> ForkSource:
    """Play a match; if its number is odd, fork it with a change."""
    name = ARENAS[number // 2 % 2]
    match_id = f"match-{number:02d}"
    bots = chance.choices(BOTS, k=2)
    late = [chance.randrange(50), chance.randrange(50)]
    settings = {"match": {"duration_s": seconds}}
    path = bot_match(folder, name, bots, settings, match_id=match_id, late_ticks=late)
    source = read_source(path)
    if number % 2 == 0:
        return source
    first, last = _play(source)
    events = _to_take_back(source)
    change = ForkJob(
        file=str(path),
        beat=max([chance.randrange(first, last), *(beat + 1 for beat, _ in events[:1])]),
        take_back=events[0][1] if events else None,
        restart=(chance.choice(source.seats),),
        match_id=f"{match_id}-changed",
        folder=str(folder),
    )
    changed = play_fork(change)
    assert changed.record is not None
    return read_source(changed.record)


def _compare(source: ForkSource, folder: Path, beats: int, chance: random.Random) -> _Same:
    different = frames = 0
    chosen = chance.sample(range(1, source.last_beat + 2), beats)
    for number, beat in enumerate(sorted(chosen)):
        match_id = f"fork-{number}-{source.match_id}"
        forked = fork(source, beat, match_id=match_id, folder=folder)
        assert forked.record is not None
        again = Record.read(forked.record)
        frames += sum(at >= beat for at, _ in again.frames)
        if differs := [*_differences(source.record, again, beat)]:
            different += 1
            print(f"{match_id} at beat {beat}: {', '.join(differs)} differ", file=sys.stderr)
        forked.record.unlink()
    return _Same(len(chosen), frames, different)


def _differences(was: Record, again: Record, beat: int) -> list[str]:
    """Name what differs, apart from the names of match and court."""
    found = []
    before, after = dict(was.frames), dict(again.frames)
    # A new segment begins with a frame also where nothing is new.
    new = set(after) - set(before)
    if any(after.get(at) != frame for at, frame in before.items()) or len(new) > 1:
        found.append("frames")
    names = ("inputs", "events", "touches")
    found += (name for name in names if getattr(was, name) != getattr(again, name))
    results = [
        None if one.result is None else (one.result.scores, one.result.official, one.result.digest)
        for one in (was, again)
    ]
    if results[0] != results[1]:
        found.append("result")
    if again.cut or verdict(again, processes=1).kind is not VerdictKind.SAME:
        found.append("proof")
    return found


def _take_backs(source: ForkSource) -> tuple[int, int]:
    """Return how many take-backs agree with the dry run, and how many there were."""
    finished = next(
        (one.beat for one in source.record.events if one.data.get("after") == "FINISHED"), None
    )
    events = _to_take_back(source)
    if finished is None or not events:
        return 0, 0
    match = resume(source.record.until(finished)).match
    asks = [Decide("referee", "", TakeBack(number, dry_run=True)) for _, number in events]
    replies = match.beat(asks).outcomes
    agreed = of = 0
    for (beat, number), reply in zip(events, replies, strict=True):
        if not isinstance(reply, DecisionReply):
            continue  # an earlier decision of the record took it back already
        of += 1
        try:
            forked = fork(source, beat + 1, ForkChange(take_back=number))
        except UserError as error:
            print(f"{source.match_id}, event {number}: {error}", file=sys.stderr)
            continue
        agreed += forked.result.scores == reply.scores
    return agreed, of


def _play(source: ForkSource) -> tuple[int, int]:
    beats = {str(one.data.get("after")): one.beat for one in source.record.events}
    return beats["PLAYING"], beats["FINISHED"]


def _to_take_back(source: ForkSource) -> list[tuple[int, int]]:
    """Return beat and number of each event of the game."""
    return [(one.beat, one.number) for one in source.record.events if "marker" in one.data]


if __name__ == "__main__":
    sys.exit(main())
