"""Writes what the pages take from the Python code: types, texts and the legs of sample robots.

    python client/web/make_wire.py

src/core/wire.gen.ts has the court's messages as types, from the Python structs,
src/core/desk.gen.ts those of an office's desk, src/core/contest/sheet.gen.ts the sheet of a
contest, src/core/leg/samples.gen.ts the legs of the sample robots, public/Loco-data.txt the sample
gait. src/i18n/texts/LANGUAGE/GROUP.json has what pages say: their own messages (texts/*.toml) and
the phrases of programs, without those of commands. A page loads its groups in one language. A test
fails when a file does not fit the Python code any more.
"""

import json
import types
import typing
from collections.abc import Callable, Mapping
from enum import IntEnum
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
import page_texts
import sample_legs

from lacoc_arenas import brains
from lacoc_client.play import simulation
from lacoc_client.web.gateway import scores
from lacoc_client.web.gateway.page import TRY_LATER
from lacoc_client.web.gateway.pieces.cutter import PIECE_MS
from lacoc_client.web.gateway.pieces.route import PiecesNow
from lacoc_client.web.gateway.viewer import LEAST_HZ, MOST_HZ, USUAL_HZ
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_client.web.office import links
from lacoc_client.workshop.classroom import cards, tournament
from lacoc_client.workshop.design import folder, requests
from lacoc_client.workshop.design.learning import diary, learner, rules
from lacoc_client.workshop.design.table import FileRow, FileTable
from lacoc_client.workshop.phases import evidence, facts
from lacoc_robots.library import sample_gait_files
from lacoc_server.contest.league import (
    contest,
    decided,
    draws,
    matches,
    pairing,
    rating,
    sheet,
    standings,
)
from lacoc_server.contest.league import facts as league_facts
from lacoc_server.contest.league.formats import format as formats
from lacoc_server.contest.league.timetable import breaks
from lacoc_server.doors.inbox import NAME_MAX
from lacoc_server.match.referee import MAX_CLOCK_S, MAX_FREEZE_S, MAX_POINTS
from lacoc_server.trial.reasons import legs
from lacoc_shared import decisions, messages, mistakes, studio
from lacoc_shared.codec import message_hash
from lacoc_shared.gait.cells import MAX_KEYS, MAX_POSTURES_PER_KEY
from lacoc_shared.gait.tables import Level
from lacoc_shared.keyspace import JOIN_MAX_BYTES
from lacoc_shared.messages import desk, office
from lacoc_shared.record import schema
from lacoc_shared.seat import (
    BEAT_S,
    BEATS_PER_S,
    REPEATS_HZ,
    RESTART_KEY,
    SILENT_AFTER_S,
    WHY_NO,
    No,
    Phase,
    SeatFlag,
)
from lacoc_shared.words import LANGUAGES
from lacoc_shared.words.phrase import Phrase
from lacoc_shared.words.render import (
    DECIMALS,
    DEEPEST,
    LARGEST,
    LONGEST_LIST,
    LONGEST_TEXT,
)

_SOURCE = Path(__file__).parent / "src"

STRUCTS = (
    messages.SeatFrame,
    messages.Frame,
    messages.Event,
    messages.SheetSeat,
    messages.MarkerInfo,
    messages.Sheet,
    messages.SceneBody,
    messages.SceneGeom,
    messages.Scene,
    messages.Gains,
    messages.SeatHealth,
    messages.LinkVerdict,
    messages.HealthVerdict,
    messages.Health,
    messages.TryOutReply,
    messages.DecisionReply,
    messages.Outlook,
    mistakes.Mistake,
    messages.SentFile,
    office.AssignedSeat,
    office.Assigned,
    office.Whereabouts,
    schema.ForkSeat,
    schema.ForkChanges,
    schema.Origin,
    schema.Setup,
    schema.Header,
    schema.Result,
    studio.LegShape,
    studio.RobotReply,
    studio.CellPlace,
    studio.Sentence,
    studio.TrialReply,
    studio.Progress,
    studio.Weight,
    studio.CellChange,
    studio.RepairTold,
    studio.CoachReply,
    studio.GaitDifference,
    studio.OtherGait,
    studio.MapCell,
    studio.MapReply,
    studio.VariantsReply,
    FileRow,
    FileTable,
    folder.FolderFile,
    rules.StudentRules,
    diary.AskedQuestion,
    diary.PhaseState,
    diary.Phases,
    evidence.TookStep,
    cards.Card,
    tournament.ClassMatch,
    simulation.PlayerStanding,
    tournament.LeftOut,
    tournament.TournamentState,
    learner.Judged,
    learner.EditReply,
    learner.AnswerReply,
    learner.CheckReply,
    PiecesNow,
)
CONTEST_STRUCTS = (
    draws.Team,
    league_facts.StageSettings,
    league_facts.Planned,
    league_facts.Called,
    formats.Stage,
    pairing.Entrant,
    pairing.WinnerOf,
    pairing.LoserOf,
    pairing.Bye,
    pairing.Pairing,
    matches.CountedGame,
    matches.ContestMatch,
    standings.Standing,
    standings.Table,
    contest.StageView,
    contest.Unused,
    decided.Decided,
    rating.Rating,
    sheet.Coming,
    sheet.Later,
    contest.Day,
    breaks.Break,
    league_facts.Announced,
    sheet.ContestSheet,
)
DESK_STRUCTS = (
    desk.TeamFiles,
    *typing.get_args(desk.AnyRequest),
    desk.EventInfo,
    desk.OwnEntry,
    desk.TeamRow,
    desk.CourtRow,
    desk.MatchMove,
    desk.Slot,
    desk.ToDraw,
    desk.Undrawable,
    desk.ShiftState,
    desk.DayState,
    desk.OfficeView,
    desk.Overviewed,
    desk.Effect,
    desk.CourtPlan,
    desk.TeamPicture,
    desk.Said,
    links.TeamLink,
    links.RefereeLink,
    links.SeatLink,
    links.StaffLink,
    links.ContestLinks,
    scores.CourtScore,
)
ENUMS: tuple[type[IntEnum] | type[SeatFlag], ...] = (Phase, SeatFlag, No, Level)
CONSTANTS: dict[str, float | str] = {
    "PROTOCOL": messages.PROTOCOL,
    "RECORD_FORMAT": schema.FORMAT,
    "RECORD_PROFILE": schema.PROFILE,
    "BEAT_S": BEAT_S,
    "BEAT_NS": schema.BEAT_NS,
    "BEATS_PER_S": BEATS_PER_S,
    "REPEATS_HZ": REPEATS_HZ,
    "SILENT_AFTER_S": SILENT_AFTER_S,
    "RESTART_KEY": RESTART_KEY,
    "RECORDED": brains.RECORDED,
    "ROOT_FLOATS": messages.ROOT_FLOATS,
    "TRY_OUT_TICKS": messages.TRY_OUT_TICKS,
    "TRY_OUT_ASKED_TICKS": messages.TRY_OUT_ASKED_TICKS,
    "TRY_OUT_KEYS": messages.TRY_OUT_KEYS,
    "HASH_BYTES": len(message_hash(b"")),
    "JOIN_MAX_BYTES": JOIN_MAX_BYTES,
    "NAME_MAX": NAME_MAX,
    "MAX_KEYS": MAX_KEYS,
    "MAX_POSTURES_PER_KEY": MAX_POSTURES_PER_KEY,
    "MAX_FREEZE_S": MAX_FREEZE_S,
    "MAX_CLOCK_S": MAX_CLOCK_S,
    "MAX_POINTS": MAX_POINTS,
    "LEAST_HZ": LEAST_HZ,
    "USUAL_HZ": USUAL_HZ,
    "MOST_HZ": MOST_HZ,
    "TRY_LATER": TRY_LATER,
    "PIECE_MS": PIECE_MS,
    "DESIGN_MAX_BYTES": requests.REQUEST_BYTES,
    "PARSE_MAX_BYTES": requests.PARSE_BYTES,
    "SAME_MM_S": facts.SAME_MM_S,
    "SAME_SHARE": facts.SAME_SHARE,
    "STRAIGHT_DEG_S": facts.STRAIGHT_DEG_S,
    "SEAM_DEG": legs.SEAM_DEG,
    "SEAM_RATIO": legs.SEAM_RATIO,
}
LIMITS: dict[str, float] = {
    "DEEPEST": DEEPEST,
    "LONGEST_LIST": LONGEST_LIST,
    "LONGEST_TEXT": LONGEST_TEXT,
    "LARGEST": LARGEST,
    "DECIMALS": DECIMALS,
}
"""Limits for turning a phrase (code and values) into words, which pages must keep too."""
_IMPORTS = {Phrase: "phrase"}
"""Types that are written by hand in TypeScript, with their module in src/core."""
_SIMPLE = {int: "number", float: "number", str: "string", bool: "boolean", bytes: "Uint8Array"}


def wire_types() -> str:
    """Return the types and constants of messages: the text of src/core/wire.gen.ts."""
    parts = [*_head("./"), _constants(CONSTANTS)]
    parts += [_enum(kind) for kind in ENUMS]
    names = ", ".join(f'"{name}"' for name in messages.MARKER_STATES)
    parts += [f"export const MARKER_STATES = [{names}] as const;", _kinds(), _why_no()]
    parts += [_interface(kind) for kind in STRUCTS]
    parts += [_field_names(kind) for kind in STRUCTS if kind.__struct_config__.array_like]
    parts += [_decisions(), _need_a_reason()]
    return "\n\n".join(parts) + "\n"


def sheet_types() -> str:
    """Return the types of the sheet of a contest: the text of src/core/contest/sheet.gen.ts."""
    parts = [*_head("../"), _constants({"VERSION": sheet.VERSION})]
    return "\n\n".join([*parts, *map(_interface, CONTEST_STRUCTS)]) + "\n"


def desk_types() -> str:
    """Return the types of messages between pages and a desk: the text of src/core/desk.gen.ts."""
    names = " | ".join(kind.__name__ for kind in typing.get_args(desk.AnyRequest))
    parts = [
        *_head("./"),
        'import type { Mistake, SentFile } from "./wire.gen";',
        _constants({"TEAM_NAME_MAX": desk.TEAM_NAME_MAX}),
        *map(_interface, DESK_STRUCTS),
        f"export type AnyRequest = {names};",
    ]
    return "\n\n".join(parts) + "\n"


def _head(core: str) -> list[str]:
    """Return the first lines of a written file; `core`: path from its folder to src/core."""
    imports = [f'import type {{ {k.__name__} }} from "{core}{m}";' for k, m in _IMPORTS.items()]
    return [
        "// Made by client/web/make_wire.py from the Python structs; not edited by hand.",
        *imports,
    ]


def _constants(constants: Mapping[str, float | str]) -> str:
    return "\n".join(
        f"export const {name} = {json.dumps(value) if isinstance(value, str) else f'{value:.15g}'};"
        for name, value in constants.items()
    )


def _kinds() -> str:
    names = "".join(f'  "{kind.name.lower()}",\n' for kind in MessageKind)
    return (
        "/** What a message of the gateway is, by its first byte; 0 is none. */\n"
        f'export const MESSAGE_KINDS = [\n  "",\n{names}] as const;'
    )


def _why_no() -> str:
    codes = "".join(f'  {int(no)}: "{why.code}",\n' for no, why in WHY_NO.items())
    return (
        "/** Why a key was refused, by its `No`: codes of the table. */\n"
        f"export const WHY_NO: Readonly<Record<number, string>> = {{\n{codes}}};"
    )


def _enum(kind: type[Any]) -> str:
    body = "\n".join(f"  {member.name}: {int(member)}," for member in kind)
    return f"export const {kind.__name__} = {{\n{body}\n}} as const;"


def _interface(kind: type[msgspec.Struct]) -> str:
    hints = typing.get_type_hints(kind)
    omits = kind.__struct_config__.omit_defaults
    config = kind.__struct_config__
    tag = [f"  {config.tag_field}: {json.dumps(config.tag)};"] if config.tag_field else []
    fields = [
        f"  {field.encode_name}{'?' if omits and not field.required else ''}: "
        f"{_type(hints[field.name])};"
        for field in msgspec.structs.fields(kind)
    ]
    body = "\n".join([*tag, *fields])
    return f"export interface {kind.__name__} {{\n{body}\n}}"


def _field_names(kind: type[msgspec.Struct]) -> str:
    names = "".join(f'  "{field.encode_name}",\n' for field in msgspec.structs.fields(kind))
    name = kind.__name__
    return (
        f"/** `{name}` is an array on the wire: the names of its places. */\n"
        f"export const {name.upper()}_FIELDS = [\n{names}] as const;"
    )


def _decisions() -> str:
    names = "".join(f'\n  | "{name}"' for name in decisions.DECISIONS)
    kinds = []
    for name, kind in decisions.DECISIONS.items():
        hints = typing.get_type_hints(kind)
        fields = "".join(
            f"; {field.encode_name}{'' if field.required else '?'}: {_type(hints[field.name])}"
            for field in msgspec.structs.fields(kind)
        )
        kinds.append(f'\n  | {{ type: "{name}"{fields} }}')
    return f"export type DecisionName ={names};\n\nexport type Decision ={''.join(kinds)};"


def _need_a_reason() -> str:
    names = "".join(
        f'  "{name}",\n' for name in decisions.DECISIONS if name in decisions.NEED_A_REASON
    )
    return (
        "/** Decisions that a referee gives a reason for. */\n"
        f"export const NEED_A_REASON: ReadonlySet<DecisionName> = new Set([\n{names}] as const);"
    )


def _type(hint: Any) -> str:
    if hint in _SIMPLE:
        return _SIMPLE[hint]
    if hint in (*STRUCTS, *CONTEST_STRUCTS, *DESK_STRUCTS) or hint in _IMPORTS:
        return str(hint.__name__)
    origin, args = typing.get_origin(hint), typing.get_args(hint)
    if origin is tuple:
        if args[-1] is Ellipsis:
            inner = _type(args[0])
            return f"({inner})[]" if " " in inner else f"{inner}[]"
        return f"[{', '.join(map(_type, args))}]"
    if origin is list:
        return f"{_type(args[0])}[]"
    if origin is dict:
        return f"Record<{_type(args[0])}, {_type(args[1])}>"
    if origin is typing.Literal:
        return " | ".join(json.dumps(value) for value in args)
    if origin in (typing.Union, types.UnionType):
        return " | ".join("null" if one is type(None) else _type(one) for one in args)
    return "unknown"


def limits() -> str:
    """Return the limits of a rendered phrase, as TypeScript."""
    return f"// Made by client/web/make_wire.py; not edited by hand.\n\n{_constants(LIMITS)}\n"


def sample_gait() -> str:
    """Return the sample's postures, which the pages offer to whoever has no gait yet."""
    postures = sample_gait_files("hexapod").postures
    assert postures is not None
    return bytes(postures.data).decode("utf-8")


FILES: dict[Path, Callable[[], str]] = {
    _SOURCE / "core" / "wire.gen.ts": wire_types,
    _SOURCE / "core" / "desk.gen.ts": desk_types,
    _SOURCE / "core" / "contest" / "sheet.gen.ts": sheet_types,
    _SOURCE / "core" / "leg" / "samples.gen.ts": sample_legs.samples,
    _SOURCE / "i18n" / "limits.gen.ts": limits,
    _SOURCE.parent / "public" / "Loco-data.txt": sample_gait,
} | {
    _SOURCE / "i18n" / "texts" / language / f"{group}.json": partial(
        page_texts.as_json, group, language
    )
    for group in page_texts.GROUPS
    for language in LANGUAGES
}

if __name__ == "__main__":
    for path, text in FILES.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text(), encoding="utf-8")
