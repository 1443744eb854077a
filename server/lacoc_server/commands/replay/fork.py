"""`lacoc replay fork`: go on with a recorded match from one of its beats."""

from collections.abc import Iterator, Sequence
from concurrent.futures import Future
from pathlib import Path
from typing import Annotated, Any

import msgspec
import typer

from lacoc_arenas import brains
from lacoc_server.simulate.forks.fork import Forked
from lacoc_server.simulate.forks.jobs import (
    ForkJob,
    attempt_fork,
    changes_of,
    opened_record,
    play_fork,
)
from lacoc_server.simulate.forks.origin import ForkSource
from lacoc_server.simulate.forks.script import Script
from lacoc_server.simulate.workers import WorkerDied, Workers
from lacoc_shared.command import options, screen
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.files import packed_path, record_paths
from lacoc_shared.record.forked import how
from lacoc_shared.record.schema import Result
from lacoc_shared.seat import Phase
from lacoc_shared.words import Phrase, render, say

app = typer.Typer()

_LONGEST_S = 86_400.0
"""Longest time that a fork may take [s]."""


@app.command(name="fork")
def fork_command(
    file: Annotated[Path, typer.Argument(help="The record: a .mcap file.")],
    beat: Annotated[
        int,
        typer.Option(
            metavar="N", help="First beat that may differ from the record (a beat is 20 ms)."
        ),
    ],
    take_back: Annotated[
        int | None,
        typer.Option(metavar="EVENT", help="Take back the event with this number."),
    ] = None,
    restart: Annotated[
        list[str] | None,
        typer.Option(metavar="SEAT", help="Put the robot of this seat back at its start place."),
    ] = None,
    keys: Annotated[
        list[str] | None,
        typer.Option(
            metavar="SEAT=FILE",
            help="Keys of a seat from a script, in the form that 'lacoc play' reads from a pipe: "
            "'1.5 3' presses 3 after 1.5 s.",
        ),
    ] = None,
    players: Annotated[
        str | None,
        typer.Option(
            metavar="A,B",
            help="Who plays from that beat on, in the order of the seats: a bot, your_bot.py, or - "
            "for the recorded keys.",
        ),
    ] = None,
    times: Annotated[
        int,
        typer.Option(
            metavar="K",
            help="How many forks are played. Bots react a little later, by times that differ from "
            "fork to fork. More than one fork also gives odds.",
            min=1,
        ),
    ] = 1,
    seconds: Annotated[
        float | None,
        typer.Option(
            help="How many seconds the fork goes on at most; by default until play ends.",
            min=0.1,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Folder for the records of forks; by default that of the record. With --times, "
            "records are written only if this option is given.",
        ),
    ] = None,
    arena: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            help="The folder of a game that is not installed; its code is run.",
            exists=True,
            file_okay=False,
        ),
    ] = None,
    jobs: options.Jobs = None,
    json: options.Json = False,
) -> None:
    """Go on with a recorded match from one of its beats, as a court would have.

    Without a change, the fork is the record, bit for bit. With --take-back the match is halted,
    the event taken back and the match resumed, as a referee does it; recorded keys are delayed by
    the same time.

    The fork is written as a record of its own. It names the match, the beat and the record that it
    is a fork of, and is nobody's official result.
    """
    source = opened_record(str(record_paths(file)[0]))
    if source.record.warning:
        screen.warn(source.record.warning)
    bots = tuple(players.split(",")) if players else ()
    if times > 1 and not any(name != brains.RECORDED for name in bots):
        raise UserError(say("fork.times-need-bots"))
    base = ForkJob(
        file=str(record_paths(file)[0]),
        beat=beat,
        take_back=take_back,
        restart=tuple(restart or ()),
        scripts=_scripts(keys or ()),
        bots=bots,
        seconds=seconds,
        arena=None if arena is None else str(arena),
    )
    if times == 1 or out is not None:
        base = msgspec.structs.replace(base, folder=str(out or file.parent))
    forks = list(_forks(base, source, times))
    played: list[Forked] = []
    for job, forked in _played(forks, jobs):
        played.append(forked)
        if json:
            screen.print_json(_told(source, job, forked))
        elif times == 1:
            _show(source, job, forked)
        elif forked.record:
            screen.show(str(forked.record))
    if times > 1:
        _show_odds(source, base, played, json)


def _scripts(given: Sequence[str]) -> dict[str, Script]:
    scripts: dict[str, Script] = {}
    for one in given:
        seat, mark, file = one.partition("=")
        if not (mark and seat and file):
            raise UserError(say("fork.bad-keys", given=one))
        try:
            text = Path(file).expanduser().read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            why = getattr(error, "strerror", None) or str(error)
            raise UserError(say("command.cannot-read", path=file, why=why)) from None
        scripts[seat] = Script(file, tuple(text.splitlines()))
    return scripts


def _forks(base: ForkJob, source: ForkSource, times: int) -> Iterator[ForkJob]:
    """Yield each fork, with an id that no other record in its folder has."""
    number = 0
    for variant in range(1, times + 1) if times > 1 else (0,):
        number += 1
        while base.folder and packed_path(Path(base.folder), _id(base, source, number)).exists():
            number += 1
        match_id = _id(base, source, number)
        yield msgspec.structs.replace(base, variant=variant, match_id=match_id)


def _id(base: ForkJob, source: ForkSource, number: int) -> str:
    return f"fork-{number}-at-{base.beat}-of-{source.match_id}"


def _played(forks: Sequence[ForkJob], jobs: int | None) -> Iterator[tuple[ForkJob, Forked]]:
    if len(forks) == 1:
        with screen.results_only():
            forked = play_fork(forks[0])
        yield forks[0], forked
        return
    with Workers(jobs, background=True, limit_s=_LONGEST_S) as workers, screen.progress() as bar:
        task = bar.add_task(render(say("fork.forks")), total=len(forks))
        futures: list[Future[Forked | Phrase]] = [
            workers.submit(attempt_fork, job) for job in forks
        ]
        for job, future in zip(forks, futures, strict=True):
            try:
                found = future.result()
            except WorkerDied:
                raise UserError(say("fork.died", beat=job.beat)) from None
            if isinstance(found, Phrase):
                raise UserError(found)
            bar.advance(task)
            yield job, found


def _told(source: ForkSource, job: ForkJob, forked: Forked) -> dict[str, Any]:
    return {
        "kind": "fork",
        "match_id": job.match_id,
        "beat": job.beat,
        "variant": job.variant,
        "made": changes_of(job, source),
        "beats": forked.beats,
        "phase": forked.phase.name,
        "decided_beat": forked.decided_beat,
        "changes": forked.changes,
        "left_out": forked.left_out,
        "result": forked.result,
        "record": str(forked.record) if forked.record else None,
    }


def _show(source: ForkSource, job: ForkJob, forked: Forked) -> None:
    screen.show(say("fork.made", match=source.match_id, beat=job.beat))
    screen.show(say("fork.how", how=how(changes_of(job, source))))
    screen.show(_ending(forked.result, forked.phase))
    was = source.record.result
    if was is not None:
        screen.show(say("fork.was", ending=_ending(was, Phase.FINISHED)))
    if forked.decided_beat is not None and forked.decided_beat != job.beat:
        screen.note(say("fork.decided-at", beat=forked.decided_beat))
    for change in forked.changes:
        screen.show(change)
    if forked.left_out:
        screen.note(say("fork.left-out", count=forked.left_out))
    if forked.record:
        screen.show(str(forked.record))


def _ending(result: Result, phase: Phase) -> Phrase:
    pairs = zip(result.teams, result.scores, strict=True)
    scores = [say("info.score", team=team, score=score) for team, score in pairs]
    if not result.computed:
        return say("fork.goes-on", scores=scores, phase=phase.word, clock_s=result.clock_s)
    return say("fork.ending", scores=scores, winner=result.computed, why=result.reason)


def _show_odds(source: ForkSource, base: ForkJob, played: Sequence[Forked], json: bool) -> None:
    made = changes_of(base, source)
    over = [one for one in played if one.result.computed]
    won = {
        seat: sum(one.result.computed == seat for one in over) for seat in (*source.seats, "draw")
    }
    others = [one.result.scores for one in played if not one.result.computed]
    leads = [scores[0] - max(scores[1:], default=0) for scores in others]
    if json:
        told = {"kind": "odds", "beat": base.beat, "forks": len(played), "won": won, "leads": leads}
        screen.print_json({**told, "made": made})
        return
    screen.show(say("fork.odds", beat=base.beat, forks=len(played)))
    screen.show(say("fork.how", how=how(made)))
    for seat, count in won.items():
        screen.show(say("fork.won", seat=seat, count=count, percent=100 * count / len(played)))
    if leads:
        said = [f"{lead:+}" for lead in leads]
        screen.show(say("fork.not-over", count=len(leads), leads=said))
