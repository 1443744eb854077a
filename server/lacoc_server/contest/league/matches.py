"""A match is a pairing with its teams, games and winner, as the facts give them."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Literal

import msgspec

from lacoc_server.contest.league.facts import (
    Called,
    NoShow,
    OfMatch,
    Outcome,
    Played,
    Replaced,
    Replay,
    StageSettings,
    Voided,
)
from lacoc_server.contest.league.pairing import AnySource, Entrant, LoserOf, Pairing, WinnerOf
from lacoc_shared.words import Phrase

NOBODY = ""
"""Stands for the team of a place that stays empty, and for the winner of a match that nobody
won."""

Team = str | None
"""A team's name. NOBODY: no team. None: the team is not known yet."""

State = Literal["waits", "open", "decided", "off"]
"""waits: a team is not known yet. open: it can be played. decided: its result is fixed. off: it is
not needed."""
How = Literal["", "played", "extra", "difference", "seed", "walkover", "bye", "void"]
"""How a match was decided; "": it is not decided."""


class CountedGame(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """A game whose result counts for its match."""

    number: int
    teams: tuple[str, str]
    """Who sat left and who sat right."""
    scores: tuple[int, int]
    outcome: Outcome
    record: str = ""
    """File name of the record of the played game; also if a decision replaced its result."""
    court: str = ""
    """Name of the court that had the game; "": not known, as in games without a network."""
    began_ms: int = 0
    """When the court was given the game, in milliseconds since 1970, UTC; 0: not known."""
    ruled: bool = False
    """Whether the result is the organiser's, and replaces the played one."""
    advice: tuple[Phrase, ...] = ()
    """Why the court advised to play the game again; empty: it gave no advice, or `ruled`."""
    fact: str
    """Id of the fact that gives this result."""

    @property
    def winner(self) -> str:
        """The team that won; NOBODY for a draw."""
        return {"left": self.teams[0], "right": self.teams[1]}.get(self.outcome, NOBODY)


class ContestMatch(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """A pairing with all that the facts say of it."""

    pairing: Pairing
    teams: tuple[Team, Team]
    """The teams of the pairing's first and second place."""
    state: State
    games: tuple[CountedGame, ...] = ()
    next_game: int = 0
    """Number of the game to play next, from 1; 0: there is none."""
    next_seats: tuple[str, str] | None = None
    """The teams that sit left and right in the next game."""
    winner: Team = None
    """The winner. NOBODY: decided without a winner, for example a draw. None: not decided, or not
    needed (`off`)."""
    loser: Team = None
    how: How = ""

    @property
    def decided(self) -> bool:
        """Whether the match needs no more games."""
        return self.state in ("decided", "off")

    @property
    def seated(self) -> tuple[Team, Team]:
        """The teams in the order in which pages show them: who sits left in game 1 comes first."""
        return (self.games[0].teams if self.games else self.next_seats) or self.teams

    @property
    def scores(self) -> tuple[int, int]:
        """Points over all games, of the first and of the second place."""
        first, second = (
            sum(
                score
                for game in self.games
                for team, score in zip(game.teams, game.scores, strict=True)
                if team == place
            )
            for place in self.teams
        )
        return first, second


class StageRules(msgspec.Struct, frozen=True, kw_only=True):
    """What `resolve` must know of a stage, besides its pairings and facts."""

    settings: StageSettings
    entries: tuple[str, ...]
    """The teams by seeding."""
    decisive: bool
    """True: a match must have a winner."""
    balanced: bool
    """True: the team that sat left less often in this stage sits left in game 1."""


def resolve(
    pairings: Sequence[Pairing],
    facts: Mapping[str, Sequence[OfMatch]],
    gone: Collection[str],
    rules: StageRules,
) -> dict[str, ContestMatch]:
    """Compute all matches of a stage from its pairings and facts.

    Args:
        pairings: each pairing comes after the pairings that its sources name.
        facts: the facts of each pairing in their order.
        gone: teams that have withdrawn or were disqualified.
        rules: what decides the matches.

    Returns:
        The matches by the pairing's id, in the order of the pairings.
    """
    matches: dict[str, ContestMatch] = {}
    left: dict[str, int] = {}
    for pairing in pairings:
        match = _match(pairing, matches, facts.get(pairing.id, ()), gone, rules, left)
        matches[pairing.id] = match
        for game in match.games:
            left[game.teams[0]] = left.get(game.teams[0], 0) + 1
            left[game.teams[1]] = left.get(game.teams[1], 0) - 1
    return matches


def _match(
    pairing: Pairing,
    matches: Mapping[str, ContestMatch],
    facts: Sequence[OfMatch],
    gone: Collection[str],
    rules: StageRules,
    left: Mapping[str, int],
) -> ContestMatch:
    first, second = (_team(source, matches) for source in pairing.sources)
    if condition := pairing.only_if_second_won:
        before = matches[condition]
        if before.decided and before.winner != before.teams[1]:
            return ContestMatch(pairing=pairing, teams=(first, second), state="off")
        if not before.decided:
            return ContestMatch(pairing=pairing, teams=(None, None), state="waits")
    if first is None or second is None:
        return ContestMatch(pairing=pairing, teams=(first, second), state="waits")
    teams = (first, second)
    if NOBODY in teams:
        return _decided(pairing, teams, (), first or second, "bye")
    swapped = rules.balanced and left.get(first, 0) > left.get(second, 0)
    return _between(pairing, teams, swapped, facts, gone, rules)


def _between(
    pairing: Pairing,
    teams: tuple[str, str],
    swapped: bool,
    facts: Sequence[OfMatch],
    gone: Collection[str],
    rules: StageRules,
) -> ContestMatch:
    """Compute the match of a pairing whose two teams are known."""
    counted, is_void, absent = counting(teams, facts)
    if is_void:
        return _decided(pairing, teams, (), NOBODY, "void")
    games: list[CountedGame] = []
    for number in range(1, rules.settings.games + rules.settings.extra_games + 1):
        ended = _verdict(games, teams, rules)
        if ended is not None:
            return _decided(pairing, teams, games, *ended)
        if number not in counted:
            break
        games.append(counted[number])
    else:
        ended = _verdict(games, teams, rules)
        if ended is not None:
            return _decided(pairing, teams, games, *ended)
    missing = {team for team in teams if team in gone or team in absent}
    if missing:
        stays = [team for team in teams if team not in missing]
        return _decided(pairing, teams, games, stays[0] if stays else NOBODY, "walkover")
    number = len(games) + 1
    # A correction may change who would have begun left, so the games that count decide first.
    more_left = sum(1 if game.teams == teams else -1 for game in counted.values())
    first_right = swapped if more_left == 0 else more_left > 0
    seats = (teams[1], teams[0]) if first_right else teams
    return ContestMatch(
        pairing=pairing,
        teams=teams,
        state="open",
        games=tuple(games),
        next_game=number,
        next_seats=seats,
    )


def counting(
    teams: tuple[str, str], facts: Iterable[OfMatch]
) -> tuple[dict[int, CountedGame], bool, set[str]]:
    """Find the facts that count in a match between two teams.

    Facts about other teams are left out: the pairing had other teams then. Of two results of the
    same game the first one counts, until a decision says otherwise.

    Returns:
        The games that count, by number; whether the match is void; and the teams that did not
        appear.
    """
    games: dict[int, CountedGame] = {}
    called: dict[int, Called] = {}
    played: dict[int, tuple[Played, Called | None]] = {}
    """By number of the game: the fact of what was played, which may be void, and its call."""
    is_void = False
    absent: set[str] = set()
    for fact in facts:
        if not is_about(fact, teams):
            continue
        if isinstance(fact, NoShow):
            absent.add(fact.team)
        elif isinstance(fact, Voided):
            is_void = True
        elif isinstance(fact, Replay):
            games.pop(fact.game, None)
            played.pop(fact.game, None)
            is_void = False
            absent.clear()
        elif isinstance(fact, Called):
            called[fact.game] = fact
        elif isinstance(fact, Replaced):
            games[fact.game] = _game(fact, *played.get(fact.game, (None, None)))
        elif isinstance(fact, Played) and fact.game not in games:
            played[fact.game] = (fact, called.get(fact.game))
            if fact.outcome != "void":
                games[fact.game] = _game(fact, *played[fact.game])
    return games, is_void, absent


def match_teams(fact: OfMatch) -> tuple[str, ...]:
    """Return both teams that a fact names as those of its match.

    () if it names none, as a `Recalled`, a `Moved`, and a `NoShow` of an older version.
    """
    if isinstance(fact, NoShow):
        return (fact.team, fact.opponent) if fact.opponent else ()
    return getattr(fact, "teams", ())


def is_about(fact: OfMatch, teams: tuple[str, str]) -> bool:
    """Return whether a fact names these two teams, in any order, as those of its match."""
    if isinstance(fact, NoShow) and not fact.opponent:
        return fact.team in teams
    return {*match_teams(fact)} == {*teams}


def _game(fact: Played | Replaced, played: Played | None, call: Called | None) -> CountedGame:
    """Make a game that counts, from the fact of its result, the game as played, and its call."""
    return CountedGame(
        number=fact.game,
        teams=fact.teams,
        scores=fact.scores,
        outcome=fact.outcome,
        record=played.record if played is not None else "",
        court=call.court if call is not None else "",
        began_ms=call.at_ms if call is not None else 0,
        ruled=isinstance(fact, Replaced),
        fact=fact.id,
        advice=fact.advice if isinstance(fact, Played) else (),
    )


def _team(source: AnySource, matches: Mapping[str, ContestMatch]) -> Team:
    if isinstance(source, Entrant):
        return source.team
    if isinstance(source, WinnerOf):
        return matches[source.pairing].winner
    if isinstance(source, LoserOf):
        return matches[source.pairing].loser
    return NOBODY


def _verdict(
    games: Sequence[CountedGame], teams: tuple[str, str], rules: StageRules
) -> tuple[str, How] | None:
    """Return the winner of a match (NOBODY: a draw) and how it was decided; None: it is open."""
    first, second = (sum(game.winner == team for game in games) for team in teams)
    left = rules.settings.games - len(games)
    if abs(first - second) > max(left, 0):
        return teams[first < second], "played" if left >= 0 else "extra"
    if left > 0:
        return None
    if not rules.decisive:
        return NOBODY, "played"
    if left > -rules.settings.extra_games:
        return None
    totals = [sum(game.scores[game.teams.index(team)] for game in games) for team in teams]
    if totals[0] != totals[1]:
        return teams[totals[0] < totals[1]], "difference"
    return min(teams, key=rules.entries.index), "seed"


def _decided(
    pairing: Pairing, teams: tuple[str, str], games: Iterable[CountedGame], winner: str, how: How
) -> ContestMatch:
    """Make a decided match. Without a winner, no team goes on from it."""
    loser = next((team for team in teams if team != winner), NOBODY) if winner else NOBODY
    return ContestMatch(
        pairing=pairing,
        teams=teams,
        state="decided",
        games=tuple(games),
        winner=winner,
        loser=NOBODY if how == "bye" else loser,
        how=how,
    )
