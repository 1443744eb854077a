"""Tests of `lacoc contest keys`: its files, who may read them, and that it destroys nothing."""

import ssl
import stat
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from lacoc_server.commands.contest.app import app
from lacoc_shared.contest import entrances
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.invitation import read_invitation
from lacoc_shared.mistakes import UserError


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


def certificate(path: Path) -> dict[str, Any]:
    """Return a certificate's fields as Python's `ssl` decodes them."""
    return ssl._ssl._test_decode_cert(str(path))  # type: ignore[attr-defined, no-any-return]


def test_one_command_encrypts_a_contest(file: Path) -> None:
    """`lacoc contest keys` makes certificates and invitations, and sets the court to TLS."""
    run("keys", str(file), "--host", "192.168.1.20", "--host", "court.example.org")

    contest = contests.load(file)
    assert contest.courts["main"].listen == ("tls/0.0.0.0:7447",)
    assert "has no mistakes" in run("check", str(file))
    keys = contest.keys
    assert keys is not None
    names = certificate(keys.certificate)["subjectAltName"]
    assert set(names) >= {("DNS", "localhost"), ("IP Address", "127.0.0.1")}
    assert set(names) >= {("DNS", "court.example.org"), ("IP Address", "192.168.1.20")}
    left = read_invitation(keys.invitation("main.left"))
    assert left.connect == "tls/192.168.1.20:7447"
    assert left.token == contest.courts["main"].seat["left"].token
    assert left.ca == keys.ca.read_text()


def test_all_of_it_is_its_owners_alone(file: Path) -> None:
    """All files, also the contest file, have mode 0600, and the folder of invitations has 0700."""
    run("keys", str(file), "--host", "x.example")
    found = [file, *(file.parent / "keys").rglob("*")]
    modes = {path.name: stat.S_IMODE(path.stat().st_mode) for path in found}
    assert {modes.pop("invitations")} == {0o700}
    assert set(modes.values()) == {0o600}
    assert len(modes) == 1 + 5 + 5  # the contest file; CA, court, gateway; five invitations


def test_an_invitation_holds_nothing_of_others(file: Path) -> None:
    """An invitation holds no private key and no token of another person."""
    run("keys", str(file), "--host", "x.example")
    contest = contests.load(file)
    people = entrances.everybody(contest, "main")
    assert contest.keys is not None
    for who, access in people.items():
        text = contest.keys.invitation(access.user).read_text()
        others = {one.token for name, one in people.items() if name != who and one.token}
        assert not any(token in text for token in others)
        assert "PRIVATE" not in text
    private = [contest.keys.ca_key, contest.keys.private_key]
    assert all("PRIVATE KEY" in path.read_text() for path in private)


def test_twice_keeps_what_was_handed_out(file: Path) -> None:
    """A second run adds a host to the court's certificate.

    The contest file and the left contestant's invitation stay the same.
    """
    run("keys", str(file), "--host", "one.example")
    before = contests.load(file)
    assert before.keys is not None
    invitation = before.keys.invitation("main.left").read_text()
    text = file.read_text()
    said = run("keys", str(file), "--host", "one.example", "--host", "two.example")

    assert "stay valid" in said
    assert before.keys.invitation("main.left").read_text() == invitation
    assert file.read_text() == text
    names = {name for _, name in certificate(before.keys.certificate)["subjectAltName"]}
    assert names >= {"one.example", "two.example"}


def test_two_contests_of_one_folder_have_keys_of_their_own(file: Path) -> None:
    """A second contest in a folder gets a key folder of its own: "keys-two" beside "keys".

    If other contests have both key folders, an error says so.
    """
    run("keys", str(file), "--host", "one.example")
    first = contests.load(file).keys
    assert first is not None
    there = {path: path.read_bytes() for path in first.path.rglob("*") if path.is_file()}
    other = file.with_name("two.toml")
    run("init", str(other))
    said = run("keys", str(other), "--host", "one.example")

    keys = contests.load(other).keys
    assert keys is not None
    assert keys.path.name == "keys-two"
    assert "handed out" not in said
    assert {path: path.read_bytes() for path in there} == there
    text = other.read_text().replace('keys = "keys-two"', "")
    other.write_text(text)
    with pytest.raises(UserError, match=r"keys and keys-two beside .* other contests"):
        run("keys", str(other), "--host", "one.example")
    assert other.read_text() == text


def test_every_court_is_named_that_can_be_started_next(file: Path) -> None:
    """With two courts in the file, the printed `serve` commands name the court with `--court`."""
    text = file.read_text()
    second = text[text.index("[court.main]") :].replace("court.main", "court.two")
    file.write_text(text + second.replace(":7447", ":7448"))
    said = " ".join(run("keys", str(file), "--host", "one.example").split())
    assert "contest.toml --court main and lacoc serve --contest " in said
    assert said.endswith("contest.toml --court two")


def test_renew_keeps_the_old_with_a_number(file: Path) -> None:
    """`--renew` makes a new authority, and adds a number to the name of the older key folder."""
    keys = file.parent / "keys"
    run("keys", str(file), "--host", "one.example")
    first = (keys / "ca.pem").read_bytes()
    assert "keys.1" in run("keys", str(file), "--host", "one.example", "--renew").replace("\n", "")
    run("keys", str(file), "--host", "one.example", "--renew")

    assert (file.parent / "keys.1" / "ca.pem").read_bytes() == first
    assert (
        len({(file.parent / n / "ca.pem").read_bytes() for n in ("keys", "keys.1", "keys.2")}) == 3
    )


def test_the_entry_goes_into_any_contest_file(tmp_path: Path) -> None:
    """The entry `keys` is added to files with and without a table [contest]; other lines stay.

    If the file has `contest.name = ...` instead, an error gives the line to add by hand.
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
        seats = "".join(f'seat.{s}.token = "{s}-token-of-main"\n' for s in ("left", "right"))
        court = f'[court.main]\narena = "othello"\nreferee.token = "{"r" * 26}"\n{seats}'
        file.write_bytes(f"{head}{court}".encode())
        if head.startswith("contest."):
            with pytest.raises(UserError, match=r'contest\.keys = "keys"'):
                run("keys", str(file))
            continue
        run("keys", str(file))
        assert contests.load(file).keys is not None
        assert head.splitlines()[0] in file.read_text()


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"0.0.0.0:7447"', '"tcp/0.0.0.0:7447"', r"Write tls/0.0.0.0:7447"),
        ("arena =", "aren =", "Allowed entries: arena"),
        ("[contest]", "[contest", "can't be read"),
    ],
)
def test_a_wrong_file_is_said_and_left(file: Path, old: str, new: str, said: str) -> None:
    """If a contest file has a mistake, the command makes no keys and does not change the file."""
    file.write_text(file.read_text().replace(old, new, 1))
    text = file.read_text()
    with pytest.raises(UserError, match=said):
        run("keys", str(file), "--host", "x.example")
    assert file.read_text() == text
    assert not (file.parent / "keys").exists()


def test_what_lacks_is_asked_for(file: Path) -> None:
    """If the court's host, the authority's key or the key folder is missing, an error says so.

    A `--host` that is no address is refused.
    """
    with pytest.raises(UserError, match="--host"):
        run("keys", str(file))
    with pytest.raises(UserError, match="not an address"):
        run("keys", str(file), "--host", "no host")
    run("keys", str(file), "--host", "x.example")
    (file.parent / "keys" / "ca.key").unlink()
    with pytest.raises(UserError, match=r"ca.key.*--renew"):
        run("keys", str(file), "--host", "x.example")
    (file.parent / "keys").rename(file.parent / "elsewhere")
    with pytest.raises(UserError, match="lacoc contest keys"):
        entrances.seat_access(contests.load(file), None, None, "left", None)


@pytest.mark.parametrize("what", ["empty", "no text", "key", "authority"])
def test_what_is_no_certificate_of_a_court_is_said(file: Path, what: str) -> None:
    """If court.pem is no court's certificate, an error names two remedies; court.pem stays.

    One remedy is to delete the file and run `keys` again with each `--host`. Then the invitation of
    the left contestant stays the same. The other one is `--renew`.
    """
    run("keys", str(file), "--host", "x.example")
    keys = contests.load(file).keys
    assert keys is not None
    mixed_up = {
        "empty": b"",
        "no text": b"\xff\x00",
        "key": keys.private_key.read_bytes(),
        "authority": keys.ca.read_bytes(),
    }
    invitation = keys.invitation("main.left").read_bytes()
    keys.certificate.write_bytes(mixed_up[what])
    with pytest.raises(
        UserError, match=r"court\.pem is not a court's certificate.*--host.*--renew"
    ):
        run("keys", str(file), "--host", "x.example")
    assert keys.certificate.read_bytes() == mixed_up[what]
    keys.certificate.unlink()
    run("keys", str(file), "--host", "x.example")
    assert keys.invitation("main.left").read_bytes() == invitation


def test_show_names_the_invitations(file: Path) -> None:
    """In a contest with keys, `show` prints commands with invitations instead of tokens."""
    run("keys", str(file), "--host", "x.example")
    shown = run("show", str(file))
    assert "lacoc play --invitation main.left.toml" in shown
    assert "lacoc web --invitation main.gateway.toml" in shown
    assert contests.load(file).courts["main"].seat["left"].token not in shown


@pytest.mark.parametrize("seat", ["referee", "gateway", "spectators"])
def test_a_seat_is_not_called_like_somebody_else(file: Path, seat: str) -> None:
    """A seat can't have the name of another user of the court, such as "referee"."""
    file.write_text(file.read_text().replace("main.seat.left", f"main.seat.{seat}"))
    with pytest.raises(UserError, match="can't be called"):
        contests.load(file)
