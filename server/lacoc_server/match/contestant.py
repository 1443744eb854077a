"""What contestants ask of a match: to join, be ready, leave, press keys; and their silence.

Each is legal in some phases (rules 3 and 4); what is refused changes nothing and says why.
"""

from typing import Any

from lacoc_server.match.entry import weigh_in
from lacoc_server.match.seat import Seat
from lacoc_server.match.state import MatchState
from lacoc_shared.gait.tables import Level
from lacoc_shared.inputs import JoinSeat, KeySeat
from lacoc_shared.messages import Done, Refusal
from lacoc_shared.mistakes import FileRefused
from lacoc_shared.seat import BEATS_PER_S, RESTART_KEY, No, Phase

_BEFORE = frozenset({Phase.LOBBY, Phase.READY})
_AFTER = frozenset({Phase.OFFICIAL, Phase.VOID})


def join(match: MatchState, item: JoinSeat) -> Done | Refusal:
    """Take a seat, or come back to it; the files of a match stay those that it began with."""
    seat = match.seats[item.seat]
    if match.phase in _BEFORE:
        return _sit_down(match, seat, item)
    if seat.join is None and match.phase not in _AFTER:
        why = f"The match is on ({match.phase.name}): join when the next one opens."
        return Refusal(why, again=True)
    seat.left = False
    seat.coming = item
    if seat.join is None:
        return Done("This match is over: you play in the next.")
    match.tell("join", f"{seat.team} is back.", seat=seat.index)
    if _files(seat.join) == _files(item):
        return Done()
    return Done("The match is on with the files that it began with; the next takes your new ones.")


def _sit_down(match: MatchState, seat: Seat, item: JoinSeat) -> Done | Refusal:
    files = (item.robot, item.postures, item.locomotion)
    try:
        entry = weigh_in(*files, match.limits, match.rules.open_levels)
    except FileRefused as refused:
        return Refusal("Your files have mistakes.", tuple(refused.mistakes))
    if seat.join is None or _files(seat.join) != _files(item):
        seat.ready = False
        match.back_to_lobby()  # also if everybody says ready again in this beat
    seat.join, seat.entry, seat.silent = item, entry, False
    match.sheet_changed()
    text = f"{item.team} takes the {seat.id} seat with {entry.robot.name}."
    match.tell("join", text, seat=seat.index)
    return Done("\n".join(entry.notes))


def ready(match: MatchState, seat: Seat, is_ready: bool) -> Done | Refusal:
    """Say ready, or take it back."""
    if match.phase not in _BEFORE:
        return Refusal(f"The match is on ({match.phase.name}).")
    if seat.join is None:
        return Refusal(f"Nobody has joined the {seat.id} seat.")
    if seat.ready != is_ready:
        seat.ready = is_ready
        word = "is ready" if is_ready else "is not ready after all"
        match.tell("ready", f"{seat.team} {word}.", seat=seat.index, ready=is_ready)
    return Done()


def leave(match: MatchState, seat: Seat) -> Done:
    """Free the seat; during a match it stays the contestant's, and the robot stands."""
    if match.phase in _BEFORE:
        match.tell("leave", f"{seat.team} leaves the {seat.id} seat.", seat=seat.index)
        seat.join = seat.entry = None
        seat.ready = seat.silent = False
        match.sheet_changed()
        return Done()
    match.tell("leave", f"{seat.team} has left; the seat stays theirs.", seat=seat.index)
    seat.silent = seat.left = True
    seat.stand()
    return Done("The seat stays yours.")


def unattended(match: MatchState) -> str:
    """Why a match that nobody judges is over, though its game is not; "" while it goes on."""
    if match.rules.start != "ready":
        return ""
    if all(seat.left for seat in match.seats):
        return "everybody has left"
    limit = round(match.rules.unattended_s * BEATS_PER_S)
    if 0 < limit <= match.silent_beats:
        return f"nobody has been heard for {match.rules.unattended_s / 60:g} minutes"
    return ""


def silent(match: MatchState, seat: Seat) -> Done:
    """Let a robot stand whose controller is not heard any more (rules 3)."""
    if not seat.silent:
        seat.silent = True
        seat.stand()
        text = f"{seat.team} is not heard any more: it stands."
        match.tell("silent", text, seat=seat.index)
    return Done()


def heard(match: MatchState, seat: Seat) -> Done:
    """Note that a controller is heard again; its robot stands until a new command."""
    if seat.silent:
        seat.silent = False
        match.tell("heard", f"{seat.team} is heard again.", seat=seat.index)
    return Done()


def key(match: MatchState, seat: Seat, item: KeySeat) -> Done | Refusal:
    """Take a digit or [x]."""
    why = No.NOT_PLAYING
    if match.phase is Phase.PLAYING:
        why = seat.why_not(item, match.ticks, match.rules.open_levels)
    if why is not No.NONE:
        seat.refused = (item.seq, why)
        return Refusal(why.name)
    # An older digit may come after a newer [x]: that is the order of a tick (rules 3).
    seat.applied = (max(item.seq, seat.applied[0]), match.beats)
    if item.key == RESTART_KEY:
        seat.restart()
        seat.locked_until = match.ticks + round(match.rules.restart_freeze_s * BEATS_PER_S)
        match.tell("restart", f"{seat.team} goes back to the start.", seat=seat.index)
    elif seat.drive and seat.state:
        seat.state = seat.drive.press(seat.state, Level(item.level), item.key)
    return Done()


def _files(item: JoinSeat) -> tuple[Any, ...]:
    return item.robot, item.postures, item.locomotion
