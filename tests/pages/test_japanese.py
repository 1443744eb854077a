"""All that a court can say stands in Japanese too (client/web/src/i18n/court.ts)."""

import ast
import json
import re
import shutil
import subprocess
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest
from stage import LEFT, QUICK, RIGHT, Script, Stage, decide, join, key, setup

from lacoc_arenas import arena as arenas
from lacoc_server.doors.sessions import Why
from lacoc_server.simulate import player, simulate
from lacoc_server.world.world import _WARNINGS
from lacoc_shared import decisions as d
from lacoc_shared.gait.workbook import read_workbook
from lacoc_shared.inputs import HeardSeat, LeaveSeat, ReadySeat, SilentSeat
from lacoc_shared.messages import DecisionReply, Done, Refusal
from lacoc_shared.mistakes import FileRefused
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import NO_SENTENCES, Phase

ROOT = Path(__file__).parents[2]
COURT_TS = ROOT / "client" / "web" / "src" / "i18n" / "court.ts"
P = Phase
SCRIPT = """
import { toJapanese } from "%s";
let text = "";
for await (const part of process.stdin) text += part;
process.stdout.write(JSON.stringify(JSON.parse(text).map(toJapanese)));
"""

SPEAKERS = (
    "arenas/lacoc_arenas/flag_strike/rules.py",
    "arenas/lacoc_arenas/othello/rules.py",
    "arenas/lacoc_arenas/practice/rules.py",
    "client/lacoc_client/asking.py",
    "client/lacoc_client/controller.py",
    "client/lacoc_client/gateway/answers.py",
    "client/lacoc_client/gateway/courts.py",
    "client/lacoc_client/gateway/feed.py",
    "client/lacoc_client/gateway/page.py",
    "client/lacoc_client/gateway/page_seat.py",
    "client/lacoc_client/gateway/referees.py",
    "client/lacoc_client/gateway/seat_thread.py",
    "client/lacoc_client/gateway/wire.py",
    "robots/lacoc_robots/toml_entries.py",
    "robots/lacoc_robots/robot_file.py",
    "server/lacoc_server/match/contestant.py",
    "server/lacoc_server/doors/decision_desk.py",
    "server/lacoc_server/match/entry.py",
    "server/lacoc_server/court/health.py",
    "server/lacoc_server/doors/inbox.py",
    "server/lacoc_server/match/match.py",
    "server/lacoc_server/match/referee.py",
    "server/lacoc_server/match/staging.py",
    "server/lacoc_server/court/unjudged.py",
    "shared/lacoc_shared/network/address.py",
    "shared/lacoc_shared/gait/reader.py",
    "shared/lacoc_shared/gait/text.py",
    "shared/lacoc_shared/gait/workbook.py",
    "shared/lacoc_shared/record/writer.py",
    "shared/lacoc_shared/seat.py",
)
"""Where the sentences come from that a page shows."""

READ_BY = re.compile(r"num of posture|id of joint|.*\\[dsS(]|EX \(input\)$", re.IGNORECASE)
"""By what files are read, and how their sheets are called."""
PARTS = {
    # Of sentences that are put together: other tests here say them whole.
    "7 7 7 for 7 points.",
    "7 to 7",
    "7, but 7 below",
    "7, but 7 of angles below",
    "7: give a reason; it goes into the record.",
    "Your files have 7 mistakes7.",
    "a number 7",
    "a robot 7 m 7 with every angle 0",
    "another version",
    "from 7 to 7",
    "is not ready after all",
    "is ready",
    's with advance = "time"',
    "the 7 team has no disc left",
    "the 7 team holds all corners",
    "the sheets ",
    "there is no decision 7 under 7",
    "version 7",
    # Units and places in files.
    "N m s/rad",
    "N m/rad",
    "kg m2",
    "gait files",
    "leg 7, position_m",
    "mass_kg and masses_kg",
    # Of an organiser's arena file, of a log and of a thread, of addresses that are wrong when a
    # program is started: no page shows them.
    "7 is not an address. It looks like 192.168.1.5, court.example.org:7447 or tcp/127.0.0.1:7447.",
    "7 needs keys. An organiser makes them with 'lacoc contest keys' and names the contest file; "
    "everybody else gets an invitation: --invitation FILE.",
    "It is not possible to listen at 7: 7.",
    "It is not possible to listen on 7: 7",
    "Port 7 is in use: another program listens at 7. Stop it, or choose another port (0 takes a "
    "free one).",
    "Port 7 needs the administrator's rights; take one above 1023.",
    "The contest has keys, and 7 is a plain address: write tls/7, or leave the protocol out.",
    "The name 7 is not known on this machine; listen on 0.0.0.0 or a number.",
    "This machine has no address 7. Listen on 0.0.0.0 to use all it has.",
    "Cannot read 7: 7.",
    "7 7 7 for 7 point7.",
    "disc_radius_m 7 is more than half of pitch_m 7: the discs overlap; make the radius smaller or "
    "the pitch larger",
    "start 7 is outside the walls",
    "start_cells names a cell twice",
    "lacoc 7",
    "not a message",
    "record sync",
    "seat 7",
    "7 sits down as a referee.",
    "Court 7 is silent.",
    "Court 7 sends frames.",
    "Refused: 7",
    "Seat 7: 77.",
    "The page of seat 7 has gone.",
    # 'lacoc gait check' alone tells it.
    "7, row 7, column 7: the legend says 7, and joint 7 is a joint of leg 7. The order of the "
    "columns counts, not the legend.",
}
NAMES = re.compile(
    r"Ants|Bees|Kim|Hexapod|planner|c\dr\d|corner\d|flag\d+|LocoTra-data|Loco-data|Num of Posture|"
    r"Key|lacoc|straight|MuJoCo|AngMin|Shift-JIS|advance|radius_m|Root|link|EX \(input\)|"
    r"Judged|x86|N m|N m s/rad|kg m2|degrees/s|gait convert|"
    r"contest keys|--(renew|host|invitation FILE)"
)
ENGLISH = re.compile(r"[A-Za-z']{2,} [A-Za-z']{2,}")


@pytest.fixture(scope="module")
def node() -> str:
    """Return a Node that reads TypeScript: that of the group `web`."""
    found = shutil.which("node", path=str(Path(sys.executable).parent)) or shutil.which("node")
    if found is None:
        pytest.skip("no Node: pip install --group web")
    version = subprocess.run([found, "--version"], capture_output=True, text=True, check=True)
    if tuple(map(int, version.stdout.strip("v\n").split(".")[:2])) < (22, 18):
        pytest.skip(f"Node {version.stdout.strip()} reads no TypeScript: pip install --group web")
    return found


def japanese(node: str, texts: Iterable[str]) -> dict[str, str]:
    wanted = sorted(set(filter(None, texts)))
    done = subprocess.run(
        [node, "--input-type=module", "-e", SCRIPT % COURT_TS.as_uri()],
        input=json.dumps(wanted),
        capture_output=True,
        text=True,
        check=True,
    )
    return dict(zip(wanted, json.loads(done.stdout), strict=True))


def check(node: str, texts: Iterable[str]) -> dict[str, str]:
    """Each is said in Japanese, and no English is left in it."""
    said = japanese(node, texts)
    assert said
    missing = {
        text: found
        for text, found in said.items()
        if not re.search(r"[\u3040-\u30ff\u4e00-\u9fff]", found)
        or ENGLISH.search(NAMES.sub("", found))
    }
    assert not missing, "\n".join(f"{text!r}\n   {found!r}" for text, found in missing.items())
    return said


def stage_in(phase: Phase, arena: str = "othello") -> Stage:
    stage = Stage(arena, QUICK if phase is not P.COUNTDOWN else None)
    if phase is P.COUNTDOWN:
        stage.to_ready()
        stage.beat(decide(d.Start()))
        return stage
    return stage.to(phase)


@pytest.mark.parametrize("arena", ["othello", "flag-strike"])
@pytest.mark.parametrize("phase", list(P)[1:], ids=lambda phase: phase.name)
def test_legality_of_every_decision_in_every_phase(node: str, phase: Phase, arena: str) -> None:
    """The referee's page shows beside each button why a decision is not legal."""
    check(node, stage_in(phase, arena).match.legality().values())


def test_all_that_is_missing_for_a_start(node: str) -> None:
    """The list is whole in Japanese too: each seat with what it lacks."""
    stage = Stage()
    stage.beat()
    why = [stage.match.legality()["start"]]
    stage.beat(join(LEFT))
    why.append(stage.match.legality()["start"])
    said = check(node, [*why, f"start: {why[1]}."])
    assert "左の席にはまだ誰も参加していません" in said[why[0]]
    assert "右の席にはまだ誰も参加していません" in said[why[0]]
    assert "Ants がまだ準備完了していません" in said[why[1]]


def test_games_without_board_or_end(node: str) -> None:
    """Reasons that are not of the phase."""
    stage = Stage("practice", {"match": {"start": "referee"}})
    stage.to_ready()
    stage.decide(d.Start())
    check(node, [*stage.match.legality().values(), *(e.text for e in stage.events)])


def decisions() -> list[tuple[Phase, d.Decision]]:
    """Every decision as it should be and with every mistake that its arguments can have."""
    nan = float("nan")
    return [
        (P.LOBBY, d.Ready("left")),
        (P.LOBBY, d.Ready("top")),
        (P.READY, d.Start()),
        (P.PLAYING, d.Halt()),
        (P.HALTED, d.Resume()),
        (P.PLAYING, d.Restart("left")),
        (P.PLAYING, d.Freeze("left", 5.0)),
        (P.PLAYING, d.Freeze("left", 601.0)),
        (P.PLAYING, d.Freeze("left", nan)),
        (P.PLAYING, d.Freeze("left", 0.001)),
        (P.PLAYING, d.Unfreeze("left")),
        (P.PLAYING, d.Adjust("right", -2)),
        (P.PLAYING, d.Adjust("right", 0)),
        (P.PLAYING, d.Adjust("right", 1001)),
        (P.HALTED, d.Set("c0r0", "right")),
        (P.HALTED, d.Set("c0r0", "neutral")),
        (P.HALTED, d.Set("c9r0", "right")),
        (P.HALTED, d.Set("c0r0", "blue")),
        (P.HALTED, d.Set("c0r0", "down")),
        (P.HALTED, d.TakeBack(1)),
        (P.HALTED, d.Clock(-10.0)),
        (P.HALTED, d.Clock(2.5)),
        (P.HALTED, d.Clock(nan)),
        (P.HALTED, d.Clock(0.001)),
        (P.PLAYING, d.Abort()),
        (P.HALTED, d.Declare("left")),
        (P.HALTED, d.Declare("draw")),
        (P.HALTED, d.Declare("Ants")),
        (P.FINISHED, d.Official()),
        (P.OFFICIAL, d.Next()),
    ]


def heard(stage: Stage, decision: d.Decision, reason: str) -> Iterator[str]:
    outcome = stage.decide(decision, reason)
    assert isinstance(outcome, DecisionReply | Refusal)
    if isinstance(outcome, Refusal):
        yield outcome.reason
    else:
        yield outcome.text
        yield from outcome.changes
    yield from (event.text for event in stage.events)


def test_every_decision_and_its_refusals(node: str) -> None:
    """Return the court's reply to each decision, and its log entry with and without a reason."""
    texts = [
        text
        for phase, decision in decisions()
        for reason in ("stuck: leg 3", "")
        for text in heard(stage_in(phase), decision, reason)
    ]
    said = check(node, texts)
    log = "Referee Kubota: Ants is frozen for 5 s. Reason: stuck: leg 3"
    assert said[log] == "審判 Kubota：Ants を 5 秒間停止させました。理由：動けない（leg 3）"


def test_the_unfreezing_of_who_was_frozen(node: str) -> None:
    """The one decision that needs another one before it."""
    stage = stage_in(P.PLAYING)
    stage.decide(d.Freeze("left", 5.0))
    check(node, heard(stage, d.Unfreeze("left"), ""))


def cell(name: str) -> tuple[float, float]:
    return (int(name[1]) - 2.5) * 0.3, (int(name[3]) - 2.5) * 0.3


def test_take_back_and_what_it_changes(node: str) -> None:
    """The dry run's list, the decision and what is judged again."""
    walk = {1: {LEFT: cell("c2r2")}, 3: {LEFT: cell("c3r2")}, 5: {RIGHT: cell("c3r3")}}
    stage = Stage("othello", QUICK, script=Script(poses=walk)).to_playing()
    for _ in range(9):
        stage.beat()
    stage.decide(d.Halt())
    flips = stage.numbers("flip")
    assert flips
    dry = stage.decide(d.TakeBack(flips[0], dry_run=True))
    assert dry.changes
    told = [*dry.changes, *heard(stage, d.TakeBack(flips[0]), "rule")]
    told += ["appears: capture corner1", "event 9 vanishes: strike flag7"]
    told += ["Judged again: Ants flips c3r2 and with it c4r2, c5r2."]
    check(node, told)


def test_contestants_come_and_go(node: str) -> None:
    """Join, ready, silence, leaving: the log, the notes and the refusals."""
    stage = Stage(overrides=QUICK)
    outcomes = [stage.send(item) for item in (join(LEFT), join(RIGHT), ReadySeat(LEFT, True))]
    outcomes += [stage.send(item) for item in (ReadySeat(LEFT, False), LeaveSeat(LEFT))]
    outcomes += [stage.send(ReadySeat(LEFT, True))]
    stage.to_playing()
    late = join(LEFT, robot="quadruped")
    items = [SilentSeat(LEFT), HeardSeat(LEFT), key(LEFT, 10), join(LEFT), late, LeaveSeat(LEFT)]
    outcomes += [stage.send(item) for item in (*items, ReadySeat(LEFT, True))]
    fresh = Stage(overrides=QUICK).to_playing()
    fresh.match.seats[LEFT].join = None
    outcomes.append(fresh.send(join(LEFT)))
    replies = [o.reason if isinstance(o, Refusal) else o.text for o in outcomes if o != Done()]
    check(node, [*replies, *(event.text for event in stage.events)])


def test_faults_and_refused_keys(node: str) -> None:
    """MuJoCo's warnings, why keys are refused, and what a court counts."""
    texts = [f"Physics stopped: {words}." for words in _WARNINGS.values()]
    texts += ["Physics stopped: MuJoCo's warning 9."]
    check(node, [*texts, *NO_SENTENCES.values(), *map(str, Why)])


@pytest.mark.slow
@pytest.mark.parametrize("arena", ["othello", "flag-strike"])
def test_a_whole_match(node: str, tmp_path: Path, arena: str) -> None:
    """Every event of a real match between two bots."""
    short = {"match": {"duration_s": 45.0}}
    ground = arenas.load(arena, short)
    players = [player(ground, LEFT, "planner", team="Ants"), player(ground, RIGHT, "straight")]
    played = setup(arena, short)
    simulate(played, players, tmp_path)
    events = Record.read(tmp_path / "m.mcap").events
    kinds = {event.kind for event in events}
    assert {"join", "ready", "phase", "decision", "result"} <= kinds
    assert kinds & {"flip", "capture", "strike"}
    check(node, (event.text for event in events))


def test_no_sentence_in_the_sources_is_forgotten(node: str) -> None:
    """Every sentence that stands in the sources, with numbers in its holes."""
    check(node, (text for speaker in SPEAKERS for text in sentences(ROOT / speaker)))


def sentences(path: Path) -> Iterator[str]:
    """The texts of a module of two words and more; no docstrings, no words of exceptions."""
    tree = ast.parse(path.read_text("utf-8"))
    passed = set(_silent(tree))
    for node in ast.walk(tree):
        if node in passed or not isinstance(node, ast.JoinedStr | ast.Constant):
            continue
        text = _filled(node).replace("{team}", "7").replace("{seat}", "7")
        if text in PARTS or READ_BY.match(text) or not re.match(r"[\w\"'{-]", text):
            continue  # the last: it goes on with a sentence
        if " " in text.strip() and re.search("[a-z]{2}", text):
            yield text


def _filled(node: ast.JoinedStr | ast.Constant) -> str:
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else ""
    return "".join(
        str(part.value) if isinstance(part, ast.Constant) else "7" for part in node.values
    )


def _silent(tree: ast.AST) -> Iterator[ast.AST]:
    """Nodes that nobody is told: docstrings, parts of f-strings, assertions, annotations."""
    for node in ast.walk(tree):
        match node:
            case ast.Expr(value=ast.Constant() as docstring):
                yield docstring
            case ast.JoinedStr(values=parts):
                for part in parts:
                    yield from ast.walk(part)
            case ast.Assert(msg=ast.AST() as words):
                yield from ast.walk(words)


GAITS = {
    "empty": b"",
    "words": b"hello there\n",
    "count": b"Num of Posture\tmany\n0 Key" + b"\t0" * 18,
    "more": b"Num of Posture\t3\tx\n0 Key" + b"\t0" * 17 + b"\t200\n0 Key" + b"\t1" * 18 + b"\nno",
    "legs": b"1\n1\n" + b"\t".join([b"0"] * 12),
    "keys": b"2\n" + b"\t".join([b"0"] * 18) + b"\n3\n" + b"\t".join([b"0"] * 17),
    "long": b"1\n" * 40_000,
    "binary": bytes(range(128, 256)),
}


@pytest.mark.parametrize("name", GAITS)
def test_mistakes_of_gait_files(node: str, name: str) -> None:
    """What was expected, and what was found where that is words."""
    from lacoc_shared.gait.text import read_gait

    with pytest.raises(FileRefused) as refused:
        read_gait(GAITS[name], "gait.txt", legs=6)
    check(node, _words(refused.value))


def test_mistakes_of_workbooks(node: str) -> None:
    """The same for a workbook that is none."""
    for data in (b"PK\x03\x04 and so on", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"):
        with pytest.raises(FileRefused) as refused:
            read_workbook(data, "gait.xlsx")
        check(node, _words(refused.value))


def test_mistakes_of_robot_files(node: str) -> None:
    """The same for a robot file in which almost everything is wrong."""
    from lacoc_robots.library import find_robot
    from lacoc_robots.robot_file import read_robot

    name, good = find_robot("hexapod")
    wrong = [
        b"",
        b"\xff\xfe",
        b"name = ",
        re.sub(rb"= [0-9.]+", b"= 99.0", good),
        re.sub(rb"= [0-9.]+", b'= "two"', good),
        re.sub(rb"\[([-0-9., ]+)\]", b"[1]", good),
        good.replace(b"[[leg]]", b"[[leg]]\nwings = 2\n", 1),
        good.replace(b"mass_kg", b"mas_kg", 1),
    ]
    for data in wrong:
        with pytest.raises(FileRefused) as refused:
            read_robot(data, name)
        check(node, _words(refused.value))


def _words(refused: FileRefused) -> Iterator[str]:
    """The texts of mistakes; a cell that is quoted and a parser's own words stay as they are."""
    for mistake in refused.mistakes:
        yield mistake.expected
        if mistake.expected.startswith("TOML"):
            continue
        if mistake.row is None and re.search("[a-z]{3}", mistake.found) and mistake.found[0] != '"':
            yield mistake.found
