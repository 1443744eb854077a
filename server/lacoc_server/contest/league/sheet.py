"""The sheet of a contest: everything that is public about it, for pages and for whoever checks it.

A published sheet is computed from the facts alone, so the same facts give the same bytes. That of
the office also has expected times and courts, and when entries close.
"""

from collections.abc import Iterable, Mapping

import msgspec

from lacoc_server.contest.league.advance import reasons
from lacoc_server.contest.league.contest import Contest, Day, StageView, Unused, compute
from lacoc_server.contest.league.decided import Decided, decided
from lacoc_server.contest.league.draws import Team
from lacoc_server.contest.league.facts import Announced, AnyFact, Called, Planned, stage_of
from lacoc_server.contest.league.fixture import match_fixture
from lacoc_server.contest.league.formats.format import Format
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.rating import Rated, Rating, ratings
from lacoc_server.contest.league.timetable.breaks import Break, newest_break
from lacoc_server.contest.league.timetable.foreseen import foreseen
from lacoc_server.contest.league.timetable.schedule import playable
from lacoc_server.contest.league.titles import titles
from lacoc_shared.words import Phrase

VERSION = 8
"""Version of the format of a sheet."""
EXPECTED_NOTHING: Mapping[str, tuple[str, int]] = {}
_UNKNOWN = ("", 0)


class Coming(msgspec.Struct, frozen=True, kw_only=True):
    """A game that can be played as soon as a court is free."""

    pairing: str
    game: int
    teams: tuple[str, str]
    """The teams that will sit left and right."""
    court: str = ""
    """Name of the court where it will probably be played; "": not known, as in a published
    sheet."""
    at_ms: int = 0
    """About when it will begin, in milliseconds since 1970, UTC; 0: not known."""


class Later(msgspec.Struct, frozen=True, kw_only=True):
    """A match that can't be played yet: its teams or its draw are not known, or it must wait."""

    pairing: str
    stage: str
    fixture: Phrase
    """Name of the match: "Semi-final 1"."""
    who: tuple[Phrase, Phrase]
    """The left and the right side, as far as they are known: a team, or "winner of Quarter-final
    2"."""
    court: str = ""
    at_ms: int = 0
    """About when it will begin, in milliseconds since 1970, UTC; 0: not known."""


class ContestSheet(msgspec.Struct, frozen=True, kw_only=True):
    """What is public about a contest."""

    version: int = VERSION
    name: str
    open: bool
    """Whether entries are open; once they are closed, a team enters only with a reason."""
    closes_ms: int
    """When entries close, in milliseconds since 1970, UTC; 0: when the organiser closes them, or
    not known, as in a published sheet."""
    teams: tuple[Team, ...]
    """The teams, in the order in which they entered."""
    stages: tuple[StageView, ...]
    """The stages that were drawn, in the order of their draws."""
    titles: dict[str, Phrase]
    """What people call each stage, drawn or not, by its name in the contest file."""
    fixtures: dict[str, Phrase]
    """Name of each match, by its pairing: "Semi-final 1"."""
    planned: tuple[Planned, ...]
    """The stages that are not drawn yet."""
    running: tuple[Called, ...]
    """The games that are on a court now."""
    coming: tuple[Coming, ...]
    """The games that can be played next, in their order."""
    later: tuple[Later, ...]
    """All other matches that are still to come, in their order."""
    reasons: dict[str, tuple[Phrase, ...]]
    """Why each team of a stage is in it, by stage, in the order of the seeding. A stage without
    such reasons is left out."""
    day: Day
    """Whether games are called now."""
    pause: Break | None
    """The newest pause or break, which may be over; None: there is none (`newest_break`)."""
    announced: Announced | None
    """The organiser's announcement on all pages; None: there is none."""
    decided: tuple[Decided, ...]
    """What people decided, the newest first."""
    ratings: tuple[Rating, ...]
    """A rating for each team that has played a game, the strongest first."""
    side_elo: float
    """Advantage of the left seat, in Elo points."""
    unused: tuple[Unused, ...]
    """Facts that have no effect, each with the reason."""


def sheet_of(name: str, facts: Iterable[AnyFact], formats: Mapping[str, Format]) -> ContestSheet:
    """Compute the sheet of a contest.

    Args:
        name: the contest's name.
        facts: in any order.
        formats: the known formats by name.

    Raises:
        UserError: if the facts contradict each other, or name an unknown format or tie-break.
    """
    return sheet(name, compute(facts, formats))


def sheet(
    name: str,
    contest: Contest,
    expected: Mapping[str, tuple[str, int]] = EXPECTED_NOTHING,
    closes_ms: int = 0,
) -> ContestSheet:
    """Make the sheet of a computed contest.

    Args:
        name: the contest's name.
        contest: the contest.
        expected: where and when matches to come will probably begin, by pairing. A published sheet
            has none, because it must follow from the facts alone.
        closes_ms: when entries close, in milliseconds since 1970, UTC; 0 in a published sheet, for
            the same reason.
    """
    games = [game for view in contest.stages for match in view.matches for game in match.games]
    rated = ratings(Rated(*game.teams, game.winner) for game in games)
    ready = playable(contest)
    coming = foreseen(contest, FORMATS)
    at_once = {match.pairing.id for match in ready}
    return ContestSheet(
        name=name,
        open=not contest.closed,
        closes_ms=closes_ms,
        teams=contest.teams,
        stages=contest.stages,
        titles=titles(contest),
        fixtures={
            match.pairing.id: match_fixture(contest, view, match)
            for view in contest.stages
            for match in view.matches
        },
        planned=contest.planned,
        running=contest.running,
        coming=tuple(
            Coming(
                pairing=match.pairing.id,
                game=match.next_game,
                teams=match.next_seats,
                court=expected.get(match.pairing.id, _UNKNOWN)[0],
                at_ms=expected.get(match.pairing.id, _UNKNOWN)[1],
            )
            for match in ready
            if match.next_seats is not None
        ),
        later=tuple(
            Later(
                pairing=one.pairing.id,
                stage=stage_of(one.pairing.id),
                fixture=one.fixture,
                who=one.who,
                court=expected.get(one.pairing.id, _UNKNOWN)[0],
                at_ms=expected.get(one.pairing.id, _UNKNOWN)[1],
            )
            for one in coming
            if one.pairing.id not in at_once
        ),
        reasons={
            view.name: told
            for view in contest.stages
            if (told := reasons(contest, view.plan, view.stage.entries))
        },
        day=contest.day,
        pause=newest_break(contest, coming),
        announced=contest.announced,
        decided=decided(contest)[::-1],
        ratings=rated.teams,
        side_elo=rated.side_elo,
        unused=contest.unused,
    )


def encode(sheet: ContestSheet) -> bytes:
    """Return a sheet as JSON; equal sheets give the same bytes."""
    return msgspec.json.encode(sheet, order="deterministic")


def decode(data: bytes) -> ContestSheet:
    """Read a sheet from JSON.

    Raises:
        msgspec.MsgspecError: if it is not the JSON of a sheet.
    """
    return msgspec.json.decode(data, type=ContestSheet)
