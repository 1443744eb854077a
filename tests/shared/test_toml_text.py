"""TOML from strangers: it is read or refused with one error, in little time and memory."""

import time

import pytest

from lacoc_shared.contest.toml_text import BadToml, read_toml


def test_what_people_write_is_read() -> None:
    """A byte order mark, nested tables, 64-bit numbers and texts with dots are read."""
    data = '\ufeffa.b = [1, {c = 2.5}]\nd = "1.2.3"\ne = 0xffff_ffff_ffff_ffff\n'.encode()
    assert read_toml(data) == {"a": {"b": [1, {"c": 2.5}]}, "d": "1.2.3", "e": 2**64 - 1}


@pytest.mark.parametrize(
    ("data", "words", "row"),
    [
        (b"a = 1\nb = \n", "Invalid value", 2),
        (b"a = '\xff'", "not text in UTF-8: expected a TOML file saved as UTF-8", None),
        (
            "name = '六足'".encode("cp932"),
            "not text in UTF-8: expected a TOML file saved as UTF-8",
            None,
        ),
        (
            "name = '六足'".encode("utf-16"),
            "not text in UTF-8: expected a TOML file saved as UTF-8",
            None,
        ),
        (
            "name = 'six'".encode("utf-16-be"),
            "not text in UTF-8: expected a TOML file saved as UTF-8",
            None,
        ),
        (b"a = " + b"[" * 5000, "too deep", None),
        (b"a = " + b"[" * 40 + b"]" * 40, "too deep", None),
        (b"a = [{" + b"b." * 60 + b"c = 1}]", "too deep", None),
        (b"x = 1\na = 1" + b"0" * 5000, r"^a number with too many digits \(line 2\)", 2),
        (b"a = [0x" + b"f" * 5000 + b"]", "too many digits", None),
        (b"a = 1\n" + b"b." * 15000 + b"c = 1", "dots in a line", 2),
        (b"#" * 2000, "at most 1000", None),
    ],
    ids=[
        "no TOML",
        "no UTF-8",
        "Shift-JIS",
        "UTF-16",
        "UTF-16 bare",
        "open",
        "deep",
        "dotted",
        "long",
        "long hex",
        "dots",
        "large",
    ],
)
def test_hostile_text_is_refused_at_once(data: bytes, words: str, row: int | None) -> None:
    """Hostile TOML is refused within half a second of processor time."""
    begin_s = time.process_time()
    with pytest.raises(BadToml, match=words) as caught:
        read_toml(data, 1000 if b"##" in data else 32 * 1024)
    assert caught.value.row == row
    assert time.process_time() - begin_s < 0.5
