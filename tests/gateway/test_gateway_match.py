"""Tests of whole matches through a gateway, with a real court and pages without a browser."""

import json
import signal
import time
from urllib.request import urlopen

import pytest
from court_stub import CourtStub
from page_client import PageClient, Refused, SleepyPage, refusal, x_of
from venue import REFEREE, TOKENS, Venue
from waiting import LIMIT_S

from lacoc_client.web.gateway.wire import MessageKind
from lacoc_shared.codec import encode
from lacoc_shared.messages import Event
from lacoc_shared.seat import BEATS_PER_S, Phase, SeatFlag
from lacoc_shared.words import render

pytestmark = pytest.mark.slow

FORWARD = {"level": 1, "key": 2}


def started(venue: Venue) -> tuple[PageClient, PageClient, PageClient]:
    """Bring a match into play; return the pages of both contestants and the referee."""
    left, right = venue.contestant("left", "Ants"), venue.contestant("right", "Bees")
    referee = venue.referee()
    referee.phase(Phase.READY)
    referee.ask("decide", decision={"type": "start"}, reason="")
    for page in (left, right):
        page.phase(Phase.PLAYING)
    return left, right, referee


def test_a_match_is_played_to_its_official_end(venue: Venue) -> None:
    """A match is played through a gateway to its official end; a late page gets the whole log."""
    venue.court("--seconds", "4")
    venue.web()
    left, right, referee = started(venue)
    assert left.frame is not None
    robot_bytes = len(left.frame.poses) // 2
    began_m = x_of(left.frame, 0, robot_bytes)
    for page in (left, right):
        seq = page.press(**FORWARD)
        page.wait_own(lambda own, seq=seq: own.applied_seq >= seq)
    with refusal("gateway.no-seat"):
        referee.press(**FORWARD)
    refused = left.press(level=0, key=1)
    left.wait_own(lambda own: own.refused_seq >= refused)

    late = venue.page()
    assert late.order[:5] == [
        MessageKind.WELCOME,
        MessageKind.NOTICE,
        MessageKind.LINK,
        MessageKind.SHEET,
        MessageKind.SCENE,
    ]
    assert MessageKind.FRAME in late.order[: late.order.index(MessageKind.REPLY)]
    assert [event.number for event in late.events] == [*range(1, len(late.events) + 1)]
    at_once = list(late.events)
    assert "PLAYING" in [event.data.get("after") for event in at_once]
    assert late.sheet is not None
    assert late.scene is not None
    assert late.scene[0] == late.sheet.scene
    assert [seat.team for seat in late.sheet.seats] == ["Ants", "Bees"]

    with urlopen(f"{venue.url}/courts.json", timeout=LIMIT_S) as answer:
        (score,) = json.load(answer)
    assert (score["court"], score["call"], len(score["scores"])) == ("main", "", 2)
    assert score["phase"] in (Phase.PLAYING, Phase.FINISHED)
    assert 0 < score["clock_s"] <= score["duration_s"]

    referee.phase(Phase.FINISHED)
    reply = referee.ask("decide", decision={"type": "official"}, reason="")
    scores = [seat.score for seat in referee.frame.seats]  # type: ignore[union-attr]
    is_draw = scores[0] == scores[1]  # the robots walk, and may have turned a disc
    assert reply["said"]["code"] == f"decision.official{'-draw' if is_draw else ''}"
    for page in (left, right, referee, late):
        page.phase(Phase.OFFICIAL)
        page.wait(lambda page=page: page.events[-1].data.get("after") == "OFFICIAL")  # type: ignore[misc]
        assert page.events == left.events
    assert at_once == left.events[: len(at_once)]
    decision = next(one for one in late.events if one.kind == "decision" and one.beat)
    assert render(decision.said).startswith("Referee Kim: ")
    assert left.frame is not None
    assert x_of(left.frame, 0, robot_bytes) > began_m + 0.05
    assert left.seat["hold"] == "held"
    referee.ask("decide", decision={"type": "next"}, reason="")
    late.wait(lambda: late.frame is not None and late.frame.match == 2)


def test_a_page_that_has_gone_lets_its_robot_stand(venue: Venue) -> None:
    """A robot whose page is gone stands (rules 3); a new page joins its seat and goes on."""
    venue.court()
    venue.web()
    left, _, referee = started(venue)
    left.press(**FORWARD)
    left.wait_own(lambda own: own.key == 2)
    assert left.frame is not None
    before = left.frame.beat
    left.close()
    assert referee.frame is not None
    gone = referee.frame.beat

    def silences() -> list[Event]:
        """Return the left seat's silences after the beat `before`.

        A busy machine may cause earlier silences, which do not count.
        """
        return [
            event
            for event in referee.events
            if event.kind == "silent" and event.seat == 0 and event.beat > before
        ]

    referee.wait(silences)
    # The inbox's own tests have the exact time; a busy court makes fewer beats in a second.
    assert silences()[0].beat - gone < 2.5 * BEATS_PER_S
    referee.wait(lambda: referee.frame is not None and referee.frame.seats[0].key == 0)

    back = venue.page(venue.key)
    back.ask("join", seat="left", token=TOKENS["left"], name="Ants")
    seq = back.press(**FORWARD)
    back.wait_own(lambda own: own.applied_seq >= seq and own.key == 2)
    assert not back.own().flags & SeatFlag.SILENT


@pytest.mark.long
def test_a_page_that_hangs_is_noticed(venue: Venue) -> None:
    """If a page hangs without closing its connection, its seat still falls silent."""
    venue.court()
    venue.web()
    left, _, referee = started(venue)
    left.press(**FORWARD)
    left.wait_own(lambda own: own.key == 2)
    left.socket.socket.settimeout(None)
    left.socket.protocol.receive_data = lambda data: None  # type: ignore[method-assign]
    referee.wait(lambda: any(event.kind == "silent" for event in referee.events), 6)


@pytest.mark.long
def test_a_reload_within_a_second_is_not_noticed(venue: Venue) -> None:
    """A robot walks on while its page is reloaded, if the page is back within a second."""
    venue.court()
    venue.web()
    page, _, referee = started(venue)
    for _ in range(10):
        page.press(**FORWARD)
        page.wait_own(lambda own: own.key == 2)
        assert page.frame is not None
        gone, gone_s = page.frame.beat, time.monotonic()
        page.close()
        page = venue.page(venue.key)
        page.ask("join", seat="left", token=TOKENS["left"], name="Ants")
        if time.monotonic() - gone_s < 0.5:  # a busy machine sometimes needs longer
            break
    page.wait(lambda: page.frame is not None and page.frame.beat > gone + 125)
    assert page.own().key == 2
    assert not any(event.kind == "silent" and event.beat > gone for event in referee.events)


def test_a_newer_page_takes_the_seat(venue: Venue) -> None:
    """The newest join takes the seat; the older page is told so and can't steer any more."""
    venue.court()
    venue.web()
    first = venue.contestant("left")
    second = venue.contestant("left")
    first.wait(lambda: first.seat["hold"] == "replaced")
    with refusal("refused.not-yours"):
        first.press(**FORWARD)
    assert second.seat["hold"] == "held"
    assert second.seat["session"] != first.seat["session"]
    session = second.seat["session"]  # as the court's health names it
    second.wait(
        lambda: second.health is not None and session in {it.session for it in second.health.seats}
    )
    second.ask("leave")
    second.wait(lambda: second.seat["hold"] == "left")


def test_one_referee_acts_until_another_takes_over(venue: Venue) -> None:
    """Only one referee's page acts until another takes over; events name the acting referee."""
    venue.court()
    venue.web()
    venue.contestant("left")
    kim, lee = venue.referee("Kim"), venue.referee("Lee")
    kim.wait(lambda: kim.referee == {"acting": "Kim", "mine": True})
    lee.wait(lambda: lee.referee == {"acting": "Kim", "mine": False})
    abort = {"decision": {"type": "abort"}, "reason": "a test"}
    with refusal("gateway.other-referee"):
        lee.ask("decide", **abort)
    lee.ask("take_over")
    kim.wait(lambda: kim.referee == {"acting": "Lee", "mine": False})
    with refusal("gateway.other-referee"):
        kim.ask("decide", **abort)
    with refusal("refused.decision"):
        lee.ask("decide", decision={"type": "start"}, reason="")
    lee.ask("decide", **abort)
    kim.wait(lambda: any(render(one.said).startswith("Referee Lee: ") for one in kim.events))
    lee.close()
    kim.wait(lambda: kim.referee == {"acting": None, "mine": False})
    again = venue.referee("Lee")
    again.wait(lambda: again.referee == {"acting": "Lee", "mine": True})


def test_who_only_watched_leaves_it_to_the_other_after_a_break(venue: Venue) -> None:
    """A referee's page that comes back, and did not act before, does not act before the other."""
    venue.court()
    venue.web()
    with PageClient(venue.url) as lee:
        lee.wait(lambda: lee.link.get("connected"))
        lee.ask("enter", token=REFEREE, by="Lee", acts=False)
        lee.wait(lambda: lee.referee == {"acting": None, "mine": False})
        kim = venue.referee("山田\u3000太郎")
        kim.wait(lambda: kim.referee == {"acting": "山田 太郎", "mine": True})
        lee.wait(lambda: lee.referee == {"acting": "山田 太郎", "mine": False})
        kim.close()
        lee.wait(lambda: lee.referee == {"acting": None, "mine": False})
        lee.ask("take_over")
        lee.wait(lambda: lee.referee == {"acting": "Lee", "mine": True})


def test_a_killed_court_comes_back(venue: Venue) -> None:
    """Pages learn that their court is gone; when the court is back, they keep their seats."""
    court = venue.court()
    venue.web()
    left, _, referee = started(venue)
    court.kill()
    referee.wait(lambda: not referee.link["connected"])
    referee.wait(lambda: referee.waits_why == "court.nobody")
    silent_s = referee.link["silent_s"]
    referee.wait(lambda: referee.link["silent_s"] > silent_s + 0.8)
    known = len(referee.events)
    venue.court()
    referee.wait(lambda: referee.link["connected"])
    for page in (left, referee):
        page.phase(Phase.HALTED)
    assert [event.number for event in referee.events] == [*range(1, len(referee.events) + 1)]
    assert len(referee.events) >= known
    left.wait(lambda: left.seat["hold"] == "held" and left.health is not None)
    referee.wait(
        lambda: (
            referee.frame is not None
            and not any(seat.flags & SeatFlag.SILENT for seat in referee.frame.seats)
        )
    )
    referee.ask("decide", decision={"type": "resume"}, reason="the court is back")
    left.phase(Phase.PLAYING)
    seq = left.press(**FORWARD)
    left.wait_own(lambda own: own.applied_seq >= seq)


@pytest.mark.long
def test_a_fresh_court_has_a_fresh_log(venue: Venue) -> None:
    """When a court begins a new match instead of the old one, pages keep no old event."""
    court = venue.court()
    venue.web()
    watcher = venue.page()
    left = venue.contestant("left", "Old Ants")
    watcher.wait(lambda: any("Old Ants is ready" in render(event.said) for event in watcher.events))
    left.close()
    court.close()
    venue.court("--fresh")
    watcher.wait(lambda: not any("Old Ants" in render(event.said) for event in watcher.events))
    venue.contestant("left", "New Ants")
    watcher.wait(lambda: any("New Ants is ready" in render(event.said) for event in watcher.events))
    assert [event.number for event in watcher.events] == [*range(1, len(watcher.events) + 1)]
    texts = [render(event.said) for event in watcher.events]
    assert not any("Old Ants" in text for text in texts), texts
    late = venue.page()
    assert late.events == watcher.events


def test_a_stopped_court_is_not_shown_as_live(venue: Venue) -> None:
    """A page that connects while its court stands still is sent no old frame."""
    court = venue.court()
    venue.web()
    watcher = venue.page()
    watcher.wait(lambda: watcher.frame)
    court.signal(signal.SIGSTOP)
    watcher.wait(lambda: not watcher.link["connected"])
    late = venue.page()
    assert late.frame is None
    assert late.link["connected"] is False
    assert late.sheet is not None
    court.signal(signal.SIGCONT)
    late.wait(lambda: late.frame is not None and late.link["connected"])


def test_a_gateway_may_come_before_its_court(venue: Venue) -> None:
    """A gateway that starts before its court waits for it, says so, and then shows the match."""
    venue.web()
    early = venue.page(venue.key)
    early.wait(lambda: early.waits_why == "connect.nobody")
    assert early.link["connected"] is False
    with refusal("connect.nobody"):
        early.ask("join", seat="left", token=TOKENS["left"], name="Ants")
    with refusal("gateway.court-not-there"):
        early.ask("enter", token=TOKENS["left"], by="Kim")
    venue.court()
    early.wait(lambda: early.link["connected"] and early.frame and early.sheet and early.scene)
    early.ask("join", seat="left", token=TOKENS["left"], name="Ants")


@pytest.mark.long
def test_a_restarted_gateway_knows_its_pages_again(venue: Venue) -> None:
    """After a restart of the gateway an open page can act again with its token."""
    venue.court()
    web = venue.web()
    left = started(venue)[0]
    web.kill()
    left.wait(left.closed.is_set)
    venue.web()
    back = venue.page(token=TOKENS["left"])
    back.ask("join", seat="left", token=TOKENS["left"], name="Ants")
    seq = back.press(**FORWARD)
    back.wait_own(lambda own: own.applied_seq >= seq)
    assert [event.number for event in back.events] == [*range(1, len(back.events) + 1)]


def test_a_gateway_ends_cleanly(venue: Venue) -> None:
    """On Ctrl-C a gateway closes its pages' connections and exits with 0."""
    venue.court()
    web = venue.web()
    page = venue.contestant("left")
    web.signal(signal.SIGINT)
    assert web.process.wait(LIMIT_S) == 0
    page.wait(page.closed.is_set)
    assert (venue.folder / "web.log").read_text().count("Traceback") == 0


@pytest.mark.parametrize(("hz", "share"), [(50, 1.0), (25, 0.5), (10, 0.2)])
def test_a_page_gets_as_many_frames_as_it_asks_for(
    open_venue: Venue, hz: int, share: float
) -> None:
    """A page gets as many frames a second as it asks for, or fewer on a busy machine."""
    with PageClient(open_venue.url, hz=hz) as page:
        page.wait(lambda: len(page.frames) > 3)
        (_, first), count = page.frames[-1], len(page.frames)
        page.wait(lambda: page.frames[-1][1] - first >= 100)
        got = (len(page.frames) - count) / (page.frames[-1][1] - first)
    assert 0.3 * share <= got <= 1.1 * share


def test_a_slow_page_never_gets_a_backlog(open_venue: Venue) -> None:
    """After reading nothing for 8 s, a page gets less than 4 s of old frames, and then new ones."""
    with PageClient(open_venue.url, hz=50) as quick, SleepyPage(open_venue.url) as sleepy:
        sleepy.watch(hz=50)
        quick.wait(lambda: quick.frame is not None)
        assert quick.frame is not None
        beat = quick.frame.beat + 400  # eight seconds
        quick.wait(lambda: quick.frame is not None and quick.frame.beat >= beat)
        beats = sleepy.read_until(beat + 25)
    old = [one for one in beats if one < beat - 25]
    assert len(old) < 4 * 50
    assert len([one for one in beats if one >= beat]) >= 2
    # The quick page did not wait for the slow one.
    assert len(quick.frames) > 0.3 * (quick.frames[-1][1] - quick.frames[0][1])


def test_what_goes_astray_disturbs_no_page(venue: Venue) -> None:
    """An unreadable frame disturbs no page; a sheet of another version is reported to pages."""
    with CourtStub(f"127.0.0.1:{venue.court_port}") as court:
        venue.web()
        page = venue.page()
        page.wait(lambda: len(page.frames) > 5)
        links = len(page.links)
        for _ in range(20):
            court.silent = True
            court.in_a_beat(lambda: court.network.publish_frame(encode({"astray": 1}), 0.0))
            time.sleep(0.1)
            court.silent, seen = False, len(page.frames)
            page.wait(lambda seen=seen: len(page.frames) > seen)
        assert page.links[links:] == []
        court.in_a_beat(lambda: court.show(court.scene, protocol=99))
        page.wait(lambda: page.waits_why == "gateway.other-version")
        court.in_a_beat(lambda: court.show(court.scene))
        page.wait(lambda: page.link["connected"])


def test_a_wrong_token_of_a_referee_is_said_in_a_field(venue: Venue) -> None:
    """Only the refusal of a wrong token sets the field that keeps a page from asking again."""
    venue.court()
    venue.web()
    page = venue.page(venue.key)
    page.wait(lambda: page.frame)
    with pytest.raises(Refused) as wrong:
        page.ask("enter", token="w" * 25, by="Kim")
    assert wrong.value.is_the_token
    with pytest.raises(Refused) as nobody:
        page.ask("enter", token=REFEREE, by=" ")
    assert not nobody.value.is_the_token
    page.ask("enter", token=REFEREE, by="Kim")


def test_a_seat_that_can_not_be_had_now_may_be_asked_for_again(venue: Venue) -> None:
    """A page may repeat a join that was refused as too frequent, but not one with a wrong token."""
    venue.court()
    venue.web()
    pages = [venue.page(venue.key) for _ in range(12)]
    with pytest.raises(Refused) as wrong:
        pages[0].ask("join", seat="right", token="a guess", name="Ants")
    assert not wrong.value.again
    asked = [page.send("join", seat="left", token=TOKENS["left"], name="Ants") for page in pages]
    refused = []
    for page, number in zip(pages, asked, strict=True):
        try:
            page.reply(number)
        except Refused as error:
            refused.append(error)
    assert {(str(error), error.again) for error in refused} == {
        ("You tried to join too often. Wait a few seconds.", True)
    }
