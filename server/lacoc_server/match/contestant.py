"""Contestants' requests to a match (join, ready, leave, keys), and their silence.

Some requests are legal only in some phases (rules 3 and 4). A refusal says why. A refused request
changes nothing, except that frames show the newest refused key.
"""

from typing import Any

from lacoc_server.match.entry import weigh_in
from lacoc_server.match.seat import Seat
from lacoc_server.match.state import MatchState
from lacoc_shared.gait.tables import Level
from lacoc_shared.inputs import JoinSeat, KeySeat
from lacoc_shared.messages import Done, Refusal
from lacoc_shared.mistakes import FileRefused
from lacoc_shared.seat import BEATS_PER_S, RESTART_KEY, WHY_NO, No, Phase
from lacoc_shared.words import Phrase, say

_BEFORE = frozenset({Phase.LOBBY, Phase.READY})


def join(match: MatchState, item: JoinSeat) -> Done | Refusal:
    """Give a seat to a contestant who asks for it, or let its contestant come back.

    From the countdown on, a seat keeps its files for this match, and new files wait for the next
    match. From then on, nobody gets an empty seat until the match is official or void.
    """
    seat = match.seats[item.seat]
    if not _is_assigned(match, seat, item):
        return Refusal(say("refused.other-match", seat=seat.id), again=True)
    if match.phase in _BEFORE:
        return _sit_down(match, seat, item)
    if seat.join is None and match.has_begun:
        return Refusal(say("refused.match-on-join", phase=match.phase.word), again=True)
    seat.left = False
    seat.coming = item
    if seat.join is None:
        return Done(say("note.next-match"))
    match.tell("join", say("event.back", team=seat.team), seat=seat.index)
    if _files(seat.join) == _files(item):
        return Done()
    return Done(say("note.files-next-match"))


def _is_assigned(match: MatchState, seat: Seat, item: JoinSeat) -> bool:
    """Return whether a team may have a seat with the files that it sent.

    An open seat is free for anybody, with any files.
    """
    if match.assigned is None:
        return True
    found = match.assigned.seat(seat.id)
    if found is None or not found.team:
        return found is not None
    return (found.team, found.files) == (item.team, _files(item))


def _sit_down(match: MatchState, seat: Seat, item: JoinSeat) -> Done | Refusal:
    files = (item.robot, item.postures, item.locomotion)
    try:
        entry = weigh_in(*files, match.limits, match.rules.open_levels)
    except FileRefused as refused:
        mistakes = tuple(refused.mistakes)
        return Refusal(say("refused.mistakes", count=len(mistakes), first=None), mistakes)
    if seat.join is None or _files(seat.join) != _files(item):
        seat.ready = False
        match.back_to_lobby()  # even if everybody says ready again in this beat
    seat.join, seat.entry, seat.silent = item, entry, False
    match.sheet_changed()
    said = say("event.joined", team=item.team, seat=seat.id, robot=entry.robot.name)
    match.tell("join", said, seat=seat.index)
    return Done(say("plain.sentences", sentences=entry.notes) if entry.notes else None)


def ready(match: MatchState, seat: Seat, is_ready: bool) -> Done | Refusal:
    """Mark a seat as ready, or take that back; refuse it after READY or if nobody has the seat."""
    if match.phase not in _BEFORE:
        return Refusal(say("refused.match-on", phase=match.phase.word))
    if seat.join is None:
        return Refusal(say("refused.nobody-joined", seat=seat.id))
    if seat.ready != is_ready:
        seat.ready = is_ready
        team = seat.team
        said = say("event.team-ready", team=team)
        if not is_ready:
            said = say("event.team-not-ready", team=team)
        match.tell("ready", said, seat=seat.index, ready=is_ready)
    return Done()


def leave(match: MatchState, seat: Seat) -> Done:
    """Let a contestant leave: free the seat in LOBBY or READY; later, let the seat's robot stand.

    In a later phase the contestant keeps the seat for this match. The next match begins without
    them, unless they come back.
    """
    if match.phase in _BEFORE:
        said = say("event.left-seat", team=seat.team, seat=seat.id)
        match.tell("leave", said, seat=seat.index)
        seat.join = seat.entry = None
        seat.ready = seat.silent = False
        match.sheet_changed()
        return Done()
    match.tell("leave", say("event.left-match", team=seat.team), seat=seat.index)
    seat.silent = seat.left = True
    seat.stand()
    return Done(say("note.seat-stays"))


def unattended(match: MatchState) -> Phrase | None:
    """Say why a match without a referee ends because nobody is there; None: it goes on."""
    if all(seat.left for seat in match.seats):
        return say("over.everybody-left")
    limit = round(match.rules.unattended_s * BEATS_PER_S)
    if 0 < limit <= match.silent_beats:
        return say("over.nobody-heard", minutes=match.rules.unattended_s / 60)
    return None


def silent(match: MatchState, seat: Seat) -> Done:
    """Mark a seat as silent and let its robot stand (rules 3)."""
    if not seat.silent:
        seat.silent = True
        seat.stand()
        match.tell("silent", say("event.silent", team=seat.team), seat=seat.index)
    return Done()


def heard(match: MatchState, seat: Seat) -> Done:
    """Mark a seat as heard again; its robot stands until a new command."""
    if seat.silent:
        seat.silent = False
        match.tell("heard", say("event.heard", team=seat.team), seat=seat.index)
    return Done()


def key(match: MatchState, seat: Seat, item: KeySeat) -> Done | Refusal:
    """Apply a digit or [x] to its seat, or refuse it.

    Frames show the seat's newest applied and its newest refused command. After an [x] the seat's
    keys are refused for `restart_freeze_s` of play.
    """
    why = No.NOT_PLAYING
    if match.phase is Phase.PLAYING:
        why = seat.why_not(item, match.ticks, match.rules.open_levels)
    if why is not No.NONE:
        seat.refused = (item.seq, why)
        return Refusal(WHY_NO[why])
    # A beat takes each seat's [x] first (rules 3), so a digit may follow an [x] of a higher number.
    seat.applied = (max(item.seq, seat.applied[0]), match.beats)
    if item.key == RESTART_KEY:
        seat.restart()
        seat.locked_until = match.ticks + round(match.rules.restart_freeze_s * BEATS_PER_S)
        match.tell("restart", say("event.restarted", team=seat.team), seat=seat.index)
    elif seat.drive and seat.state:
        seat.idle = False
        seat.state = seat.drive.press(seat.state, Level(item.level), item.key)
    return Done()


def _files(item: JoinSeat) -> tuple[Any, ...]:
    return item.robot, item.postures, item.locomotion
