"""Tests of pictures of teams: what becomes of a file, and the way to the pages and the folder."""

import hashlib
import io
import struct
import zlib
from contextlib import suppress
from pathlib import Path

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from office_room import CODE, KEY, Room, said, sample
from PIL import Image

from lacoc_server.contest.kept.entries import gather_entry
from lacoc_server.contest.kept.publish import publish
from lacoc_server.contest.kept.team_picture import SIDE_PX, small_picture
from lacoc_server.contest.league import facts as league_facts
from lacoc_server.contest.league.contest import compute
from lacoc_server.contest.league.facts import Entered
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.verify.published import check_published
from lacoc_shared.contest.file import picture_path
from lacoc_shared.messages import SentFile
from lacoc_shared.messages.desk import (
    Apply,
    Approve,
    ChangeFiles,
    CloseEntries,
    OwnEntry,
    SeePicture,
    TeamFiles,
    TeamPicture,
)
from lacoc_shared.mistakes import UserError


def drawn(kind: str, size: tuple[int, int] = (300, 200), **options: object) -> bytes:
    """Return a picture file whose left half is red and whose right half is blue."""
    picture = Image.new("RGB", size, "red")
    picture.paste("blue", (size[0] // 2, 0, *size))
    out = io.BytesIO()
    picture.save(out, kind, **options)
    return out.getvalue()


PNG = drawn("PNG")


def claiming(width_px: int, height_px: int) -> bytes:
    """Return a small file that says that its picture is large."""
    header = b"IHDR" + struct.pack(">IIBBBBB", width_px, height_px, 8, 2, 0, 0, 0)
    check = struct.pack(">I", zlib.crc32(header))
    return PNG[:12] + header + check + PNG[33:]


def with_picture(data: bytes = PNG, name: str = "we.png") -> TeamFiles:
    """Return the sample's files and a picture."""
    return msgspec.structs.replace(sample(), picture=SentFile(name, data))


@pytest.mark.parametrize("kind", ["PNG", "JPEG", "WEBP", "GIF"])
def test_a_picture_becomes_a_small_square(kind: str) -> None:
    """Of each kind of file the middle is kept, upright, as a WebP file of a fixed size."""
    made = small_picture(SentFile("we", drawn(kind)))
    with Image.open(io.BytesIO(made)) as picture:
        assert (picture.format, picture.size) == ("WEBP", (SIDE_PX, SIDE_PX))
        red, _, blue = picture.convert("RGB").getpixel((20, 20))  # type: ignore[misc]
        assert red > 200 > 60 > blue
    assert len(made) < 20_000


def test_nothing_else_of_a_file_is_kept() -> None:
    """What a camera wrote into the picture, and what stands behind its end, does not come along."""
    exif = Image.Exif()
    exif[0x010E], exif[0x0112] = "at home", 6  # description; turned by a quarter
    made = small_picture(SentFile("we.jpg", drawn("JPEG", exif=exif) + b"<script>"))
    assert b"at home" not in made
    assert b"script" not in made
    with Image.open(io.BytesIO(made)) as picture:
        top, below = (picture.convert("RGB").getpixel((96, y)) for y in (10, 180))
        assert (top[0] > 200, below[2] > 200) == (True, True)  # type: ignore[index]


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b"hello", "desk.no-picture"),
        (b"<svg xmlns='http://www.w3.org/2000/svg'/>", "desk.no-picture"),
        (PNG[: len(PNG) // 2], "desk.damaged-picture"),
        (drawn("PNG", (5000, 10)), "desk.large-picture"),
        (claiming(12_000, 12_000), "desk.large-picture"),
        (claiming(50_000, 50_000), "desk.large-picture"),
    ],
)
def test_what_is_no_picture_is_told(data: bytes, why: str) -> None:
    """Other files, halves and giants are refused, each with its reason."""
    with pytest.raises(UserError) as error:
        small_picture(SentFile("we.png", data))
    assert error.value.phrase.code == why


@given(st.binary(max_size=64), st.integers(0, len(PNG) - 1), st.integers(1, 255))
def test_a_damaged_picture_ends_nothing(more: bytes, at: int, flip: int) -> None:
    """Whatever the bytes, there is a picture or a reason."""
    data = bytearray(PNG)
    data[at] ^= flip
    for one in (bytes(data) + more, more, PNG[:8] + more):
        with suppress(UserError):
            assert small_picture(SentFile("x", one)).startswith(b"RIFF")


def test_an_entry_without_a_picture_has_the_hash_that_it_always_had() -> None:
    """Published folders from before there were pictures still name their entries rightly."""
    entry = gather_entry(None, "planner", "hexapod").entry
    parts = {
        "robot": entry.robot,
        "postures": entry.postures,
        "locomotion": entry.locomotion,
        "bot": "planner",
        "program": None,
    }
    packed = msgspec.msgpack.encode(parts)
    assert entry.hash == hashlib.blake2b(packed, digest_size=16).hexdigest()
    assert msgspec.structs.replace(entry, picture=b"x").hash != entry.hash


def test_a_picture_comes_with_the_files_and_stays(tmp_path: Path) -> None:
    """A picture waits, is approved and published with the team's files; other files keep it."""
    room = Room(tmp_path)
    room.enter("Ants")
    refused = room.ask(Apply(secret=CODE, team="Bees", files=with_picture(b"no")))
    assert said(refused) == "desk.no-picture"
    applied = room.ask(Apply(secret=CODE, team="Bees", files=with_picture()))
    assert isinstance(applied, OwnEntry)
    assert [row.picture for row in room.view.teams if row.team == "Bees"] == [True]
    seen = room.ask(SeePicture(secret=KEY, team="Bees"))
    assert seen == TeamPicture(webp=small_picture(SentFile("we.png", PNG)))
    assert room.ask(SeePicture(secret=KEY, team="Ants")) == TeamPicture(webp=b"")

    room.ask(Approve(secret=KEY, teams=("Bees",)))
    changed = room.ask(ChangeFiles(secret=applied.token, files=sample(b"\n")))
    assert isinstance(changed, OwnEntry)
    assert changed.files != applied.files
    team = compute(room.facts, FORMATS).teams[1]
    assert (team.files, team.picture) == (changed.files, True)
    path = picture_path(room.where.sheet, team.files)
    assert path is not None
    assert path.read_bytes() == seen.webp
    assert picture_path(room.where.sheet, "../secrets") is None

    room.ask(CloseEntries(secret=KEY))
    out = tmp_path / "out"
    publish(room.where, room.facts, out)
    assert (out / "entries" / team.files / "picture.webp").read_bytes() == seen.webp
    assert [*check_published(out, room.facts)] == []
    forged = tuple(
        msgspec.structs.replace(fact, picture=not fact.picture)
        if isinstance(fact, Entered)
        else fact
        for fact in room.facts
    )
    (out / "facts.json").write_bytes(league_facts.encode(forged))
    told = {phrase.code for phrase in check_published(out, forged)}
    assert "verify.other-picture" in told


def test_the_organiser_takes_a_picture_away(tmp_path: Path) -> None:
    """Files that wait, and those that a team plays with, lose their picture alone."""
    room = Room(tmp_path)
    applied = room.ask(Apply(secret=CODE, team="Bees", files=with_picture()))
    assert isinstance(applied, OwnEntry)
    room.ask(SeePicture(secret=KEY, team="Bees", remove=True))
    assert room.ask(SeePicture(secret=KEY, team="Bees")) == TeamPicture(webp=b"")
    assert room.states() == {"Bees": "waits"}

    room.ask(Approve(secret=KEY, teams=("Bees",)))
    room.ask(ChangeFiles(secret=applied.token, files=with_picture()))
    assert compute(room.facts, FORMATS).teams[0].picture
    room.ask(SeePicture(secret=KEY, team="Bees", remove=True))
    team = compute(room.facts, FORMATS).teams[0]
    assert not team.picture
    assert room.where.entries.load(team.files).picture is None
    assert said(room.ask(SeePicture(secret=applied.token, team="Bees"))) == "desk.not-organiser"


def test_a_folder_with_a_picture_enters_with_it(tmp_path: Path) -> None:
    """`lacoc contest enter --folder` takes the picture of the folder."""
    postures = sample().postures
    assert postures is not None
    (tmp_path / "Loco-data.txt").write_bytes(postures.data)
    (tmp_path / "picture.png").write_bytes(PNG)
    handed = gather_entry(tmp_path, "", "hexapod")
    assert handed.entry.picture == small_picture(SentFile("picture.png", PNG))
    assert "picture.png" in handed.taken
