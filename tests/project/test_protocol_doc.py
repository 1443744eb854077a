"""docs/protocol.md describes every key expression, message and field of the code, and no others."""

import hashlib
import re
from pathlib import Path
from typing import get_args

import msgspec
import pytest

from lacoc_shared import inputs, keyspace, messages, mistakes, studio
from lacoc_shared.codec import encode, message_hash
from lacoc_shared.decisions import DECISIONS
from lacoc_shared.messages import office
from lacoc_shared.record import schema
from lacoc_shared.seat import No, Phase, SeatFlag

PAGE = (Path(__file__).parents[2] / "docs" / "protocol.md").read_text(encoding="utf-8")
SECTIONS = dict(re.findall(r"^### (\w+)\n(.*?)(?=^##|\Z)", PAGE, re.MULTILINE | re.DOTALL))
MESSAGES = {
    kind.__name__: kind
    for module in (messages, office, schema, studio, mistakes)
    for kind in vars(module).values()
    if isinstance(kind, type)
    and issubclass(kind, msgspec.Struct)
    and kind.__module__ == module.__name__
}
INPUTS = {str(kind.__struct_config__.tag): kind for kind in get_args(inputs.Input)}


def rows(text: str) -> list[list[str]]:
    """Return the cells of a table's rows, without its two header lines."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


def by_name(text: str) -> dict[str, list[str]]:
    """Map each name in a table to its fields; a row without a name belongs to the name above it."""
    found: dict[str, list[str]] = {}
    name = ""
    for first, field, *_ in rows(text):
        name = first.strip("`") or name
        found.setdefault(name, []).extend([field.strip("`")] if field else [])
    return found


def fields(kind: type[msgspec.Struct]) -> list[str]:
    return [field.name for field in msgspec.structs.fields(kind)]


def section(title: str) -> str:
    """Return the text below a heading of docs/protocol.md."""
    match = re.search(rf"^##+ {title}\n(.*?)(?=^##|\Z)", PAGE, re.MULTILINE | re.DOTALL)
    assert match, title
    return match[1]


def test_every_message_has_its_table_and_no_other() -> None:
    """docs/protocol.md has a section for each message of the code, and for no other."""
    assert set(SECTIONS) - {"Decisions"} == set(MESSAGES)


@pytest.mark.parametrize("name", MESSAGES)
def test_every_field_is_described_in_its_order(name: str) -> None:
    """The table of a message lists all its fields in order, each with a unit or range."""
    table = rows(SECTIONS[name])

    assert [row[0].strip("`") for row in table] == fields(MESSAGES[name])
    assert all(row[1] for row in table)


@pytest.mark.parametrize("name", MESSAGES)
def test_what_travels_as_an_array_says_so(name: str) -> None:
    """docs/protocol.md says for each message whether it travels as an array."""
    assert SECTIONS[name].lstrip().startswith("Array.") == bool(
        MESSAGES[name].__struct_config__.array_like
    )


def test_every_decision_and_its_fields() -> None:
    """docs/protocol.md lists each decision of `lacoc_shared.decisions` with its fields in order."""
    expected = {name: fields(kind) for name, kind in DECISIONS.items()}
    assert list(by_name(SECTIONS["Decisions"]).items()) == list(expected.items())


def test_every_input_and_its_fields() -> None:
    """docs/protocol.md lists each input of `lacoc_shared.inputs` with its fields, in order."""
    expected = {name: fields(kind) for name, kind in INPUTS.items()}
    assert list(by_name(section("Inputs of the record")).items()) == list(expected.items())


def test_every_topic_of_a_record_and_its_message() -> None:
    """docs/protocol.md lists each topic of a record with its message, in the code's order."""
    table = rows(section("The record"))
    assert [row[0].strip("`") for row in table] == list(schema.KINDS)
    for (_, cell, _), kind in zip(table, schema.KINDS.values(), strict=True):
        name = kind.__name__ if isinstance(kind, type) else "inputs"
        assert cell.startswith("no msgpack") if kind is None else f"[{name}](#" in cell
    assert f"{schema.BEAT_NS:,} ns" in PAGE
    assert f"profile `{schema.PROFILE}`, format {schema.FORMAT} (`FORMAT`)" in PAGE


def test_a_scene_is_named_by_the_hash_that_the_page_says() -> None:
    """docs/protocol.md describes the hash that the code uses to name a scene."""
    assert "BLAKE2b of that digest size over the encoded [Scene]" in SECTIONS["Frame"]
    encoded = encode(messages.Scene(bodies=(), geoms=()))
    assert message_hash(encoded) == hashlib.blake2b(encoded, digest_size=8).digest()


def test_every_key_expression() -> None:
    """The key expressions in docs/protocol.md are those of `lacoc_shared.keyspace`."""
    keys = keyspace.KeySpace("main")
    expected = {
        keys.frame,
        keys.event,
        keys.sheet,
        keys.scene,
        keys.health,
        keys.command("{seat}"),
        *(keys.request("{seat}", what) for what in ("join", "ready", "leave", "try")),
        keys.enter,
        keys.decision("{decision}"),
        keys.outlook,
        *(keys.office(what) for what in ("assign", "withdraw", "tell", "copy", "retire")),
        keys.where,
        keys.alive,
    }
    found = {
        expression
        for row in rows(section("Key expressions"))
        for expression in re.findall(r"`([^`]+)`", row[0])
    }
    assert {one.replace("{court}", "main") for one in found} == expected


def test_every_key_expression_of_a_studio() -> None:
    """The key expressions in the studio's section are those of `lacoc_shared.studio`."""
    keys = studio.StudioKeys("main")
    asked = [
        keys.request(what) for what in ("robot", "trial", "coach", "map", "variants", "cancel")
    ]
    found = [
        expression
        for row in rows(section("The studio"))
        for expression in re.findall(r"`([^`]+)`", row[0])
    ]
    expected = [*asked, keys.progress("{job}"), keys.alive]
    assert [one.replace("{studio}", "main") for one in found] == expected


def test_sizes_and_numbers() -> None:
    """docs/protocol.md has the code's limits, phases and flags.

    It lists as many reasons of refusal as the code has.
    """
    table = section("Key expressions")
    assert f"at most {keyspace.COMMAND_MAX_BYTES // 1024} KiB" in table
    assert f"at most {keyspace.DECISION_MAX_BYTES // 1024} KiB" in table
    assert f"at most {keyspace.JOIN_MAX_BYTES // 1024} KiB" in table
    assert f"at most {keyspace.ASSIGN_MAX_BYTES // 1024} KiB" in table
    assert f"at most {studio.STUDIO_MAX_BYTES // 1024} KiB" in section("The studio")
    assert f"at most {studio.TRIAL_REPLY_MAX_BYTES >> 20} MiB" in section("The studio")
    assert f"version {messages.PROTOCOL} of the protocol" in PAGE
    assert ", ".join(f"{phase.value} {phase.name}" for phase in Phase) in PAGE
    flags = dict(re.findall(r"(\d) (\w+)", SECTIONS["SeatFrame"].split("bits:")[1].split("|")[0]))
    assert {int(bit): word.upper() for bit, word in flags.items()} == {
        flag.value: flag.name for flag in SeatFlag
    }
    assert len(re.findall(r"\d [a-z]", SECTIONS["SeatFrame"].split("`refused_why` |")[1])) == len(
        No
    )
