"""What is to be drawn next, when nobody says otherwise."""

from collections.abc import Mapping

from lacoc_server.contest.league.contest import Contest, next_round
from lacoc_server.contest.league.facts import Closed, Drawn, Planned, RoundDrawn, new
from lacoc_server.contest.league.formats.format import Format


def due(contest: Contest, formats: Mapping[str, Format]) -> Closed | Drawn | RoundDrawn | None:
    """Return the next draw; None: nothing can be drawn now.

    Before the first draw, entries are closed.

    The next round of a stage is drawn when all matches of its earlier rounds are decided. A stage
    that follows another one is drawn when that one is over, with those who are left in the contest.
    Stages that follow none are drawn one after another.
    """
    for view in contest.stages:
        if view.may_draw:
            pairs = next_round(contest, view.name, formats)
            return new(RoundDrawn, stage=view.name, round=len(view.stage.drawn) + 1, pairs=pairs)
    for plan in contest.planned:
        if (teams := _teams(contest, plan)) is not None:
            if not contest.closed:
                return new(Closed)
            return new(Drawn, stage=plan.stage, entries=teams)
        return None
    return None


def _teams(contest: Contest, plan: Planned) -> tuple[str, ...] | None:
    """Return the teams of a stage by seeding; None: they are not known yet."""
    before = {view.name: view for view in contest.stages}
    if any(not view.over for view in before.values()):
        return None
    here = [team.name for team in contest.teams if not team.gone]
    seeding = before[plan.after].ranking if plan.after in before else here
    left = [team for team in seeding if team in here]
    return tuple(left[: plan.teams or None])
