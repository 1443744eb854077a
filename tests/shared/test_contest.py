"""Tests of the contest file, and of which source gives an option its value."""

from pathlib import Path

import pytest

from lacoc_shared.contest import file as contests
from lacoc_shared.mistakes import UserError

GOOD = """
[contest]
name = "Spring"
recordings = "records"
robot = "robots/own.toml"
[limits]
legs_max = 6
[health]
silent_s = 2
[court.main]
arena = "othello"
listen = ["0.0.0.0", "tcp/127.0.0.1:7450"]
[court.main.settings.match]
duration_s = 60.0
"""
SECOND = """
[court.second]
arena = "games/tag"
listen = ["0.0.0.0:7448"]
connect = "court.example.org:7448"
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "contest.toml"
    path.write_text(GOOD)
    return path


def test_a_good_file_loads_with_paths_from_its_own_folder(file: Path) -> None:
    """Relative paths in a contest file start from its folder; names of arenas stay names."""
    file.write_text(GOOD + SECOND)

    contest = contests.load(file)

    assert contest.name == "Spring"
    assert contest.recordings == file.parent / "records"
    assert contest.robot == str(file.parent / "robots/own.toml")
    assert contest.limits == {"legs_max": 6.0}
    assert contest.health == contests.HealthLimits(silent_s=2.0)
    assert contest.courts["main"].arena == "othello"
    assert contest.courts["main"].listen == ("tcp/0.0.0.0:7447", "tcp/127.0.0.1:7450")
    assert contest.courts["main"].settings == {"match": {"duration_s": 60.0}}
    assert contest.courts["second"].arena == str(file.parent / "games/tag")
    assert contest.courts["second"].connect == "tcp/court.example.org:7448"


def test_records_may_be_in_the_home_folder(file: Path) -> None:
    """A ~ in a path is the user's own folder, here as everywhere."""
    file.write_text(GOOD.replace('"records"', '"~/records"'))
    assert contests.load(file).recordings == Path.home() / "records"


def test_empty_tables_are_courts_with_ports_of_their_own(file: Path) -> None:
    """A court needs no entry: it plays Othello, and listens on this machine alone."""
    file.write_text("[court.red]\n[court.blue]\n")
    courts = contests.load(file).courts
    assert {name: (one.arena, one.listen) for name, one in courts.items()} == {
        "red": ("othello", ("tcp/127.0.0.1:7447",)),
        "blue": ("othello", ("tcp/127.0.0.1:7448",)),
    }


def test_links_are_made_equal_where_the_court_says_so(file: Path) -> None:
    """A court makes links equal only if its entry says so, with at most 400 ms by default."""
    assert contests.load(file).courts["main"].most_delay_ms == 0
    equal = 'arena = "othello"\ninput_delay = "equal"'
    file.write_text(GOOD.replace('arena = "othello"', equal))
    assert contests.load(file).courts["main"].most_delay_ms == 400


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('arena = "othello"', 'arena = "othello"\ninput_delay = "fair"', r"court.main.input_delay"),
        (
            'arena = "othello"',
            'arena = "othello"\ninput_delay_max_ms = 5',
            r"court.main.input_delay_max_ms.*at least 20",
        ),
        (
            'arena = "othello"',
            "arena = 3",
            r"court.main.arena\]: expected text in quotes, found a whole number",
        ),
        ("arena =", "aren =", r"no entry \"aren\".*Allowed entries: arena, listen"),
        (
            "legs_max = 6",
            'legs_max = "6"',
            r"\[limits.legs_max\]: expected a number, without quotes, found text in quotes",
        ),
        (
            "[contest]",
            '[contest]\nleast_rest_s = "60"',
            r"\[contest.least_rest_s\]: expected a number, without quotes, found text",
        ),
        ("legs_max = 6", "legs_max = nan", r"limits.legs_max.*finite number, found nan"),
        ('"0.0.0.0"', '"http://x"', r'court.main.*"http://x" is not an address'),
        ('listen = ["0.0.0.0", "tcp/127.0.0.1:7450"]', "listen = []", r"court.main.listen"),
        ("[court.main", "[court.Main", r'court.Main.*"Main"'),
        (
            "[contest]",
            "[contst]",
            r"no entry \"contst\".*contest, limits, health, standby, court",
        ),
        ('arena = "othello"', 'arena = "a\\u0000/b"', "is not a path"),
        ('robot = "robots/own.toml"', 'robot = "~nobody-here/b"', "is not a path"),
        ('recordings = "records"', 'recordings = "a\\u0000b"', r"contest\.recordings"),
        (
            'recordings = "records"',
            'recordings = "~nobody-here/b"',
            "~nobody-here/b. is not a path",
        ),
        ("[contest]", '[contest]\nauthority = "~nobody-here/b"', "~nobody-here/b. is not a path"),
        ("legs_max = 6", "legs_max = 1" + "0" * 5000, "digits"),
        ("legs_max = 6", "legs_max = " + "[" * 2000, "too deep"),
        ("duration_s = 60.0", "duration_s = 0x" + "f" * 40, "many digits"),
        ('name = "Spring"', "name = Spring", r"can't be read.*\(line 3\): name = Spring\.$"),
        ("silent_s = 2", "faults = -1", r"health.faults.*expected a whole number of at least 0"),
        ("silent_s = 2", "silent_s = nan", r"health.silent_s"),
        ("silent_s = 2", "silent = 1", r"no entry \"silent\".*silent_s"),
        ("[limits]", '[office]\ntoken = "a secret of old"\n[limits]', r'no entry "office"'),
        (GOOD, "[contest]\n", r"entry \"court\" is missing"),
        (GOOD, "court = 1\n", r"\[court\]: expected a table, found a whole number"),
        (GOOD, "[court]\nmain = 1\n", r"\[court.main\]: expected a table, found a whole number"),
        (GOOD, "[court]\n", r"\[court\]: expected a table with a length of at least 1"),
    ],
)
def test_a_wrong_entry_is_named(file: Path, old: str, new: str, said: str) -> None:
    """The message about a wrong entry names the file, the entry, and what was expected."""
    assert old in GOOD
    file.write_text(GOOD.replace(old, new))

    with pytest.raises(UserError, match=said) as caught:
        contests.load(file)

    assert str(file) in str(caught.value)


def test_all_wrong_entries_are_named_at_once(file: Path) -> None:
    """Each wrong entry of each table has a line; what follows from another mistake has none."""
    wrong = GOOD
    for old, new in (
        ("[contest]", '[contest]\nleast_rest_s = "60"\nrebot = "a"\nentries_close = "noon"'),
        ("legs_max = 6", "legs_max = nan"),
        ('arena = "othello"', 'arena = 3\ninput_delay = "fair"\ninput_delay_max_ms = 5'),
        ("silent_s = 2", "silent = 1"),
    ):
        assert old in wrong
        wrong = wrong.replace(old, new)
    file.write_text(wrong)
    with pytest.raises(UserError) as caught:
        contests.load(file)
    lines = str(caught.value).splitlines()
    assert all(line.startswith(f"Contest file {file}, [") for line in lines)
    assert [line.partition("[")[2].partition("]")[0] for line in lines] == [
        "contest.entries_close",
        "contest.least_rest_s",
        "contest",
        "court.main.arena",
        "court.main.input_delay",
        "court.main.input_delay_max_ms",
        "limits.legs_max",
        "health",
    ]
    assert lines[4].endswith('"fair" is not possible; choose none or equal.')


@pytest.mark.parametrize(
    "time",
    [
        '"next tuesday"',
        "next tuesday",
        '"2026-11-25 09:00"',
        "2026-11-25",
        "2026-11-25 9:00",
        "2026-13-25T09:00:00+09:00",
        "2026-11-25T09:00:00+9",
        "20261125",
    ],
)
def test_a_wrong_time_is_told_with_an_example(file: Path, time: str) -> None:
    """Whatever is wrong with the time, one message names the entry, what it is, and a right one."""
    file.write_text(GOOD.replace("[contest]", f"[contest]\nentries_close = {time}  # noon"))
    with pytest.raises(UserError) as caught:
        contests.load(file)
    assert str(caught.value) == (
        f"Contest file {file}, [contest.entries_close]: expected a time such as "
        f"2026-11-25T09:00:00+09:00, without quotes, found {time}."
    )


@pytest.mark.parametrize("time", ["9999-12-31T23:59:59-09:00", "0001-01-01T00:00:00+09:00"])
def test_a_time_that_is_in_no_calendar_is_wrong(file: Path, time: str) -> None:
    """In UTC it would be in the year 10000 or 0."""
    file.write_text(GOOD.replace("[contest]", f"[contest]\nentries_close = {time}"))
    with pytest.raises(UserError, match=rf"expected a time such as .* found {time[:10]}"):
        contests.load(file)


@pytest.mark.parametrize("time", ["2026-11-25T09:00:00+09:00", '"2026-11-25T09:00:00+09:00"'])
def test_a_right_time_is_read(file: Path, time: str) -> None:
    """The time of the example is read, with and without quotes."""
    file.write_text(GOOD.replace("[contest]", f"[contest]\nentries_close = {time}"))
    close = contests.load(file).entries_close
    assert close is not None
    assert close.isoformat() == "2026-11-25T09:00:00+09:00"


def test_only_a_missing_file_is_to_be_written(file: Path) -> None:
    """A file that is there but wrong is to be mended; 'init' would move it away."""
    file.write_text("[contest\n")
    with pytest.raises(UserError, match=r"can't be read: .*line 1") as caught:
        contests.load(file)
    assert "init" not in str(caught.value)
    file.unlink()
    with pytest.raises(UserError, match="'lacoc contest init' writes one"):
        contests.load(file)


TWO = """
[court.main]
arena = "othello"
{main}
[court.second]
arena = "othello"
{second}
"""


@pytest.mark.parametrize(
    ("main", "second"),
    [
        ("", 'listen = ["127.0.0.1"]'),
        ('listen = ["0.0.0.0:7448"]', ""),
        ('listen = ["10.0.0.7:7450", "127.0.0.1"]', 'listen = ["[::]:7447"]'),
        ('listen = ["0.0.0.0:7448"]\nconnect = "one.example"', ""),
        (
            'listen = ["0.0.0.0:7448"]\nconnect = "one.example"',
            'connect = "one.example:7448"',
        ),
    ],
)
def test_two_courts_at_one_port_are_named(file: Path, main: str, second: str) -> None:
    """Two courts that would use the same port are refused; the message suggests a free port."""
    file.write_text(TWO.format(main=main, second=second))
    with pytest.raises(
        UserError, match=r'court\.second.*"main" listens at .*:744[78] too.*:744[789]'
    ):
        contests.load(file)


@pytest.mark.parametrize(
    ("main", "second"),
    [
        ("", ""),
        ('listen = ["127.0.0.1:0"]', 'listen = ["0.0.0.0:0"]'),
        ('listen = ["10.0.0.7"]', 'listen = ["10.0.0.8"]'),
        (
            'listen = ["0.0.0.0"]\nconnect = "one.example"',
            'listen = ["0.0.0.0"]\nconnect = "two.example"',
        ),
    ],
)
def test_courts_that_can_run_at_once_are_right(file: Path, main: str, second: str) -> None:
    """Courts with different ports, addresses or machines are accepted."""
    file.write_text(TWO.format(main=main, second=second))
    assert list(contests.load(file).courts) == ["main", "second"]


ELSEWHERE = TWO.format(
    main='elsewhere = "10.0.0.7"', second='listen = ["127.0.0.1:7448"]\nelsewhere = "10.0.0.8:7450"'
)


def test_a_court_elsewhere_has_two_addresses(file: Path) -> None:
    """Clients look for it on its machine first, then where the office runs it instead."""
    file.write_text(ELSEWHERE)
    contest = contests.load(file)
    assert contest.access("second").addresses == ["tcp/10.0.0.8:7450", "tcp/127.0.0.1:7448"]


def test_mistakes_with_courts_elsewhere_are_told(file: Path) -> None:
    """Each needs an address of its own."""
    file.write_text(ELSEWHERE.replace("10.0.0.8:7450", "10.0.0.7"))
    with pytest.raises(UserError, match=r'court\.second.*"main" is elsewhere at .*:7447 too'):
        contests.load(file)


STANDBY = """
[standby]
office = "{office}"
"""


def test_a_second_machine_has_an_address(file: Path) -> None:
    """The office lets it copy at the same port of every address of its own machine."""
    text = STANDBY.format(office="10.0.0.7:7440")
    file.write_text(text + TWO.format(main="", second='listen = ["127.0.0.1:7448"]'))
    found = contests.load(file).standby
    assert found is not None
    assert (found.office, found.listen) == ("tcp/10.0.0.7:7440", "tcp/0.0.0.0:7440")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (STANDBY.format(office="10.0.0.7:7448"), '"second" listens at'),
        (STANDBY.format(office="x y"), r"\[standby\]"),
        (STANDBY.format(office="tls/10.0.0.7:1"), r"\[standby\]"),
        (STANDBY.format(office="10.0.0.7:1") + "token = 'a'\n", r'no entry "token"'),
    ],
)
def test_mistakes_with_a_second_machine_are_told(file: Path, text: str, said: str) -> None:
    """It needs an address, with a port that no court has."""
    file.write_text(text + TWO.format(main="", second='listen = ["127.0.0.1:7448"]'))
    with pytest.raises(UserError, match=said):
        contests.load(file)


def test_no_file_and_no_text_are_said(tmp_path: Path) -> None:
    """A missing file, or one that is not text, is refused with a message."""
    with pytest.raises(UserError, match=r"No such file.*lacoc contest init"):
        contests.load(tmp_path / "none.toml")
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(UserError, match="can't be read"):
        contests.load(tmp_path / "bytes.toml")


def test_a_file_saved_by_an_editor_that_writes_a_mark_loads(file: Path) -> None:
    """A contest file that begins with a UTF-8 byte order mark loads."""
    file.write_bytes(b"\xef\xbb\xbf" + GOOD.encode())

    assert contests.load(file).name == "Spring"


def test_the_only_court_needs_no_name(file: Path) -> None:
    """A contest's only court needs no name; an error about a court's name lists all courts."""
    assert contests.load(file).court()[0] == "main"
    file.write_text(GOOD + SECOND)
    contest = contests.load(file)
    assert contest.court("second")[0] == "second"
    for name in (None, "third"):
        with pytest.raises(UserError, match="main, second"):
            contest.court(name)
