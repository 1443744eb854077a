"""Computes a contest from its facts: teams, stages, matches and tables; also its pauses."""

from collections.abc import Iterable, Mapping, Sequence

import msgspec

from lacoc_server.contest.league.draws import Team, drawn_stages, entered_teams
from lacoc_server.contest.league.facts import (
    Announced,
    AnyFact,
    Called,
    Closed,
    Moved,
    OfDecision,
    OfMatch,
    Paused,
    Planned,
    Played,
    Recalled,
    Replaced,
    Resumed,
    Shifted,
    Undrawn,
    Unshifted,
    decisions,
    ordered,
    stage_of,
)
from lacoc_server.contest.league.formats.format import Format, Pair, Stage
from lacoc_server.contest.league.matches import (
    ContestMatch,
    CountedGame,
    StageRules,
    counting,
    is_about,
    resolve,
)
from lacoc_server.contest.league.standings import Table
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, say

TEAMS_LEAST = 2
"""With fewer teams nothing is drawn, so entries do not close by themselves."""
_MINUTE_MS = 60_000


class StageView(msgspec.Struct, frozen=True, kw_only=True):
    """A stage with its matches and tables."""

    plan: Planned
    stage: Stage
    matches: tuple[ContestMatch, ...]
    tables: tuple[Table, ...]
    rounds_to_draw: int
    """How many more rounds are drawn at most; some formats end earlier if the places are clear."""

    @property
    def name(self) -> str:
        """Name of the stage."""
        return self.stage.name

    @property
    def may_draw(self) -> bool:
        """Whether the next round can be drawn: all matches are decided, and a round is left."""
        return self.rounds_to_draw > 0 and all(match.decided for match in self.matches)

    @property
    def over(self) -> bool:
        """Whether nothing is left to play or to draw."""
        return self.rounds_to_draw == 0 and all(match.decided for match in self.matches)

    @property
    def ranking(self) -> tuple[str, ...]:
        """The teams over all groups, the best first: the seeding of a stage that follows.

        First the winners of all groups, then all second places, and so on; at equal rank by points,
        difference, points scored and seeding. Where teams share a rank, the order of the draw says
        who is first in the group. Disqualified teams are left out.
        """
        rows = [
            (place if row.shares else row.rank, row)
            for table in self.tables
            for place, row in enumerate(table.rows, 1)
            if not row.out
        ]
        seeds = {team: place for place, team in enumerate(self.stage.entries)}
        return tuple(
            row.team
            for _, row in sorted(
                rows,
                key=lambda placed: (
                    placed[0],
                    -placed[1].points,
                    placed[1].conceded - placed[1].scored,
                    -placed[1].scored,
                    seeds[placed[1].team],
                ),
            )
        )


class Unused(msgspec.Struct, frozen=True, kw_only=True):
    """A fact that changes nothing, and why."""

    fact: str
    why: Phrase


class Day(msgspec.Struct, frozen=True, kw_only=True):
    """Whether games are called now, or from when."""

    paused: bool
    """True: no game is called until somebody resumes the contest."""
    until_ms: int
    """No game is called before this time, in milliseconds since 1970, UTC; 0: there is no such
    time."""
    reason: str

    def is_held(self, now_ms: int) -> bool:
        """Return whether, at this time, a pause or a shift keeps all games from being called."""
        return self.paused or now_ms < self.until_ms


class Contest(msgspec.Struct, frozen=True, kw_only=True):
    """A contest as its facts make it: teams, stages, matches, tables and pauses."""

    teams: tuple[Team, ...]
    """The teams, in the order in which they entered."""
    closed: bool
    """Whether entries are closed: then a team enters only with a reason."""
    stages: tuple[StageView, ...]
    """The drawn stages, in the order of their draws."""
    planned: tuple[Planned, ...]
    """The plans of stages that are not drawn yet, in the order in which they were first made."""
    with_result: dict[str, frozenset[str]]
    """For each stage with results: the teams that have one, of a game or by a decision. They keep
    their places, and the stage its draw."""
    undrawn: frozenset[str]
    """Names of the planned stages whose draw was taken back."""
    running: tuple[Called, ...]
    """Games that are on a court now."""
    moves: tuple[Moved, ...]
    """The newest move of each match that was moved, in the order in which they were made."""
    decisions: tuple[OfDecision, ...]
    """The facts about what people decided, in their order."""
    day: Day
    shifted: Shifted | None
    """The newest shift (postponement) that was not taken back; None: there is none."""
    announced: Announced | None
    """The organiser's announcement on all pages; None: there is none."""
    ended_ms: dict[str, tuple[str, int]]
    """By team: the pairing of its newest game, and when this game ended, in milliseconds since
    1970, UTC."""
    stages_ended_ms: dict[str, int]
    """By stage: when its newest game ended, in milliseconds since 1970, UTC. A stage without a
    game is left out."""
    unused: tuple[Unused, ...]

    @property
    def here(self) -> int:
        """Number of teams that have not left."""
        return len(_here(self))

    @property
    def matches(self) -> dict[str, ContestMatch]:
        """The matches of all drawn stages, by the ids of their pairings."""
        return {match.pairing.id: match for view in self.stages for match in view.matches}

    @property
    def over(self) -> bool:
        """Whether nothing is left to play or to draw."""
        return bool(self.stages) and not self.planned and all(view.over for view in self.stages)

    def stage(self, name: str) -> StageView:
        """Return a stage.

        Raises:
            KeyError: if no stage of this name was drawn.
        """
        return {view.name: view for view in self.stages}[name]

    def encoded(self) -> bytes:
        """Return the contest as JSON; the same facts give the same bytes."""
        return msgspec.json.encode(self, order="deterministic")


class Changes(msgspec.Struct, frozen=True, kw_only=True):
    """The differences between two contests, for example before and after one more fact."""

    matches: tuple[tuple[ContestMatch | None, ContestMatch | None], ...]
    """Each match whose teams, state or winner differ: as it is in the contest before, and after.
    None: it is not in that contest."""
    ranks: tuple[tuple[str, str, int, int], ...]
    """Each team whose rank in a stage differs: stage, team, rank before and after."""
    leaving: tuple[str, ...]
    """The teams that take part in the contest before, and have left it in the contest after."""


def changes(before: Contest, after: Contest) -> Changes:
    """Compare two contests, such as before and after a decision that is not yet made."""
    was, now = before.matches, after.matches
    old, new = _ranks(before), _ranks(after)
    return Changes(
        matches=tuple(
            (was.get(name), now.get(name))
            for name in {**was, **now}
            if _outcome(was.get(name)) != _outcome(now.get(name))
        ),
        ranks=tuple(
            (*key, old[key], new[key]) for key in old if key in new and old[key] != new[key]
        ),
        leaving=tuple(
            team.name for team in after.teams if team.gone and team.name in _here(before)
        ),
    )


def _here(contest: Contest) -> set[str]:
    return {team.name for team in contest.teams if not team.gone}


def _outcome(match: ContestMatch | None) -> tuple[object, ...]:
    return (match.teams, match.state, match.winner) if match else ()


def _ranks(contest: Contest) -> dict[tuple[str, str], int]:
    return {
        (view.name, row.team): row.rank
        for view in contest.stages
        for table in view.tables
        for row in table.rows
    }


def compute(facts: Iterable[AnyFact], formats: Mapping[str, Format]) -> Contest:
    """Compute a contest from its facts.

    Args:
        facts: in any order; a fact that occurs twice counts once.
        formats: the known formats by name.

    Raises:
        UserError: if two different facts have the same id, or a stage has an unknown format or
            tie-break.
    """
    known = ordered(facts)
    contest = _computed(known, formats)
    if not contest.over:
        return contest
    # What steers the day ends with the contest; a line that was said after the end stays.
    line = contest.announced
    if line is not None and not _computed(known[: known.index(line)], formats).over:
        line = None
    day = Day(paused=False, until_ms=0, reason="")
    return msgspec.structs.replace(contest, day=day, shifted=None, announced=line)


def _computed(known: Sequence[AnyFact], formats: Mapping[str, Format]) -> Contest:
    """Compute a contest from facts in their order; the errors are those of `compute`."""
    unused: dict[str, Phrase] = {}
    teams = entered_teams(known, unused)
    drawn, planned, with_result = drawn_stages(known, teams, formats, unused)
    valid = _of_newest_draws(known, unused)
    by_pairing: dict[str, list[OfMatch]] = {}
    for fact in valid:
        if isinstance(fact, OfMatch):
            by_pairing.setdefault(fact.pairing, []).append(fact)
    shifts = _shifts(known, unused)
    steering = [fact for fact in valid if not isinstance(fact, Shifted) or fact.id in shifts]
    stages = [
        _view(plan, stage, formats[plan.format], teams, by_pairing, is_last=number == len(drawn))
        for number, (plan, stage) in enumerate(drawn, 1)
    ]
    matches = {match.pairing.id: match for view in stages for match in view.matches}
    coming = {plan.stage for plan in planned}
    for pairing, about in by_pairing.items():
        if pairing not in matches:  # it was moved before the draw, which then had fewer teams
            about = [fact for fact in about if not isinstance(fact, Moved)]
        _note_unused(matches.get(pairing), about, unused)
    return Contest(
        teams=tuple(teams.values()),
        closed=any(isinstance(fact, Closed) for fact in known),
        stages=tuple(stages),
        planned=tuple(planned),
        undrawn=frozenset(
            fact.stage
            for fact in known
            if isinstance(fact, Undrawn) and fact.id not in unused and fact.stage in coming
        ),
        with_result=with_result,
        running=_running(valid),
        moves=_moves(steering),
        decisions=decisions(known),
        day=_day(steering),
        shifted=next(reversed(shifts.values()), None),
        announced=_announced(known),
        ended_ms=_ended(known),
        stages_ended_ms=_stages_ended(known),
        unused=tuple(
            Unused(fact=fact.id, why=unused[fact.id]) for fact in known if fact.id in unused
        ),
    )


def _of_newest_draws(facts: Sequence[AnyFact], unused: Mapping[str, Phrase]) -> list[AnyFact]:
    """Return the facts without those about matches of a draw that was taken back afterwards."""
    undrawn = {
        fact.stage: number
        for number, fact in enumerate(facts)
        if isinstance(fact, Undrawn) and fact.id not in unused
    }
    return [
        fact
        for number, fact in enumerate(facts)
        if not isinstance(fact, OfMatch) or number > undrawn.get(stage_of(fact.pairing), -1)
    ]


class Newest:
    """Keeps the newest computed contest, and computes it again only if the facts have changed.

    Args:
        formats: the known formats by name.
    """

    def __init__(self, formats: Mapping[str, Format]) -> None:
        self._formats = formats
        self._facts: tuple[AnyFact, ...] = ()
        self._contest: Contest | None = None

    def of(self, facts: tuple[AnyFact, ...]) -> Contest:
        """Return the contest that follows from facts; the errors are those of `compute`."""
        if self._contest is None or facts != self._facts:
            self._contest = compute(facts, self._formats)
            self._facts = facts
        return self._contest


def next_round(contest: Contest, name: str, formats: Mapping[str, Format]) -> tuple[Pair, ...]:
    """Pair the next round of a stage.

    Raises:
        KeyError: if no stage of this name was drawn.
        UserError: if no round can be drawn now.
    """
    view = contest.stage(name)
    if not view.may_draw:
        raise UserError(say("league.no-round", stage=name))
    gone = {team.name for team in contest.teams if team.gone}
    matches = {match.pairing.id: match for match in view.matches}
    return formats[view.plan.format].next_round(view.stage, matches, gone)


def _view(
    plan: Planned,
    stage: Stage,
    how: Format,
    teams: Mapping[str, Team],
    by_pairing: Mapping[str, Sequence[OfMatch]],
    *,
    is_last: bool,
) -> StageView:
    gone = {team.name for team in teams.values() if team.gone}
    out = {team.name for team in teams.values() if team.disqualified}
    rules = StageRules(
        settings=stage.settings, entries=stage.entries, decisive=how.decisive, balanced=how.balanced
    )
    matches = resolve(how.pairings(stage), by_pairing, gone, rules)
    to_draw = max(0, how.rounds(stage) - len(stage.drawn))
    if to_draw and all(match.decided for match in matches.values()):
        # Once another stage is drawn, a correction opens no earlier stage again.
        to_draw *= is_last and not how.is_decided(stage, matches, gone)
    return StageView(
        plan=plan,
        stage=stage,
        matches=tuple(matches.values()),
        tables=how.tables(stage, matches, out),
        rounds_to_draw=to_draw,
    )


def _note_unused(
    match: ContestMatch | None, about: Sequence[OfMatch], unused: dict[str, Phrase]
) -> None:
    """Note the facts about a match that have no effect on it, each with the reason."""
    used = {game.fact for game in match.games} if match else set()
    teams = (match.teams[0] or "", match.teams[1] or "") if match else ("", "")
    counted, is_void, _ = counting(teams, about)
    for fact in about:
        if match is None:
            unused[fact.id] = say("league.unknown-pairing", pairing=fact.pairing)
        elif not isinstance(fact, Recalled | Moved) and not is_about(fact, teams):
            unused[fact.id] = say("league.other-teams", pairing=fact.pairing)
        elif isinstance(fact, Played | Replaced) and fact.id not in used:
            unused[fact.id] = _why_unused(match, fact, counted.get(fact.game), is_void)


def _why_unused(
    match: ContestMatch, fact: Played | Replaced, counts: CountedGame | None, is_void: bool
) -> Phrase:
    """Say why a result has no effect on its match.

    Args:
        match: the match.
        fact: the result.
        counts: the result of this game that counts; None: there is none.
        is_void: whether a decision has made the match void.
    """
    if is_void:
        return say("league.match-void", pairing=fact.pairing)
    if fact.outcome == "void":
        return say("league.result-void", pairing=fact.pairing, game=fact.game)
    if counts is None:
        return say("league.result-again", pairing=fact.pairing, game=fact.game)
    if counts.fact != fact.id:
        return say("league.result-replaced", pairing=fact.pairing, game=fact.game)
    if match.decided:
        return say("league.result-unneeded", pairing=fact.pairing, game=fact.game)
    return say("league.result-early", pairing=fact.pairing, game=fact.game)


def _running(facts: Sequence[AnyFact]) -> tuple[Called, ...]:
    """Find the games that are on a court: called, and since then neither taken back nor ended."""
    running: dict[str, Called] = {}
    for fact in facts:
        if isinstance(fact, Called):
            running[fact.court] = fact
        elif isinstance(fact, Recalled | Played):
            running = {
                court: call
                for court, call in running.items()
                if (call.pairing, call.game) != (fact.pairing, fact.game)
            }
    return tuple(running[court] for court in sorted(running))


def _shifts(facts: Sequence[AnyFact], unused: dict[str, Phrase]) -> dict[str, Shifted]:
    """Find the shifts that were not taken back, by the ids of their facts, in their order."""
    shifts: dict[str, Shifted] = {}
    for fact in facts:
        if isinstance(fact, Shifted):
            shifts[fact.id] = fact
        elif isinstance(fact, Unshifted) and shifts.pop(fact.shift, None) is None:
            unused[fact.id] = say("league.no-shift")
    return shifts


def _moves(facts: Sequence[AnyFact]) -> tuple[Moved, ...]:
    """Find the newest move of each match to another court or time, or before another match.

    If a match was moved to a time, a shift after that postpones this time too.
    """
    moves: dict[str, Moved] = {}
    for fact in facts:
        if isinstance(fact, Moved):
            moves.pop(fact.pairing, None)
            moves[fact.pairing] = fact
        elif isinstance(fact, Shifted):
            for pairing, move in moves.items():
                if move.not_before_ms > fact.at_ms:
                    later_ms = move.not_before_ms + fact.by_ms
                    moves[pairing] = msgspec.structs.replace(move, not_before_ms=later_ms)
    return tuple(moves.values())


def end_ms(begin_ms: int, length_ms: int) -> int:
    """Return when a pause ends, in milliseconds since 1970, UTC.

    A pause of a minute or more ends at a full minute, because pages show its end without seconds.
    """
    ends_ms = begin_ms + length_ms
    return ends_ms if length_ms < _MINUTE_MS else -(-ends_ms // _MINUTE_MS) * _MINUTE_MS


def _day(facts: Sequence[AnyFact]) -> Day:
    """Return whether games are called, by the newest pause or resumption and all later shifts."""
    day = Day(paused=False, until_ms=0, reason="")
    for fact in facts:
        match fact:
            case Paused():
                day = Day(paused=not fact.until_ms, until_ms=fact.until_ms, reason=fact.reason)
            case Resumed():
                day = Day(paused=False, until_ms=0, reason="")
            case Shifted():
                until_ms = max(day.until_ms, end_ms(fact.at_ms, fact.by_ms))
                day = Day(paused=day.paused, until_ms=until_ms, reason=fact.reason or day.reason)
    return day


def _announced(facts: Sequence[AnyFact]) -> Announced | None:
    newest = next((fact for fact in reversed(facts) if isinstance(fact, Announced)), None)
    return newest if newest is not None and newest.text else None


def _stages_ended(facts: Sequence[AnyFact]) -> dict[str, int]:
    """Return for each stage when its newest game ended, in milliseconds since 1970, UTC."""
    ended: dict[str, int] = {}
    for fact in facts:
        if isinstance(fact, Played):
            stage = stage_of(fact.pairing)
            ended[stage] = max(ended.get(stage, 0), fact.at_ms)
    return ended


def _ended(facts: Sequence[AnyFact]) -> dict[str, tuple[str, int]]:
    """Return for each team its newest game that has ended.

    Each value is the id of the game's pairing, and when it ended, in milliseconds since 1970, UTC.
    """
    ended: dict[str, tuple[str, int]] = {}
    for fact in facts:
        if isinstance(fact, Played):
            for team in fact.teams:
                if fact.at_ms >= ended.get(team, ("", 0))[1]:
                    ended[team] = (fact.pairing, fact.at_ms)
    return ended
