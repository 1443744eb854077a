"""What the organiser asks the desk: to approve, decline, close, draw, take out, rule and move."""

from collections.abc import Iterable, Sequence

from lacoc_server.contest.acts import deciding, organiser
from lacoc_server.contest.desk.book import Book
from lacoc_server.contest.league.facts import AnyFact, Closed, Drawn, Moved, new
from lacoc_shared.messages.desk import (
    Approve,
    Draw,
    Effect,
    Move,
    OpenSeat,
    Rule,
    Said,
    TakeOut,
    TokenList,
)
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, say


def approve(book: Book, asked: Approve) -> Said:
    """Let teams take part, come back while entries are open, or use their late files.

    Raises:
        UserError: if a team has not applied or can't come back, entries are closed, or a reason is
            missing. Teams earlier in the list than this team have been let in then.
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
        done = organiser.enter_weighed(book.where, book.store, team, entry, asked.reason)
        book.applications.drop(team)
        said.append(done)
    return Said(said=tuple(said))


def decline(book: Book, teams: Sequence[str]) -> Said:
    """Turn applications down, and forget that files were refused.

    A team that is already in the contest keeps its token; any other team loses it.

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
    book.secrets.forget(
        *(team for team in teams if team not in inside)
    )  # others may take the names
    return Said(said=tuple(say("desk.declined", team=team) for team in teams))


def new_code(book: Book) -> Said:
    """Make another event code; teams that have applied keep their links.

    Raises:
        UserError: if it can't be written.
    """
    book.code.change()
    return Said(said=(say("desk.new-code", code=book.code.value),))


def close(book: Book) -> Said:
    """Close entries, so that the office draws.

    Raises:
        UserError: if there are fewer than two teams, or entries are closed already.
    """
    organiser.check_teams(book.where, book.contest)
    if book.contest.closed:
        raise UserError(say("desk.closed-already"))
    book.store.append(new(Closed))
    here = sum(not team.gone for team in book.contest.teams)
    return Said(said=(say("desk.closed", teams=here), *organiser.doubts(book.where, book.contest)))


def draw(book: Book, asked: Draw) -> Said:
    """Draw the stage that waits for the organiser.

    Raises:
        UserError: if none waits, or its teams are not those that the page shows.
    """
    shown = new(Drawn, stage=asked.stage, entries=asked.entries)
    return Said(said=(organiser.draw(book.store, shown),))


def take_out(book: Book, asked: TakeOut) -> Effect:
    """Take a team out, or say what that would change.

    Raises:
        UserError: if the team has not entered.
    """
    leaving = organiser.leaving(
        book.contest, asked.team, asked.reason, disqualified=asked.disqualify
    )
    return _decided(book, leaving, asked.really)


def rule(book: Book, asked: Rule) -> Effect:
    """Decide about a match, or say what that would change.

    Raises:
        UserError: if there is no such match, game or team, or something is missing.
    """
    wanted = deciding.Wanted(
        asked.kind, asked.pairing, asked.game, asked.team, asked.scores, asked.reason
    )
    return _decided(book, [deciding.decision(book.contest, wanted)], asked.really)


def move(book: Book, asked: Move) -> Said:
    """Move a match to another court, before another match, or to a later time.

    Raises:
        UserError: if there is no such match or court, if the match is decided, or if the match
            would have to be played before itself.
    """
    match = deciding.match_of(book.contest, asked.pairing)
    if asked.before:
        deciding.match_of(book.contest, asked.before)
    if asked.before == asked.pairing:
        raise UserError(say("desk.before-itself"))
    if match.decided:
        raise UserError(say("desk.match-over", pairing=asked.pairing))
    courts = [*book.where.contest.courts]
    if asked.court and asked.court not in courts:
        raise UserError(say("desk.no-court", court=asked.court, courts=courts))
    where = {"court": asked.court, "before": asked.before, "not_before_ms": asked.not_before_ms}
    book.store.append(new(Moved, pairing=asked.pairing, **where))
    teams = [team or "?" for team in match.teams]
    return Said(said=(say("desk.moved", teams=teams, court=asked.court or None),))


def tokens(book: Book) -> TokenList:
    """Return the tokens of all teams of people that are in or wait, of referees and open seats.

    Raises:
        UserError: if a new token can't be written.
    """
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
    )


def _decided(book: Book, facts: Iterable[AnyFact], really: bool) -> Effect:
    """Say what the given facts would change; append the facts if `really`."""
    more = [*facts]
    lines = deciding.effect(book.facts, more)
    if really:
        book.store.append(*more)
    return Effect(lines=lines, done=really)
