"""Why each team of a stage is in it: its place in the stage before, and what that hung on; pure."""

from collections.abc import Iterator

from lacoc_server.contest.league.contest import Contest, StageView
from lacoc_server.contest.league.facts import Planned, Substituted
from lacoc_server.contest.league.standings import Standing, Table
from lacoc_shared.words import Phrase, say

_ACROSS = ("points", "difference", "scored")
"""What orders equal places of several groups (`StageView.ranking`)."""


def reasons(contest: Contest, plan: Planned, entries: tuple[str, ...]) -> tuple[Phrase, ...]:
    """Say of each team of a stage why it goes on into it.

    Args:
        contest: the contest.
        plan: the plan of the stage.
        entries: its teams by their seeding.

    Returns:
        A reason for each team; none if the stage follows no stage that is drawn.
    """
    before = next((view for view in contest.stages if view.name == plan.after), None)
    if before is None:
        return ()
    tables = {row.team: table for table in before.tables for row in table.rows}
    gone = {team.name for team in contest.teams if team.gone}
    instead = {
        fact.substitute: fact.team for fact in contest.decisions if isinstance(fact, Substituted)
    }
    return tuple(
        _reason(before, tables[team], team, entries, gone)
        if team in tables
        else say("advance.other", team=instead.get(team))
        for team in entries
    )


def _placed(table: Table) -> Iterator[tuple[int, Standing]]:
    """Yield the rows of a table with their places, as the seeding of the next stage counts them."""
    for place, row in enumerate(table.rows, 1):
        yield (place if row.shares else row.rank), row


def _reason(
    before: StageView, table: Table, team: str, entries: tuple[str, ...], gone: set[str]
) -> Phrase:
    """Say why a team goes on: its place, and what put it before whoever is just behind it."""
    at = next(at for at, row in enumerate(table.rows) if row.team == team)
    row, *behind = table.rows[at:]
    counts = "points" in table.tie_breaks
    is_tied = counts and behind and behind[0].points == row.points and not behind[0].out
    other = _beaten(before, table, team, entries)
    left = [one.team for one in table.rows[:at] if one.team in gone or one.out]
    return say(
        "advance.place",
        rank=row.rank,
        group=table.section.upper() if len(before.tables) > 1 else None,
        points=row.points if counts else None,
        below=behind[0].team if is_tied else None,
        tie=behind[0].decided_by if is_tied else None,
        other=other.team if other else None,
        by=_by(row, other) if other else None,
        gone=left or None,
    )


def _beaten(before: StageView, own: Table, team: str, entries: tuple[str, ...]) -> Standing | None:
    """Return the best team at the same place of another group that does not go on; None: none."""
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
    """Return what puts a team before another one of the same place in another group."""
    values = ((one.points, one.scored - one.conceded, one.scored) for one in (row, other))
    return next((code for code, a, b in zip(_ACROSS, *values, strict=True) if a != b), "seed")
