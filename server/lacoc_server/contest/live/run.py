"""A contest at its courts, with people and bots."""

import math
import time
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, ExitStack
from functools import partial
from pathlib import Path
from typing import NamedTuple

from lacoc_server.contest.desk.book import Book, milliseconds
from lacoc_server.contest.desk.desk import Desk
from lacoc_server.contest.desk.service import DeskService
from lacoc_server.contest.kept.applications import Applications
from lacoc_server.contest.kept.event_code import EventCode
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.sheet_writer import Progress, SheetWriter
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.kept.tokens import TeamTokens
from lacoc_server.contest.live import venue
from lacoc_server.contest.live.away import AwayCourt
from lacoc_server.contest.live.court_link import CourtLink
from lacoc_server.contest.live.office import Office
from lacoc_server.contest.live.ticker import Ticker
from lacoc_server.contest.organiser import prepare
from lacoc_server.contest.sheet import ContestSheet
from lacoc_shared.command.scratch import Scratch
from lacoc_shared.contest.entrances import event_code, organiser_key
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import open_client
from lacoc_shared.words import Phrase, say

_STEP_S = 0.05
"""Time between two looks at the courts."""
_FAREWELL_S = 5.0
"""The courts stay for so long after the end, so that all teams hear that the contest is over."""
_LATE_S = 30.0
"""With several courts at real time they stay for so long: pages that follow the director show the
end 20 s later, and then the result.
"""
_COPY_S = 60.0
"""Longest further wait for the newest records of courts on other machines."""
_SHOWN_S = 60.0
"""The last match is shown for so long on a court of another machine. Then the
court closes it, so that its record can be copied whole."""


class Opened(NamedTuple):
    """Where the parts of an opened contest can be reached."""

    url: str
    """Address of the pages."""
    courts: dict[str, str]
    """Addresses of the courts, by name."""
    office: str
    """Link of the organiser's page; secret."""
    code: str
    """The event code."""


def play_live(
    file: Path,
    opened: Callable[[Opened], None],
    progress: Progress,
    tell: Callable[[Phrase], None],
    *,
    news: Callable[[Phrase], None] = lambda _: None,
    speed: float = 1.0,
    listen: str | None = None,
    show: bool = False,
    entering: bool = False,
    until_over: bool = False,
) -> ContestSheet:
    """Run a contest at its courts until it is interrupted.

    The courts of the contest file, the gateway and the bots of teams run as processes of their own;
    each is started again if it ends.

    Args:
        file: the contest file.
        opened: called when courts and pages are there.
        progress: told about each change.
        tell: told what somebody must know: a court that can't be opened, or that went on here.
        news: told each thing that happens: a game that is called, a result, a court that is lost.
        speed: 2 plays twice as fast as real time.
        listen: where the gateway listens; None: this machine only.
        show: whether to open a browser.
        entering: whether teams may enter until the time in the contest file, or until the organiser
            closes entries; False: the first stage is drawn at once.
        until_over: whether to end soon after the contest is over; False: courts, pages and office
            stay until somebody interrupts them.

    Returns:
        The sheet at the end.

    Raises:
        KeyboardInterrupt: if it is interrupted before the contest is over.
        UserError: if the contest runs already, has no stage, no office or too few teams, or
            something goes wrong.
    """
    where = ContestFolder(file)
    if where.contest.office is None:
        raise UserError(say("contest.no-office", file=str(file)))
    with ExitStack() as stack:
        stack.enter_context(where.alone())
        store = stack.enter_context(FactStore(where.facts))
        prepare(where, store, entering=entering)
        logs = stack.enter_context(Scratch("contest"))
        run_here = partial(_run_here, where, logs, speed, tell)
        addresses: dict[str, str] = {}
        told: dict[str, str] = {}
        links: dict[str, CourtLink | None] = dict.fromkeys(where.contest.courts)
        away: list[AwayCourt] = []
        for name, court in where.contest.courts.items():
            if court.elsewhere:
                addresses[name] = told[name] = court.elsewhere
                away.append(stack.enter_context(AwayCourt(where, name, run_here, tell)))
                continue
            addresses[name] = address = stack.enter_context(run_here(name))
            told[name] = venue.told_address(court, address)
            session = stack.enter_context(open_client([address]))
            links[name] = CourtLink(session, name, where.contest.office.token)
        tokens = TeamTokens(where.tokens)
        rest_ms = round(1000 * where.contest.least_rest_s)
        draw_from_ms = (milliseconds(where.contest.entries_close) or None) if entering else 0
        office = Office(store, where.entries, tokens.of, links, told, rest_ms, draw_from_ms)
        applications = stack.enter_context(Applications(where.applications))
        own_store = stack.enter_context(FactStore(where.facts))
        key = organiser_key(where.contest)
        code = EventCode(where.event_code, event_code(where.contest))
        book = Book(where, own_store, applications, tokens, code)
        desk = Desk(book, key, lambda: office.known)
        service = stack.enter_context(DeskService(desk))
        bots = stack.enter_context(venue.Bots(where, tokens))
        writer = SheetWriter(where, progress)
        writer(office.contest)
        ticker = Ticker(office.facts)
        url = stack.enter_context(venue.pages(where, logs, listen, show, service.address))
        opened(Opened(url, addresses, f"{url}/office#organiser={key}", code.value))
        over_s = math.inf  # when the contest was over, as far as is known
        is_late = speed <= 1 and len(addresses) > 1
        farewell_s = _LATE_S if is_late else _FAREWELL_S
        shown_s = farewell_s if until_over else _SHOWN_S
        try:
            while not (until_over and _is_done(time.monotonic() - over_s - farewell_s, away)):
                office.step()
                now_s = time.monotonic()
                if office.over and over_s == math.inf:
                    if not until_over:
                        tell(say("contest.is-over", url=f"{url}/contest"))
                    elif is_late:
                        tell(say("contest.stays", seconds=farewell_s))
                over_s = min(over_s, now_s) if office.over else math.inf
                for elsewhere in away:
                    elsewhere.step(office, closing=now_s - over_s > shown_s)
                writer(office.contest)
                bots.follow(office.contest)
                for line in ticker.newest(office.contest, office.facts, office.known):
                    news(line)
                time.sleep(_STEP_S)
        except KeyboardInterrupt:
            if not office.over:
                raise
        return writer.write()


def _run_here(
    where: ContestFolder, logs: Path, speed: float, tell: Callable[[Phrase], None], name: str
) -> AbstractContextManager[str]:
    """Return a context manager that runs a court on this machine, and gives its address."""
    return venue.court(where, name, logs / name, speed, tell, here=True)


def _is_done(passed_s: float, away: Sequence[AwayCourt]) -> bool:
    """Return whether the office may end, so long after the farewell: all records are here."""
    return passed_s > 0 and (passed_s > _COPY_S or all(one.is_copied for one in away))
