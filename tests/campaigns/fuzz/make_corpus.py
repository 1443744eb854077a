"""Makes the seeds of tests/campaigns/fuzz/corpus: `python -m tests.campaigns.fuzz.make_corpus`.

Most seeds are small and good inputs, from the samples and from a short match. Seeds named
`found-...` once crashed a reader, hung it or filled the memory, or would have. Records named
`...-protocol-1` were made by an older version, which sent sentences; today's code can't make them.
"""

import io
import struct
import tempfile
import zipfile
from pathlib import Path

import msgspec
import zstandard
from stage import QUICK, Stage, decide, join, key, setup
from tests.campaigns.fuzz import doors

import lacoc_arenas
from lacoc_robots.library import find_robot, installed_robots, sample_gait_files
from lacoc_server.journal.journal import Journal
from lacoc_server.match.match import Match
from lacoc_server.world.world import World
from lacoc_shared import decisions as d
from lacoc_shared.codec import encode
from lacoc_shared.gait.cells import LEG_LABELS
from lacoc_shared.gait.text import read_gait
from lacoc_shared.gait.workbook.file import write_workbook
from lacoc_shared.inputs import ReadySeat
from lacoc_shared.messages import (
    DecisionReply,
    Done,
    Health,
    Joined,
    Refusal,
    SeatHealth,
)
from lacoc_shared.mistakes import Mistake
from lacoc_shared.record.pack import pack
from lacoc_shared.words import say

_HERE = Path(__file__).parent
_CALC = _HERE.parents[1] / "gait/files/calc.xlsx"
CORPUS = _HERE / "corpus"


def write(folder: str, name: str, data: bytes) -> None:
    """Write one seed into a folder of the corpus."""
    path = CORPUS / folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)


def write_packets() -> None:
    """Write packets that arrive at a court, a client or a gateway."""
    made = {
        "commands": doors.command_seeds(),
        "requests": doors.request_seeds(),
        "joins": doors.join_seeds(),
        "decisions": doors.decision_seeds(),
        "page": _page_seeds(),
    }
    stage = Stage("othello").to_playing()
    stage.run(5)
    scene = World(stage.match.arena, ()).scene
    scene = msgspec.structs.replace(scene, bodies=scene.bodies[:4])
    health = Health(
        match=1, beat=9, real_time_factor=1.0, slow_beats=0, worst_late_ms=0.5,
        dropped={"flood": 3}, input_delay_ms=240,
        seats=(SeatHealth(id="left", joined=True, session=7, heard_ms=3.5, commands_hz=10.0,
                          refused={"old": 1}, round_trip_p50_ms=21.5, round_trip_p95_ms=40.0,
                          late=2),),
        decisions=stage.match.legality(),
    )  # fmt: skip
    mistake = Mistake(file="a.txt", found="x", expected="an angle", row=1, column=2, leg="R,F")
    stays = say("note.seat-stays")
    reply = DecisionReply(
        beat=7, event=3, said=say("decision.adjust", points=3, team="Ants"), scores=(1, 2),
        changes=(say("change.appears", kind="flip", marker="c0r0"),),
    )  # fmt: skip
    made |= {
        "message-frame": [encode(stage.frame), encode(Stage("othello").beat().frame)],
        "message-event": [encode(event) for event in stage.events[:6]],
        "message-sheet": [encode(stage.match.sheet())],
        "message-scene": [encode(msgspec.structs.replace(scene, geoms=scene.geoms[:6]))],
        "message-health": [encode(health)],
        "message-joined": [encode(Joined(session=1, secret=bytes(16), last_seq=4, notes=(stays,)))],
        "message-done": [encode(Done(stays))],
        "message-refusal": [encode(Refusal(say("refused.mistakes", count=2), (mistake, mistake)))],
        "message-decisionreply": [encode(reply)],
    }
    for folder, seeds in made.items():
        for number, data in enumerate(seeds):
            write(folder, f"seed-{number:02}", data)


def _page_seeds() -> list[bytes]:
    asks = [
        {"do": "watch", "court": "main", "hz": 25.0, "key": "secret"},
        {"do": "rate", "hz": 10},
        {"do": "ping", "t": 1.5},
        {"do": "join", "seat": "left", "token": "t", "name": "A",
         "robot": {"name": "r.toml", "data": b"x" * 50}},
        {"do": "ready", "ready": True},
        {"do": "leave"},
        {"do": "key", "level": 1, "key": 2, "match": 1, "beat": 9},
        {"do": "saw", "match": 1, "beat": 9},
        {"do": "enter", "token": "t", "by": "Kubota"},
        {"do": "take_over"},
        {"do": "decide", "decision": {"type": "adjust", "seat": "left", "points": 3}},
    ]  # fmt: skip
    return [encode({"id": number, **ask}) for number, ask in enumerate(asks)]


def write_files() -> None:
    """Write gaits, workbooks, robots, arenas, a contest file and a key script."""
    for name in installed_robots():
        write("robot", f"{name}.toml", find_robot(name)[1])
        for file in sample_gait_files(name):
            if file is not None:
                write("gait", f"{name}-{file.name}", file.data)
    postures, locomotion = sample_gait_files("hexapod")
    assert postures is not None
    assert locomotion is not None
    text = postures.data.decode()
    write("gait", "utf-16.txt", text.encode("utf-16"))
    write("gait", "shift-jis.txt", text.replace("Position", "脚の位置").encode("cp932"))
    write("gait", "spaces.txt", locomotion.data.replace(b"\t", b" "))
    write("gait", "short.txt", b"1\n1\n" + b"\t".join([b"-1,5"] * 12) + b"\n")
    table = read_gait(postures.data, "Loco-data.txt")
    write("workbook", "ours.xlsx", write_workbook(table, LEG_LABELS[6]))  # type: ignore[arg-type]
    write("workbook", "calc.xlsx", _CALC.read_bytes())
    arenas = Path(next(iter(lacoc_arenas.__path__)))
    for name in ("othello", "flag_strike"):
        write("arena", f"{name}.toml", (arenas / name / "arena.toml").read_bytes())
    write("contest", "two-courts.toml", _CONTEST.encode())
    write("keys", "script.txt", b"tab 1\n1.5 3\n1 2 3 4\n1234 # all\n0.25 x\n2\nspace up 7\nq\n")


_CONTEST = """\
[contest]
name = "Spring"
recordings = "records"
robot = "robots/own.toml"
[limits]
legs_max = 6
[court.main]
arena = "othello"
listen = ["0.0.0.0", "tcp/127.0.0.1:7450"]
connect = "court.example.org:7448"
[court.main.settings.match]
duration_s = 60.0
levels = ["A", "B"]
[court.second]
arena = "games/tag"
listen = ["0.0.0.0:7448"]
"""


def write_records() -> None:
    """Write a short practice as an open and as a closed segment, and a match as a packed record."""
    with tempfile.TemporaryDirectory() as folder:
        journal = Journal(Match(setup("practice"), World), Path(folder))
        journal.beat([join(0)])
        journal.beat([ReadySeat(0, True)])
        _play(journal)
        assert journal.writer is not None
        path = journal.writer.path
        write("segment", "cut.mcap", path.read_bytes())
        journal.close()
        write("segment", "closed.mcap", path.read_bytes())
    with tempfile.TemporaryDirectory() as folder:
        journal = Journal(Match(setup("othello", QUICK), World), Path(folder))
        journal.beat([join(0), join(1)])
        journal.beat([ReadySeat(0, True), ReadySeat(1, True)])
        journal.beat([decide(d.Start())])
        _play(journal)
        journal.close()
        assert journal.writer is not None
        pack([journal.writer.path], Path(folder) / "m.mcap")
        write("packed", "packed.mcap", (Path(folder) / "m.mcap").read_bytes())


def _play(journal: Journal) -> None:
    journal.beat()
    journal.beat([key(seat.index, 2) for seat in journal.match.seats])
    for _ in range(8):
        journal.beat()
    journal.beat([decide(d.Halt())])
    journal.beat([decide(d.Declare("draw"))])


def write_found() -> None:
    """Write inputs that once caused a failure, and decompression bombs."""
    write("robot", "found-long-hex-in-list", b"name = [0x" + b"f" * 5000 + b"]\n")
    write("robot", "found-deep-in-list", b"name = [{" + b"a." * 3000 + b"a = 1}]\n")
    write("robot", "found-dotted-key", b"a." * 15000 + b"a = 1\n")
    write("robot", "found-dotted-header", b"[" + b"a." * 15000 + b"a]\n")
    base = b'[court.main]\narena = "othello"\n'
    write("contest", "found-long-number", b"a = " + b"9" * 5000)
    write("contest", "found-deep", b"a = " + b"[" * 2000)
    write("contest", "found-nul-in-arena", base.replace(b"othello", b"a\\u0000/b"))
    write("contest", "found-nul-in-robot", base + b'[contest]\nrobot = "a\\u0000/b"\n')
    write("contest", "found-nul-in-folder", base + b'[contest]\nrecordings = "a\\u0000b"\n')
    write("contest", "found-no-such-user", base + b'[contest]\nrobot = "~nobody-here/b"\n')
    write("contest", "found-huge-setting", base + b"[court.main.settings]\na = 0x" + b"f" * 40)
    write("gait", "found-16000-mistakes.txt", b"1\n" * 16000)
    write("gait", "tabs.txt", b"\t" * 32000)
    for name, part, content in _workbook_bombs():
        write("workbook", f"found-{name}.xlsx", _with_part(part, content))
    packed = (CORPUS / "packed" / "packed.mcap").read_bytes()
    zeros = bytes(1 << 30)  # 1 GiB that compresses to 32 KiB
    for name, told in (("honest", len(zeros)), ("lying", 100)):
        write("packed", f"found-zstd-bomb-{name}.mcap", packed[:8] + _chunk(zeros, told))
    leave = struct.pack("<HIQQ", 2, 0, 0, 0) + b"\x92\xa5leave\x00"
    message = struct.pack("<BQ", 5, len(leave)) + leave
    channel = b"".join(_records_of(packed, code=4))
    write("packed", "found-20000-inputs-in-a-beat.mcap",
          packed[:8] + _chunk(channel + message * 20_000, None))  # fmt: skip


def _workbook_bombs() -> list[tuple[str, str, bytes]]:
    main = b'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
    strings, sheet = "xl/sharedStrings.xml", "xl/worksheets/sheet1.xml"
    laughs = b"".join(
        b'<!ENTITY l%d "%s">' % (level, b"&l%d;" % (level - 1) * 10) for level in range(1, 12)
    )
    head = b'<?xml version="1.0"?><!DOCTYPE a [<!ENTITY l0 "ha">'
    sst = b"<sst " + main + b">%s</sst>"
    file = b'<!DOCTYPE a [<!ENTITY f SYSTEM "file:///etc/passwd">]>'
    rows = b"<worksheet " + main + b'><dimension ref="A1:XFD1048576"/><sheetData>%s</sheetData>'
    return [
        ("billion-laughs", strings, head + laughs + b"]>" + sst % b"<si><t>&l11;</t></si>"),
        ("entities-in-utf-16", strings,
         (head + b"]>" + sst % b"<si><t>&l0;</t></si>").decode().encode("utf-16")),
        ("external-file", strings, file + sst % b"<si><t>&f;</t></si>"),
        ("million-strings", strings, sst % (b"<si/>" * 1_500_000)),
        ("million-cells", sheet, rows % (b"<row>" + b"<c/>" * 1_500_000 + b"</row>")),
        ("same-row", sheet, rows % (b'<row r="1"/>' * 600_000)),
        ("deep", sheet, rows % (b"<row>" * 1_000_000)),
        ("last-row", sheet, rows % b'<row r="1048576"><c r="XFD1048576"><v>1</v></c></row>'),
    ]  # fmt: skip


def _with_part(name: str, content: bytes) -> bytes:
    stream = io.BytesIO()
    with (
        zipfile.ZipFile(CORPUS / "workbook" / "ours.xlsx") as old,
        zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as new,
    ):
        for info in old.infolist():
            data = content if info.filename == name else old.read(info)
            new.writestr(zipfile.ZipInfo(info.filename), data, zipfile.ZIP_DEFLATED)
    return stream.getvalue()


def _chunk(inside: bytes, told: int | None) -> bytes:
    """Return an MCAP chunk that claims to unpack to `told` bytes (None: to its true size)."""
    data = zstandard.ZstdCompressor(19).compress(inside)
    told = len(inside) if told is None else told
    body = struct.pack("<QQQII", 0, 0, told, 0, 4) + b"zstd" + struct.pack("<Q", len(data)) + data
    return struct.pack("<BQ", 6, len(body)) + body


def _records_of(packed: bytes, code: int) -> list[bytes]:
    """Return the records of an MCAP file that have this opcode, without those inside chunks."""
    at, found = 8, []
    while at + 9 <= len(packed) - 8:
        kind, size = struct.unpack_from("<BQ", packed, at)
        if kind == code:
            found.append(packed[at : at + 9 + size])
        at += 9 + size
    return found


if __name__ == "__main__":
    write_packets()
    write_files()
    write_records()
    write_found()
