"""How many matches a stage has, before it is drawn."""

from collections.abc import Mapping

from lacoc_server.contest.league.facts import Planned
from lacoc_server.contest.league.formats.format import Format, Stage
from lacoc_server.contest.league.pairing import Bye, LoserOf, Source, WinnerOf


def most_matches(plan: Planned, teams: int, formats: Mapping[str, Format]) -> int:
    """Return how many matches a stage has at most, if nobody leaves it.

    Args:
        plan: the stage.
        teams: how many teams it has.
        formats: the known formats by name.
    """
    stage = Stage(name=plan.stage, settings=plan.settings, entries=tuple(map(str, range(teams))))
    kind = formats[plan.format]
    if rounds := kind.rounds(stage):
        return rounds * (teams // 2)
    found, nobody = 0, set[Source]()
    for pairing in kind.pairings(stage):
        here = [source for source in pairing.sources if source != Bye() and source not in nobody]
        found += len(here) == 2
        if len(here) < 2:
            nobody.add(LoserOf(pairing.id))
        if not here:
            nobody.add(WinnerOf(pairing.id))
    return found
