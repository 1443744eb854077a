"""Names a match or a game of a contest, as a phrase: "Semi-final 1, game 2 of 3"; pure."""

import re

from lacoc_server.contest.league.contest import Contest, StageView
from lacoc_server.contest.league.matches import ContestMatch
from lacoc_server.contest.league.titles import title
from lacoc_shared.words import Phrase, say


def named(contest: Contest, pairing: str, game: int = 0) -> Phrase:
    """Name a match, such as "Semi-final 1", or a game of it: "Semi-final 1, game 2 of 3".

    If the draw of its stage was taken back, the match is named by stage, group and round, and its
    games are not named apart.

    Args:
        contest: the contest.
        pairing: id of the match's pairing.
        game: number of the game in its match, from 1; 0: name the match.
    """
    for view in contest.stages:
        for match in view.matches:
            if match.pairing.id == pairing:
                if game:
                    return fixture(contest, view, match, game)
                return match_fixture(contest, view, match)
    return _undrawn(contest, pairing)


def _undrawn(contest: Contest, pairing: str) -> Phrase:
    """Name a match whose stage is not drawn now, by stage, group and round, as they are in its id.

    If the contest has no plan of the stage, the match is named by its id.
    """
    stage, _, place = pairing.partition(":")
    found = re.fullmatch(r"([a-z]*)([0-9]{1,4})\.[0-9]+", place)
    plan = next((one for one in contest.planned if one.stage == stage), None)
    if found is None or plan is None:
        return say("fixture.named", name=pairing)
    group = found[1].upper() if plan.settings.groups > 1 else None
    return say("fixture.round", stage=title(contest, stage), group=group, round=int(found[2]))


def fixture(
    contest: Contest, view: StageView, match: ContestMatch, game: int, *, stands: bool = False
) -> Phrase:
    """Name a game of a contest: "Semi-final 1, game 2 of 3"; the match, if it has only one game.

    Args:
        contest: the contest.
        view: the stage of the match.
        match: the match.
        game: number of the game in its match, from 1.
        stands: whether to say how the match stands before this game.
    """
    said = match_fixture(contest, view, match)
    games = max(game, view.stage.settings.games)  # the last ones may be extra games
    if games == 1:
        return said
    named_game = say("fixture.game", match=said, game=game, games=games)
    if not (stands and match.games):
        return named_game
    return say("fixture.so-far", game=named_game, standing=standing(match))


def standing(match: ContestMatch) -> Phrase:
    """Say how many games each team of a match has won; a draw is a half: "Ants 1½ : ½ Bees"."""
    first, second = match.seated
    drawn = sum(not game.winner for game in match.games)
    halves = [2 * sum(game.winner == team for game in match.games) + drawn for team in match.seated]
    one, other = map(_halves, halves)
    return say("fixture.standing", left=first or "?", right=second or "?", won=one, lost=other)


def _halves(count: int) -> str:
    """Write a number of halves, for example 3 as "1½"."""
    whole, half = divmod(count, 2)
    return f"{whole or '' if half else whole}{'½' if half else ''}"


def match_fixture(contest: Contest, view: StageView, match: ContestMatch) -> Phrase:
    """Name a match of a contest: "Semi-final 1"; arguments as in `fixture`."""
    pairing = match.pairing
    number = int(pairing.id.rpartition(".")[2])
    knockouts = [one for one in contest.stages if any(map(_is_knockout, one.matches[:1]))]
    stage = title(contest, view.name) if len(knockouts) > 1 else None
    # Groups of a round robin have letters too: group F is no final.
    match pairing.section if view in knockouts else "":
        case "p":
            return say("fixture.third-place", stage=stage)
        case "f" if pairing.round == 2:
            return say("fixture.deciding-final", stage=stage)
        case "f":
            return say("fixture.final", stage=stage)
        case "l":
            return say("fixture.losers", stage=stage, round=pairing.round, number=number)
        case "w":
            return _winners(view, match, stage, number)
    several = view.plan.settings.groups > 1 and any(
        one.pairing.section != pairing.section for one in view.matches
    )
    group = pairing.section.upper() if several else None
    return say("fixture.round", stage=title(contest, view.name), group=group, round=pairing.round)


def _winners(view: StageView, match: ContestMatch, stage: Phrase | None, number: int) -> Phrase:
    """Name a match of the winners' bracket: "Final", "Semi-final 1", or by round and number."""
    pairing = match.pairing
    double = any(one.pairing.section == "l" for one in view.matches)
    there = sum(
        (one.pairing.section, one.pairing.round) == (pairing.section, pairing.round)
        for one in view.matches
    )
    match 0 if double else there:
        case 1:
            return say("fixture.final", stage=stage)
        case 2:
            return say("fixture.semi-final", stage=stage, number=number)
        case 4:
            return say("fixture.quarter-final", stage=stage, number=number)
    return say("fixture.knockout", stage=stage, round=pairing.round, number=number)


def _is_knockout(match: ContestMatch) -> bool:
    """Return whether a match is part of a knockout."""
    return match.pairing.loser_place is not None
