"""Carries out what the organiser and the staff ask of the desk; `acts` has the functions."""

from collections.abc import Callable, Iterable, Sequence

import msgspec

from lacoc_server.contest.acts import deciding, organiser, steering
from lacoc_server.contest.desk.book import Book
from lacoc_server.contest.kept.contacts import Contact
from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.facts import AnyFact, Closed, Drawn, new
from lacoc_server.contest.league.timetable.steered import steered
from lacoc_shared.messages.desk import (
    Announce,
    Approve,
    Draw,
    Effect,
    Move,
    OpenSeat,
    PauseContest,
    ResumeContest,
    Rule,
    Said,
    Shift,
    Staff,
    Substitute,
    TakeOut,
    TokenList,
    Undraw,
    Unshift,
)
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, render, say


def approve(book: Book, asked: Approve) -> Said:
    """Approve teams: they may enter, come back after leaving, or use files that they sent late.

    Raises:
        UserError: if a team has neither applied nor taken part before, if it can't come back, or if
            a reason is missing. The teams before that team in the list stay approved.
    """
    said: list[Phrase] = []
    for team in asked.teams:
        waiting, there = book.applications.waiting.get(team), book.team(team)
        if waiting is not None:
            entry = waiting.entry
        elif there is not None and there.gone:  # it comes back with the files that it had
            entry = book.where.entries.load(there.files)
        else:
            raise UserError(say("desk.no-application", team=team))
        club = book.contacts.of(team).club if there is None else None
        done = organiser.enter_weighed(book.where, book.store, team, entry, asked.reason, club)
        book.applications.drop(team)
        said.append(done)
    return Said(said=tuple(said))


def decline(book: Book, teams: Sequence[str]) -> Said:
    """Turn down what teams have handed in, and forget the mistakes in files that were refused.

    A team that is already in the contest keeps its token and contact; those of any other team are
    forgotten, and others may take its name.

    Raises:
        UserError: if a team has neither waiting nor refused files. Then no team is declined.
    """
    for team in teams:
        if team not in book.applications.waiting and team not in book.refused:
            raise UserError(say("desk.no-application", team=team))
    book.applications.drop(*teams)
    for team in teams:
        book.note_refused(team, ())
    inside = {team.name for team in book.contest.teams}
    outside = [team for team in teams if team not in inside]
    book.secrets.forget(*outside)
    for team in outside:
        book.contacts.put(team, Contact())
    return Said(said=tuple(say("desk.declined", team=team) for team in teams))


def new_code(book: Book) -> Said:
    """Replace the event code by a new one; the links of teams that have applied stay valid.

    Raises:
        UserError: if it can't be written.
    """
    book.code.change()
    return Said(said=(say("desk.new-code", code=book.code.value),))


def close(book: Book) -> Said:
    """Close entries; the office can then draw the first stage.

    Raises:
        UserError: if there are fewer than two teams, or entries are closed already.
    """
    organiser.check_teams(book.where, book.contest)
    if book.contest.closed:
        raise UserError(say("desk.closed-already"))
    book.store.append(new(Closed))
    here = book.contest.here
    return Said(said=(say("desk.closed", teams=here), *organiser.doubts(book.where, book.contest)))


def draw(book: Book, asked: Draw) -> Said:
    """Draw the stage that waits for the organiser; errors as `organiser.draw`."""
    given = {"how": asked.how, "lot": asked.lot, "reason": asked.reason}
    shown = new(Drawn, stage=asked.stage, entries=asked.entries, **given)
    return Said(said=(organiser.draw(book.store, shown),))


def take_out(book: Book, asked: TakeOut) -> Effect:
    """Take a team out of the contest; if the request only asks, say what that would change.

    Raises:
        UserError: if the team has not entered.
    """
    team, reason, expels = asked.team, asked.reason, asked.disqualify
    return _decided(
        book,
        lambda contest: organiser.leaving(contest, team, reason, disqualified=expels),
        asked.really,
    )


def remove_picture(book: Book, team: str) -> Said:
    """Remove a team's picture from its files that wait, and from those with which it plays.

    Raises:
        UserError: if the files can't be read or written.
    """
    waiting, there = book.applications.waiting.get(team), book.team(team)
    said = say("desk.picture-removed", team=team)
    if waiting is not None:
        entry = msgspec.structs.replace(waiting.entry, picture=None)
        book.applications.put(team, entry, waiting.at_ms)
    if there is not None and there.picture and not there.gone:
        entry = msgspec.structs.replace(book.where.entries.load(there.files), picture=None)
        organiser.enter_weighed(book.where, book.store, team, entry, render(said))
    return Said(said=(said,))


def rule(book: Book, asked: Rule) -> Effect:
    """Decide about a match for the organiser; if the request only asks, say what would change.

    Raises:
        UserError: if there is no such match, game or team, or the reason or the points are missing.
    """
    wanted = deciding.WantedDecision(
        asked.kind, asked.pairing, asked.game, asked.team, asked.scores, asked.reason
    )
    return _decided(book, lambda contest: [deciding.decision(contest, wanted)], asked.really)


def undraw(book: Book, asked: Undraw) -> Effect:
    """Take the draw of a stage back; if the request only asks, say what that would change.

    The errors are those of `steering.undrawing`.
    """
    return _decided(
        book,
        lambda contest: steering.undrawing(contest, asked.stage, asked.reason),
        asked.really,
    )


def substitute(book: Book, asked: Substitute) -> Effect:
    """Give a team's place to a substitute; if the request only asks, say what that would change.

    The errors are those of `steering.substituting`.
    """
    teams, reason = (asked.team, asked.substitute), asked.reason
    return _decided(
        book, lambda contest: [steering.substituting(contest, *teams, reason)], asked.really
    )


def steer(
    book: Book,
    asked: Move | PauseContest | ResumeContest | Shift | Unshift | Announce,
    now_ms: int,
) -> Said:
    """Append a fact of `acts.steering`, with the same errors; say what was done.

    A request moves a match, pauses or resumes the contest, makes or undoes a shift, or shows a line
    to all.
    """

    def act(contest: Contest) -> AnyFact:
        match asked:
            case Move():
                courts = book.where.contest.courts
                where = (asked.court, asked.before, asked.not_before_ms, now_ms)
                return steering.moving(contest, courts, asked.pairing, *where)
            case PauseContest():
                return steering.pausing(contest, asked.until_ms, asked.reason, now_ms)
            case ResumeContest():
                return steering.resuming(contest, now_ms)
            case Shift():
                return steering.shifting(asked.by_ms, asked.reason)
            case Unshift():
                return steering.unshifting(contest, asked.shift)
            case Announce():
                return steering.announcing(asked.text)

    before = book.contest
    book.store.decide(lambda facts: [act(book.contest_of(facts))])
    return Said(said=(steered(before, act(before)),))


def staff(book: Book, asked: Staff) -> Said:
    """Add a member of staff, who gets a link of their own, or remove one.

    Raises:
        UserError: if the name has no visible character or is too long, or if the file of secrets
            can't be written.
    """
    name = organiser.team_name(asked.name)
    if asked.remove:
        book.secrets.forget_staff(name)
        return Said(said=(say("desk.staff-removed", name=name),))
    book.secrets.staff(name)
    return Said(said=(say("desk.staff-added", name=name),))


def tokens(book: Book, by: str) -> TokenList:
    """Return the tokens of referees, of open seats, and of all teams that people play for.

    These are teams in the contest, and teams that wait for the organiser's approval.

    Args:
        book: the contest.
        by: who asks; only the organiser ("") gets the tokens of the staff.

    Raises:
        UserError: if a token is missing, and a new one can't be written.
    """
    staff = () if by else book.secrets.staff_names
    people = [team.name for team in book.contest.teams if not (team.bot or team.gone)]
    waiting = [team for team in book.applications.waiting if team not in people]
    stage, courts = book.where.open_stage, book.where.contest.courts
    return TokenList(
        teams={team: book.secrets.team(team) for team in (*people, *waiting)},
        referees={name: book.secrets.referee(name) for name in courts},
        seats=tuple(
            OpenSeat(court=court, seat=seat, token=book.secrets.seat(court, seat))
            for court in courts
            for seat in (stage.seats if stage is not None else ())
        ),
        staff={name: book.secrets.staff(name) for name in staff},
        contacts={team: book.contacts.of(team).reach for team in (*people, *waiting)},
    )


def _decided(book: Book, act: Callable[[Contest], Iterable[AnyFact]], really: bool) -> Effect:
    """Say what new facts would change; append them if `really`.

    Args:
        book: the contest.
        act: takes the contest as it is now, and returns the facts to append.
        really: True: append the facts. False: only say what they would change.
    """
    lines = deciding.effect(book.facts, act(book.contest))
    if really:
        book.store.decide(lambda facts: act(book.contest_of(facts)))
    return Effect(lines=lines, done=really)
