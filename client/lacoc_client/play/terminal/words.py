"""Clocks, scores, keys and links as texts for all screens of the terminal."""

from collections.abc import Mapping

from lacoc_client.play.terminal.plain import poses
from lacoc_shared.command.log import log_clock
from lacoc_shared.gait.tables import Level
from lacoc_shared.messages import Event, Frame, SeatFrame, Sheet
from lacoc_shared.seat import BEAT_S, BEATS_PER_S, SILENT_AFTER_S, Phase, SeatFlag
from lacoc_shared.words import Phrase, render, say


def phase_name(phase: Phase) -> str:
    """Return the name of a phase, such as "PLAYING"."""
    return render(say("terminal.phase", phase=phase.name.lower()))


def clock(ticks: int) -> str:
    """Format a time in ticks, rounded up to whole seconds, such as "2:05"."""
    seconds = -(-max(0, ticks) // BEATS_PER_S)
    return f"{seconds // 60}:{seconds % 60:02d}"


def match_clock(frame: Frame, sheet: Sheet) -> str:
    """Format the match's time left, or the time played if it has no time limit."""
    return clock(_shown_ticks(frame.clock_ticks, sheet))


def event_clock(event: Event, sheet: Sheet) -> str:
    """Format the time that the match's clock showed at an event, with tenths."""
    return log_clock(_shown_ticks(event.clock_ticks, sheet))


def _shown_ticks(clock_ticks: int, sheet: Sheet) -> int:
    """Return the ticks left, or the ticks played if the match has no time limit."""
    lasts = round(sheet.duration_s * BEATS_PER_S)
    return lasts - clock_ticks if lasts else clock_ticks


def phase_hint(frame: Frame, sheet: Sheet) -> str:
    """Say what a phase other than PLAYING means, and in the lobby who is missing."""
    if frame.phase == Phase.LOBBY and sheet.fixture is not None and not sheet.call:
        return render(sheet.fixture)
    if frame.phase == Phase.LOBBY:
        missing = map(render, _missing(frame, sheet))
        return render(say("join.semicolon")).join(missing) or render(say("hint.lobby"))
    match frame.phase:
        case Phase.CREATED:
            hint = say("hint.created")
        case Phase.READY:
            hint = say("hint.ready")
        case Phase.COUNTDOWN:
            hint = say("hint.countdown", seconds=-(-frame.countdown_beats * BEAT_S // 1))
        case Phase.HALTED:
            hint = say("hint.halted")
        case Phase.FINISHED:
            hint = say("hint.finished")
        case Phase.OFFICIAL:
            hint = say("hint.official")
        case Phase.VOID:
            hint = say("hint.void")
        case _:
            return ""
    return render(hint)


def score(frame: Frame) -> str:
    """Format the points of the seats, such as "18 : 20"."""
    return " : ".join(str(seat.score) for seat in frame.seats)


def played(sheet: Sheet) -> str:
    """Return what is played: the match's name in its contest ("Semi-final 1"), and the game."""
    if not sheet.call or sheet.fixture is None:
        return sheet.title
    return f"{render(sheet.fixture)} · {sheet.title}"


def teams(sheet: Sheet) -> list[str]:
    """Return the teams' names; a seat's id where nobody has joined."""
    return [seat.team or seat.id for seat in sheet.seats]


def refusals(refused: Mapping[str, int]) -> str:
    """List how many messages were refused and why: "2 (wrong token), 1 (too many at once)"."""
    counts = [say("info.refused", count=count, why=why) for why, count in refused.items()]
    return render(say("plain.sentences", sentences=counts))


def standing_key(frame: Frame, sheet: Sheet, index: int) -> str:
    """Return a robot's present key, as "B key 2, posture 1/4"; "" if it is not on the field yet."""
    if not frame.poses:
        return ""
    seat = frame.seats[index]
    counts = sheet.seats[index].postures
    several = seat.level == Level.LOCOMOTION and seat.key < len(counts) and counts[seat.key] > 1
    key = say(
        "terminal.standing-key",
        level="AB"[seat.level],
        key=seat.key,
        posture=seat.posture + 1 if several else None,
        of=counts[seat.key] if several else None,
    )
    return render(key)


def place(frame: Frame, sheet: Sheet, seat: str) -> str:
    """Return where a seat's robot is: "  x 0.12 m  y 0.43 m  heading 1°"; "" if there is none.

    The heading is the yaw in Pos-data.txt, as on pages: 0 where it looks along the field's +y.
    """
    pose = poses(frame, sheet).get(seat)
    if pose is None:
        return ""
    # Adding zero turns a rounded -0.00 into 0.00.
    x_m, y_m = (round(pose[name], 2) + 0.0 for name in ("x_m", "y_m"))
    turned_deg = (round(pose["heading_deg"]) + 270) % 360
    yaw_deg = turned_deg - 360 if turned_deg > 180 else turned_deg
    return render(say("terminal.place", x_m=x_m, y_m=y_m, yaw_deg=yaw_deg))


def seat_state(seat: SeatFrame) -> str:
    """Return why a seat's keys have no effect now, or that the seat is silent; "": neither."""
    flags = SeatFlag(seat.flags)
    if SeatFlag.FROZEN in flags:
        return render(say("terminal.frozen", seconds=_wait_s(seat)))
    if seat.locked_ticks:
        return render(say("terminal.restarted", seconds=_wait_s(seat)))
    return render(say("terminal.not-heard")) if SeatFlag.SILENT in flags else ""


def link(silent_s: float) -> str:
    """Return a banner that says for how long no frame has come; "" while frames come."""
    if silent_s < SILENT_AFTER_S:
        return ""
    return render(say("terminal.no-word", seconds=silent_s))


def _missing(frame: Frame, sheet: Sheet) -> list[Phrase]:
    missing = []
    for info, seat in zip(sheet.seats, frame.seats, strict=False):
        if not seat.flags & SeatFlag.JOINED:
            missing.append(say("hint.not-joined", seat=info.id))
        elif not seat.flags & SeatFlag.READY:
            missing.append(say("hint.not-ready", team=info.team or info.id))
    return missing


def _wait_s(seat: SeatFrame) -> int:
    return -(-seat.locked_ticks // BEATS_PER_S)
