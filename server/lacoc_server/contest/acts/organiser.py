"""What an organiser does with a contest: enter teams, take them out, draw, play without courts."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, suppress
from datetime import UTC, datetime
from pathlib import Path

import msgspec

from lacoc_server.contest.acts.deciding import team_of
from lacoc_server.contest.headless.play import GameEngine, play_contest
from lacoc_server.contest.kept import publish
from lacoc_server.contest.kept.applications import Applications
from lacoc_server.contest.kept.entries import ContestEntry, HandedIn, gather_entry, weigh
from lacoc_server.contest.kept.folder import ContestFolder, RunsAlready
from lacoc_server.contest.kept.plans import check_drawn, game, note_plans
from lacoc_server.contest.kept.sheet_writer import Progress, SheetWriter
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league import sheet as sheets
from lacoc_server.contest.league.contest import TEAMS_LEAST, Contest, compute
from lacoc_server.contest.league.draws import by_lot
from lacoc_server.contest.league.facts import (
    AnyFact,
    Closed,
    Disqualified,
    Drawn,
    Entered,
    EntriesOpened,
    FilesChanged,
    Withdrawn,
    new,
)
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.sheet import ContestSheet
from lacoc_server.contest.league.timetable.schedule import waits_for_organiser
from lacoc_server.contest.league.titles import title
from lacoc_shared.contest.names import look_alike, read_name
from lacoc_shared.messages.desk import TEAM_NAME_MAX
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, say


def enter(
    file: Path,
    team: str,
    folder: Path | None,
    bot: str,
    reason: str,
    found: Callable[[HandedIn], None] = lambda _: None,
    *,
    club: str | None = None,
    by: str = "",
) -> Phrase:
    """Enter a team, or change the files or the club of one that has entered; say what was done.

    Args:
        file: the contest file.
        team: name of the team.
        folder: folder with its files; None: the contest's robot with its sample gait.
        bot: the bot that plays for it; "": people play.
        reason: why the team enters, or its files change; needed once entries are closed.
        found: called with the team's files before they are weighed in.
        club: its school or club; "": none; None: as before, or none.
        by: who of the staff decides; "": the organiser.

    Raises:
        FileRefused: with every mistake of every file.
        UserError: if the team can't enter, or a file can't be read.
    """
    team = team_name(team)
    where = ContestFolder(file)
    handed = gather_entry(folder, bot, where.contest.robot)
    found(handed)
    entry = weigh(handed, where.games, where.contest.limits)
    with FactStore(where.facts, by) as store:
        return enter_weighed(where, store, team, entry, reason, club)


def team_name(text: str) -> str:
    """Return a team's name in the form in which the contest keeps it.

    Raises:
        UserError: if the name has no visible character, is too long, or has characters that can't
            be printed.
    """
    team = read_name(text, TEAM_NAME_MAX)
    if team is None:
        raise UserError(say("contest.team-name", most=TEAM_NAME_MAX))
    return team


def enter_weighed(
    where: ContestFolder,
    store: FactStore,
    team: str,
    entry: ContestEntry,
    reason: str,
    club: str | None = None,
) -> Phrase:
    """Enter a team with a weighed entry, or change the files or the club of one that has entered.

    Say what was done.

    Args:
        where: the contest.
        store: its facts.
        team: name of the team, from `team_name`.
        entry: its files and its bot.
        reason: why the team enters, or its files change; needed once entries are closed.
        club: its school or club; "": none; None: as before, or none.

    Raises:
        UserError: if the team can't enter, or the files can't be written.
    """
    close_in_time(where, store)
    said = say("contest.entered-same", team=team)

    def decision(facts: tuple[AnyFact, ...]) -> Iterator[AnyFact]:
        nonlocal said
        contest = compute(facts, FORMATS)
        known = {one.name: one for one in contest.teams}
        there = known.get(team)
        late = reason.strip()
        may_come = bool(late) or not contest.closed
        if there is not None and there.gone and (contest.closed or not there.may_return):
            raise UserError(say("contest.gone-for-good", team=team))
        same_files = there is not None and there.files == entry.hash
        other_club = there is not None and club not in (None, there.club)
        if there is not None and not there.gone and same_files and not other_club:
            return
        alike = next((name for name in known if look_alike(name, team)), None)
        if team not in known and alike is not None:
            raise UserError(say("contest.name-alike", team=team, there=alike))
        if not may_come and team in known:
            raise UserError(say("contest.needs-reason", team=team))
        if not may_come:
            raise UserError(say("contest.late-reason", team=team))
        files = where.entries.save(entry)
        used = {"team": team, "files": files, "bot": entry.bot, "picture": bool(entry.picture)}
        if there is not None and there.gone:
            said = say("contest.entered-back", team=team, hash=files)
            yield new(Entered, **used, club=there.club if club is None else club, reason=late)
        elif there is not None:
            said = say("contest.entered-again", team=team, hash=files)
            if same_files:
                said = say("contest.entered-club", team=team, club=club or None)
            yield new(FilesChanged, **used, club=club if other_club else None, reason=reason)
        else:
            said = say("contest.entered", team=team, hash=files)
            yield new(Entered, **used, club=club or "", reason=late)

    store.decide(decision)
    return said


def take_out(file: Path, team: str, reason: str, *, disqualified: bool, by: str = "") -> Phrase:
    """Take a team out of a contest; say what was done.

    Args:
        file: the contest file.
        team: name of the team.
        reason: why; it is public.
        disqualified: True: the team is ranked last.
        by: who of the staff decides; "": the organiser.

    Raises:
        UserError: if the team has not entered.
    """
    with FactStore(ContestFolder(file).facts, by) as store:
        team = team_of(compute(store.facts(), FORMATS), team).name
        store.decide(
            lambda facts: leaving(compute(facts, FORMATS), team, reason, disqualified=disqualified)
        )
    return say("contest.left", team=team)


def leaving(contest: Contest, team: str, reason: str, *, disqualified: bool) -> list[AnyFact]:
    """Return the facts that take a team out of a contest; no fact if it has left already.

    A team that has withdrawn can still be disqualified.

    `team`, `reason`, `disqualified` and the error are as in `take_out`.
    """
    there = team_of(contest, team)
    if disqualified and not there.disqualified:
        return [new(Disqualified, team=there.name, reason=reason)]
    return [] if there.gone else [new(Withdrawn, team=there.name, reason=reason)]


def drawing(contest: Contest) -> Drawn:
    """Return the draw that waits for the organiser.

    Raises:
        UserError: if no draw waits for the organiser.
    """
    draw = waits_for_organiser(contest, FORMATS)
    if draw is None:
        raise UserError(say("contest.nothing-to-draw"))
    return draw


def draw(store: FactStore, shown: Drawn) -> Phrase:
    """Draw the stage that waits for the organiser; say what was done.

    Args:
        store: the facts.
        shown: the draw as the organiser's page showed it, or the same teams in an order made by
            hand. If a lot decides, the order follows from the lot.

    Raises:
        UserError: if no draw waits or a different one does, or if the reason or the lot is missing;
            nothing is drawn then.
    """

    def decision(facts: tuple[AnyFact, ...]) -> list[AnyFact]:
        contest = compute(facts, FORMATS)
        made = drawing(contest)
        order = sorted if shown.how else tuple
        if (made.stage, order(made.entries)) != (shown.stage, order(shown.entries)):
            raise UserError(say("contest.other-draw", stage=title(contest, made.stage)))
        if shown.how == "hand" and not shown.reason.strip():
            raise UserError(say("decide.needs-reason"))
        if shown.how == "lot":
            if not shown.lot.strip():
                raise UserError(say("contest.needs-lot"))
            return [msgspec.structs.replace(shown, entries=by_lot(made.entries, shown.lot))]
        return [shown]

    store.decide(decision)
    stage = title(compute(store.facts(), FORMATS), shown.stage)
    return say("contest.drawn", stage=stage, teams=len(shown.entries))


def tokens(file: Path, team: str | None) -> dict[str, str]:
    """Return the tokens of teams, by team; make the tokens that do not exist yet.

    Args:
        file: the contest file.
        team: name of a team; None: all teams in the contest that are not bots.

    Raises:
        UserError: if there is no such team, if no team has people (for None), or if a token can't
            be written.
    """
    where = ContestFolder(file)
    with FactStore(where.facts) as store:
        contest = compute(store.facts(), FORMATS)
    wanted = [one for one in contest.teams if not (one.gone or one.bot)]
    if team is not None:
        wanted = [team_of(contest, team)]
    if not wanted:
        raise UserError(say("contest.no-people"))
    return {one.name: where.contest.secrets.team(one.name) for one in wanted}


def play_headless(
    file: Path,
    steer: str,
    engine: AbstractContextManager[GameEngine],
    progress: Progress,
    tell: Callable[[Phrase], None] = lambda _: None,
) -> tuple[ContestSheet, int]:
    """Play a contest to its end without a network.

    Args:
        file: the contest file.
        steer: the bot that steers teams without a bot.
        engine: plays the games; it is opened and closed here.
        progress: called with the numbers of decided and of all matches, after each change.
        tell: called for each team whose bot pressed keys that its gait does not have.

    Returns:
        The contest's sheet after its last game, and how many games this call played.

    Raises:
        UserError: if the contest runs already, has no stage or too few teams, if a game has no time
            limit, or if a game can't be played or written.
    """
    where = ContestFolder(file)
    with where.alone(), FactStore(where.facts) as store:
        prepare(where, store, headless=True)
        for plan in where.plans:
            if not game(plan, where.folder).match.duration_s:
                raise UserError(say("contest.no-end", stage=plan.stage))
        writer = SheetWriter(where, progress)
        with engine as opened:
            played = play_contest(where, store, opened, steer, writer, tell)
        return writer.write(), played


def renew_sheet(file: Path) -> None:
    """Write the sheet that pages and films read, if there is one and no office writes it.

    An office writes each change itself; after its end, decisions can still be made.

    Raises:
        UserError: if the sheet can't be written.
    """
    where = ContestFolder(file)
    if not where.sheet.exists():
        return
    with suppress(RunsAlready), where.alone(), FactStore(where.facts) as store:
        writer = SheetWriter(where, lambda _done, _all: None)
        writer(compute(store.facts(), FORMATS))


def sheet(file: Path) -> ContestSheet:
    """Return the sheet of a contest as it is now."""
    where = ContestFolder(file)
    with FactStore(where.facts) as store:
        return sheets.sheet_of(where.contest.name, store.facts(), FORMATS)


def waiting(file: Path) -> list[str]:
    """Return the teams whose entries wait for the organiser, the oldest first.

    Raises:
        UserError: if the entries that wait can't be read.
    """
    path = ContestFolder(file).applications
    if not path.exists():  # nobody entered by page; reading makes no file
        return []
    with Applications(path) as applications:
        return [*applications.waiting]


def publish_to(file: Path, folder: Path) -> None:
    """Write all that is public of a contest into a folder; `publish.publish` lists the errors."""
    where = ContestFolder(file)
    with FactStore(where.facts) as store:
        publish.publish(where, store.facts(), folder)


def prepare(
    where: ContestFolder, store: FactStore, *, entering: bool = False, headless: bool = False
) -> None:
    """Append the stages of the contest file to the facts; check that the contest can be played.

    Args:
        where: the contest.
        store: its facts.
        entering: whether teams may still enter.
        headless: whether there are no courts; then a file with only an open stage has no stage.

    Raises:
        UserError: if the file has no stage, if it has changed a stage that is drawn already, or if
            there are too few teams.
    """
    if not where.plans and (headless or where.open_stage is None):
        raise UserError(say("contest.no-stages", file=str(where.file)))
    note_plans(store, where.plans)
    contest = compute(store.facts(), FORMATS)
    if where.plans and not (entering and not contest.closed):
        check_teams(where, contest)


def doubts(where: ContestFolder, contest: Contest) -> list[Phrase]:
    """Return warnings about plans of stages that are legal, but hardly fit the number of teams.

    Up to now there is one: a Swiss stage with more rounds than a team has opponents, so teams meet
    again.
    """
    here = contest.here
    found: list[Phrase] = []
    for plan in where.plans:
        teams = min(plan.teams, here) if plan.teams else here
        most = teams - 1 + teams % 2
        if plan.format == "swiss" and teams > 1 and plan.settings.rounds > most:
            rounds = plan.settings.rounds
            found.append(
                say("contest.many-rounds", stage=plan.stage, rounds=rounds, teams=teams, most=most)
            )
    return found


def doubts_of(file: Path) -> list[Phrase]:
    """Return the warnings of `doubts` for the contest file and the facts beside it.

    Raises:
        UserError: if the file has changed a stage that is drawn already.
    """
    where = ContestFolder(file)
    with FactStore(where.facts) as store:
        contest = compute(store.facts(), FORMATS)
    check_drawn(contest, where.plans)
    return doubts(where, contest)


def check_teams(where: ContestFolder, contest: Contest) -> None:
    """Check that there are enough teams for a draw.

    Raises:
        UserError: if there are fewer than two, and nothing is drawn yet.
    """
    if contest.here < TEAMS_LEAST and not contest.stages:
        raise UserError(say("contest.few-teams", teams=contest.here, file=str(where.file)))


def keep_open(store: FactStore, entering: bool) -> bool:
    """Return whether teams may enter until the organiser closes entries.

    A fact keeps this. So entries stay open after a restart, and at another machine.

    Args:
        store: the facts.
        entering: whether the organiser wants that now.

    Raises:
        UserError: if the fact can't be written.
    """

    def opening(facts: Sequence[AnyFact]) -> list[AnyFact]:
        known = any(isinstance(fact, EntriesOpened | Closed) for fact in facts)
        return [] if known or not entering else [new(EntriesOpened)]

    store.decide(opening)
    return entering or any(isinstance(fact, EntriesOpened) for fact in store.facts())


def close_in_time(where: ContestFolder, store: FactStore) -> None:
    """Close entries if the contest file names a time for it, and that time has passed.

    They stay open while there are too few teams to play.

    Raises:
        UserError: if the fact can't be written.
    """

    def closing(facts: Sequence[AnyFact]) -> list[AnyFact]:
        contest = compute(facts, FORMATS)
        return [] if contest.closed or contest.here < TEAMS_LEAST else [new(Closed)]

    end = where.contest.entries_close
    if end is not None and end.astimezone(UTC) <= datetime.now(UTC):
        store.decide(closing)
