"""Writes what the pages have of the Python code, as TypeScript.

    python client/web/make_wire.py

src/core/wire.gen.ts has the court's messages as types, from the Python structs, and
src/i18n/words.gen.ts the table of everything that is said, without what only commands say.
A test says when a file is behind.
"""

import json
import types
import typing
from enum import IntEnum
from pathlib import Path
from typing import Any

import msgspec

from lacoc_shared import decisions, messages, mistakes
from lacoc_shared.gait.tables import Level
from lacoc_shared.record import schema
from lacoc_shared.seat import (
    BEATS_PER_S,
    REPEATS_HZ,
    RESTART_KEY,
    SILENT_AFTER_S,
    No,
    Phase,
    SeatFlag,
)
from lacoc_shared.words.phrase import Phrase
from lacoc_shared.words.table import ON_PAGES, table

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
    messages.SeatHealth,
    messages.LinkVerdict,
    messages.HealthVerdict,
    messages.Health,
    messages.DecisionReply,
    mistakes.Mistake,
    schema.Setup,
    schema.Header,
    schema.Result,
)
ENUMS: tuple[type[IntEnum] | type[SeatFlag], ...] = (Phase, SeatFlag, No, Level)
CONSTANTS: dict[str, float] = {
    "PROTOCOL": messages.PROTOCOL,
    "BEATS_PER_S": BEATS_PER_S,
    "REPEATS_HZ": REPEATS_HZ,
    "SILENT_AFTER_S": SILENT_AFTER_S,
    "RESTART_KEY": RESTART_KEY,
    "ROOT_FLOATS": messages.ROOT_FLOATS,
}
_IMPORTS = {Phrase: "./phrase"}
"""Types that pages write themselves, with the module that has them."""
_SIMPLE = {int: "number", float: "number", str: "string", bool: "boolean", bytes: "Uint8Array"}


def wire_types() -> str:
    """The whole file."""
    parts = ["// Made by client/web/make_wire.py from the Python structs; not edited by hand."]
    parts += [f'import type {{ {k.__name__} }} from "{m}";' for k, m in _IMPORTS.items()]
    parts += ["\n".join(f"export const {k} = {n:g};" for k, n in CONSTANTS.items())]
    parts += [_enum(kind) for kind in ENUMS]
    names = ", ".join(f'"{name}"' for name in messages.MARKER_STATES)
    parts += [f"export const MARKER_STATES = [{names}] as const;"]
    parts += [_interface(kind) for kind in STRUCTS]
    parts += [_field_names(kind) for kind in STRUCTS if kind.__struct_config__.array_like]
    parts += [_decisions(), _need_a_reason()]
    return "\n\n".join(parts) + "\n"


def _enum(kind: type[Any]) -> str:
    body = "\n".join(f"  {member.name}: {int(member)}," for member in kind)
    return f"export const {kind.__name__} = {{\n{body}\n}} as const;"


def _interface(kind: type[msgspec.Struct]) -> str:
    hints = typing.get_type_hints(kind)
    omits = kind.__struct_config__.omit_defaults
    body = "\n".join(
        f"  {field.encode_name}{'?' if omits and not field.required else ''}: "
        f"{_type(hints[field.name])};"
        for field in msgspec.structs.fields(kind)
    )
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
    if hint in STRUCTS or hint in _IMPORTS:
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
    if origin in (typing.Union, types.UnionType):
        return " | ".join("null" if one is type(None) else _type(one) for one in args)
    return "unknown"


def words() -> str:
    """Write the table of what is said, for pages."""
    lines = "".join(
        f"  {json.dumps(code)}: {json.dumps([entry.en, entry.ja], ensure_ascii=False)},\n"
        for code, entry in table(ON_PAGES).items()
    )
    return (
        "// Made by client/web/make_wire.py from lacoc_shared/words/texts; not edited by hand.\n\n"
        "/** Each code with its templates: English, Japanese. */\n"
        f"export const WORDS: Record<string, readonly [string, string]> = {{\n{lines}}};\n"
    )


FILES = {
    _SOURCE / "core" / "wire.gen.ts": wire_types,
    _SOURCE / "i18n" / "words.gen.ts": words,
}

if __name__ == "__main__":
    for path, text in FILES.items():
        path.write_text(text(), encoding="utf-8")
