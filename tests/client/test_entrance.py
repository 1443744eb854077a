"""Tests of how commands find their court: a link, options, the environment."""

import pytest
import typer
from typer.testing import CliRunner

from lacoc_client.commands import entrance
from lacoc_client.play.link.event import FoundEvent, LinkedEvent
from lacoc_shared.command import options
from lacoc_shared.contest.access import Access
from lacoc_shared.contest.link import Link
from lacoc_shared.messages import PROTOCOL
from lacoc_shared.mistakes import UserError

LINK = "https://lacoc.example.org/play#token=abc"


def refused(code: str) -> pytest.RaisesExc[UserError]:
    """Return a context manager that expects an error with the phrase of this code."""
    return pytest.raises(UserError, check=lambda error: error.phrase.code == code)


@pytest.fixture(autouse=True)
def pages(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let each link lead to an event of two courts."""
    courts = {"red": ("tls/red:1", "tls/red:2"), "blue": ("tls/blue:1",)}

    def find(text: str) -> FoundEvent:
        return FoundEvent(
            Link.read(text), LinkedEvent(protocol=PROTOCOL, courts=courts, authority="PEM")
        )

    monkeypatch.setattr(entrance, "find", find)


def test_a_court_that_was_started_alone() -> None:
    """Without a link, address and token come from options; the address is complete then."""
    access = entrance.contestant(None, None, "10.0.0.7", "t" * 20)
    assert access == Access(court="main", connect="tcp/10.0.0.7:7447", token="t" * 20)
    assert entrance.one_court(None, "red", None).connect == "tcp/127.0.0.1:7447"
    several = entrance.one_court(None, "red", "10.0.0.7,tls/hall:7448")
    assert several.addresses == ["tcp/10.0.0.7:7447", "tls/hall:7448"]
    with refused("entrance.no-token"):
        entrance.referee(None, None, None, None)
    with refused("address.none"):
        entrance.one_court(None, None, "http://x")


def test_a_link_leads_to_any_court() -> None:
    """A contestant asks whichever court answers; a referee and a watcher want one court."""
    access = entrance.contestant(LINK, None, None, None)
    assert access.addresses == ["tls/red:1", "tls/red:2", "tls/blue:1"]
    assert (access.token, access.authority) == ("abc", "PEM")
    with refused("entrance.which-court"):
        entrance.one_court(LINK, None, None)
    assert entrance.one_court(LINK, "blue", None).addresses == ["tls/blue:1"]
    named = LINK.replace("play", "referee?court=blue")
    assert entrance.referee(named, None, None, None).court == "blue"


def test_what_does_not_fit_is_told() -> None:
    """A link excludes an address and a token; a court must be one of the link."""
    for connect, token in (("10.0.0.7", None), (None, "x")):
        with refused("link.or-address"):
            entrance.courts(LINK, None, connect, token)
    with refused("gateway.no-court"):
        entrance.courts(LINK, "green", None)
    with refused("entrance.no-token"):
        entrance.contestant("https://lacoc.example.org/", None, None, None)


@pytest.mark.parametrize(
    ("line", "environment", "expected"),
    [
        (["--connect", "1.1.1.1"], {"LACOC_CONNECT": "2.2.2.2"}, "tcp/1.1.1.1:7447"),
        ([], {"LACOC_CONNECT": "2.2.2.2"}, "tcp/2.2.2.2:7447"),
        ([], {"LACOC_CONNECT": ""}, "tcp/127.0.0.1:7447"),
        ([LINK], {}, "tls/red:1"),
        ([], {"LACOC_LINK": LINK}, "tls/red:1"),
    ],
)
def test_precedence(line: list[str], environment: dict[str, str], expected: str) -> None:
    """What is given comes from the command line, else from the environment."""
    app = typer.Typer()

    @app.command()
    def command(link: options.Link = None, connect: options.Connect = None) -> None:
        print(next(iter(entrance.courts(link, None, connect).values())).connect)

    result = CliRunner().invoke(app, line, env=environment)
    assert result.stdout.strip() == expected
