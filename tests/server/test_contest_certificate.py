"""Tests of `lacoc contest certificate`: its files, who may read them, what a second run keeps."""

import ssl
import stat
from pathlib import Path

import pytest
from typer.testing import CliRunner

from lacoc_server.commands.contest.app import app
from lacoc_shared.contest import file as contests
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.certificate import Certificate

FILES = ("authority.pem", "authority.key", "fullchain.pem", "privkey.pem")


def run(*args: str) -> str:
    result = CliRunner().invoke(app, args)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result.output


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "contest.toml"
    run("init", str(path))
    return path


def names(file: Path) -> set[tuple[str, str]]:
    """Return the names in a contest's certificate, as Python's `ssl` decodes them."""
    shown = ssl._ssl._test_decode_cert(str(file.parent / "tls/fullchain.pem"))  # type: ignore[attr-defined]
    return set(shown["subjectAltName"])


def test_one_command_encrypts_a_contest(file: Path) -> None:
    """It makes a certificate that its authority vouches for, and courts listen at TLS."""
    run("certificate", str(file), "--host", "192.168.1.20", "--host", "court.example.org")

    contest = contests.load(file)
    assert contest.courts["main"].listen == ("tls/0.0.0.0:7447",)
    assert contest.public.scheme == "https"
    assert "has no mistakes" in run("check", str(file))
    assert names(file) >= {("DNS", "localhost"), ("IP Address", "127.0.0.1")}
    assert names(file) >= {("DNS", "court.example.org"), ("IP Address", "192.168.1.20")}
    assert contest.public.pair is not None
    Certificate(contest.public.pair)
    access = contest.access(contest.court()[0])
    assert access.authority == (file.parent / "tls/authority.pem").read_text()
    assert "PRIVATE" not in access.authority


def test_a_certificate_must_outlast_the_entries(file: Path) -> None:
    """`check` says when it ends, also if entries close in the last year that there is."""
    run("certificate", str(file))
    end = "entries_close = 9999-12-31T23:59:59Z"
    file.write_text(file.read_text().replace("[contest]", f"[contest]\n{end}", 1))
    assert "The certificate ends on" in run("check", str(file))


def test_the_hosts_of_the_contest_file_are_named_too(file: Path) -> None:
    """The certificate also names the pages, the courts, and the machines of courts elsewhere."""
    text = file.read_text().replace("[contest]", '[contest]\npages = "https://pages.example"')
    text = text.replace("# connect =", "connect =")
    file.write_text(text.replace("[court.main]", '[court.main]\nelsewhere = "10.0.0.9"'))
    run("certificate", str(file))
    assert names(file) >= {("DNS", "pages.example"), ("IP Address", "192.168.1.20")}
    assert ("IP Address", "10.0.0.9") in names(file)


def test_all_of_it_is_its_owners_alone(file: Path) -> None:
    """All files, also the contest file, have mode 0600, and their folder has 0700."""
    run("certificate", str(file))
    folder = file.parent / "tls"
    assert sorted(one.name for one in folder.iterdir()) == sorted(FILES)
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    found = [file, *folder.iterdir()]
    assert {stat.S_IMODE(one.stat().st_mode) for one in found} == {0o600}


def test_a_second_run_keeps_the_authority_and_the_names(file: Path) -> None:
    """A second run makes a new certificate with one more name; the contest file stays the same."""
    run("certificate", str(file), "--host", "one.example")
    authority, chain, *_ = before = [(file.parent / "tls" / name).read_bytes() for name in FILES]
    text = file.read_text()
    run("certificate", str(file), "--host", "two.example")

    after = [(file.parent / "tls" / name).read_bytes() for name in FILES]
    assert before[:2] == after[:2]
    assert {*before[2:]}.isdisjoint(after[2:])
    assert authority != chain
    assert file.read_text() == text
    assert names(file) >= {("DNS", "one.example"), ("DNS", "two.example")}


def test_the_entries_go_into_any_contest_file(tmp_path: Path) -> None:
    """The entries are added to files with and without a table [contest]; other lines stay.

    If the file has `contest.name = ...` instead, an error says what to write.
    """
    for number, head in enumerate(
        (
            '[contest]\r\nname = "A"\r\n',
            "# my contest\n",
            "[ contest ] # here\n",
            'contest.name = "A"\n',
        )
    ):
        file = tmp_path / f"{number}" / "contest.toml"
        file.parent.mkdir()
        court = '[court.main]\narena = "othello"\n'
        file.write_bytes(f"{head}{court}".encode())
        if head.startswith("contest."):
            with pytest.raises(UserError, match=r"below a line \[contest\]"):
                run("certificate", str(file))
            continue
        run("certificate", str(file))
        assert contests.load(file).public.protocol == "tls"
        assert head.splitlines()[0] in file.read_text()


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"0.0.0.0:7447"', '"tcp/0.0.0.0:7447"', r"Write tls/0.0.0.0:7447"),
        ("listen =", "lisen =", "Allowed entries: arena"),
        ("[contest]", "[contest", "can't be read"),
        ("[contest]", '[contest]\npages = "http://a.example"', "begins with https://"),
        ("[contest]", '[contest]\ncertificate = "mine.pem"', "another certificate already"),
    ],
)
def test_a_wrong_file_is_said_and_left(file: Path, old: str, new: str, said: str) -> None:
    """If a contest file has a mistake, the command makes nothing and does not change the file."""
    file.write_text(file.read_text().replace(old, new, 1))
    text = file.read_text()
    with pytest.raises(UserError, match=said):
        run("certificate", str(file))
    assert file.read_text() == text
    assert not (file.parent / "tls").exists()


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("authority.key", None),
        ("authority.pem", None),
        ("authority.key", "fullchain.pem"),
        ("authority.key", "privkey.pem"),
        ("fullchain.pem", "privkey.pem"),
    ],
)
def test_a_file_that_can_not_be_used_is_said(file: Path, name: str, content: str | None) -> None:
    """If the authority is not whole, nothing is made in its place."""
    run("certificate", str(file))
    folder = file.parent / "tls"
    if content is None:
        (folder / name).unlink()
    else:
        (folder / name).write_bytes((folder / content).read_bytes())
    there = {path: path.read_bytes() for path in folder.iterdir()}
    with pytest.raises(UserError, match=rf"{name}.*can't be used"):
        run("certificate", str(file))
    assert {path: path.read_bytes() for path in folder.iterdir()} == there


def test_an_authority_that_can_not_be_read_is_said(file: Path) -> None:
    """A client that can't read the authority says so, instead of trusting nobody."""
    run("certificate", str(file))
    (file.parent / "tls/authority.pem").unlink()
    with pytest.raises(UserError, match=r"authority\.pem can't be read"):
        contests.load(file).access(contests.load(file).court()[0])
    with pytest.raises(UserError, match="not an address"):
        run("certificate", str(file), "--host", "no host")
