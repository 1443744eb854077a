"""Runs a contest at its courts, with people and bots: opens everything, and steps the office."""

import math
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import AbstractContextManager, ExitStack, suppress
from functools import partial
from pathlib import Path
from typing import NamedTuple
from urllib.parse import urlsplit

from lacoc_server.contest.acts.organiser import keep_open, prepare
from lacoc_server.contest.desk.book import Book
from lacoc_server.contest.desk.desk import Desk
from lacoc_server.contest.desk.service import DeskService
from lacoc_server.contest.kept import machine
from lacoc_server.contest.kept.applications import Applications
from lacoc_server.contest.kept.event_code import EventCode
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.plans import not_for_courts
from lacoc_server.contest.kept.sheet_writer import Progress, SheetWriter
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.facts import generation
from lacoc_server.contest.league.sheet import ContestSheet
from lacoc_server.contest.league.timetable.ticker import Ticker
from lacoc_server.contest.live import venue
from lacoc_server.contest.live.away import AwayCourt
from lacoc_server.contest.live.court_link import CourtLink
from lacoc_server.contest.live.office import Office
from lacoc_server.contest.live.open_matches import OpenMatches
from lacoc_server.contest.standby.door import StandbyDoor
from lacoc_server.contest.standby.lookout import Lookout
from lacoc_server.contest.standby.sealing import Sealing
from lacoc_server.contest.standby.tenure import Tenure
from lacoc_shared.command.replacing import write
from lacoc_shared.command.scratch import Scratch
from lacoc_shared.contest.link import Link
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import open_client
from lacoc_shared.words import Phrase, say

_PAGES = ""
"""Key of the pages in dicts whose other keys are names of courts; no court has this name."""
_STEP_S = 0.05
"""Time between two looks at the courts [s]."""
_FAREWELL_S = 5.0
"""After the end the courts stay open for this long, so that all teams hear of it [s]."""
_LATE_S = 30.0
"""Several courts at real time stay open for this long after the end [s], not for `_FAREWELL_S`:
pages that follow the director show the end 20 s later, and then the result."""
_COPY_S = 60.0
"""Longest wait for records of courts on other machines, after `_FAREWELL_S` or `_LATE_S` [s]."""
_SHOWN_S = 60.0
"""A court on another machine shows the last match for this long [s]. Then the court closes it, so
that its record can be copied whole."""


class Opened(NamedTuple):
    """Addresses, links and the code of a contest that was opened."""

    url: str
    """Address of the pages."""
    courts: dict[str, str]
    """Addresses of the courts, by name."""
    office: str
    """Link of the organiser's page; secret."""
    code: str
    """The event code."""
    seats: dict[str, dict[str, str]]
    """Links of the open seats, by court and seat; secret."""


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
    """Run a contest at its courts until it is interrupted, or with `until_over` until it is over.

    The courts of this machine, the gateway and the bots of teams run as processes of their own;
    each is started again if it ends.

    Args:
        file: the contest file.
        opened: called when courts and pages can be reached.
        progress: called with the numbers of decided and of all matches, after each change.
        tell: called with what the organiser must know: a court can't be opened, or goes on at this
            machine; the contest is over; a second machine copies, or is silent.
        news: called with a line for what happens: a called game, a result, a lost court (`Ticker`).
        speed: 2 plays twice as fast as real time.
        listen: where the gateway listens; None: this machine only.
        show: whether to open a browser.
        entering: whether teams may enter until the organiser closes entries, also if the contest
            file has no time when entries close; it holds for later calls too. False: the first
            stage is drawn at that time, or at once if there is none.
        until_over: whether to end soon after the contest is over; False: courts, pages and office
            stay until somebody interrupts them.

    Returns:
        The contest's sheet when this call ends.

    Raises:
        KeyboardInterrupt: if it is interrupted before the contest is over.
        Retired: if the contest's office went on at another machine.
        UserError: if the contest runs already, has no stage or too few teams, if a game is not
            installed, or if something goes wrong.
    """
    where = ContestFolder(file)
    if wrong := not_for_courts([*where.plans, where.open_stage]):
        raise UserError(wrong)
    secrets = where.contest.secrets
    for court in where.contest.courts:
        secrets.referee(court)  # a machine to which the file is copied makes none
    with ExitStack() as stack:
        stack.enter_context(where.alone())
        machine.check_office(machine.read(where.machine))
        store = stack.enter_context(FactStore(where.facts))
        standby = where.contest.standby
        tenure = Tenure(where, generation(store.facts()))
        if standby is not None:
            sealing = Sealing(secrets.standby)
            stack.enter_context(Lookout(tenure, sealing))
            tenure.check()
        entering = keep_open(store, entering)
        draw_from_ms = where.contest.closes_ms or (None if entering else 0)
        is_open = draw_from_ms is None or draw_from_ms > time.time_ns() // 1_000_000
        prepare(where, store, entering=entering or is_open)
        logs = stack.enter_context(Scratch("contest"))
        run_here = partial(_run_here, where, logs, speed, tell)
        addresses = {name: court.elsewhere for name, court in where.contest.courts.items()}
        link_to = partial(CourtLink, token=secrets.office, generation=tenure.generation)
        away = [
            stack.enter_context(AwayCourt(where, name, link_to, run_here, tell))
            for name in filter(addresses.get, addresses)
        ]
        rest_ms = round(1000 * where.contest.least_rest_s)
        stage, open_matches = where.open_stage, None
        if stage is not None:
            open_matches = OpenMatches(stage, secrets.seat, tell)
        applications = stack.enter_context(Applications(where.applications))
        office = Office(
            store,
            where.entries,
            secrets.team,
            dict.fromkeys(where.contest.courts),
            addresses,
            rest_ms,
            draw_from_ms,
            open_matches,
            lambda: applications.teams,
        )
        own_store = stack.enter_context(FactStore(where.facts))
        code = EventCode(where.event_code, secrets.event_code)
        book = Book(where, own_store, applications, code)
        desk = Desk(book, secrets.organiser, lambda: office.known)
        service = stack.enter_context(DeskService(desk.judge))
        door = None
        if standby is not None:
            door = stack.enter_context(StandbyDoor(where, tenure, applications, sealing))
            stack.enter_context(DeskService(door.judge, standby.listen))
        # Courts and pages take some seconds each, so all of them open at the same time.
        starting = {name: run_here(name) for name, away_at in addresses.items() if not away_at}
        starting[_PAGES] = venue.pages(where, logs, listen, show, service.address, tell)
        found = _opened(stack, starting)
        url = found.pop(_PAGES)
        if not where.contest.public.pages:
            with suppress(OSError):  # without it, `contest invite` only names the usual port
                write(where.port, str(urlsplit(url).port).encode())
        private = where.contest.public.read_authority()
        for name, address in found.items():
            addresses[name] = address
            session = stack.enter_context(open_client([address], authority=private))
            told = venue.told_address(where.contest, name, address)
            office.connect(name, link_to(session, name), told)
            office.expect(name)
        bots = stack.enter_context(venue.Bots(where, addresses))
        writer = SheetWriter(where, progress)
        writer(office.contest)
        ticker = Ticker(office.facts)
        authority = where.contest.public.fingerprint

        def link(page: str, token: str) -> str:
            return Link(pages=url, page=page, token=token, authority=authority).text

        seats = {
            name: {
                seat: link("play", secrets.seat(name, seat))
                for seat in (stage.seats if stage is not None else ())
            }
            for name in addresses
        }
        opened(Opened(url, addresses, link("office", secrets.organiser), code.value, seats))
        if is_open and where.plans and not office.contest.closed:
            until = where.contest.entries_close if draw_from_ms else None
            tell(say("contest.entries-open", time=until.isoformat() if until else None))
        over_s = math.inf  # when the contest was over, as far as is known
        is_late = speed <= 1 and len(addresses) > 1
        farewell_s = _LATE_S if is_late else _FAREWELL_S
        shown_s = farewell_s if until_over else _SHOWN_S
        try:
            while not (until_over and _is_done(time.monotonic() - over_s - farewell_s, away)):
                office.step()
                if office.is_superseded:
                    tenure.end()
                tenure.check()
                for line in ticker.newest(office.contest, office.facts, office.known):
                    news(line)
                now_s = time.monotonic()
                if office.over and over_s == math.inf:
                    if not until_over:
                        tell(say("contest.is-over", url=f"{url}/contest"))
                    elif is_late:
                        tell(say("contest.stays", seconds=farewell_s))
                over_s = min(over_s, now_s) if office.over else math.inf
                for elsewhere in away:
                    elsewhere.step(office, closing=now_s - over_s > shown_s)
                writer(office.contest, office.expected)
                bots.follow(office.contest)
                for line in door.news() if door is not None else ():
                    tell(line)
                time.sleep(_STEP_S)
        except KeyboardInterrupt:
            if not office.over:
                raise
        return writer.write()


def _run_here(
    where: ContestFolder, logs: Path, speed: float, tell: Callable[[Phrase], None], name: str
) -> AbstractContextManager[str]:
    """Return a context manager that runs a court on this machine, and yields its address."""
    return venue.court(where, name, logs / name, speed, tell, here=True)


def _opened(stack: ExitStack, parts: Mapping[str, AbstractContextManager[str]]) -> dict[str, str]:
    """Open courts and pages, all at the same time; the stack closes them.

    Returns:
        Their addresses, by name.

    Raises:
        UserError: if a court or the pages can't be opened.
    """

    def open_one(part: AbstractContextManager[str]) -> tuple[ExitStack, str]:
        with ExitStack() as own:
            address = own.enter_context(part)
            return own.pop_all(), address

    with ThreadPoolExecutor(len(parts), "opens") as aside:
        opening = {name: aside.submit(open_one, part) for name, part in parts.items()}
        try:
            wait(opening.values())
        finally:  # Ctrl-C must close them, too
            for one in opening.values():
                if one.exception() is None:
                    stack.push(one.result()[0])
    return {name: one.result()[1] for name, one in opening.items()}


def _is_done(passed_s: float, away: Sequence[AwayCourt]) -> bool:
    """Return whether the office may end after the contest.

    It may if it has copied all records of courts on other machines, or has waited for `_COPY_S`.

    Args:
        passed_s: for how long the courts have not had to stay open any more [s]; negative: they
            still must.
        away: the courts on other machines.
    """
    return passed_s > 0 and (passed_s > _COPY_S or all(one.is_copied for one in away))
