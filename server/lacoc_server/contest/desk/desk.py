"""The desk: it checks the secret of each request that needs one, and answers the request."""

import threading
import time
from collections.abc import Callable

import msgspec

from lacoc_server.contest.desk import entering, organising, overview, refereeing
from lacoc_server.contest.desk.admission import Admission, Slower
from lacoc_server.contest.desk.book import Book
from lacoc_server.contest.kept.contacts import Contact
from lacoc_server.contest.kept.entries import ContestEntry, weigh
from lacoc_server.contest.kept.publish import publish
from lacoc_server.contest.league.timetable.whereabouts import OfficeKnowledge
from lacoc_shared.messages import Refusal
from lacoc_shared.messages.desk import (
    DESK_MAX_BYTES,
    Announce,
    Answer,
    AnyRequest,
    Apply,
    Approve,
    ChangeFiles,
    CloseEntries,
    CourtDay,
    Decline,
    Draw,
    LookAtEvent,
    Move,
    NewCode,
    OfStaff,
    Overview,
    Overviewed,
    Own,
    PauseContest,
    Publish,
    ResumeContest,
    Rule,
    Said,
    SeePicture,
    Shift,
    Staff,
    Substitute,
    TakeOut,
    TeamFiles,
    TeamPicture,
    Tokens,
    Undraw,
    Unshift,
)
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.words import say

_WEIGHED_AT_ONCE = 2
"""How many entries are weighed in at the same time at most; further ones wait."""
_requests: msgspec.msgpack.Decoder[AnyRequest] = msgspec.msgpack.Decoder(AnyRequest)


class Desk:
    """Answers requests; any thread may ask.

    Args:
        book: the contest.
        organiser: the organiser's key.
        known: returns what the office knows besides the facts.
    """

    def __init__(self, book: Book, organiser: str, known: Callable[[], OfficeKnowledge]) -> None:
        secrets = book.secrets
        self.admission = Admission(
            organiser, secrets.staff_of, lambda: book.code.value, secrets.team_of
        )
        self._book = book
        self._known = known
        self._games = book.where.games
        self._one = threading.Lock()
        """Lock of the contest's data; a thread does not hold it while it weighs files in."""
        self._publishing = threading.Lock()
        """Lock that a thread holds while it writes the published folder."""
        self._scales = threading.Semaphore(_WEIGHED_AT_ONCE)

    def judge(self, payload: bytes) -> Answer | Refusal:
        """Answer an encoded request, or refuse it.

        Args:
            payload: should be an encoded `AnyRequest`; other bytes are refused.
        """
        try:
            return self.answer(read(payload))
        except FileRefused as error:
            mistakes = tuple(error.mistakes)
            return Refusal(say("refused.mistakes", count=len(mistakes), first=None), mistakes)
        except UserError as error:
            return Refusal(error.phrase, again=isinstance(error, Slower))

    def answer(self, asked: AnyRequest) -> Answer:
        """Answer a request.

        Raises:
            FileRefused: with every mistake of every file that was handed in.
            UserError: if the secret is wrong, or the request can't be done.
        """
        now_s = time.monotonic()
        if isinstance(asked, LookAtEvent):
            with self._one:
                return self._book.event
        if isinstance(asked, Apply):
            self.admission.applicant(asked.secret, now_s)
            return self._apply(asked)
        if isinstance(asked, ChangeFiles | Own):
            team = self.admission.team(asked.secret, now_s)
            entry = None if isinstance(asked, Own) else self._weighed(team, asked.files)
            with self._one:
                self.admission.team(asked.secret, now_s)  # it may have been declined meanwhile
                if entry is None:
                    return entering.own(self._book, team)
                return entering.change(self._book, team, entry)
        if isinstance(asked, CourtDay):
            there = asked.court in self._book.where.contest.courts
            token = self._book.secrets.referee(asked.court) if there else None
            self.admission.referee(asked.secret, token, now_s)
            with self._one:
                return refereeing.plan(self._book, self._known(), asked)
        by = self.admission.organiser(asked.secret, now_s)
        if isinstance(asked, Publish):
            return self._publish()
        with self._one, self._book.store.decided_by(by):
            return self._organise(asked, by)

    def _organise(self, asked: OfStaff, by: str) -> Answer:
        book = self._book
        match asked:
            case Overview():
                made = overview.view(book, self._known(), by)
                return Overviewed(view=None if made.version == asked.known else made)
            case Approve():
                return organising.approve(book, asked)
            case Decline():
                return organising.decline(book, asked.teams)
            case NewCode():
                return organising.new_code(book)
            case CloseEntries():
                return organising.close(book)
            case Draw():
                return organising.draw(book, asked)
            case Undraw():
                return organising.undraw(book, asked)
            case Substitute():
                return organising.substitute(book, asked)
            case TakeOut():
                return organising.take_out(book, asked)
            case SeePicture(remove=False):
                return TeamPicture(webp=entering.picture(book, asked.team) or b"")
            case SeePicture():
                return organising.remove_picture(book, asked.team)
            case Rule():
                return organising.rule(book, asked)
            case Move() | PauseContest() | ResumeContest() | Shift() | Unshift() | Announce():
                return organising.steer(book, asked, time.time_ns() // 1_000_000)
            case Staff():
                if by:
                    raise UserError(say("desk.not-organiser"))
                return organising.staff(book, asked)
            case Tokens():
                return organising.tokens(book, by)

    def _publish(self) -> Said:
        """Write the contest to its published folder. Other requests are answered meanwhile.

        Raises:
            UserError: if the contest still holds records back, a record or an entry is missing, or
                something can't be written.
        """
        replays, folder = self._book.where.contest.replays, self._book.where.published
        with self._publishing:
            with self._one:
                facts, contest = self._book.facts, self._book.contest
            if replays != "at-once" and not contest.over:  # everybody can read the folder
                raise UserError(say("desk.holds-back", replays=replays))
            publish(self._book.where, facts, folder)
        return Said(said=(say("desk.published", folder=str(folder)),))

    def _apply(self, asked: Apply) -> Answer:
        with self._one:
            team = entering.newcomer(self._book, asked.team)
        entry = self._weighed(team, asked.files)
        with self._one:
            contact = Contact(asked.contact.strip(), asked.club.strip())
            return entering.apply(self._book, team, entry, contact)

    def _weighed(self, team: str, files: TeamFiles) -> ContestEntry:
        """Weigh in a team's files; return the entry.

        Note any mistakes in the files for the organiser.
        """
        contest = self._book.where.contest
        try:
            with self._scales:  # reading a workbook takes a while, too
                handed = entering.handed_in(files, contest.robot)
                entry = weigh(handed, self._games, contest.limits)
        except FileRefused as error:
            with self._one:
                self._book.note_refused(team, tuple(error.mistakes))
            raise
        with self._one:
            self._book.note_refused(team, ())
        return entry


def read(payload: bytes) -> AnyRequest:
    """Decode a request.

    Raises:
        UserError: if the bytes are no request, or are too long.
    """
    try:
        if len(payload) > DESK_MAX_BYTES:
            raise msgspec.DecodeError(f"{len(payload)} bytes, at most {DESK_MAX_BYTES} are read")
        return _requests.decode(payload)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise UserError(say("desk.bad-request", error=str(error)[:200])) from None
