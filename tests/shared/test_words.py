"""Every phrase can be rendered in both languages, with the same text on pages and terminals."""

import ast
import json
import math
import random
import subprocess
import sys
from pathlib import Path
from typing import Any

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_shared import codec, words
from lacoc_shared.command import language
from lacoc_shared.mistakes import FileRefused, Mistake, UserError
from lacoc_shared.words import LANGUAGES, Phrase, faults, render, say
from lacoc_shared.words.render import DEEPEST
from lacoc_shared.words.table import ON_PAGES, table
from lacoc_shared.words.template import BadTemplate, holes, parse

ROOT = Path(__file__).parents[2]
NODE = Path(sys.executable).with_name("node")
CODES = sorted(table())
KINDS = {"text", "number", "phrase", "list", "any"}

TEXTS = st.text(st.characters(exclude_characters="{}<>", codec="utf-8"), max_size=20) | (
    st.sampled_from(["left", "draw", "playing", "start", "constructor"])
)
NUMBERS = (
    st.integers(-(2**53), 2**53)
    | st.floats(width=64)
    | st.sampled_from([0.5, 2.5, -0.125, 1, -0.0])
)
PLAIN = st.sampled_from([c for c in CODES if not table()[c].values]).map(say)


def values_of(kind: str) -> st.SearchStrategy[Any]:
    """Draw a random value of a kind, such as "text" or "number?"."""
    if kind.endswith("?"):
        return st.none() | values_of(kind[:-1])
    return {
        "text": TEXTS,
        "number": NUMBERS,
        "phrase": PLAIN,
        "list": st.lists(TEXTS | NUMBERS | PLAIN, max_size=4).map(tuple),
        "any": TEXTS | NUMBERS | PLAIN,
    }[kind]


def phrases(codes: list[str]) -> st.SearchStrategy[Phrase]:
    """Draw a phrase with one of the codes and values of the right kinds."""
    return st.sampled_from(codes).flatmap(
        lambda code: st.fixed_dictionaries(
            {name: values_of(kind) for name, kind in table()[code].values.items()}
        ).map(lambda values: Phrase(code, values))
    )


def test_each_code_uses_its_values_in_both_languages() -> None:
    """For each phrase code, the text in each language uses exactly the values of the code."""
    for code in CODES:
        _check_entry(code)


def _check_entry(code: str) -> None:
    entry = table()[code]
    assert {kind.removesuffix("?") for kind in entry.values.values()} <= KINDS
    for name, text in (("en", entry.en), ("ja", entry.ja)):
        assert text, f"{code} has no {name}"
        outside, inside = holes(text)
        used = {hole.name for hole in outside + inside}
        # A game of another package gives its text in both languages, as the values en and ja.
        expected = set(entry.values) - ({"en", "ja"} - {name})
        assert used == expected, code
        shown = {hole.name for hole in outside if not _is_plural(hole.formats)}
        optional = {name for name, kind in entry.values.items() if kind.endswith("?")}
        assert not shown & optional, f"{code}: outside of a clause"


def _is_plural(formats: tuple[str, ...]) -> bool:
    return any(one.startswith("plural ") for one in formats)


@given(phrases(CODES), st.sampled_from(LANGUAGES))
def test_every_phrase_renders_without_an_open_hole(phrase: Phrase, chosen: Any) -> None:
    """A phrase with values of the right kinds is rendered with every placeholder filled in."""
    assert faults(phrase) == []
    text = render(phrase, chosen)
    assert not set("{}<>") & set(text)
    assert codec.decode(codec.encode(phrase), Phrase).code == phrase.code


ANYTHING = st.recursive(
    st.none() | st.booleans() | TEXTS | NUMBERS,
    lambda inner: (
        st.lists(inner, max_size=3).map(tuple)
        | st.builds(
            Phrase, st.sampled_from(CODES) | TEXTS, st.dictionaries(TEXTS, inner, max_size=3)
        )
    ),
    max_leaves=8,
)


@given(st.builds(Phrase, st.sampled_from(CODES) | TEXTS, st.dictionaries(TEXTS, ANYTHING)))
def test_nothing_that_arrives_raises(phrase: Phrase) -> None:
    """Any phrase, also with unknown codes or wrong values, is rendered without an exception."""
    for chosen in LANGUAGES:
        assert isinstance(render(phrase, chosen), str)


def test_hostile_nesting_and_hostile_bytes_end() -> None:
    """A phrase that is nested too deep is cut, and bytes that are no phrase raise BadMessage."""
    deep = say("over.time")
    for _ in range(500):
        deep = say("event.finished", why=deep)
    assert render(deep, "en").count("finished") <= DEEPEST + 1
    for data in (b"\x81", b"\x82\xa4code\x01\xa6values\x80", b"\xc0", b"\xff" * 50):
        with pytest.raises(codec.BadMessage):
            codec.decode(data, Phrase)
    bottomless = b"\x82\xa4code\xa1x\xa6values\x81\xa1v" * 5_000
    with pytest.raises(codec.BadMessage):
        codec.decode(bottomless, Phrase, len(bottomless))


def test_pages_and_terminals_say_the_same() -> None:
    """TypeScript (pages) and Python (terminals) render the same text for many phrases."""
    cases: list[tuple[Phrase, str]] = []
    on_pages = sorted(table(ON_PAGES))
    draw = random.Random(7)
    for code in on_pages:
        for _ in range(8):
            phrase = Phrase(code, {n: _some(k, draw) for n, k in table()[code].values.items()})
            cases += [(phrase, chosen) for chosen in LANGUAGES]
    for number in (0.5, 1.5, 2.5, 0.125, 1e-7, 123456.7890625, -0.04, -59.5, 3599.5, 1e15, 2**60):
        for code, name in (
            ("health.real-time", "factor"),
            ("health.late-beat", "late_ms"),
            ("decision.adjust", "points"),
            ("note.none", "b"),
        ):
            cases.append((Phrase(code, {name: number, "a": True, "Z": None}), "en"))
    deep: Phrase = say("over.time")
    for _ in range(9):
        deep = say("event.judged-again", event=deep)
    hostile = Phrase("\u202ex\n", {"😀": ("a" * 3000, say("over.time")), "\uffff": False})
    cases += [(deep, "ja"), (hostile, "en"), (Phrase("constructor", {"__proto__": 1}), "en")]
    lines = b"".join(msgspec.json.encode(case) + b"\n" for case in cases)
    node = subprocess.run(
        [NODE, "--no-warnings", Path(__file__).with_name("words.mts")],
        input=lines,
        capture_output=True,
        check=True,
    )
    answers = [json.loads(line) for line in node.stdout.decode().splitlines()]
    for (phrase, chosen), answer in zip(cases, answers, strict=True):
        assert render(phrase, chosen) == answer, phrase  # type: ignore[arg-type]


def _some(kind: str, draw: random.Random) -> Any:
    if kind.endswith("?") and draw.random() < 0.5:
        return None
    text: str = draw.choice(["Ants", "left", "draw", "lobby", "停\u0007止", "", "a{b}<c>"])
    number = draw.choice([0, 1, -1, 7, 2.5, draw.uniform(-100, 100), draw.uniform(0, 1e-3), 1e14])
    plain = say(draw.choice(["over.time", "no.such-code", "why.no-end"]))
    match kind.removesuffix("?"):
        case "text":
            return text
        case "number":
            return number
        case "list":
            return tuple(draw.choice([text, number, plain]) for _ in range(draw.randrange(4)))
    return draw.choice([plain, text])


SENDERS = [
    file
    for room in ("shared", "robots", "arenas", "server", "client")
    for file in sorted((ROOT / room).rglob("*.py"))
    if "node_modules" not in file.parts
]


def test_every_say_in_the_source_has_a_code_and_its_values() -> None:
    """Each call of `say` in the source has a code of the table and exactly its values.

    This test is needed because `say` itself checks nothing in a match.
    """
    wrong = []
    for file in SENDERS:
        if "say(" not in (text := file.read_text("utf-8")):
            continue
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.Call) and _is_say(node.func):
                place = f"{file.relative_to(ROOT)}:{node.lineno}"
                wrong += [f"{place}: {one}" for one in _wrong_call(node)]
    assert not wrong, "\n".join(wrong)


def _is_say(function: ast.expr) -> bool:
    """Return whether a call is of the function `say`, not of a method with this name."""
    return isinstance(function, ast.Name) and function.id == "say"


def _wrong_call(node: ast.Call) -> list[str]:
    if len(node.args) != 1 or not isinstance(node.args[0], ast.Constant):
        return ["the code must be a literal: one call for each"]
    code = str(node.args[0].value)
    if code not in table():
        return [f"there is no code {code!r}"]
    given_names = {keyword.arg for keyword in node.keywords}
    differs = given_names ^ set(table()[code].values)
    return [f"{code}: {', '.join(map(str, differs))} is missing or too many"] if differs else []


def test_a_wrong_call_is_found() -> None:
    """The check of `say` calls finds wrong codes, missing values and values too many."""
    calls = {
        'say("over.time")': 0,
        "say(code)": 1,
        'say("over.no-such")': 1,
        'say("event.back")': 1,
        'say("event.back", team="x", seat="y")': 1,
        'say("event.back", **values)': 1,
    }
    for text, count in calls.items():
        call = ast.parse(text, mode="eval").body
        assert isinstance(call, ast.Call)
        assert len(_wrong_call(call)) == count, text


def test_faults_find_wrong_kinds_within_lists() -> None:
    """`faults` finds values of a wrong kind, also in phrases within a list."""
    assert faults(say("event.back", team=3)) != []
    assert faults(say("event.advised", reasons=[say("health.faults", times="x", most=1)])) != []
    assert faults(say("event.advised", reasons=[say("health.faults", times=1, most=1)])) == []


@pytest.mark.parametrize(
    ("phrase", "english", "japanese"),
    [
        (
            say("decision.adjust", points=3, team="Ants"),
            "+3 points for Ants.",
            "Ants の得点を +3 点修正しました。",
        ),
        (
            say("decision.adjust", points=-1, team="Ants"),
            "-1 point for Ants.",
            "Ants の得点を -1 点修正しました。",
        ),
        (
            say("event.decided", by="Kim", did=say("decision.halt"), reason=None),
            "Referee Kim: halted.",
            "審判 Kim：試合を中断しました。",
        ),
        (
            say("event.flip", team="Ants", marker="c2r3", also=["c3r3", "c4r3"]),
            "Ants flips disc C4 and with it disc D4, disc E4.",
            "Ants が ディスク C4 を反転しました（同時に ディスク D4、ディスク E4 も反転）。",
        ),
        (
            say("why.no-marker", marker="\x1b[31m", markers=["a", "b", "c"]),
            'there is no "\ufffd[31m" on this board. Choose a, b or c',
            "この盤面に「\ufffd[31m」はありません。a、bまたはcから選んでください",
        ),
        (
            Phrase("new.code", {"b": 1, "a": say("over.time")}),
            "new.code (a: over.time, b: 1)",
            "new.code (a: over.time, b: 1)",
        ),
        (
            Phrase("event.back"),
            "? is back.",
            "? が戻りました。",
        ),
    ],
)
def test_phrases_in_words(phrase: Phrase, english: str, japanese: str) -> None:
    """Sample phrases have exactly these texts in English and Japanese."""
    assert (render(phrase, "en"), render(phrase, "ja")) == (english, japanese)


@pytest.mark.parametrize("template", ["{a", "a}", "{a:blue}", "<a", "a>", "<a<b>>", "{a:plural x}"])
def test_a_template_that_is_wrong_is_refused(template: str) -> None:
    """A text with a wrong placeholder or clause is refused."""
    with pytest.raises(BadTemplate):
        parse(template)


def test_errors_speak_the_language_of_the_process() -> None:
    """Errors and mistakes are in the language that the process uses."""
    error = UserError(say("record.exists", file="a.mcap"))
    mistake = Mistake(file="g.txt", row=2, found=say("gait.nothing"), expected="x")
    assert "exists already" in str(error)
    assert str(mistake) == "g.txt, row 2: found nothing, expected x"
    assert codec.decode(codec.encode(mistake), Mistake) == mistake
    assert mistake.in_words().found == "nothing"
    words.use("ja")
    try:
        assert "すでにあります" in str(error)
        assert "2 行目" in str(mistake)
        assert "空欄" in str(FileRefused([mistake]))
    finally:
        words.use("en")


@pytest.mark.parametrize(
    ("variables", "spoken"),
    [
        ({"LANG": "ja_JP.UTF-8"}, "ja"),
        ({"LANG": "ja_JP.UTF-8", "LC_ALL": "C"}, "en"),
        ({"LANG": "C", "LC_MESSAGES": "ja"}, "ja"),
        ({"LC_ALL": "ja_JP", "LACOC_LANGUAGE": "en"}, "en"),
        ({"LANG": "de_DE"}, "en"),
        ({"LC_ALL": "", "LANG": "ja"}, "ja"),
    ],
)
def test_a_terminal_speaks_the_language_that_is_set(variables: dict[str, str], spoken: str) -> None:
    """LACOC_LANGUAGE, LC_ALL, LC_MESSAGES or LANG gives the language: the first not empty one."""
    assert language.of_process(variables) == spoken


def test_a_number_that_is_none_is_shown_as_unknown() -> None:
    """NaN is shown as "?"."""
    assert render(say("health.late-beat", late_ms=math.nan, most_ms=1), "en").startswith(
        "the worst beat began ? ms late"
    )
