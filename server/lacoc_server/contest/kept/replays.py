"""Hides records that not everybody may see yet, because a record holds the gaits of both teams."""

from msgspec.structs import replace

from lacoc_server.contest.league.sheet import ContestSheet
from lacoc_shared.messages.desk import Replays


def shown(sheet: ContestSheet, when: Replays) -> ContestSheet:
    """Return a sheet that names only the records which everybody may see now.

    If a contest keeps records back, its gateway serves only the records that this sheet names.

    Args:
        sheet: the sheet, which names all records.
        when: when the contest shows records: at once, after their stage, or at the end.
    """
    if when == "at-once":
        return sheet
    over = not sheet.planned and all(view.over for view in sheet.stages)
    return replace(
        sheet,
        stages=tuple(
            view
            if over or (when == "after-stage" and view.over)
            else replace(
                view,
                matches=tuple(
                    replace(match, games=tuple(replace(game, record="") for game in match.games))
                    for match in view.matches
                ),
            )
            for view in sheet.stages
        ),
    )
