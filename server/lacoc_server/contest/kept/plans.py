"""The stages of a contest, as its contest file plans them."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path
from typing import Annotated, Any, get_args

import msgspec

from lacoc_arenas import arena as arenas
from lacoc_arenas.arena import Arena
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.contest import Contest, compute
from lacoc_server.contest.league.facts import (
    STAGE_NAME,
    AnyFact,
    Draw,
    Planned,
    StageSettings,
    Unplanned,
    new,
)
from lacoc_server.contest.league.formats.format import Stage
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.standings import TIE_BREAKS
from lacoc_shared.contest.courts import beside, wrong_in
from lacoc_shared.contest.file import ContestFile, wrong_entries
from lacoc_shared.contest.wrong_value import convert, place_and_words
from lacoc_shared.mistakes import Gathered, UserError, text_of
from lacoc_shared.words import LANGUAGES, Phrase, say

_USUAL_ARENA = "othello"
_SETTINGS = StageSettings.__struct_fields__
_DRAWS = get_args(Draw)
_AT_ONCE = _DRAWS[0]
_TEAMS_FOR_THIRD = 4
"""Least number of teams with which there is a match for place 3: with fewer, no two teams lose a
semi-final."""


_Break = Annotated[float, msgspec.Meta(ge=0, le=31_536_000)]
"""Length of a break [s]: at most a year."""


class _StageEntries(msgspec.Struct, frozen=True, kw_only=True):
    """Entries of a stage's table in the contest file that are not in `StageSettings`."""

    format: str
    after: str = ""
    title: Any = ""
    """One text, or one for each language."""
    draw: str = _AT_ONCE
    teams: int = 0
    arena: str = _USUAL_ARENA
    settings: dict[str, Any] = {}
    """Entries that replace those of the arena file."""
    apart: bool = False
    break_s: _Break = 0.0
    final_court: str = ""
    final_break_s: _Break = 0.0


OPEN = "open"
"""Format of a stage of friendly matches: it has no draw, no standings and no end."""


class _OpenTable(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """All entries that the table of an open stage can have in the contest file."""

    format: str
    arena: str = _USUAL_ARENA
    settings: dict[str, Any] = {}


@dataclass(frozen=True)
class OpenStage:
    """A stage of friendly matches, which courts play while they have no game of another stage."""

    arena: str
    arena_settings: dict[str, Any]
    """Entries that replace those of the arena file."""
    limits: dict[str, float]
    seats: tuple[str, ...]
    """Names of the arena's seats."""


def open_stage(contest: ContestFile, file: Path) -> OpenStage | None:
    """Read the open stage of a contest file; None: there is none.

    Args:
        contest: the contest file.
        file: its path, for messages.

    Raises:
        UserError: if a setting of the stage is wrong, or there are two open stages.
    """
    found = {name: one for name, one in contest.stages.items() if one.get("format") == OPEN}
    if not found:
        return None
    if len(found) > 1:
        wrong = say("contest.one-open-stage", stages=[text_of(name) for name in found])
        raise wrong_entries(file, UserError(wrong))
    ((name, entries),) = found.items()
    try:
        table = convert(entries, _OpenTable, f"stage.{text_of(name)}")
        path = beside(file.resolve().parent, table.arena)
        arena = arenas.load(path, table.settings)
    except UserError as error:
        raise wrong_entries(file, error) from None
    seats = tuple(seat.id for seat in arena.seats)
    return OpenStage(path, table.settings, contest.limits, seats)


def plans(contest: ContestFile, file: Path) -> list[Planned]:
    """Read the stages of a contest file, without the open stage.

    Args:
        contest: the contest file.
        file: its path, for messages.

    Raises:
        UserError: if settings are wrong; the message names the first wrong one of each stage.
    """
    wrong = Gathered()
    found: dict[str, Planned | None] = {}
    for name, table in contest.stages.items():
        if table.get("format") == OPEN:
            continue
        plan = None
        with wrong:
            plan = _read(name, table, contest, found, file.resolve().parent)
        found[name] = plan
    try:
        wrong.check()
    except UserError as error:
        raise wrong_entries(file, error) from None
    return [plan for plan in found.values() if plan is not None]


def _read(
    name: str,
    table: Mapping[str, Any],
    contest: ContestFile,
    before: Mapping[str, Planned | None],
    folder: Path,
) -> Planned:
    """Read one stage.

    Args:
        name: its name.
        table: its table in the file.
        contest: the contest file.
        before: the stages before it in the file, by name; None: that stage has wrong settings.
        folder: folder of the file; the path of an arena starts there.

    Raises:
        UserError: at the first wrong setting.
    """
    try:
        if not re.fullmatch(STAGE_NAME, name):
            raise UserError(say("contest.stage-name"))
        plan = _plan(name, table, contest.limits)
        _check(plan, before, [*contest.courts])
        game(plan, folder)
    except msgspec.ValidationError as error:
        where, said = place_and_words(error)
        raise UserError(
            say("contest.bad-stage", stage=text_of(name), where=where or None, error=said)
        ) from None
    except UserError as error:
        raise wrong_in(f"stage.{text_of(name)}", error) from None
    return plan


def doubts(stages: Sequence[Planned]) -> Iterator[Phrase]:
    """Yield warnings about knockouts in which teams of one earlier group can meet again."""
    known = {plan.stage: plan for plan in stages}
    for plan in stages:
        before = known.get(plan.after)
        if before is None or before.format != "round-robin" or not FORMATS[plan.format].decisive:
            continue
        if before.settings.groups == 1:
            yield say("contest.all-meet-again", stage=plan.stage, after=plan.after)
        elif not plan.apart:
            yield say("contest.may-meet-again", stage=plan.stage, after=plan.after)


def game(plan: Planned, folder: Path) -> Arena:
    """Load the arena of a stage.

    Args:
        plan: the plan of the stage.
        folder: folder of the contest file; the path of an arena starts there.

    Raises:
        UserError: if it is not installed, its settings are wrong, or it has not two seats.
    """
    arena = arenas.load(beside(folder, plan.arena), plan.arena_settings)
    if len(arena.seats) != 2:
        raise UserError(say("contest.not-for-two", arena=plan.arena))
    return arena


def not_for_courts(stages: Iterable[Planned | OpenStage | None]) -> Phrase | None:
    """Return a sentence if the game of a stage is in a folder; None: all games are installed.

    Courts play only installed games: code must not run because the office names its folder.
    """
    games = dict.fromkeys(stage.arena for stage in stages if stage is not None)
    folders = [name for name in games if not arenas.is_installed(name)]
    return say("contest.game-in-folder", folders=folders) if folders else None


def note_plans(store: FactStore, wanted: list[Planned]) -> None:
    """Append facts: plans that are new or have changed, and stages that are not planned any more.

    Raises:
        UserError: if the plan of a stage that is drawn has changed; nothing is appended then.
    """

    def decision(facts: tuple[AnyFact, ...]) -> Iterator[AnyFact]:
        contest = compute(facts, FORMATS)
        check_drawn(contest, wanted)
        drawn = {view.name: view.plan for view in contest.stages}
        planned = [plan.stage for plan in contest.planned]
        names = [plan.stage for plan in wanted if plan.stage not in drawn]
        # Stages are drawn in the order of their plans, so from the first other name on all are new.
        same = sum(
            1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(planned, names, strict=False))
        )
        for stage in planned[same:]:
            yield new(Unplanned, stage=stage)
        known = {**{plan.stage: plan for plan in contest.planned[:same]}, **drawn}
        for plan in wanted:
            if plan.stage not in known or _content(known[plan.stage]) != _content(plan):
                yield plan

    store.decide(decision)


def check_drawn(contest: Contest, wanted: Iterable[Planned]) -> None:
    """Check that the plans of all drawn stages are still as they were at the draw.

    Args:
        contest: the contest.
        wanted: the plans of the contest file.

    Raises:
        UserError: at the first plan that has changed; the message names the first entry of the
            contest file that differs.
    """
    drawn = {view.name: view.plan for view in contest.stages}
    for plan in wanted:
        before, now = (_entries(_content(one)) for one in (drawn.get(plan.stage, plan), plan))
        for entry, value in now.items():
            if value != before[entry]:
                raise UserError(say("contest.stage-began", stage=plan.stage, entry=entry))


def _entries(plan: Planned) -> dict[str, Any]:
    """Return what a plan has taken from the contest file, by the place of the entry or table."""
    table = msgspec.structs.asdict(plan)
    limits, of_arena = table.pop("limits"), table.pop("arena_settings")
    table = {**table, **msgspec.structs.asdict(plan.settings), "settings": of_arena}
    stage = {f"stage.{plan.stage}.{entry}": value for entry, value in table.items()}
    return {**stage, "limits": limits}


def _plan(name: str, table: Mapping[str, Any], limits: Mapping[str, float]) -> Planned:
    own = {key: value for key, value in table.items() if key in _StageEntries.__struct_fields__}
    rest = {key: value for key, value in table.items() if key not in own}
    if unknown := [key for key in rest if key not in _SETTINGS]:
        known = [*_StageEntries.__struct_fields__, *_SETTINGS]
        raise UserError(say("contest.stage-entry", entry=text_of(unknown[0]), known=known))
    stage = msgspec.convert(own, _StageEntries)
    if stage.draw not in _DRAWS:
        raise UserError(say("contest.stage-draw", draw=text_of(stage.draw), known=[*_DRAWS]))
    if stage.format not in FORMATS:
        raise UserError(say("league.unknown-format", format=stage.format, known=[*FORMATS, OPEN]))
    read = FORMATS[stage.format].settings
    if idle := [key for key in rest if key not in read]:
        known = [key for key in _SETTINGS if key in read]
        raise UserError(say("contest.stage-idle", entry=idle[0], format=stage.format, known=known))
    title = stage.title
    if isinstance(title, str):
        title = dict.fromkeys(LANGUAGES, title) if title else {}
    elif not isinstance(title, dict) or {*title} != {*LANGUAGES}:
        raise UserError(say("contest.stage-languages"))
    plan = new(
        Planned,
        stage=name,
        title=title,
        format=stage.format,
        settings=msgspec.convert(rest, StageSettings),
        after=stage.after,
        draw=stage.draw,
        apart=stage.apart,
        met_apart=stage.apart and bool(stage.after),
        break_s=stage.break_s,
        final_court=stage.final_court,
        final_break_s=stage.final_break_s,
        teams=stage.teams,
        arena=stage.arena,  # a path as it is written: the folder of the contest may be moved
        arena_settings=stage.settings,
        limits=dict(limits),
    )
    return msgspec.convert(msgspec.to_builtins(plan), Planned)  # checks the lengths and patterns


def _check(plan: Planned, before: Mapping[str, Planned | None], courts: Sequence[str]) -> None:
    """Check that the names in a plan exist, and that its settings fit each other.

    Args:
        plan: the plan of a stage.
        before: the plans of the stages before it, by name; None: that stage has wrong settings.
        courts: names of the contest's courts.

    Raises:
        UserError: at the first name that is not known, or the first setting that does not fit.
    """
    if plan.after and plan.after not in before:
        raise UserError(say("contest.stage-after", after=plan.after, before=[*before] or None))
    if plan.teams == 1:
        raise UserError(say("contest.one-team"))
    most = _most_teams(plan, before)
    if plan.settings.third_place and 0 < most < _TEAMS_FOR_THIRD:
        raise UserError(say("contest.no-third-place", teams=most, least=_TEAMS_FOR_THIRD))
    how = FORMATS[plan.format]
    if plan.apart and how.rounds(Stage(name="", settings=plan.settings, entries=("", ""))):
        raise UserError(say("contest.not-apart", format=plan.format))
    if (plan.final_court or plan.final_break_s) and not how.decisive:
        raise UserError(say("contest.no-final", format=plan.format))
    if plan.final_court and plan.final_court not in courts:
        raise UserError(say("desk.no-court", court=plan.final_court, courts=[*courts]))
    for code in plan.settings.tie_breaks:
        if code not in TIE_BREAKS:
            raise UserError(say("league.unknown-tie-break", code=code, known=[*TIE_BREAKS]))


def _most_teams(plan: Planned | None, before: Mapping[str, Planned | None]) -> int:
    """Return how many teams a stage can have at most by its plans; 0: the plans set no limit."""
    if plan is None:
        return 0
    earlier = _most_teams(before[plan.after], before) if plan.after else 0
    return min(filter(None, (plan.teams, earlier)), default=0)


def _content(plan: Planned) -> Planned:
    return msgspec.structs.replace(plan, id="new", number=0, at_ms=0)
