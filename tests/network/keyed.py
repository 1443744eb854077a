"""A contest file with keys, and a court for tests that uses the keys."""

from collections.abc import Mapping
from pathlib import Path

import msgspec
from court_stub import TOKENS, WHISTLE, CourtStub

from lacoc_server.doors.keys.make import make_keys
from lacoc_server.doors.keys.protection import protection
from lacoc_shared.contest import entrances
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.access import Access
from lacoc_shared.network.session import Session, open_client


def keyed_file(folder: Path, where: str = "127.0.0.1:0", name: str = "contest") -> Path:
    """Write a contest file with keys, for one court with the tokens of `court_stub`."""
    file = folder / f"{name}.toml"
    seats = "".join(f'[court.main.seat.{s}]\ntoken = "{t}"\n' for s, t in TOKENS.items())
    file.write_text(
        f'[contest]\nkeys = "{name}-keys"\n[court.main]\narena = "othello"\n'
        f'listen = ["{where}"]\n{seats}[court.main.referee]\ntoken = "{WHISTLE}"\n'
    )
    make_keys(file, (), renew=False)
    return file


class KeyedCourt(CourtStub):
    """A court for tests with keys; `people` has the address and credentials of each person."""

    def __init__(self, file: Path, listen: str = "127.0.0.1:0") -> None:
        contest = contests.load(file)
        super().__init__(listen, protection(contest, "main"))
        everybody = entrances.everybody(contest, "main")
        self.people: Mapping[str, Access] = {
            who: msgspec.structs.replace(access, connect=self.address)
            for who, access in everybody.items()
        }

    def enter(self, who: str) -> Session:
        """Open a network session with a person's credentials."""
        access = self.people[who]
        return open_client([access.connect], authority=access.authority)
