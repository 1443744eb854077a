"""Reasons why each team of a stage is in it and has its seed; pure."""

from collections.abc import Iterator

from lacoc_server.contest.league.contest import Contest, StageView
from lacoc_server.contest.league.facts import Planned, Substituted
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.standings import Standing, Table
from lacoc_server.contest.league.timetable.seeding import by_rank, moved_apart
from lacoc_shared.words import Phrase, say

_ACROSS = ("points", "difference", "scored")
"""Codes that order teams with the same place in different groups (`StageView.ranking`)."""


def reasons(contest: Contest, plan: Planned, entries: tuple[str, ...]) -> tuple[Phrase, ...]:
    """Say why each team of a stage is in it, and, if it was moved to keep teams apart, which.

    Args:
        contest: the contest.
        plan: the plan of the stage.
        entries: its teams by their seeding.

    Returns:
        A reason for each team. Empty if the stage follows no drawn stage and no team was moved to
        keep teams apart: then there is nothing to explain.
    """
    before = next((view for view in contest.stages if view.name == plan.after), None)
    how = FORMATS.get(plan.format)
    moved = moved_apart(contest, plan, how, entries) if how is not None else {}
    if before is None:
        entered = [team for team in by_rank(contest, plan) if team in entries]
        return tuple(
            say("advance.entered", number=entered.index(team) + 1, moved=moved.get(team))
            for team in (entries if moved else ())
        )
    tables = {row.team: table for table in before.tables for row in table.rows}
    gone = {team.name for team in contest.teams if team.gone}
    instead = {
        fact.substitute: fact.team for fact in contest.decisions if isinstance(fact, Substituted)
    }
    return tuple(
        _reason(before, tables[team], team, entries, gone, moved.get(team))
        if team in tables
        else say("advance.other", team=instead.get(team))
        for team in entries
    )


def _placed(table: Table) -> Iterator[tuple[int, Standing]]:
    """Yield the rows of a table, each with the team's place by which the next stage is seeded."""
    for place, row in enumerate(table.rows, 1):
        yield (place if row.shares else row.rank), row


def _reason(
    before: StageView,
    table: Table,
    team: str,
    entries: tuple[str, ...],
    gone: set[str],
    moved: Phrase | None,
) -> Phrase:
    """Say why a team goes on: its place, and which tie-break ranked it above the next team.

    For the last of several teams with equal points, say which tie-break ranked it below the team
    above it.
    """
    at = next(at for at, row in enumerate(table.rows) if row.team == team)
    row, *behind = table.rows[at:]
    above = table.rows[at - 1] if at else None
    counts = "points" in table.tie_breaks
    is_tied = bool(behind) and _is_tied(table, row, behind[0])
    if is_tied or above is None or not _is_tied(table, above, row):
        above = None
    other = _beaten(before, table, team, entries)
    left = [one.team for one in table.rows[:at] if one.team in gone or one.out]
    return say(
        "advance.place",
        rank=row.rank,
        group=table.section.upper() if len(before.tables) > 1 else None,
        points=row.points if counts else None,
        below=behind[0].team if is_tied else None,
        tie=behind[0].decided_by if is_tied else None,
        above=above.team if above else None,
        under=row.decided_by if above else None,
        other=other.team if other else None,
        by=_by(row, other) if other else None,
        gone=left or None,
        moved=moved,
    )


def _is_tied(table: Table, row: Standing, behind: Standing) -> bool:
    """Return whether a team is before the next one only by a tie-break, at equal points."""
    if behind.out or not behind.decided_by:
        return False
    return "points" not in table.tie_breaks or row.points == behind.points


def _beaten(before: StageView, own: Table, team: str, entries: tuple[str, ...]) -> Standing | None:
    """Find, in the other groups, the best team that has the place of `team` and does not go on.

    Return None if there is no such team.
    """
    place = next(there for there, row in _placed(own) if row.team == team)
    same = (
        row
        for table in before.tables
        for there, row in _placed(table)
        if table is not own and there == place and row.team not in entries and not row.out
    )
    return min(
        same, key=lambda one: (-one.points, one.conceded - one.scored, -one.scored), default=None
    )


def _by(row: Standing, other: Standing) -> str:
    """Return the code that ranks a team above the team with the same place in another group."""
    values = ((one.points, one.scored - one.conceded, one.scored) for one in (row, other))
    return next((code for code, a, b in zip(_ACROSS, *values, strict=True) if a != b), "seed")
