"""The data that the desk works on: a contest's facts, its applications, and the teams' tokens."""

from lacoc_server.contest.kept.applications import Applications
from lacoc_server.contest.kept.contacts import Contacts
from lacoc_server.contest.kept.event_code import EventCode
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.contest import Contest, Newest
from lacoc_server.contest.league.draws import Team
from lacoc_server.contest.league.facts import AnyFact
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_shared.contest.names import look_alike
from lacoc_shared.messages.desk import EventInfo
from lacoc_shared.mistakes import Mistake

_REFUSED_KEPT = 50
"""For how many teams the mistakes in refused files are kept at most, for the organiser to read."""


class Book:
    """The data of a contest that the desk reads and changes; only one thread may use it at a time.

    Args:
        where: the contest.
        store: its facts.
        applications: the entries that wait for the organiser.
        code: the event code.
    """

    def __init__(
        self,
        where: ContestFolder,
        store: FactStore,
        applications: Applications,
        code: EventCode,
    ) -> None:
        self.where = where
        self.store = store
        self.applications = applications
        self.contacts = Contacts(where.contacts)
        self.secrets = where.contest.secrets
        self.code = code
        self.refused: dict[str, tuple[Mistake, ...]] = {}
        """Mistakes in the newest files of teams whose files were refused; not kept on the disk."""
        self._newest = Newest(FORMATS)

    @property
    def facts(self) -> tuple[AnyFact, ...]:
        """All facts of the contest, also those that other programs have appended.

        Raises:
            UserError: if they can't be read.
        """
        return self.store.facts()

    @property
    def contest(self) -> Contest:
        """The contest that follows from the facts.

        Raises:
            UserError: if they can't be read.
        """
        return self.contest_of(self.facts)

    def contest_of(self, facts: tuple[AnyFact, ...]) -> Contest:
        """Return the contest that is computed from the given facts."""
        return self._newest.of(facts)

    @property
    def event(self) -> EventInfo:
        """Public data of the contest, such as its name, and whether entries are open."""
        plan = self.where.contest
        return EventInfo(
            name=plan.name,
            open=not self.contest.closed,
            closes_ms=plan.closes_ms,
            replays=plan.replays,
            announced=said.text if (said := self.contest.announced) is not None else "",
        )

    def team(self, name: str) -> Team | None:
        """Return a team of the contest; None: no team of this name has entered."""
        return next((team for team in self.contest.teams if team.name == name), None)

    def is_taken(self, name: str) -> bool:
        """Return whether a team, entered or waiting, has this name or one that looks like it."""
        names = (*(team.name for team in self.contest.teams), *self.applications.waiting)
        return any(look_alike(name, other) for other in names)

    def note_refused(self, team: str, mistakes: tuple[Mistake, ...]) -> None:
        """Keep the mistakes in a team's newest files; an empty tuple removes those kept before."""
        self.refused.pop(team, None)
        if mistakes:
            self.refused[team] = mistakes
        while len(self.refused) > _REFUSED_KEPT:
            del self.refused[next(iter(self.refused))]
