"""Makes hostile inputs from good ones; the same random seed makes the same inputs again."""

import io
import random
import struct
import warnings
import zipfile
import zlib
from collections.abc import Sequence
from typing import Any

import msgpack
import zstandard

LARGEST = 80_000
"""The usual largest input [bytes], slightly above the largest message from the network."""

INTEGERS = (
    0, 1, -1, 2, 7, 8, 10, 11, 127, 128, 255, 256, -128, -129, 2**15, 2**16, 2**31 - 1, 2**31,
    2**32 - 1, 2**32, 2**53 - 1, 2**53, 2**63 - 1, 2**63, 2**64 - 1, -(2**31), -(2**63),
)  # fmt: skip
FLOATS = (float("nan"), float("inf"), -float("inf"), 1e308, -1e308, 5e-324, -0.0, 0.1, 1e15)
TEXTS = (
    "", "\0", "a\0b", "\x1b[2J", "\u202e", "\ufeff", "１２", "1_0", "é" * 50, "x" * 300, "../../x",
    "left", "right", "solo", "draw", "left ", "c2r3", "corner0", "flag7", "none", "%s%n", "{0}",
)  # fmt: skip
TOKENS = (
    b"nan", b"inf", b"-inf", b"1e308", b"-1e308", b"1e999", b"5e-324", b"-0.0", b"0", b"-1", b"1",
    b"9" * 30, b"9" * 5000, b"0x" + b"f" * 5000, b"1_0", "１２".encode(), "−５".encode(), b"1,5",
    b"1e5", b"+.5", b"4.", b"true", b"[]", b"{}", b"[[]]", b"{a=1}", b'""', b"''", b'"\\u0000"',
    b'"\\ud800"', b"1979-05-27", b"12:00:00", b"\0", b"\t", b"\t" * 65536, b"\n" * 3000,
    b"\xff\xfe", b"\xef\xbb\xbf", b"\xed\xa0\x80", b"\x80\xff", b'"', b"'''", b"#", b"=", b".",
    b"a." * 3000, b"[" * 5000, b"{a=" * 400, b"<!DOCTYPE a [<!ENTITY b SYSTEM 'file:///x'>]>",
    b"<c r='XFD1048576'><v>1</v></c>", b"<row r='1048576'/>", b"&#0;", b"&lt;", b"<v>1e400</v>",
    b"<v>" + b"9" * 5000 + b"</v>", b"Num of Posture", b"0 Key", b"10 Key", b"ID of Joint", b"x",
    b"tab 1", b"1.5 3", b"nan. 3", b"1e308. 3",
)  # fmt: skip


class Pairs(list[tuple[Any, Any]]):
    """A msgpack map as a list of pairs, so that a key may appear twice."""


class Raw(bytes):
    """Bytes that are written into the msgpack unchanged."""


_RAWS = (
    b"\xc1",
    b"\xdd\xff\xff\xff\xff",
    b"\xdf\xff\xff\xff\xff",
    b"\xdb\xff\xff\xff\xff",
    b"\xc6\x7f\xff\xff\xff",
    b"\xc7\x05\x05hello",
    b"\xd6\xff\xff\xff\xff\xff",
    b"\xc7\x0c\xff" + b"\xff" * 12,
    b"\xc9\xff\xff\xff\xff\x01",
    b"\x91" * 3000 + b"\xc0",
    b"\x81\xa1a" * 1500 + b"\xc0",
    b"\xa3\xed\xa0\x80",
    b"\xa2\xff\xfe",
    b"\xcf" + b"\xff" * 8,
    b"\xd3\x80" + b"\0" * 7,
    b"\xcb\x7f\xf8" + b"\0" * 6,
)


class Mutator:
    """Makes one hostile input after another.

    Args:
        seeds: good inputs.
        kind: the inputs' format: msgpack, text, zip or mcap.
        seed: start of the random numbers; the same seed gives the same inputs.
    """

    def __init__(self, seeds: Sequence[bytes], kind: str, seed: int | str) -> None:
        self._chance = random.Random(seed)
        self._seeds = list(seeds)
        self._shaped = {
            "msgpack": self._msgpack,
            "text": self._text,
            "zip": self._zip,
            "mcap": self._mcap,
        }[kind]
        self._trees: dict[bytes, Any] = {}

    def next(self) -> bytes:
        """Return the next input."""
        chance = self._chance
        data = chance.choice(self._seeds)
        roll = chance.random()
        if roll < 0.02:
            return data
        if roll < 0.7:
            data = self._shaped(data)
        if roll > 0.6:
            for _ in range(chance.choice((1, 1, 1, 2, 4))):
                data = self._bytes(data)
        return data[:LARGEST] if len(data) > LARGEST and chance.random() < 0.9 else data

    def _bytes(self, data: bytes) -> bytes:
        chance = self._chance
        size = len(data)
        at = chance.randrange(size + 1)
        match chance.randrange(10):
            case 0 | 1 if size:
                at = min(at, size - 1)
                return data[:at] + bytes([data[at] ^ (1 << chance.randrange(8))]) + data[at + 1 :]
            case 2 if size:
                at = min(at, size - 1)
                value = chance.choice((0, 1, 0x7F, 0x80, 0xC1, 0xDD, 0xDF, 0xFF, 9, 10, 32, 34))
                return data[:at] + bytes([value]) + data[at + 1 :]
            case 3:
                return data[:at]
            case 4:
                end = min(size, at + chance.choice((1, 2, 8, 64, 1000)))
                return data[:at] + data[end:]
            case 5:
                end = min(size, at + chance.choice((1, 8, 64, 1000)))
                return data[:end] + data[at:end] * chance.choice((1, 2, 20)) + data[end:]
            case 6:
                other = chance.choice(self._seeds)
                return data[:at] + other[chance.randrange(len(other) + 1) :]
            case 7:
                return data[:at] + chance.randbytes(chance.choice((1, 2, 8, 64))) + data[at:]
            case 8:
                number = chance.choice(INTEGERS) % 2**64
                width, order = chance.choice((1, 2, 4, 8)), chance.choice(("big", "little"))
                packed = (number % 256**width).to_bytes(width, order)  # type: ignore[arg-type]
                return data[:at] + packed + data[at + width :]
            case _:
                return data[:at] + chance.choice(TOKENS) + data[at:]

    # Messages

    def _msgpack(self, data: bytes) -> bytes:
        tree = self._trees.get(data)
        if tree is None:
            try:
                tree = msgpack.unpackb(data, object_pairs_hook=Pairs, strict_map_key=False)
            except Exception:
                return self._bytes(data)
            if len(self._trees) < 1000:
                self._trees[data] = tree
        for _ in range(self._chance.choice((1, 1, 2))):
            tree = self._changed(tree)
        return pack(tree)

    def _changed(self, node: Any) -> Any:
        """Return the tree below `node` with one of its nodes changed."""
        chance = self._chance
        if isinstance(node, list) and node and chance.random() < 0.85:
            copy = type(node)(node)
            at = chance.randrange(len(copy))
            if isinstance(node, Pairs):
                key, value = copy[at]
                roll = chance.random()
                if roll < 0.1:
                    copy.append((key, self._value()))  # the same key a second time
                elif roll < 0.2:
                    copy[at] = (self._value(), value)
                else:
                    copy[at] = (key, self._changed(value))
            else:
                copy[at] = self._changed(copy[at])
            return copy
        if isinstance(node, list) and node:
            copy = type(node)(node)
            at = chance.randrange(len(copy))
            match chance.randrange(5):
                case 0:
                    del copy[at]
                case 1:
                    copy.insert(at, copy[at])
                case 2:
                    copy *= chance.choice((2, 2, 50)) if len(copy) < 20 else 2
                case 3:
                    copy.insert(at, ("new", self._value()) if isinstance(copy, Pairs) else 0)
                case _:
                    return self._value()
            return copy
        if isinstance(node, bytes | str) and chance.random() < 0.4:
            raw = node if isinstance(node, bytes) else node.encode("utf-8", "replace")
            raw = self._bytes(raw)
            return raw if isinstance(node, bytes) else raw.decode("utf-8", "replace")
        if isinstance(node, int) and chance.random() < 0.4:
            return node + chance.choice((1, -1, 2**8, 2**32))
        return self._value()

    def _value(self) -> Any:
        chance = self._chance
        match chance.randrange(8):
            case 0 | 1:
                return chance.choice(INTEGERS)
            case 2:
                return chance.choice(FLOATS)
            case 3:
                return chance.choice(TEXTS)
            case 4:
                return chance.choice((None, True, False, [], Pairs(), b"", [[]]))
            case 5:
                return chance.choice((b"\0" * 8, b"x" * 2000, "x" * 2000))
            case 6:
                return Raw(chance.choice(_RAWS))
            case _:
                return chance.choice(([0], [0] * 5, Raw(b"\xdc\x13\x88" + bytes(5000))))

    # Texts

    def _text(self, data: bytes) -> bytes:
        chance = self._chance
        for _ in range(chance.choice((1, 1, 2, 5))):
            match chance.randrange(7):
                case 0 | 1 | 2:  # replace a word
                    at = chance.randrange(len(data) + 1)
                    while at > 0 and data[at - 1 : at] not in (b"\t", b" ", b"\n", b"=", b","):
                        at -= 1
                    end = at
                    while end < len(data) and data[end] not in b"\t \n,=]":
                        end += 1
                    data = data[:at] + chance.choice(TOKENS) + data[end:]
                case 3:
                    lines = data.split(b"\n")
                    at = chance.randrange(len(lines))
                    copies = chance.choice((0, 2, 2, 30))
                    data = b"\n".join(lines[:at] + lines[at : at + 1] * copies + lines[at + 1 :])
                case 4:
                    lines = data.split(b"\n")
                    chance.shuffle(lines)
                    data = b"\n".join(lines)
                case 5:
                    old, new = chance.sample((b"\t", b"\n", b" ", b"\r\n", b",", b"", b"\0"), 2)
                    data = data.replace(old or b".", new)[: 2 * LARGEST]
                case _:
                    text = data.decode("utf-8", "replace")
                    name = chance.choice(("utf-16", "utf-16-le", "utf-16-be", "cp932", "utf-8-sig"))
                    data = text.encode(name, "replace")
        return data

    # Workbooks

    def _zip(self, data: bytes) -> bytes:
        chance = self._chance
        parts = self._trees.get(data)
        if parts is None:
            with zipfile.ZipFile(io.BytesIO(data)) as archive:
                parts = [(info.filename, archive.read(info)) for info in archive.infolist()]
            self._trees[data] = parts
        parts = list(parts)
        for _ in range(chance.choice((1, 1, 2, 4))):
            at = chance.randrange(len(parts))
            name, content = parts[at]
            match chance.randrange(8):
                case 0:
                    del parts[at]
                    parts = parts or [("a", b"")]
                case 1:
                    parts.append((name, self._bytes(content)))
                case 2:
                    parts[at] = (self._bytes(name.encode()).decode("latin1")[:60000], content)
                case 3 | 4:  # remove or repeat an element
                    cells = content.split(b"<")
                    one = chance.randrange(len(cells))
                    copies = chance.choice((0, 2, 2, 500, 60_000))
                    made = cells[:one] + cells[one : one + 1] * copies + cells[one + 1 :]
                    parts[at] = (name, b"<".join(made)[: 1 << 20])
                case 5:
                    cells = content.split(b">")
                    one = chance.randrange(len(cells))
                    cells[one] += b">" + chance.choice(TOKENS)
                    parts[at] = (name, b">".join(cells))
                case _:
                    parts[at] = (name, self._bytes(self._bytes(content)))
        stream = io.BytesIO()
        warnings.simplefilter("ignore")  # the same name twice is intended
        method = chance.choice((zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED))
        with zipfile.ZipFile(stream, "w", method, compresslevel=1) as archive:
            for name, content in parts:
                archive.writestr(zipfile.ZipInfo(name or "a"), content, method)
        made = stream.getvalue()
        if chance.random() < 0.1:  # false sizes and offsets
            at = made.rfind(b"PK\x01\x02") + chance.choice((10, 16, 20, 24, 42))
            number = chance.choice(INTEGERS) % 2**32
            made = made[:at] + struct.pack("<I", number) + made[at + 4 :]
        return made

    # Records

    def _mcap(self, data: bytes) -> bytes:
        chance = self._chance
        records = self._trees.get(data)
        if records is None:
            records = self._trees[data] = list(_mcap_records(data[8:-8]))
        records = list(records)
        for _ in range(chance.choice((1, 1, 2))):
            if not records:
                break
            at = chance.randrange(len(records))
            code, content = records[at]
            match chance.randrange(8):
                case 0:
                    del records[at]
                case 1:
                    records.insert(chance.randrange(len(records) + 1), records[at])
                case 2:
                    copies = chance.choice((2, 20, 2000 if len(content) < 1000 else 2))
                    records[at:at] = [records[at]] * copies
                case 3 | 4 if code == 5:
                    head, body = content[:22], content[22:]
                    if chance.random() < 0.3:
                        head = self._bytes(head)
                    records[at] = (code, head + self._msgpack(body))
                case 3 | 4 | 5 if code == 6:
                    records[at] = (code, self._chunk(content))
                case _:
                    records[at] = (code, self._bytes(content))
        made = [data[:8]]
        lie = chance.randrange(len(records)) if records and chance.random() < 0.1 else -1
        for number, (code, content) in enumerate(records):
            size = len(content) if number != lie else chance.choice(INTEGERS) % 2**64
            made.append(struct.pack("<BQ", code, size) + content)
        return b"".join([*made, data[-8:]])

    def _chunk(self, content: bytes) -> bytes:
        """Return the content of an MCAP chunk with changed records and perhaps with false sizes."""
        chance = self._chance
        if len(content) < 40:
            return self._bytes(content)
        size, _, length = struct.unpack_from("<QII", content, 16)
        packed = content[40 + length :]
        if content[32 : 32 + length] != b"zstd" or _unpacked(packed) > 1 << 20:
            return self._bytes(content)
        try:
            inside = zstandard.decompress(packed, max_output_size=min(size, 1 << 20))
        except zstandard.ZstdError:
            return self._bytes(content)
        records = list(_mcap_records(inside)) or [(5, inside)]
        if chance.random() < 0.2:
            inside = b"\0" * chance.choice((0, 1, 1 << 22, 1 << 27))
        else:
            for _ in range(chance.choice((1, 3))):
                at = chance.randrange(len(records))
                code, body = records[at]
                if code == 5 and chance.random() < 0.7:
                    records[at] = (code, body[:22] + self._msgpack(body[22:]))
                elif chance.random() < 0.5:
                    records[at] = (code, self._bytes(body))
                else:
                    records[at:at] = [records[chance.randrange(len(records))]] * 20
            inside = b"".join(struct.pack("<BQ", c, len(b)) + b for c, b in records)
        packed = zstandard.ZstdCompressor(1, write_content_size=chance.random() < 0.7).compress(
            inside
        )
        if chance.random() < 0.3:
            packed = self._bytes(packed)
        told = len(inside) if chance.random() < 0.8 else chance.choice(INTEGERS) % 2**64
        crc = chance.choice((0, zlib.crc32(inside)))
        name = b"zstd" if chance.random() < 0.9 else chance.choice((b"lz4", b"", b"xz"))
        head = content[:16] + struct.pack("<QII", told, crc, len(name)) + name
        return head + struct.pack("<Q", len(packed)) + packed


def pack(node: Any) -> bytes:
    """Write a tree as msgpack, including parts that no library would write.

    A value that msgpack can't hold becomes nil.
    """
    if not isinstance(node, list | Raw):
        try:
            return msgpack.packb(node)  # type: ignore[no-any-return]
        except (OverflowError, ValueError, TypeError):
            return b"\xc0"
    if isinstance(node, Raw):
        return bytes(node)
    if isinstance(node, Pairs):
        parts = [pack(part) for pair in node for part in pair]
        return _head(len(node), 0x80, 0xDE) + b"".join(parts)
    return _head(len(node), 0x90, 0xDC) + b"".join(map(pack, node))


def _head(size: int, short: int, long: int) -> bytes:
    if size < 16:
        return bytes([short | size])
    return struct.pack(">BH", long, size) if size < 65536 else struct.pack(">BI", long + 1, size)


def _unpacked(packed: bytes) -> int:
    try:
        return int(zstandard.frame_content_size(packed))
    except zstandard.ZstdError:
        return 1 << 62


def _mcap_records(data: bytes) -> Any:
    at = 0
    while at + 9 <= len(data):
        code, size = struct.unpack_from("<BQ", data, at)
        yield code, data[at + 9 : at + 9 + size]
        at += 9 + size
