"""Forges a game: plays it again with one or two things changed, so that its record is true to them.

Every value of a record that a forger may choose is a change here: each kind of input, in each
phase; who plays with what; the match's setup; the header; physics. The bots answer to what happens,
so their keys are those of the changed game. What comes after the game is computed again by
`contest_forging`.
"""

import random
import shutil
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from operator import itemgetter
from pathlib import Path
from typing import Any

from msgspec.structs import replace

from lacoc_arenas import arena as arenas
from lacoc_arenas.arena import Arena
from lacoc_arenas.bot import Brain
from lacoc_server.contest.headless.pool import bot_of, setup_of
from lacoc_server.contest.kept.entries import ContestEntry
from lacoc_server.contest.league.facts import AnyFact, Called, Recalled, new
from lacoc_server.contest.verify.games import GameToCheck
from lacoc_server.journal.journal import Journal
from lacoc_server.match.match import Match
from lacoc_server.match.physics import Fault
from lacoc_server.simulate.headless import Seated
from lacoc_server.simulate.inputs import AUTHOR, SETTLE_BEATS, closing
from lacoc_server.world.world import World, chained
from lacoc_shared import decisions as d
from lacoc_shared import seal
from lacoc_shared.gait.tables import Posture
from lacoc_shared.inputs import (
    Advice,
    Decide,
    HeardSeat,
    Input,
    KeySeat,
    LeaveSeat,
    ReadySeat,
    SilentSeat,
)
from lacoc_shared.messages import HealthVerdict
from lacoc_shared.messages.office import Assigned, AssignedSeat
from lacoc_shared.record.pack import pack
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import Header, Origin, Setup
from lacoc_shared.record.writer import RecordWriter
from lacoc_shared.seat import RESTART_KEY, Phase
from lacoc_shared.words import say

_MOST_BEATS = 1500
_SEATS = ("left", "right")


@dataclass
class Change:
    """A game as it will be played, and what its record and its fact will say."""

    chance: random.Random
    arena: Arena
    entries: list[ContestEntry]
    teams: list[str]
    setup: Setup
    late_ticks: list[int]
    names: list[str] = field(default_factory=list)
    extra: dict[tuple[Phase, int], list[Input]] = field(default_factory=dict)
    """Inputs that are added, by phase and by the number of the beat in it."""
    start: int = SETTLE_BEATS + 1
    mute: dict[int, int] = field(default_factory=dict)
    """By seat, the beat of play from which its bot's keys are left out."""
    key: Callable[[KeySeat, int], KeySeat] = lambda key, beat: key
    """Changes a bot's key, given the beat of play."""
    wait: int = 0
    """Beats that pass between the end of play and the closing decision."""
    last: Input | None = None
    """In place of the closing decision."""
    stop: int | None = None
    """Tick in which physics is said to have stopped."""
    nudge: float = 0.0
    """By how much the state is moved in the first snapshot [m]."""
    header: Callable[[Header], Header] = lambda header: header
    health: HealthVerdict | None = None
    second_at: int | None = None
    """Beat at which a second segment begins."""
    is_open: bool = False
    """Whether the file is left without an end, as by a killed court."""
    claims: tuple[int, int] | None = None
    """The score that the result claims, if the file is left without an end."""
    fact: dict[str, Any] = field(default_factory=dict)
    """Fields of the game's fact that are changed."""
    before: list[AnyFact] = field(default_factory=list)
    """Facts that come before the game's fact."""

    def add(self, phase: Phase, *items: Input, within: int = 190) -> None:
        """Add inputs in a beat of a phase that is chosen by chance."""
        self.extra.setdefault((phase, self.chance.randrange(1, within)), []).extend(items)

    def seat(self) -> int:
        """Choose a seat."""
        return self.chance.randrange(2)


def forge(
    game: GameToCheck,
    entries: Sequence[ContestEntry],
    folder: Path,
    chance: random.Random,
    names: Sequence[str] = (),
) -> Change:
    """Play a game again with one or two changes, and write its record into a folder.

    Args:
        game: the game, as the honest facts give it.
        entries: the entries of its teams, and then those of other teams.
        folder: where the record goes.
        chance: chooses the changes.
        names: the changes; empty: one or two by chance.
    """
    assert game.plan is not None
    arena = arenas.load(game.plan.arena, game.plan.arena_settings)
    change = Change(
        chance=chance,
        arena=arena,
        entries=[*entries],
        teams=[*game.played.teams],
        setup=setup_of(Path(game.played.record).stem, arena, game.plan.limits),
        late_ticks=[game.late_ticks] * 2,
    )
    for name in names or _some(chance):
        before = len(change.names)
        CHANGES[name](change, game)
        detail = ", ".join(change.names[before:])
        change.names[before:] = [f"{name} ({detail})" if detail else name]
    play(change, folder / (change.fact.get("record") or game.played.record))
    return change


def play(change: Change, path: Path) -> None:
    """Play a changed game, and write its record."""
    match = Match(change.setup, lambda arena, entries: _World(arena, entries, change))
    scratch = path.parent / "scratch"
    journal = Journal(match, scratch)
    joins = [
        one.join(seat, team)
        for seat, (one, team) in enumerate(zip(change.entries[:2], change.teams, strict=True))
    ]
    minds: list[Brain] = []
    seqs = [0, 0]
    passed: dict[Phase, int] = {}
    beat = journal.beat(joins)[0]
    while match.beats < _MOST_BEATS and match.phase not in (Phase.OFFICIAL, Phase.VOID):
        phase = match.phase
        at = passed[phase] = passed.get(phase, 0) + 1
        items: list[Input] = [*change.extra.get((phase, at), ())]
        if phase is Phase.LOBBY and at == 1:
            items += [ReadySeat(seat, True) for seat in range(2)]
        elif phase is Phase.READY and match.beats + 1 == change.start:
            items.append(Decide(AUTHOR, "", d.Start()))
        elif phase is Phase.PLAYING:
            minds = minds or [
                bot_of(change.arena, Seated(join, one.bot, one.program))(match.sheet(), seat)
                for seat, (one, join) in enumerate(zip(change.entries[:2], joins, strict=True))
            ]
            for seat, mind in enumerate(minds):
                key = mind(beat.frame) if match.ticks > change.late_ticks[seat] else None
                if key is not None and at < change.mute.get(seat, _MOST_BEATS):
                    seqs[seat] += 1
                    made = KeySeat(seat, seqs[seat], int(key.level), key.key)
                    items.append(change.key(made, at))
        elif phase is Phase.HALTED and at <= 5 and change.stop is None:
            items += [Decide("Kim", "", d.Resume())] * (at == 5)
        elif phase is Phase.FINISHED and at <= change.wait:
            pass
        elif phase in (Phase.FINISHED, Phase.HALTED) or (
            phase is Phase.LOBBY and Phase.READY in passed
        ):
            items.append(change.last or closing(phase))
            change.last = None
        beat = journal.beat(items)[0]
    journal.close()
    assert journal.writer is not None
    record = Record.read([journal.writer.path])
    shutil.rmtree(scratch)
    _write(record, change, path)


class _World(World):
    """Physics that a forger can stop or nudge."""

    def __init__(self, arena: Arena, entries: Sequence[Any], change: Change) -> None:
        super().__init__(arena, entries)
        self._change = change
        self._ticks = 0

    def step(self, angles: Sequence[Posture]) -> Fault | None:
        before = self.digest
        self._ticks += 1
        if self._ticks == self._change.stop:
            return Fault(0, say("fault.velocity"))
        fault = super().step(angles)
        if self._ticks == 1 and self._change.nudge:
            self._qpos[0] += self._change.nudge
            self._keep()
            state = self.save()[8:]
            self.load(chained(before, state) + state)
        return fault


def _write(record: Record, change: Change, path: Path) -> None:
    """Write a record with a forged header."""
    first = change.header(record.header)
    record.headers = [first]
    if change.claims is not None and record.result is not None:
        left, right = change.claims
        outcome = "left" if left > right else "right" if right > left else "draw"
        record.results = [replace(record.result, scores=(left, right), official=outcome)]
        last = record.frames[-1][0]
        record.frames = record.frames[:-1]
        record.events = [one for one in record.events if one.beat < last]
    written(record, path, change)


def written(record: Record, path: Path, change: Change | None = None) -> None:
    """Write a record as a packed file.

    Args:
        record: the record.
        path: the file.
        change: may leave the file open, and add a health message or a segment.
    """
    second = None if change is None else change.second_at
    headers = [record.header]
    if second is not None:
        headers.append(replace(record.header, segment=1, first_beat=second, arithmetic={}))
    writers = [RecordWriter(path.parent, header) for header in headers]

    def at(beat: int) -> RecordWriter:
        return writers[-1] if second is not None and beat >= second else writers[0]

    writes: list[tuple[int, Callable[[], None]]] = []
    for beat, inputs in record.inputs.items():
        writes += ((beat, partial(at(beat).input, beat, item)) for item in inputs)
    writes += ((beat, partial(at(beat).frame, beat, frame)) for beat, frame in record.frames)
    writes += ((event.beat, partial(at(event.beat).event, event)) for event in record.events)
    writes += ((beat, partial(at(beat).touch, beat, one)) for beat, one in record.touches.items())
    writes += ((beat, partial(at(beat).snapshot, beat, one)) for beat, one in record.snapshots)
    writes += ((beat, partial(at(beat).sheet, beat, sheet)) for beat, sheet in record.sheets)
    writes += ((beat, partial(at(beat).scene, beat, scene)) for beat, scene in record.scenes)
    for _, write in sorted(writes, key=itemgetter(0)):
        write()
    if record.result is not None:
        writers[-1].result(record.result)
    if change is not None and change.health is not None:
        writers[-1].health(record.last_beat, change.health)
    if change is not None and change.is_open:
        writers[-1].leave()
        writers[-1].path.rename(path)
        return
    for writer in writers:
        writer.close()
    pack([writer.path for writer in writers], path)


# Changes. Each is given the game as it will be played, and the honest game.


def _silent(change: Change, game: GameToCheck) -> None:
    seat = change.seat()
    change.add(Phase.PLAYING, SilentSeat(seat))
    if change.chance.random() < 0.5:
        change.add(Phase.PLAYING, HeardSeat(seat))


def _heard(change: Change, game: GameToCheck) -> None:
    change.add(Phase.PLAYING, HeardSeat(change.seat()))


def _leave(change: Change, game: GameToCheck) -> None:
    change.add(
        change.chance.choice((Phase.PLAYING, Phase.PLAYING, Phase.FINISHED)),
        LeaveSeat(change.seat()),
    )


def _join_again(change: Change, game: GameToCheck) -> None:
    seat = change.seat()
    change.add(Phase.PLAYING, change.entries[seat].join(seat, change.teams[seat]))


def _ready(change: Change, game: GameToCheck) -> None:
    ready = change.chance.random() < 0.5
    phase = change.chance.choice((Phase.READY, Phase.PLAYING))
    change.add(phase, ReadySeat(change.seat(), ready), within=40)


def _key_added(change: Change, game: GameToCheck) -> None:
    key = change.chance.choice((0, 1, 2, 3, RESTART_KEY))
    change.add(Phase.PLAYING, KeySeat(change.seat(), 10_000, change.chance.choice((0, 1)), key))


def _key_changed(change: Change, game: GameToCheck) -> None:
    at, key = change.chance.randrange(1, 150), change.chance.randrange(4)
    seat = change.seat()

    def changed(one: KeySeat, beat: int) -> KeySeat:
        return replace(one, key=key) if one.seat == seat and beat >= at else one

    change.key = changed


def _key_fields(change: Change, game: GameToCheck) -> None:
    name = change.chance.choice(("seen", "held", "late", "seq"))
    more = change.chance.choice((1, 3, 50))
    change.names.append(name)
    change.key = lambda one, beat: replace(one, **{name: getattr(one, name) + more})


def _mute(change: Change, game: GameToCheck) -> None:
    change.mute[change.seat()] = change.chance.choice((0, 20, 80))


def _advice(change: Change, game: GameToCheck) -> None:
    change.add(Phase.PLAYING, Advice((say("health.beats", percent=3.0),)))


def _decided(change: Change, game: GameToCheck) -> None:
    """Add any decision of a referee, of the court or of the headless player, in any phase."""
    seat = _SEATS[change.seat()]
    rare = (
        d.Ready(seat),
        d.Start(),
        d.Resume(),
        d.Unfreeze(seat),
        d.TakeBack(change.chance.randrange(1, 12)),
        d.Clock(seconds=1.0),
        d.Abort(),
        d.Official(),
        d.Next(),
    )
    phase = change.chance.choice((Phase.READY, Phase.PLAYING, Phase.FINISHED))
    _decide(change, phase, change.chance.choice(rare))


def _decide(change: Change, phase: Phase, decision: d.Decision) -> None:
    if phase is Phase.FINISHED:
        change.wait = max(change.wait, 3)
    within = {Phase.FINISHED: 2, Phase.READY: 30}.get(phase, 150)
    by = change.chance.choice((AUTHOR, "Kim", ""))
    change.names.append(f"{type(decision).__name__} in {phase.name} by {by or 'the court'}")
    reason = change.chance.choice(("agreed", say("reason.ended-early")))
    change.add(phase, Decide(by, reason, decision), within=within)


def _points(change: Change, game: GameToCheck) -> None:
    phase = change.chance.choice((Phase.PLAYING, Phase.FINISHED))
    points = change.chance.choice((-5, 1, 5, 40))
    _decide(change, phase, d.Adjust(_SEATS[change.seat()], points))


def _marker(change: Change, game: GameToCheck) -> None:
    marker = change.chance.choice(change.arena.game.markers).name
    _decide(change, Phase.PLAYING, d.Set(marker, _SEATS[change.seat()]))


def _winner(change: Change, game: GameToCheck) -> None:
    winners = [one for one in (*_SEATS, "draw") if one != game.played.outcome]
    _decide(change, Phase.FINISHED, d.Declare(change.chance.choice(winners)))


def _frozen(change: Change, game: GameToCheck) -> None:
    _decide(change, Phase.PLAYING, d.Freeze(_SEATS[change.seat()], 3.0))


def _put_back(change: Change, game: GameToCheck) -> None:
    _decide(change, Phase.PLAYING, d.Restart(_SEATS[change.seat()]))


def _time(change: Change, game: GameToCheck) -> None:
    _decide(change, Phase.PLAYING, d.Clock(gives_s=change.chance.choice((-2.0, 2.0, 5.0))))


def _halt(change: Change, game: GameToCheck) -> None:
    change.add(Phase.PLAYING, Decide(AUTHOR, "", d.Halt()))


def _start(change: Change, game: GameToCheck) -> None:
    change.start += change.chance.choice((-30, -7, -1, 1, 2, 9, 40))


def _late(change: Change, game: GameToCheck) -> None:
    ticks = change.chance.choice((1, 7, 14, 40))
    if change.chance.random() < 0.5:
        change.late_ticks = [game.late_ticks + ticks] * 2
    else:
        change.late_ticks[change.seat()] = game.late_ticks + ticks


def _bot(change: Change, game: GameToCheck) -> None:
    """Let another bot steer a team, with the team's own files."""
    seat = change.seat()
    there = [name for name in change.arena.bots if name != change.entries[seat].bot]
    own = change.entries[seat]
    honest = own.join(seat, change.teams[seat])
    other = replace(own, bot=change.chance.choice(there), program=None)
    assert other.join(seat, change.teams[seat]) == honest
    change.entries[seat] = other


def _files(change: Change, game: GameToCheck) -> None:
    """Let a team play with a gait that walks another way."""
    seat = change.seat()
    own = change.entries[seat]
    data = own.locomotion or b""
    rows = data.decode().splitlines()
    at = change.chance.randrange(2, len(rows))
    cells = rows[at].split("\t")
    if len(cells) < 2:
        cells = [*cells, ""]
    with suppress(ValueError):
        cells[0] = f"{float(cells[0]) + 3:g}"
    rows[at] = "\t".join(cells)
    change.entries[seat] = replace(own, locomotion="\n".join(rows).encode() + b"\n")


def _teams(change: Change, game: GameToCheck) -> None:
    change.teams = change.teams[::-1]
    change.entries[:2] = change.entries[1::-1]


def _closing(change: Change, game: GameToCheck) -> None:
    decision = change.chance.choice((d.Abort(), d.Official()))
    by = change.chance.choice((AUTHOR, "Kim"))
    change.names.append(f"{type(decision).__name__} by {by}")
    change.last = Decide(by, change.chance.choice(("", "agreed")), decision)
    if isinstance(decision, d.Abort):
        change.last = Decide(by, "agreed", decision)


def _wait(change: Change, game: GameToCheck) -> None:
    change.wait += change.chance.choice((1, 50))


def _stop(change: Change, game: GameToCheck) -> None:
    """Say that physics stopped, in READY or in play."""
    change.stop = change.chance.choice((10, 60, 120, 200))


def _nudge(change: Change, game: GameToCheck) -> None:
    """Choose another path within the bound of another arithmetic, and claim one."""
    change.nudge = change.chance.choice((-9e-6, -4e-6, 4e-6, 9e-6))
    _arithmetic(change, game)


def _of_setup(**fields: Callable[[Change], Any]) -> Callable[[Change, GameToCheck], None]:
    def forged(change: Change, game: GameToCheck) -> None:
        change.setup = replace(change.setup, **{name: of(change) for name, of in fields.items()})

    return forged


def _settings(change: Change) -> dict[str, Any]:
    settings = change.setup.settings
    kind = change.chance.choice(("duration", "countdown", "colour", "start", "bots"))
    change.names.append(kind)
    match = dict(settings["match"])
    if kind == "duration":
        match["duration_s"] = change.chance.choice((2.0, 3.0, 6.0))
    elif kind == "countdown":
        match["countdown_s"] = 0.5
    elif kind == "start":
        match["start"] = "ready"
    elif kind == "colour":
        seats = [dict(one) for one in settings["seat"]]
        seats[0]["colour"] = "#123456"
        return {**settings, "seat": seats}
    else:
        return {**settings, "more": {"bots": True}}
    return {**settings, "match": match}


def assigned_of(change: Change) -> Assigned:
    """Return what an office assigns to a court."""
    token = seal.hash_token("token", b"0" * 16)
    return Assigned(
        call=change.chance.choice(("f3", "f99")),
        fixture=say("fixture.waiting"),
        seats=tuple(
            AssignedSeat(
                id=seat,
                team=change.teams[at],
                token_hashes=(token,),
                robot=(join := change.entries[at].join(at, change.teams[at])).robot,
                postures=join.postures,
                locomotion=join.locomotion,
            )
            for at, seat in enumerate(_SEATS)
        ),
    )


def _name(change: Change, game: GameToCheck) -> None:
    """Give the match another name, in its setup, in its header or in its fact too."""
    name = "f" * 32
    where = change.chance.choice(("setup", "header", "all"))
    change.names.append(where)
    if where in ("setup", "all"):
        change.setup = replace(change.setup, match_id=name)
    if where == "all":
        change.fact["record"] = f"{name}.mcap"
    if where == "header":
        before = change.header
        change.header = lambda header: replace(before(header), match_id=name)


def _of_header(name: str, *values: Any) -> Callable[[Change, GameToCheck], None]:
    def forged(change: Change, game: GameToCheck) -> None:
        before, value = change.header, change.chance.choice(values)
        change.names.append(str(value))
        change.header = lambda header: replace(before(header), **{name: value})

    return forged


def _version(change: Change, game: GameToCheck) -> None:
    name, value = change.chance.choice(
        (
            ("lacoc", "0.0.9"),
            ("lacoc", "9.9.9"),
            ("lacoc", ""),
            ("protocol", "1"),
            ("mujoco", "3.0.0"),
            ("model", "1"),
            ("machine", "pdp11"),
        )
    )
    change.names.append(f"{name} {value}")
    before = change.header

    def forged(header: Header) -> Header:
        header = before(header)
        return replace(header, versions={**header.versions, name: value})

    change.header = forged


def _no_versions(change: Change, game: GameToCheck) -> None:
    before = change.header

    def forged(header: Header) -> Header:
        header = before(header)
        return replace(header, versions={"mujoco": header.versions["mujoco"]})

    change.header = forged


def _arithmetic(change: Change, game: GameToCheck) -> None:
    before, made_by = change.header, {"functions": "0" * 16, "path": "0" * 16}
    is_none = change.chance.random() < 0.5
    change.names.append("none" if is_none else "another")

    def forged(header: Header) -> Header:
        header = before(header)
        return replace(header, arithmetic={} if is_none else {**header.arithmetic, **made_by})

    change.header = forged


def _health(change: Change, game: GameToCheck) -> None:
    change.health = HealthVerdict(
        played_beats=200,
        real_time_factor=0.5,
        slow_beats=9,
        worst_late_ms=80.0,
        faults=0,
        resumptions=0,
        seats=(),
        advice=(say("health.beats", percent=3.0),),
    )


def _second(change: Change, game: GameToCheck) -> None:
    """Write a second segment, as a court that was killed does; it names no arithmetic."""
    if not change.is_open:
        change.second_at = change.chance.choice((1, 40, 120))
    change.nudge = change.chance.choice((0.0, 9e-6))


def _open(change: Change, game: GameToCheck) -> None:
    """Leave the record without an end; most of the time, claim another result in it."""
    change.is_open, change.second_at = True, None
    if change.chance.random() < 0.8:
        change.claims = change.chance.choice(((30, 0), (0, 30), (7, 7)))


def _fact(change: Change, game: GameToCheck) -> None:
    played = game.played
    name = change.chance.choice(("scores", "outcome", "record_hash", "steer", "void"))
    change.names.append(name)
    left, right = played.scores
    values: dict[str, dict[str, Any]] = {
        "scores": {"scores": (left + 1, right)},
        "outcome": {"outcome": "right" if played.outcome == "left" else "left"},
        "record_hash": {"record_hash": ""},
        "steer": {"steer": change.chance.choice(("planner", "straight", "nobody"))},
        "void": {"outcome": "void", "scores": (0, 0)},
    }
    change.fact |= values[name]


def _called(change: Change, game: GameToCheck) -> None:
    """Say that the game was called to a court, and perhaps taken back again."""
    what = {"pairing": game.played.pairing, "game": game.played.game}
    change.before.append(new(Called, court="main", teams=game.played.teams, **what))
    if change.chance.random() < 0.4:
        change.names.append("and taken back")
        change.before.append(new(Recalled, **what))
        return
    call = f"f{game.played.number}"
    if change.chance.random() < 0.8:
        change.names.append("and recorded so")
        change.setup = replace(
            change.setup, court="main", assigned=replace(assigned_of(change), call=call)
        )


def _tried(change: Change, game: GameToCheck) -> None:
    """Say that the game was played before, without a result, so that its bots start later."""
    void = replace(game.played, outcome="void", scores=(0, 0))
    change.before.append(void)
    change.late_ticks = [ticks + 1 for ticks in change.late_ticks]


_Changes = dict[str, Callable[[Change, GameToCheck], None]]

DEEDS: _Changes = {
    "silent": _silent,
    "leave": _leave,
    "a key added": _key_added,
    "a key changed": _key_changed,
    "keys left out": _mute,
    "points": _points,
    "a marker": _marker,
    "a winner": _winner,
    "frozen": _frozen,
    "put back": _put_back,
    "time": _time,
    "a decision": _decided,
    "a halt": _halt,
    "the start": _start,
    "late bots": _late,
    "another bot": _bot,
    "other files": _files,
    "seats swapped": _teams,
    "the last decision": _closing,
    "physics stops": _stop,
    "another path": _nudge,
    "settings": _of_setup(settings=_settings),
    "no end": _open,
    "the fact": _fact,
}
"""Changes that can give another result, by name."""
COVERS: _Changes = {
    "nothing": lambda change, game: None,
    "heard": _heard,
    "join": _join_again,
    "ready": _ready,
    "fields of keys": _key_fields,
    "advice": _advice,
    "a later end": _wait,
    "court": _of_setup(court=lambda change: change.chance.choice(("main", "", "Simulation"))),
    "match number": _of_setup(match=lambda change: change.chance.choice((0, 2, 99))),
    "limits": _of_setup(limits=lambda change: {"legs_max": 8.0}),
    "assigned": _of_setup(assigned=assigned_of),
    "origin": _of_setup(origin=lambda change: Origin(match_id="x", beat=3, record_hash="0" * 32)),
    "name": _name,
    "versions": _version,
    "no versions": _no_versions,
    "arithmetic": _arithmetic,
    "started": _of_header("started", "", "2001-01-01T00:00:00+00:00"),
    "segment": _of_header("segment", 1, 7),
    "first beat": _of_header("first_beat", 1, 5),
    "health": _health,
    "a second segment": _second,
    "called": _called,
    "tried before": _tried,
}
"""Changes that might keep a check from looking, by name."""
CHANGES = DEEDS | COVERS


def _some(chance: random.Random) -> list[str]:
    """Choose a change or two: one that can give another result, and most of the time a cover."""
    first = [chance.choice(sorted(DEEDS))]
    return first + chance.choice(
        ([], [chance.choice(sorted(COVERS))], [chance.choice(sorted(COVERS))], _more(chance, first))
    )


def _more(chance: random.Random, first: list[str]) -> list[str]:
    return [chance.choice(sorted(CHANGES.keys() - {*first}))]
