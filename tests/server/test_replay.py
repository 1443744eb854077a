"""Tests of replay: a record is verified, or a match is resumed from where the record ends."""

import struct
from collections.abc import Iterator
from pathlib import Path

import msgspec
import pytest
from stage import FORWARD, LEFT, QUICK, RIGHT, TURN_LEFT, TURN_RIGHT, X, decide, join, key, setup
from verdicts import verdict

from lacoc_arenas import arena as arenas
from lacoc_server.journal.journal import SNAPSHOT_TICKS, Journal
from lacoc_server.journal.replay import resume, verify
from lacoc_server.journal.verdict import VerdictKind
from lacoc_server.match.match import Beat, Match
from lacoc_server.simulate import player, simulate
from lacoc_server.world.world import World
from lacoc_shared import decisions as d
from lacoc_shared.codec import decode, encode
from lacoc_shared.inputs import HeardSeat, Input, KeySeat, ReadySeat, SilentSeat
from lacoc_shared.messages import Event, Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import KINDS, Result
from lacoc_shared.record.stream import walk_messages
from lacoc_shared.record.writer import RecordWriter
from lacoc_shared.seat import Phase
from lacoc_shared.words import render, say

INPUTS: dict[int, list[Input]] = {
    0: [join(LEFT), join(RIGHT)],
    1: [ReadySeat(LEFT, True), ReadySeat(RIGHT, True)],
    8: [decide(d.Start())],
    12: [key(LEFT, FORWARD, 1), key(RIGHT, FORWARD, 1)],
    260: [key(RIGHT, TURN_LEFT, 2), decide(d.Adjust("right", 2))],
    300: [SilentSeat(RIGHT)],
    310: [HeardSeat(RIGHT), key(LEFT, X, 2), key(LEFT, FORWARD, 3)],
    330: [decide(d.Halt()), decide(d.Start())],  # the start is refused
    340: [decide(d.Restart("right")), decide(d.Set("flag18", "left"))],
    341: [decide(d.Start())],  # refused; nothing else happens in this beat
    350: [decide(d.TakeBack(17)), decide(d.Resume())],
    353: [key(RIGHT, TURN_RIGHT, 3)],
}
"""Inputs of a Flag-Strike match, by beat: keys, [x], a silence, and legal and illegal decisions."""
BEATS = 420


@pytest.fixture(scope="module")
def live(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Path, list[Beat]]]:
    """Give the path of the record of a match that is still on, and the match's beats."""
    journal = Journal(Match(setup("flag-strike", QUICK), World), tmp_path_factory.mktemp("live"))
    assert journal.writer is not None
    beats = [journal.beat(INPUTS.get(number, ()))[0] for number in range(BEATS)]
    assert {Phase(beat.frame.phase).name for beat in beats} == {
        "LOBBY",
        "READY",
        "COUNTDOWN",
        "PLAYING",
        "HALTED",
    }
    yield journal.writer.path, beats
    journal.close()


def boundaries(data: bytes) -> list[int]:
    """Return the offsets of all records in an MCAP file without chunks."""
    places, at = [], 8
    while at < len(data):
        places.append(at)
        at += 9 + struct.unpack_from("<Q", data, at + 1)[0]
    return places


# Verify.


@pytest.mark.slow
@pytest.mark.parametrize("arena", [pytest.param("othello", marks=pytest.mark.long), "flag-strike"])
def test_a_simulated_match_verifies(arena: str, tmp_path: Path) -> None:
    """The verdict on the record of a simulated match is "same", in either game."""
    made = setup(arena, {"match": {"duration_s": 20.0}})
    ground = arenas.load(arena)
    bots = list(ground.bots)
    simulate(made, [player(ground, 0, bots[1]), player(ground, 1, bots[0])], tmp_path)
    record = Record.read(tmp_path / "m.mcap")
    assert (record.cut, record.result is not None) == (None, True)
    found = verdict(record)
    assert (found.kind, found.differs_at) == (VerdictKind.SAME, None)
    assert found.beats == record.last_beat + 1
    assert found.frames > 1000


def test_a_match_that_goes_on_verifies_up_to_where_it_is(live: tuple[Path, list[Beat]]) -> None:
    """The record of a match that is still on verifies up to its newest beat."""
    record = Record.read(live[0])
    assert record.cut
    found = verdict(record)
    assert (found.kind, found.beats, found.frames) == (VerdictKind.SAME, BEATS, len(record.frames))


def test_a_changed_key_is_named(live: tuple[Path, list[Beat]]) -> None:
    """If a key is changed in the record, verify names the beat of that key."""
    record = Record.read(live[0])
    record.inputs[260] = [
        KeySeat(item.seat, item.seq, item.level, TURN_RIGHT) if isinstance(item, KeySeat) else item
        for item in record.inputs[260]
    ]
    found = verdict(record)
    assert found.differs_at == 260
    assert render(found.said).startswith("beat 260 differs: seats, poses, state hash")


def test_a_missing_input_is_named(live: tuple[Path, list[Beat]]) -> None:
    """If an input is taken out of the record, verify names the beat of that input."""
    record = Record.read(live[0])
    del record.inputs[300]
    assert verdict(record).differs_at == 300


@pytest.mark.parametrize("beat", [5, 9, 200, 335, 419])
def test_one_flipped_bit_of_a_pose_is_named(
    beat: int, live: tuple[Path, list[Beat]], tmp_path: Path
) -> None:
    """If one bit of a pose is flipped, verify names the frame's beat."""
    path, beats = live
    data = bytearray(path.read_bytes())
    recorded = [at for at, _ in Record.read(path).frames]
    beat = max(at for at in recorded if at <= beat)
    frame = beats[beat].frame
    at = data.index(encode(frame)) + encode(frame).index(frame.poses)
    data[at + 17] ^= 1 << 2
    copy = tmp_path / path.name
    copy.write_bytes(data)
    found = verdict(Record.read(copy))
    assert found.differs_at == beat
    assert render(found.said) == f"beat {beat} differs: poses"


@pytest.mark.parametrize(
    ("what", "words"),
    [
        ("event", "its events"),
        ("touch", "what the robots touched"),
        ("snapshot", "the snapshot"),
    ],
)
def test_a_changed_event_touch_or_snapshot_is_named(
    what: str, words: str, live: tuple[Path, list[Beat]]
) -> None:
    """If an event or a snapshot is changed, or a touch is missing, verify names it and its beat."""
    record = Record.read(live[0])
    if what == "event":
        event = record.events[-1]
        record.events[-1] = msgspec.structs.replace(event, said=say("plain.text", text="!"))
        beat = event.beat
    elif what == "touch":
        beat = max(record.touches)
        del record.touches[beat]
    else:
        beat, saved = record.snapshots[-1]
        record.snapshots[-1] = beat, saved[:-1] + bytes([saved[-1] ^ 1])
    assert render(verdict(record).said) == f"beat {beat} differs: {words}"


def test_no_robot_is_moved_between_two_snapshots(tmp_path: Path) -> None:
    """A snapshot without a tick differs: two of them would let a robot jump in a countdown."""
    slow = {"match": {"countdown_s": 0.06}}
    match = Match(setup("flag-strike", slow), World)
    journal, first = Journal(match, tmp_path), 350
    writer = journal.writer
    assert writer is not None
    for number in range(BEATS):
        beat, _ = journal.beat(INPUTS.get(number, ()))
        if number in (first, first + 1):
            assert isinstance(match.physics, World)
            assert (Phase(beat.frame.phase), beat.ticked) == (Phase.COUNTDOWN, False)
            saved = match.physics.save()
            if number > first:  # the first robot's position, after the digest and the time
                (x_m,) = struct.unpack_from("<d", saved, 16)
                saved = saved[:16] + struct.pack("<d", x_m + 0.05) + saved[24:]
                match.physics.load(saved)
            writer.snapshot(number, saved)
    journal.close()
    record = Record.read(writer.path)
    assert render(verdict(record).said) == f"beat {first} differs: the snapshot"
    with pytest.raises(UserError, match=f"beat {first} differs: the snapshot"):
        resume(record)


def as_protocol_1(record: Record, live: Path, folder: Path) -> Path:
    """Copy a record as software of protocol 1 would have written it; return the copy's path."""
    header = record.header
    versions = {**header.versions, "protocol": "1"}
    writer = RecordWriter(folder, msgspec.structs.replace(header, versions=versions))

    def take(topic: str, beat: int, data: bytes, message: object) -> None:
        if isinstance(message, Event):
            fields = msgspec.structs.asdict(message)
            fields["text"] = render(fields.pop("said"))
            data = encode(fields)
        if topic != "/lacoc/header":
            writer._write(1 + list(KINDS).index(topic), beat, data)

    walk_messages(live, take)
    writer.close()
    return writer.path


def test_a_record_of_protocol_1_is_read_and_verified(
    live: tuple[Path, list[Beat]], tmp_path: Path
) -> None:
    """Events of protocol 1 have English sentences instead of phrases; other fields are verified."""
    path = as_protocol_1(Record.read(live[0]), live[0], tmp_path)
    record = Record.read(path)
    first = Record.read(live[0]).events[0]
    assert record.events[0].said == say("plain.text", text=render(first.said))
    assert verdict(record).kind is VerdictKind.SAME
    event = record.events[-1]
    record.events[-1] = msgspec.structs.replace(event, kind="another")
    assert verdict(record).differs_at == event.beat


@pytest.mark.slow
def test_a_changed_result_is_named(tmp_path: Path) -> None:
    """If the recorded result is changed, verify names the last beat and the result."""
    made = setup("othello", {"match": {"duration_s": 0.5}})
    ground = arenas.load("othello")
    simulate(made, [player(ground, seat, "straight") for seat in (0, 1)], tmp_path)
    record = Record.read(tmp_path / "m.mcap")
    assert record.result is not None
    record.results = [msgspec.structs.replace(record.result, scores=(36, 0))]
    assert render(verdict(record).said) == f"beat {record.last_beat} differs: the result"


def result(beats: int) -> Result:
    """Return a result that somebody invents for a record."""
    return Result(
        match_id="m",
        court="main",
        match=1,
        arena="flag-strike",
        teams=("Ants", "Bees"),
        scores=(0, 99),
        computed="right",
        official="right",
        reason=say("over.time"),
        clock_s=1.0,
        beats=beats,
        digest="",
        model="",
    )


@pytest.mark.parametrize("more", [1, 2, 3])
def test_an_invented_result_is_named(more: int, live: tuple[Path, list[Beat]]) -> None:
    """If a result is added to the record of a match that goes on, verify names the result."""
    record = Record.read(live[0])
    record.results = [result(record.last_beat + more)]
    last = record.last_beat
    assert render(verdict(record).said) == f"beat {last} differs: the result"
    assert record.result == (record.results[0] if more == 1 else None)


def test_an_invented_event_is_named(live: tuple[Path, list[Beat]]) -> None:
    """An event of the next beat is accepted only if the court was killed in that beat."""
    record = Record.read(live[0])
    last = record.last_beat
    record.events.append(msgspec.structs.replace(record.events[-1], beat=last + 1))
    assert render(verdict(record).said) == f"beat {last} differs: events of no beat"
    record.last_beat += 1
    assert verdict(record).kind is VerdictKind.SAME


def test_what_a_killed_court_told_nobody_is_no_result(
    live: tuple[Path, list[Beat]],
) -> None:
    """A result of the beat in which a court was killed does not count; the record verifies."""
    record = Record.read(live[0])
    record.last_beat += 1  # the beat has an event, and no frame
    record.events.append(msgspec.structs.replace(record.events[-1], beat=record.last_beat))
    record.results = [result(record.last_beat + 1)]
    assert record.result is None
    assert verdict(record).kind is VerdictKind.SAME


def test_a_record_without_beats_has_no_result(
    live: tuple[Path, list[Beat]], tmp_path: Path
) -> None:
    """A record that is empty verifies, but not if it has a result."""
    header = Record.read(live[0]).header
    empty, invented = (RecordWriter(tmp_path / name, header) for name in "ab")
    invented.result(result(1))
    for writer in (empty, invented):
        writer.close()
    assert verdict(Record.read(empty.path)).kind is VerdictKind.SAME
    assert render(verdict(Record.read(invented.path)).said) == "beat 0 differs: the result"


def test_another_mujoco_is_refused(live: tuple[Path, list[Beat]]) -> None:
    """A record of another MuJoCo is not verified or resumed; the error says what to install."""
    record = Record.read(live[0])
    versions = {**record.header.versions, "mujoco": "3.9.9"}
    record.headers[0] = msgspec.structs.replace(record.header, versions=versions)
    for attempt in (lambda: next(verify(record)), lambda: resume(record)):
        with pytest.raises(UserError, match=r"made with MuJoCo 3\.9\.9.*pip install mujoco==3\.9"):
            attempt()


# A cut record, and a match that is resumed from it.


def go_on(match: Match, beats: list[Beat]) -> None:
    """Continue a resumed match; check that each beat has the same bits as in the whole match."""
    for number in range(match.beats + 1, len(beats)):
        beat = match.beat(INPUTS.get(number, ()))
        assert encode(beat.frame) == encode(beats[number].frame), number
        assert encode(beat.events) == encode(beats[number].events)
        assert beat.touch == beats[number].touch


@pytest.mark.parametrize(
    "part",
    [0.12, 0.73, *(pytest.param(part, marks=pytest.mark.long) for part in (0.31, 0.5, 0.9, 1.0))],
)
def test_a_record_cut_anywhere(part: float, live: tuple[Path, list[Beat]], tmp_path: Path) -> None:
    """A cut record verifies to its end, and the match resumed from it goes on with equal bits."""
    path, beats = live
    data = path.read_bytes()
    copy = tmp_path / path.name
    copy.write_bytes(data[: int(len(data) * part)])
    record = Record.read(copy)
    assert verdict(record).kind is VerdictKind.SAME
    match = resume(record).match
    assert match.beats in (record.last_beat, record.last_beat - 1)
    assert match.physics.digest == (
        beats[match.beats].frame.digest if match.beats >= 0 else bytes(8)
    )
    go_on(match, beats)


@pytest.mark.slow
@pytest.mark.parametrize(
    "beat",
    [309, *(pytest.param(beat, marks=pytest.mark.long) for beat in (259, 329, 339, 340, 349, 352))],
)
def test_a_beat_is_whole_or_not_at_all(
    beat: int, live: tuple[Path, list[Beat]], tmp_path: Path
) -> None:
    """A court that was killed in the middle of a beat does that beat again.

    The record is cut after each message around a beat with inputs, decisions and events.
    """
    path, beats = live
    data = path.read_bytes()
    whole = Record.read(path)
    frames = dict(whole.frames)
    start = data.index(frames[max(at for at in frames if at <= beat)])
    for cut in [at for at in boundaries(data) if start < at][:9]:
        copy = tmp_path / path.name
        copy.write_bytes(data[:cut])
        record = Record.read(copy)
        match = resume(record).match
        answered = max(at for at, _ in record.frames)
        assert match.beats == max(answered, record.last_beat - 1)
        again = match.beat(INPUTS.get(match.beats + 1, ()))
        assert encode(again.frame) == encode(beats[match.beats].frame)
        assert encode(again.events) == encode(beats[match.beats].events)


@pytest.mark.slow
@pytest.mark.parametrize("snapshot", [0, 1])
def test_restored_from_any_snapshot(snapshot: int, live: tuple[Path, list[Beat]]) -> None:
    """From whichever snapshot a match is resumed, it ends with the digest of the whole match."""
    path, beats = live
    record = Record.read(path)
    assert len(record.snapshots) == 2
    match = resume(record, at=record.snapshots[snapshot][0]).match
    assert isinstance(match.physics, World)
    assert match.physics.digest == beats[-1].frame.digest
    before = resume(record, at=record.snapshots[0][0] - 1).match  # from the very beginning
    assert before.physics.digest == beats[-1].frame.digest


def test_snapshots_come_every_5_s_of_physics(live: tuple[Path, list[Beat]]) -> None:
    """The record has a snapshot in the first tick and every 5 s of physics."""
    path, beats = live
    ticked = [beat.frame.beat for beat in beats if beat.ticked]
    expected = [ticked[n] for n in range(0, len(ticked), SNAPSHOT_TICKS)]
    assert [beat for beat, _ in Record.read(path).snapshots] == expected


def test_the_court_goes_on_in_a_new_segment(live: tuple[Path, list[Beat]], tmp_path: Path) -> None:
    """After two kills, the record of three segments verifies and has each event once."""
    path, beats = live
    data = path.read_bytes()
    segment = tmp_path / path.name
    at = data.index(dict(Record.read(path).frames)[309])
    segment.write_bytes(data[: [b for b in boundaries(data) if b > at][2]])  # in beat 310
    for number, last in enumerate((345, 400), start=1):
        match = resume(Record.read(segment)).match
        journal = Journal(match, tmp_path, number)
        while match.beats < last:
            journal.beat(INPUTS.get(match.beats + 1, ()))
        assert journal.writer is not None
        if number == 1:  # killed in the middle of beat 346
            journal.writer.input(346, key(LEFT, TURN_LEFT, 9))
            journal.leave()
        else:
            journal.close()
    record = Record.read(segment)
    assert [header.segment for header in record.headers] == [0, 1, 2]
    assert verdict(record).kind is VerdictKind.SAME
    events: list[Event] = [e for beat in beats[:401] for e in beat.events]
    assert encode(record.events) == encode(events)
    assert decode(record.frames[-1][1], Frame) == beats[400].frame
