"""A contest with its desk, in the process of a test: no network, no courts."""

from pathlib import Path

from lacoc_robots.library import sample_gait_files
from lacoc_server.contest.acts import organiser
from lacoc_server.contest.desk.book import Book
from lacoc_server.contest.desk.desk import Desk
from lacoc_server.contest.kept.applications import Applications
from lacoc_server.contest.kept.event_code import EventCode
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.plans import note_plans
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.contest import compute
from lacoc_server.contest.league.facts import AnyFact
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.timetable.calling import SeenCourt
from lacoc_server.contest.league.timetable.schedule import due
from lacoc_server.contest.league.timetable.whereabouts import ContestPace, OfficeKnowledge
from lacoc_shared.codec import encode
from lacoc_shared.messages import Refusal, SentFile
from lacoc_shared.messages.desk import (
    AnyRequest,
    OfficeView,
    Overview,
    Overviewed,
    TeamFiles,
)

NOW_MS = 1_800_000_000_000
KEY, CODE = "organiser", "K7QM3X"
_STAGES = """
[stage.cup]
format = "round-robin"
"""
_COURTS = """
[court.north]
arena = "othello"
listen = ["127.0.0.1:0"]
[court.south]
arena = "othello"
listen = ["127.0.0.1:0"]
"""


def sample(change: bytes = b"") -> TeamFiles:
    """Return the files of a team; another `change` gives them another hash."""
    postures, locomotion = sample_gait_files("hexapod")
    assert locomotion is not None
    locomotion = SentFile(locomotion.name, locomotion.data.rstrip() + b"\n" + change)
    return TeamFiles(postures=postures, locomotion=locomotion)


class Room:
    """A contest with its desk."""

    def __init__(self, folder: Path, more: str = "", stages: str = _STAGES) -> None:
        self.file = folder / "contest.toml"
        self.file.write_text(stages + _COURTS + more)
        self.where = ContestFolder(self.file)
        self.store = FactStore(self.where.facts)
        note_plans(self.store, self.where.plans)
        self.applications = Applications(self.where.applications)
        self.secrets = self.where.contest.secrets
        code = EventCode(self.where.event_code, CODE)
        store = FactStore(self.where.facts)
        self.book = Book(self.where, store, self.applications, code)
        courts = {court: SeenCourt(NOW_MS, there=True) for court in ("north", "south")}
        self.known = OfficeKnowledge(courts, ContestPace(NOW_MS, 60_000), {})
        self.desk = Desk(self.book, KEY, lambda: self.known)

    def ask(self, request: AnyRequest) -> object:
        """Encode a request as the network does, and return the desk's answer."""
        return self.desk.judge(encode(request))

    @property
    def facts(self) -> tuple[AnyFact, ...]:
        return self.store.facts()

    @property
    def view(self) -> OfficeView:
        answer = self.ask(Overview(secret=KEY))
        assert isinstance(answer, Overviewed)
        assert answer.view is not None
        return answer.view

    def states(self) -> dict[str, str]:
        return {row.team: row.state for row in self.view.teams}

    def draw(self) -> None:
        """Draw the stage that is due, as the office does when entries are closed."""
        self.store.decide(lambda facts: filter(None, [due(compute(facts, FORMATS), FORMATS)]))

    def enter(self, *teams: str, reason: str = "") -> None:
        for team in teams:
            organiser.enter(self.file, team, None, "", reason)


def said(answer: object) -> str:
    assert isinstance(answer, Refusal), answer
    return answer.why.code
