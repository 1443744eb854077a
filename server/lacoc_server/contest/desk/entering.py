"""Carries out what teams ask of the desk: to apply, to hand in files, to see their own entry."""

from dataclasses import replace
from typing import Literal

from msgspec import structs

from lacoc_robots.seat_files import SeatFiles
from lacoc_server.contest.acts.organiser import close_in_time, enter_weighed, team_name
from lacoc_server.contest.desk.book import Book
from lacoc_server.contest.kept.contacts import Contact
from lacoc_server.contest.kept.entries import ContestEntry, HandedIn, hand_in
from lacoc_server.contest.kept.team_picture import small_picture
from lacoc_shared.messages.desk import OwnEntry, TeamFiles
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

APPLICATIONS_MOST = 300
"""How many teams can wait for the organiser's approval at most."""


def handed_in(files: TeamFiles, robot: str) -> HandedIn:
    """Read the files that a team hands in on its page.

    Args:
        files: the files.
        robot: the contest's robot, for a team that brings none.

    Raises:
        UserError: if there is no gait file, the picture can't be read as one, or the contest's
            robot can't be read.
    """
    if files.postures is None and files.locomotion is None:
        raise UserError(say("desk.no-files"))
    picture = None if files.picture is None else small_picture(files.picture)
    handed = hand_in(SeatFiles(files.robot, files.postures, files.locomotion), robot)
    return replace(handed, picture=picture)


def newcomer(book: Book, text: str) -> str:
    """Check whether a new team can apply.

    Return its name in the form in which the contest keeps it. A team can apply after entries are
    closed, too; then the organiser must give a reason to let it in.

    Raises:
        UserError: if the contest is over, the name is wrong or taken, or too many teams wait.
    """
    close_in_time(book.where, book.store)
    team = team_name(text)
    if book.contest.over:
        raise UserError(say("league.closed", team=team))
    if book.is_taken(team):
        raise UserError(say("desk.name-taken", team=team))
    if len(book.applications.waiting) >= APPLICATIONS_MOST:
        raise UserError(say("desk.many-applications", most=APPLICATIONS_MOST))
    return team


def apply(book: Book, team: str, entry: ContestEntry, contact: Contact) -> OwnEntry:
    """Store the weighed entry of a new team, which then waits for the organiser's approval.

    Raises:
        UserError: as `newcomer`, or if the entry can't be written.
    """
    team = newcomer(book, team)  # somebody else may have taken the name while this was weighed
    book.contacts.put(team, contact)
    book.applications.put(team, entry)
    return own(book, team)


def change(book: Book, team: str, entry: ContestEntry) -> OwnEntry:
    """Replace the files of a team by new ones that were weighed in.

    While entries are open, a team in the contest plays with its new files at once. When entries are
    closed, or if the team itself is not approved yet, its files wait for the organiser. A team that
    sends no new picture keeps its old one.

    Raises:
        UserError: if the team has left the contest, or the files can't be written.
    """
    close_in_time(book.where, book.store)
    there = book.team(team)
    if entry.picture is None:
        entry = structs.replace(entry, picture=picture(book, team))
    if there is not None and there.gone:
        raise UserError(say("desk.left", team=team))
    if there is not None and not book.contest.closed:
        enter_weighed(book.where, book.store, team, entry, "")
        book.applications.drop(team)
    elif there is not None and there.files == entry.hash:
        book.applications.drop(team)  # these are the files that it has already
    else:
        book.applications.put(team, entry)
    return own(book, team)


def picture(book: Book, team: str) -> bytes | None:
    """Return the newest picture of a team; None: it has none.

    Raises:
        UserError: if its entry can't be read.
    """
    waiting, there = book.applications.waiting.get(team), book.team(team)
    if waiting is not None:
        return waiting.entry.picture
    if there is None or not there.picture:
        return None
    return book.where.entries.load(there.files).picture


def own(book: Book, team: str) -> OwnEntry:
    """Return the state of a team's entry, for the team's own page.

    Raises:
        UserError: if the facts can't be read, or a new token can't be written.
    """
    there = book.team(team)
    waiting = book.applications.waiting.get(team)
    token = book.secrets.team(team)
    files = waiting.entry.hash if waiting else there.files if there else ""
    state: Literal["waits", "in", "late", "left", "none"] = "waits" if waiting else "none"
    if there is not None:
        state = "left" if there.gone else "late" if waiting else "in"
    return OwnEntry(
        event=book.event,
        team=team,
        token=token,
        state=state,
        files=files,
        at_ms=waiting.at_ms if waiting else 0,
    )
