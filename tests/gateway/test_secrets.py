"""Tests that secrets stay in their files: they search what a match sends, prints and records."""

import subprocess
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from lacoc_process import Lacoc, environment
from mcap.reader import make_reader
from page_client import PageClient, Refused
from venue import REFEREE, TOKENS, Venue
from waiting import LIMIT_S

from lacoc_client.play.controller import Controller
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_shared.contest.file import secrets_path
from lacoc_shared.keyspace import KeySpace
from lacoc_shared.network.session import Session, open_client
from lacoc_shared.seat import Phase

KEYS = KeySpace("main")


class HearingPage(PageClient):
    """A page that keeps all bytes of the messages that it receives."""

    heard: bytes = b""

    def _take(self, kind: MessageKind, payload: bytes) -> None:
        self.heard += payload
        super()._take(kind, payload)


class HeardVenue(Venue):
    """A venue whose pages keep what they hear."""

    def __init__(self, folder: Path, stack: ExitStack) -> None:
        super().__init__(folder, stack)
        self.pages: list[HearingPage] = []

    def page(self, key: str | None = None, **options: object) -> HearingPage:
        page = HearingPage(self.url, key, **options)
        self._stack.callback(page.close)
        self.pages.append(page)
        return page

    def session(self) -> Session:
        return self._stack.enter_context(open_client([f"127.0.0.1:{self.court_port}"]))

    def start(self, *words: str, token: str = "") -> Lacoc:
        """Start a command that is killed at the end of the test."""
        process = Lacoc(
            *words,
            f"--connect=tcp/127.0.0.1:{self.court_port}",
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            env=environment() | ({"LACOC_TOKEN": token} if token else {}),
            cwd=self.folder,
        )
        self._stack.callback(process.kill)
        return process


@pytest.fixture
def heard(tmp_path: Path) -> Iterator[HeardVenue]:
    with ExitStack() as stack:
        yield HeardVenue(tmp_path, stack)


def titles(where: Path) -> bytes:
    """Return the command lines of the processes that run in a folder; every user can read them."""
    found = b""
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if (process / "cwd").readlink() == where:
                found += (process / "cmdline").read_bytes()
        except OSError:  # it has ended
            continue
    return found


def in_record(path: Path) -> bytes:
    """Unpack all messages of a record and return them."""
    with path.open("rb") as file:
        return b"".join(message.data for _, _, message in make_reader(file).iter_messages())


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/cmdline").exists(), reason="reads /proc")
def test_no_secret_leaves_its_place(heard: HeardVenue) -> None:
    """No secret leaks in a short match of a bot and a page, in which wrong tokens are tried too.

    The test searches all that the court publishes, all that pages receive, the output, logs and
    command lines of all processes, and the record.
    """
    court, web = heard.court(), heard.web()
    watching = heard.session()
    boxes = {
        what: watching.mailbox(f"{KEYS.root}/{what}", 100_000)
        for what in ("frame", "event", "sheet", "health")
    }
    bot = heard.start("bot", "straight", token=TOKENS["left"])
    refused = heard.start("referee", "start", token=f"no{REFEREE}")
    page = heard.page(heard.key)
    for ask in ({"do": "join", "seat": "right", "name": "x"}, {"do": "enter", "by": "x"}):
        with pytest.raises(Refused):
            page.ask(**ask, token=f"no{TOKENS['right']}")
    contestant = heard.contestant("right", "Right")
    referee = heard.referee()
    contestant.phase(Phase.READY)
    referee.ask("decide", decision={"type": "start"}, reason="")
    contestant.phase(Phase.PLAYING)
    contestant.press(level=1, key=2)
    contestant.wait_own(lambda own: own.applied_seq)

    own = Controller(heard.session(), "main", "right", TOKENS["right"], "Right")
    own.join()  # takes the seat from the page, so that this test knows a session's secret
    assert own._joined is not None
    secrets = {f"token of {seat}": token.encode() for seat, token in TOKENS.items()}
    secrets |= {"token of referee": REFEREE.encode(), "a session's secret": own._joined.secret}
    watch = heard.start("watch", "--json", "--hz=5")
    seen = {"titles": titles(heard.folder)}
    for decision in ("halt", "declare left --yes --reason end", "official --yes"):
        by_hand = heard.start("referee", *decision.split(), token=REFEREE)
        seen[decision] = by_hand.communicate(timeout=LIMIT_S)[0]
        assert by_hand.returncode == 0, seen[decision]
    seen["watch"] = watch.communicate(timeout=LIMIT_S)[0]
    seen["refused"] = refused.communicate(timeout=LIMIT_S)[0]
    for what, box in boxes.items():
        seen[what] = b"".join(mail.payload for mail in iter(box.take, None))
    seen["scene"] = watching.ask(KEYS.scene)
    seen["pages"] = b"".join(one.heard for one in heard.pages)
    bot.terminate()
    seen["bot"] = bot.communicate(timeout=LIMIT_S)[0]
    court.close()
    web.close()
    # A court that was started alone prints its tokens once, for whoever started it.
    seen |= {"court": court.said.partition("\n")[2].encode(), "web": web.said.encode()}
    (record,) = (heard.folder / "recordings").glob("*.mcap")
    seen["record"] = in_record(record)
    seen |= {path.name: path.read_bytes() for path in heard.folder.glob("*.log")}

    said = {where: what for where, what in seen.items() if where not in ("court.log", "web.log")}
    assert all(said.values()), [where for where, what in said.items() if not what]
    assert b"Right" in seen["record"]
    assert b"not a referee's token" in seen["refused"]
    leaks = [(w, s) for w, what in seen.items() for s, word in secrets.items() if word in what]
    assert leaks == []
    control = secrets_path(heard.contest).read_bytes()
    assert sum(word in control for word in secrets.values()) == 3  # the search finds secrets
