"""Tests of a gateway that knows nothing but the address of other pages."""

import json
import urllib.error
import urllib.request

import pytest
from page_client import PageClient
from venue import TOKENS, Venue
from waiting import LIMIT_S, until

pytestmark = pytest.mark.slow


def test_a_gateway_without_secrets_shows_all_courts_and_the_contest(venue: Venue) -> None:
    """With a link, a second gateway serves the same courts, the newest sheet and its pictures."""
    sheet = venue.contest.with_suffix(".json")
    sheet.write_text('{"stages": []}')
    pictures = {
        hash: sheet.parent / "entries" / hash / "picture.webp" for hash in ("0a" * 16, "0b" * 16)
    }
    for hash, path in pictures.items():
        path.parent.mkdir(parents=True)
        path.write_bytes(b"RIFF" + hash.encode())
    venue.court()
    venue.web()
    second = venue.started("web", venue.url, "--json", name="second")
    try:
        url = second.opened["url"]

        def contest() -> object:
            try:
                with urllib.request.urlopen(f"{url}/contest.json", timeout=LIMIT_S) as answer:
                    return json.load(answer)
            except urllib.error.HTTPError:  # the second gateway has no copy yet
                return None

        until(lambda: contest() == {"stages": []})
        sheet.write_text('{"stages": [1]}')
        until(lambda: contest() == {"stages": [1]})
        teams = [{"files": hash, "picture": hash != "0b" * 16} for hash in (*pictures, "0c" * 16)]
        sheet.write_text(json.dumps({"stages": [], "teams": teams}))
        until(lambda: contest() == {"stages": [], "teams": teams})

        def picture(hash: str) -> bytes | int:
            try:
                with urllib.request.urlopen(f"{url}/pictures/{hash}.webp") as answer:
                    return bytes(answer.read())
            except urllib.error.HTTPError as error:
                return error.code

        # It is there before the sheet that names it; who gave none has none.
        assert picture("0a" * 16) == pictures["0a" * 16].read_bytes()
        assert [picture("0b" * 16), picture("0c" * 16)] == [404, 404]
        late = sheet.parent / "entries" / ("0c" * 16) / "picture.webp"
        late.parent.mkdir()
        late.write_bytes(b"RIFF")
        sheet.write_text(json.dumps({"stages": [2], "teams": teams}))
        until(lambda: picture("0c" * 16) == b"RIFF")
        with PageClient(url, token=TOKENS["left"]) as page:
            assert page.welcome["courts"] == ["main"]
            page.ask("join", seat="left", token=TOKENS["left"], name="Ants")
            page.wait(lambda: page.frame is not None)
    finally:
        second.close()


def test_a_line_reaches_all_pages_and_the_published_contest_is_served(venue: Venue) -> None:
    """Pages that are open hear it, others when they come; the folder is served below the pages."""
    sheet = venue.contest.with_suffix(".json")
    sheet.write_text('{"stages": []}')
    venue.court()
    venue.web()
    url = venue.url

    def tell(text: str) -> None:
        day = {"paused": True, "until_ms": 0, "reason": "a cable"}
        sheet.write_text(json.dumps({"stages": [], "announced": {"text": text}, "day": day}))

    with PageClient(url) as page:
        tell("Lunch")
        page.wait(lambda: page.notice.get("text") == "Lunch")
        assert page.notice == {"text": "Lunch", "paused": True, "until_ms": 0, "reason": "a cable"}
        with PageClient(url) as late:
            late.wait(lambda: late.notice == page.notice)

    def status(path: str) -> int:
        try:
            with urllib.request.urlopen(f"{url}/{path}", timeout=LIMIT_S) as answer:
                return int(answer.status)
        except urllib.error.HTTPError as error:
            return error.code

    assert status("published/") == 404
    folder = sheet.with_name(f"{sheet.stem}-published")
    (folder / "records").mkdir(parents=True)
    (folder / "index.html").write_text("<title>Cup</title>")
    (folder / "records" / "a.mcap").write_bytes(b"x" * 9)
    (folder / "out").symlink_to(venue.contest)
    assert [status(f"published/{one}") for one in ("", "records/a.mcap")] == [200, 200]
    hidden = ("out", "../contest.toml", "%2e%2e/contest.toml", "records", "x", "%00")
    assert [status(f"published/{one}") for one in hidden] == [404] * len(hidden)

    entry = sheet.parent / "entries" / ("0a" * 16)
    entry.mkdir(parents=True)
    (entry / "picture.webp").write_bytes(b"RIFF")
    (entry / "robot.toml").write_text("secret until entries are closed")
    assert status(f"pictures/{entry.name}.webp") == 200
    none = (
        f"pictures/{'0b' * 16}.webp",
        "pictures/..%2f.webp",
        f"pictures/{entry.name}/robot.toml",
    )
    assert [status(one) for one in none] == [404] * len(none)
