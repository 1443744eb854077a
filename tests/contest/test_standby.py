"""Tests of the copy of an office's folder on a second machine."""

import os
import stat
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

import pytest
from cup import Cup
from msgspec.structs import replace
from ports import free_port
from standby_room import (
    OPEN,
    PLAYED,
    Near,
    OfficeRoom,
    contents,
    contest_text,
    entry,
    following,
    second,
)

from lacoc_server.contest.desk.service import DeskService
from lacoc_server.contest.kept import machine
from lacoc_server.contest.kept.applications import Applications
from lacoc_server.contest.kept.machine import Machine, Retired
from lacoc_server.contest.kept.publish import entries_of
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.facts import (
    Called,
    Closed,
    Entered,
    TakenOver,
    Withdrawn,
    generation,
    new,
)
from lacoc_server.contest.standby.following import CopyingEnded
from lacoc_server.contest.standby.lookout import Lookout
from lacoc_server.contest.standby.messages import AnyAsk, KnockAsk, OfficeThere, PartAsk, StepAsk
from lacoc_server.contest.standby.other import LacksIt, NotThere, Other, OtherToken
from lacoc_server.contest.standby.sealing import REQUEST, BadSeal, Sealing
from lacoc_server.contest.standby.taking_over import set_aside, take_over
from lacoc_server.contest.standby.tenure import Tenure
from lacoc_shared.codec import encode
from lacoc_shared.messages import Refusal
from lacoc_shared.messages.office import Assigned
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.files import packed_path, segment_path
from lacoc_shared.record.schema import FORMAT, Header, Setup
from lacoc_shared.record.writer import RecordWriter
from lacoc_shared.words import say

T = TypeVar("T")


@pytest.fixture
def room(tmp_path: Path) -> Iterator[OfficeRoom]:
    """Give an office that keeps something of everything."""
    with OfficeRoom(tmp_path / "office", contest_text()) as made:
        made.fill()
        yield made


def test_everything_is_copied_and_stays_in_step(room: OfficeRoom, tmp_path: Path) -> None:
    """A step copies all that is new: also what was changed, removed or packed since."""
    where = second(room, tmp_path / "second")
    with following(where, Near(room)) as follower:
        copy = follower.step()
        assert contents(where) == contents(room.where)
        assert (copy.facts, copy.records, copy.open) == (5, 1, 1)
        room.grow(OPEN, 1)
        room.grow(OPEN, 10, segment=1)
        room.applications.drop("Cat")
        room.applications.put("Dan", entry("Dan"))
        room.where.stand_ins.unlink()
        room.where.secrets.write_bytes(b"{}")
        follower.step()
        assert contents(where) == contents(room.where)
        room.play(2, OPEN)
        room.pack(OPEN)
        copy = follower.step()
        assert (copy.facts, copy.records, copy.open) == (6, 2, 0)
        assert contents(where) == contents(room.where)
    with FactStore(where.facts) as store, Applications(where.applications) as applications:
        assert store.facts() == room.store.facts()
        assert applications.waiting == room.applications.waiting
    assert stat.S_IMODE(os.stat(where.secrets).st_mode) == 0o600


def test_a_copy_that_stops_at_any_moment_can_be_used(room: OfficeRoom, tmp_path: Path) -> None:
    """After any number of answers, no fact here names an entry or a record that is not here.

    The record of the second result is not packed yet: all of it that is written is here.
    """
    room.play(2, OPEN)
    answers, is_whole = 0, False
    while not is_whole:
        where = second(room, tmp_path / f"second-{answers}")
        near = Near(room, answers)
        with following(where, near) as follower, suppress(NotThere):
            follower.step()
            is_whole = True
        with FactStore(where.facts) as store:
            facts = store.facts()
        assert facts in ((), room.store.facts())
        for one in entries_of(facts):
            where.entries.load(one)
        if facts:
            assert packed_path(where.records, PLAYED).stat().st_size == 300_000
            assert segment_path(where.records, OPEN, 0).stat().st_size == 200_000
        assert bool(machine.read(where.machine).copied_ms) == is_whole
        near.answers = 1_000_000
        with following(where, near) as follower:
            follower.step()
        assert contents(where) == contents(room.where)
        answers += 1
    assert answers > 10


class Restless(Near):
    """An office whose tokens and result change twice, each time after it was asked for a step."""

    changes = 2

    def ask(self, request: AnyAsk, kind: type[T]) -> T:
        answer = super().ask(request, kind)
        if isinstance(request, StepAsk) and self.changes:
            self.changes -= 1
            self.room.where.secrets.write_text(f'{{"Ann": "token {self.changes}"}}')
            self.room.store.append(new(Withdrawn, team="Ann", reason=str(self.changes)))
        return answer


def test_what_changes_in_a_step_is_copied_again(room: OfficeRoom, tmp_path: Path) -> None:
    """No fact is stored before all that was there when it was read has been copied whole."""
    where = second(room, tmp_path / "second")
    where.secrets.unlink()
    restless = Restless(room)
    with following(where, restless) as follower:
        copy = follower.step()
    assert restless.changes == 0
    assert copy.facts == len(room.store.facts())
    assert contents(where) == contents(room.where)
    restless.changes = 100
    room.where.secrets.write_text("{}")
    with following(where, restless) as follower, pytest.raises(UserError, match="again and again"):
        follower.step()


def test_only_an_office_takes_facts(room: OfficeRoom, tmp_path: Path) -> None:
    """Neither a copy nor an office that went elsewhere appends a fact, whichever program tries."""
    where = second(room, tmp_path / "second")
    with following(where, Near(room)) as follower:
        follower.step()
    with FactStore(where.facts) as store:
        with pytest.raises(UserError, match="copy of the office"):
            store.append(new(Closed))
        assert store.facts() == room.store.facts()
    room.tenure.check()
    room.tenure.hear(0)
    room.tenure.check()
    room.tenure.hear(1)
    with pytest.raises(Retired):
        room.tenure.check()
    with pytest.raises(Retired):
        room.store.append(new(Closed))


def test_a_folder_with_other_facts_is_no_copy(room: OfficeRoom, tmp_path: Path) -> None:
    """Facts of a folder that do not belong to those of the office stay as they are."""
    where = second(room, tmp_path / "second")
    with FactStore(where.facts) as store:
        store.append(new(Entered, team="Zoe"))
    with following(where, Near(room)) as follower, pytest.raises(UserError, match="new folder"):
        follower.step()
    assert machine.read(where.machine) == Machine()
    with FactStore(where.facts) as store:
        assert len(store.facts()) == 1


def test_a_contest_file_that_can_not_be_used_here_is_told(
    room: OfficeRoom, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A wrong contest file is told once and not taken; everything else is copied."""
    where = second(room, tmp_path / "second")
    before = where.file.read_bytes()
    room.file.write_bytes(before.replace(b"round-robin", b"square-robin"))
    with following(where, Near(room)) as follower:
        follower.step()
        follower.step()
        assert capsys.readouterr().out.count("standby.bad-contest") == 1
        assert where.file.read_bytes() == before
        assert where.secrets.exists()
        room.file.write_bytes(before + b"# later\n")
        follower.step()
        assert where.file.read_bytes() == before + b"# later\n"


def test_seals_open_with_the_token_for_their_purpose() -> None:
    """Nothing but the same token and purpose opens a message, and no byte of it can be changed."""
    sealing = Sealing("one token of many")
    sealed = sealing.seal(b"secret", b"this")
    assert b"secret" not in sealed
    assert Sealing("one token of many").open(sealed, b"this") == b"secret"
    changed = [
        bytes([*sealed[:at], sealed[at] ^ 1, *sealed[at + 1 :]]) for at in range(len(sealed))
    ]
    for wrong in (*changed, b"", sealed[:11], sealed[:-1]):
        with pytest.raises(BadSeal):
            sealing.open(wrong, b"this")
    for other, purpose in ((sealing, b"that"), (Sealing("another token"), b"this")):
        with pytest.raises(BadSeal):
            other.open(sealed, purpose)


def test_strangers_read_and_learn_nothing(room: OfficeRoom) -> None:
    """Without the token a request is refused; an answer shows no secret to whoever listens."""
    stranger = Sealing("the token of nobody")
    asked = PartAsk(generation=0, kind="file", name="secrets", offset=0)
    for payload in (b"", b"x" * 100, encode(asked), stranger.seal(encode(asked), REQUEST)):
        assert isinstance(room.door.judge(payload), Refusal)
    step = StepAsk(generation=0, address="tcp/x:1", facts=0, last="", applications="")
    secrets = [room.where.secrets.read_bytes(), room.where.event_code.read_bytes()]
    secrets += [token for secret in secrets for token in secret.split(b'"') if len(token) > 8]
    for one in (asked, step, replace(asked, name="contest")):
        answer = room.door.judge(room.sealing.seal(encode(one), REQUEST))
        assert isinstance(answer, bytes)
        assert not any(secret in answer for secret in secrets)
    for name in ("../contest.toml", "/etc/passwd", "contest.toml", ""):
        for kind in ("file", "entry", "application"):
            with pytest.raises(LacksIt):
                Near(room).ask(PartAsk(generation=0, kind=kind, name=name, offset=0), OfficeThere)


def test_machines_find_each_other_over_the_network(room: OfficeRoom, tmp_path: Path) -> None:
    """A copy over Zenoh; then the second machine takes over, and the first one hears of it."""
    where = second(room, tmp_path / "second")
    with DeskService(room.door.judge) as service:
        stranger = Other(service.address, Sealing("the token of nobody"))
        with stranger, pytest.raises(OtherToken):
            stranger.ask(KnockAsk(generation=9), OfficeThere)
        with Other(service.address, room.sealing) as other:
            with following(where, other) as follower:
                follower.step()
            assert contents(where) == contents(room.where)
            assert [line.code for line in room.door.news()] == ["standby.copies"]
            with pytest.raises(UserError, match="still answers"):
                take_over(where.file)
            with FactStore(where.facts) as store:
                store.take_over()
                later = Tenure(where, generation(store.facts()))
            machine.save(where.machine, Machine(known=(service.address,)))
            room.tenure.check()
            with Lookout(later, room.sealing):
                later.check()
            with pytest.raises(Retired):
                room.tenure.check()
            room.tenure.hear(0)
            with pytest.raises(Retired):
                room.tenure.check()
    assert machine.read(room.where.machine).role == "retired"
    with Other(f"tcp/127.0.0.1:{free_port()}", room.sealing) as nobody, pytest.raises(NotThere):
        nobody.ask(KnockAsk(generation=0), OfficeThere)


def test_a_move_of_the_office_changes_nothing_else() -> None:
    """The contest that follows from the facts is the same, with its games in play."""
    cup = Cup()
    cup.won("cup:a1.1", ("t001", "t004"))
    cup.call("cup:a1.2", "north", ("t002", "t003"))
    before = cup.contest
    assert before.running
    cup.add(TakenOver)
    assert cup.contest == before


def test_an_office_that_comes_back_asks_first(room: OfficeRoom, tmp_path: Path) -> None:
    """A machine that knows who copied it finds the later office before it does anything."""
    with OfficeRoom(tmp_path / "later", room.file.read_text(), room.where.secrets) as later:
        later.store.append(new(TakenOver))
        later.tenure.generation = 1
        with DeskService(later.door.judge) as service:
            room.tenure.know(service.address)
            room.tenure.know(service.address)
            assert room.tenure.known == (service.address,)
            back = Tenure(room.where, 0)
            with Lookout(back, room.sealing), pytest.raises(Retired):
                back.check()
            later.tenure.check()


def test_a_machine_takes_over_once(room: OfficeRoom, tmp_path: Path) -> None:
    """From a whole copy, after the copying program has ended; doing it again changes nothing."""
    where = second(room, tmp_path / "second")
    with pytest.raises(UserError, match="nothing can be taken over"):
        take_over(where.file)
    near = Near(room, 1)
    near.address = f"tcp/127.0.0.1:{free_port()}"
    with following(where, near) as follower, pytest.raises(NotThere):
        follower.step()
    with pytest.raises(UserError, match="never whole"):
        take_over(where.file)
    near.answers = 1_000_000
    with following(where, near) as follower:
        follower.step()
        machine.save(where.machine, Machine(role="copy", office=near.address, ends=True))
        near.answers = 0  # it ends also while the office is gone
        with pytest.raises(CopyingEnded):
            follower.step()
        machine.save(where.machine, Machine(role="copy", office=near.address, copied_ms=1))
    said = take_over(where.file)
    assert said is not None
    assert said.code == "standby.takes-over"
    assert machine.read(where.machine) == Machine(known=(near.address,))
    with FactStore(where.facts) as store:
        store.append(new(Closed))
        facts = store.facts()
    assert facts[:5] == room.store.facts()
    assert [fact.id for fact in facts[5:]] == ["f6.1", "f7.1"]
    assert take_over(where.file) is None
    machine.save(where.machine, Machine(role="retired"))
    with pytest.raises(Retired):
        take_over(where.file)


def test_matches_that_no_call_knows_are_set_aside(room: OfficeRoom, tmp_path: Path) -> None:
    """No court goes on with a match that was called after the facts were copied.

    A record without a header yet is left to the court, and so is an open match.
    """
    (*_, call) = (fact for fact in room.store.facts() if isinstance(fact, Called))
    records = tmp_path / "records"
    for number, called in enumerate((call.id, "f99", "open.1"), 1):
        assigned = Assigned(call=called, fixture=say("fixture.waiting"), seats=())
        setup = Setup(
            match_id=f"20260501-100000-north-00{number}",
            court="north",
            match=number,
            arena="othello",
            settings={},
            limits={},
            assigned=assigned,
        )
        header = Header(
            format=FORMAT,
            match_id=setup.match_id,
            segment=0,
            first_beat=0,
            started="",
            versions={},
            setup=setup,
        )
        RecordWriter(records, header).leave()
    young = segment_path(records, OPEN, 0)
    young.write_bytes(b"no header")
    kept, aside, friendly = sorted(path.name for path in records.iterdir() if path != young)
    set_aside(records, room.store.facts())
    assert {path.name for path in records.iterdir()} == {
        kept,
        f"{aside}.left",
        friendly,
        young.name,
    }
