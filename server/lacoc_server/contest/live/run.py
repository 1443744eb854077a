"""A contest at its courts, with people and bots."""

import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory

from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.sheet_writer import Progress, SheetWriter
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.kept.tokens import TeamTokens
from lacoc_server.contest.live import venue
from lacoc_server.contest.live.court_link import CourtLink
from lacoc_server.contest.live.office import Office
from lacoc_server.contest.organiser import prepare
from lacoc_server.contest.sheet import ContestSheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import open_client
from lacoc_shared.words import say

_STEP_S = 0.05
"""Time between two looks at the courts."""
_FAREWELL_S = 5.0
"""The courts stay for so long after the end, so that all teams hear that the contest is over."""


def play_live(
    file: Path,
    opened: Callable[[str, dict[str, str]], None],
    progress: Progress,
    *,
    speed: float = 1.0,
    listen: str | None = None,
    show: bool = False,
) -> ContestSheet:
    """Run a contest at its courts until it is over.

    The courts of the contest file, the gateway and the bots of teams run as processes of their own;
    each is started again if it ends.

    Args:
        file: the contest file.
        opened: called with the address of the pages, and the courts' addresses by name.
        progress: told about each change.
        speed: 2 plays twice as fast as real time.
        listen: where the gateway listens; None: this machine only.
        show: whether to open a browser.

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
        prepare(where, store)
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
        office = Office(store, where.entries, tokens.of, links, told, rest_ms)
        bots = stack.enter_context(venue.Bots(where, tokens, next(iter(addresses.values()))))
        writer = SheetWriter(where, progress)
        writer(office.contest)
        opened(stack.enter_context(venue.pages(where, logs, listen, show)), addresses)
        while not office.over:
            office.step()
            writer(office.contest)
            bots.follow(office.contest)
            time.sleep(_STEP_S)
        end_s = time.monotonic() + _FAREWELL_S
        while time.monotonic() < end_s:
            office.step()
            time.sleep(_STEP_S)
        return writer.write()
