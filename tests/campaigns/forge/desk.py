"""Hostile clients at the desk of a contest's office try everything that is not theirs.

    python -m tests.campaigns.forge.desk [--attempts 10000] [--seed N]

They stand where a gateway would stand if it were broken into: in Zenoh sessions at the desk itself.
They know the event code and the token of one team. They try to do what the organiser does, to enter
or to change files for another team, to read what is another's, to answer in the desk's name, and to
append facts with bytes of any kind. An honest organiser asks in between, and must be answered.

The command ends with 0 if no forgery was accepted or changed anything (facts, applications,
tokens), nothing was told of other teams or overheard, and the organiser was always answered.
"""

import json
import random
import sys
import tempfile
from collections import Counter
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import msgspec
from arguments import arguments

from lacoc_robots.library import sample_gait_files
from lacoc_server.contest.acts import organiser
from lacoc_server.contest.desk.book import Book
from lacoc_server.contest.desk.desk import Desk
from lacoc_server.contest.desk.service import DeskService
from lacoc_server.contest.kept.applications import Applications
from lacoc_server.contest.kept.event_code import EventCode
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.contest import compute
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.timetable.calling import SeenCourt
from lacoc_server.contest.league.timetable.schedule import due
from lacoc_server.contest.league.timetable.whereabouts import ContestPace, OfficeKnowledge
from lacoc_shared.codec import encode
from lacoc_shared.contest.tokens import new_token
from lacoc_shared.keyspace import DESK
from lacoc_shared.messages import SentFile
from lacoc_shared.messages.desk import (
    Apply,
    Approve,
    ChangeFiles,
    CloseEntries,
    Decline,
    DeskRequest,
    Draw,
    Move,
    NewCode,
    Overview,
    Own,
    Rule,
    TakeOut,
    TeamFiles,
    Tokens,
)
from lacoc_shared.network.session import NoReply, Refused, open_client

_SESSIONS = 3
_HONEST_EVERY = 250
_ANSWER_S = 5.0
_FILE = """
[stage.cup]
format = "round-robin"
[court.north]
arena = "othello"
listen = ["127.0.0.1:0"]
"""
_IN, _WAITS, _MINE = ("Ants", "Bees"), "Crabs", "Dogs"


def main() -> None:
    """Try all forgeries, and print what came of them."""
    options = arguments(__doc__, attempts=10_000, seed=1)
    with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
        found = _Trial(Path(folder), stack, random.Random(options.seed)).run(options.attempts)
    json.dump(found, sys.stdout, indent=2)
    print()
    sys.exit(not found["right"])


class _Trial:
    def __init__(self, folder: Path, stack: ExitStack, chance: random.Random) -> None:
        self._chance = chance
        file = folder / "contest.toml"
        file.write_text(_FILE)
        self._where = where = ContestFolder(file)
        self._files = _sample()
        self._store = stack.enter_context(FactStore(where.facts))
        self._applications = stack.enter_context(Applications(where.applications))
        self._secrets = where.contest.secrets
        self._whistle = self._secrets.referee("north")
        self._key, self._code = self._secrets.organiser, self._secrets.event_code
        own = stack.enter_context(FactStore(where.facts))
        organiser.prepare(where, self._store, entering=True)
        for team in (*_IN, _MINE):
            organiser.enter(file, team, None, "", "")
        book = Book(
            where,
            own,
            self._applications,
            EventCode(where.event_code, self._code),
        )
        known = OfficeKnowledge({"north": SeenCourt(0)}, ContestPace(0, 60_000), {})
        desk = Desk(book, self._key, lambda: known)
        desk.answer(Apply(secret=self._code, team=_WAITS, files=self._files))
        self._mine = self._secrets.team(_MINE)
        self._others = {team: self._secrets.team(team) for team in (*_IN, _WAITS)}
        service = stack.enter_context(DeskService(desk.judge))
        self._honest = stack.enter_context(open_client([service.address]))
        self._hostile = [
            stack.enter_context(open_client([service.address])) for _ in range(_SESSIONS)
        ]
        self._overheard = 0
        # Zenoh hands a session's requests to its own queryables too, so this one asks nothing.
        self._listener = stack.enter_context(open_client([service.address]))
        self._listener.answer(DESK, self._overhear)

    def run(self, attempts: int) -> dict[str, Any]:
        before = self._state()
        kinds = (self._organise, self._for_another, self._read_another, self._any_bytes)
        tried: Counter[str] = Counter()
        refused: Counter[str] = Counter()
        accepted: Counter[str] = Counter()
        leaked = answered = asked = 0
        for number in range(attempts):
            if number % _HONEST_EVERY == 0:
                asked += 1
                answered += self._asks_honestly()
            kind = kinds[number % len(kinds)]
            name = kind.__name__.strip("_")
            tried[name] += 1
            session = self._chance.choice(self._hostile)
            try:
                answer = session.ask(DESK, kind(), _ANSWER_S)
                accepted[name] += 1
            except Refused as no:
                answer = no.payload
                refused[msgspec.msgpack.decode(answer)["why"]["code"]] += 1
            except NoReply:
                answer = b""
                refused["no reply"] += 1
            leaked += self._leaks(answer)
        for session in self._hostile:  # the right key, but not as a question: nobody reads it
            session.send(DESK, encode(CloseEntries(secret=self._key)))
        changed = self._state() != before
        right = not (sum(accepted.values()) or leaked or changed or self._overheard)
        return {
            "right": right and asked == answered,
            "attempts": dict(tried),
            "accepted": dict(accepted),
            "refused": dict(refused),
            "answers with another's secret or files": leaked,
            "requests of others that were overheard": self._overheard,
            "facts, applications or tokens changed": changed,
            "honest requests": asked,
            "answered": answered,
        }

    # Forgeries

    def _organise(self) -> bytes:
        """Make a request that only the organiser may send, with a wrong secret."""
        secret = self._chance.choice(
            (
                "",
                self._code,
                self._mine,
                self._whistle,
                self._guess(self._key),
            )
        )
        team = self._chance.choice((*_IN, _WAITS, _MINE))
        kinds: tuple[DeskRequest, ...] = (
            Approve(secret=secret, teams=(_WAITS,), reason="x"),
            Decline(secret=secret, teams=(_WAITS,)),
            NewCode(secret=secret),
            Draw(secret=secret, stage="cup", entries=(_WAITS,)),
            CloseEntries(secret=secret),
            TakeOut(secret=secret, team=team, reason="x", really=True),
            Rule(secret=secret, kind="void", pairing="cup:a1.1", reason="x", really=True),
            Move(secret=secret, pairing="cup:a1.1", court="north"),
            Tokens(secret=secret),
            Overview(secret=secret),
        )
        return encode(self._chance.choice(kinds))

    def _for_another(self) -> bytes:
        """Make a request to enter a team that is not ours, or to replace its files."""
        team, token = self._chance.choice([*self._others.items()])
        looks = self._chance.choice((team, team.upper(), f" {team} ", team.lower()))
        kinds: tuple[Any, ...] = (
            Apply(secret=self._code, team=looks, files=self._files),
            ChangeFiles(secret=self._guess(token), files=self._files),
            ChangeFiles(secret=team, files=self._files),
            {"do": "change", "secret": self._mine, "team": team, "files": {}},
            {"do": "change", "secret": [self._mine, token[:5]], "files": {}},
        )
        return encode(self._chance.choice(kinds))

    def _read_another(self) -> bytes:
        """Ask for the entry, the files or the token of a team that is not ours."""
        team, token = self._chance.choice([*self._others.items()])
        kinds: tuple[Any, ...] = (
            Own(secret=self._guess(token)),
            Own(secret=team),
            {"do": "own", "secret": self._mine, "team": team},
            {"do": "files", "secret": self._mine, "team": team},
            Tokens(secret=self._mine),
        )
        return encode(self._chance.choice(kinds))

    def _any_bytes(self) -> bytes:
        """Make a request of the organiser with a wrong key, and change some of its bytes."""
        request = bytearray(encode(Approve(secret=self._guess(self._key), teams=(_WAITS,))))
        for _ in range(self._chance.randint(1, 4)):
            request[self._chance.randrange(len(request))] = self._chance.randrange(256)
        return bytes(request[: self._chance.randint(0, len(request))])

    def _guess(self, secret: str) -> str:
        """Return a secret that is wrong by one character, or wholly."""
        if self._chance.random() < 0.5:
            return new_token()
        at = self._chance.randrange(len(secret))
        other = "z" if secret[at] != "z" else "y"
        return secret[:at] + other + secret[at + 1 :]

    # What came of it

    def _asks_honestly(self) -> bool:
        try:
            return bool(self._honest.ask(DESK, encode(Overview(secret=self._key)), _ANSWER_S))
        except (NoReply, Refused):
            return False

    def _overhear(self, _: object) -> None:
        self._overheard += 1

    def _leaks(self, answer: bytes) -> bool:
        assert self._files.locomotion is not None
        files = compute(self._store.facts(), FORMATS).teams[0].files
        secrets = (*self._others.values(), self._key, files)
        return any(one.encode() in answer for one in secrets)

    def _state(self) -> tuple[object, ...]:
        facts = self._store.facts()
        assert due(compute(facts, FORMATS), FORMATS) is not None, "entries are open"
        with Applications(self._where.applications) as waiting:
            kept = waiting.waiting
        return facts, kept, self._where.secrets.read_bytes()


def _sample() -> TeamFiles:
    postures, locomotion = sample_gait_files("hexapod")
    assert locomotion is not None
    return TeamFiles(
        postures=postures, locomotion=SentFile(locomotion.name, locomotion.data + b"\n")
    )


if __name__ == "__main__":
    main()
