"""Tests of forks that a page asks its gateway for, over HTTP."""

import json
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from bot_matches import bot_match
from venue import Venue

from lacoc_shared.record.reader import Record

pytestmark = pytest.mark.slow

MATCH = "a-match"


class Answer(NamedTuple):
    """The answer to a request."""

    status: int
    text: str

    @property
    def value(self) -> Any:
        return json.loads(self.text)


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Venue]:
    """Give a gateway with the recording of a short match of two bots."""
    with ExitStack() as stack:
        venue = Venue(tmp_path_factory.mktemp("library"), stack)
        bots, settings = ("planner", "nearest"), {"match": {"duration_s": 1.0, "countdown_s": 0.2}}
        bot_match(venue.folder / "recordings", "othello", bots, settings, match_id=MATCH)
        venue.web("--recordings", str(venue.folder / "recordings"))
        yield venue


def ask(
    venue: Venue, body: Any = None, key: str | None = None, name: str = MATCH, language: str = "en"
) -> Answer:
    """Ask for a fork of a recording; without a body, ask which bots there are."""
    data = None if body is None else body if isinstance(body, bytes) else json.dumps(body).encode()
    headers = {"X-Lacoc-Key": venue.key if key is None else key, "Accept-Language": language}
    url = f"{venue.url}/recordings/{name}.mcap/forks"
    try:
        with urllib.request.urlopen(urllib.request.Request(url, data, headers)) as answer:
            return Answer(answer.status, answer.read().decode())
    except urllib.error.HTTPError as error:
        return Answer(error.code, error.read().decode())


@pytest.mark.long
def test_a_fork_becomes_a_recording_of_the_gateway(library: Venue) -> None:
    """A fork is listed and can be fetched; the folder of the recordings stays as it was."""
    folder = library.folder / "recordings"
    before = sorted(folder.iterdir())
    asked = {"beat": 80, "restart": ["left"], "players": ["-", "straight"]}
    name = ask(library, asked).value["name"]
    assert name == f"fork-1-at-80-of-{MATCH}.mcap"
    assert sorted(folder.iterdir()) == before
    with urllib.request.urlopen(f"{library.url}/recordings") as answer:
        listed = {one["name"]: one["match"] for one in json.load(answer)}
    assert listed[name]["fork_of"] == MATCH
    with urllib.request.urlopen(f"{library.url}/recordings/{name}") as answer:
        file = library.folder / "fetched.mcap"
        file.write_bytes(answer.read())
    origin = Record.read(file).header.setup.origin
    assert origin is not None
    assert (origin.match_id, origin.beat) == (MATCH, 80)
    again = ask(library, asked).value["name"]
    assert again == f"fork-2-at-80-of-{MATCH}.mcap"
    assert ask(library, {"beat": 90, "restart": ["left"]}, name=name[:-5]).status == 200


def test_only_a_key_or_an_accepted_token_opens_it(library: Venue) -> None:
    """Without a secret nobody learns anything, and nothing is played."""
    for body in (None, {"beat": 80, "restart": ["left"]}):
        for key in ("", "x" * 22, "schlüssel"):
            found = ask(library, body, key)
            assert found.status == 403
            assert "Open your link first" in found.text


def test_the_bots_of_the_game_are_listed(library: Venue) -> None:
    """The gateway tells which bots can go on with a recording."""
    assert {"straight", "nearest", "planner"} <= set(ask(library).value["bots"])


@pytest.mark.parametrize(
    ("asked", "status", "words"),
    [
        ({"beat": 80, "players": ["bot.py", "-"]}, 409, "There is no bot bot.py. There are: "),
        ({"beat": 80, "players": ["ghost:x.mcap:left", "-"]}, 409, "There is no bot ghost"),
        ({"beat": 100_000, "restart": ["left"]}, 409, "100000"),
        ({"beat": 80, "restart": ["middle"]}, 409, "middle"),
        ({"beat": 80, "take_back": 999}, 409, "999"),
        ({"beat": 80, "restart": ["--help"]}, 400, "restart"),
        ({"beat": 0}, 400, "beat"),
        ({"beat": 80, "out": "/tmp"}, 400, "out"),
        (b"\xff", 400, ""),
        (b" " * 5000, 409, "5000"),
    ],
)
def test_a_wrong_request_is_told_in_words(
    library: Venue, asked: Any, status: int, words: str
) -> None:
    """A request that can't be done is refused with the reason; no file of a bot is opened."""
    found = ask(library, asked)
    assert (found.status, words in found.text) == (status, True), found.text
    assert "Traceback" not in found.text


def test_the_reason_is_in_the_reader_s_language(library: Venue) -> None:
    """The command's own error comes in the language of the page."""
    found = ask(library, {"beat": 100_000, "restart": ["left"]}, language="ja")
    assert found.text.startswith("分岐を作れませんでした。")
    assert "エラー" not in found.text


def test_an_unknown_recording_is_not_found(library: Venue, tmp_path: Path) -> None:
    """Only recordings of the gateway can be forked."""
    assert ask(library, {"beat": 80, "restart": ["left"]}, name="nothing").status == 404
