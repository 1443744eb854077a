"""A contest at its courts, with people and bots."""

import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from lacoc_server.contest.desk.book import Book, milliseconds
from lacoc_server.contest.desk.desk import Desk
from lacoc_server.contest.desk.service import DeskService
from lacoc_server.contest.kept.applications import Applications
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.sheet_writer import Progress, SheetWriter
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.kept.tokens import TeamTokens
from lacoc_server.contest.live import venue
from lacoc_server.contest.live.court_link import CourtLink
from lacoc_server.contest.live.office import Office
from lacoc_server.contest.organiser import prepare
from lacoc_server.contest.sheet import ContestSheet
from lacoc_shared.contest.entrances import event_code, organiser_key
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import open_client
from lacoc_shared.words import say

_STEP_S = 0.05
"""Time between two looks at the courts."""
_FAREWELL_S = 5.0
"""The courts stay for so long after the end, so that all teams hear that the contest is over."""


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
    *,
    speed: float = 1.0,
    listen: str | None = None,
    show: bool = False,
    entering: bool = False,
) -> ContestSheet:
    """Run a contest at its courts until it is over.

    The courts of the contest file, the gateway and the bots of teams run as processes of their own;
    each is started again if it ends.

    Args:
        file: the contest file.
        opened: called when courts and pages are there.
        progress: told about each change.
        speed: 2 plays twice as fast as real time.
        listen: where the gateway listens; None: this machine only.
        show: whether to open a browser.
        entering: whether teams may enter until the time in the contest file, or until the organiser
            closes entries, and the office stays after the last game until it is interrupted; False:
            the first stage is drawn at once.

    Returns:
        The sheet at the end.

    Raises:
        UserError: if the contest has no stage, no office or too few teams, or something goes wrong.
    """
    where = ContestFolder(file)
    if where.contest.office is None:
        raise UserError(say("contest.no-office", file=str(file)))
    with ExitStack() as stack:
        store = stack.enter_context(FactStore(where.facts))
        prepare(where, store, entering=entering)
        logs = Path(stack.enter_context(TemporaryDirectory(prefix="lacoc-contest-")))
        addresses = stack.enter_context(venue.courts(where, logs, speed))
        links = {
            name: CourtLink(
                stack.enter_context(open_client([address])), name, where.contest.office.token
            )
            for name, address in addresses.items()
        }
        tokens = TeamTokens(where.tokens)
        rest_ms = round(1000 * where.contest.least_rest_s)
        told = {
            name: venue.told_address(where.contest.courts[name], address)
            for name, address in addresses.items()
        }
        draw_from_ms = (milliseconds(where.contest.entries_close) or None) if entering else 0
        office = Office(store, where.entries, tokens.of, links, told, rest_ms, draw_from_ms)
        applications = stack.enter_context(Applications(where.applications))
        own_store = stack.enter_context(FactStore(where.facts))
        key, code = organiser_key(where.contest), event_code(where.contest)
        book = Book(where, own_store, applications, tokens)
        desk = Desk(book, key, code, lambda: office.known)
        service = stack.enter_context(DeskService(desk))
        bots = stack.enter_context(venue.Bots(where, tokens, next(iter(addresses.values()))))
        writer = SheetWriter(where, progress)
        writer(office.contest)
        url = stack.enter_context(venue.pages(where, logs, listen, show, service.address))
        opened(Opened(url, addresses, f"{url}/office#organiser={key}", code))
        while entering or not office.over:
            office.step()
            writer(office.contest)
            bots.follow(office.contest)
            time.sleep(_STEP_S)
        end_s = time.monotonic() + _FAREWELL_S
        while time.monotonic() < end_s:
            office.step()
            time.sleep(_STEP_S)
        return writer.write()
