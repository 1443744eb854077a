"""Clocks, scores, keys and links as texts, the same on every screen of the terminal."""

from lacoc_client.terminal.plain import poses
from lacoc_shared.command.log import log_clock
from lacoc_shared.gait.tables import Level
from lacoc_shared.messages import Event, Frame, SeatFrame, Sheet
from lacoc_shared.seat import BEAT_S, BEATS_PER_S, SILENT_AFTER_S, Phase, SeatFlag

_PHASES = {
    Phase.CREATED: "the court opens",
    Phase.LOBBY: "waiting for the teams",
    Phase.READY: "ready, waiting for the start",
    Phase.COUNTDOWN: "starts in {countdown_s:.0f} s",
    Phase.HALTED: "halted; the referee resumes it",
    Phase.FINISHED: "over; the referee confirms the result",
    Phase.OFFICIAL: "the result is official",
    Phase.VOID: "the match is void",
}


def clock(ticks: int) -> str:
    """Format a time of the clock, rounded up to a second: "2:05"."""
    seconds = -(-max(0, ticks) // BEATS_PER_S)
    return f"{seconds // 60}:{seconds % 60:02d}"


def match_clock(frame: Frame, sheet: Sheet) -> str:
    """Format the time left, or the time played if the match has no end."""
    return clock(_shown_ticks(frame.clock_ticks, sheet))


def event_clock(event: Event, sheet: Sheet) -> str:
    """Format the time that the clock showed at an event, with tenths."""
    return log_clock(_shown_ticks(event.clock_ticks, sheet))


def _shown_ticks(clock_ticks: int, sheet: Sheet) -> int:
    """Return the ticks left, or the ticks played if the match has no end."""
    lasts = round(sheet.duration_s * BEATS_PER_S)
    return lasts - clock_ticks if lasts else clock_ticks


def phase_hint(frame: Frame, sheet: Sheet) -> str:
    """Say what a phase other than PLAYING means, and in the lobby who is missing."""
    if frame.phase == Phase.LOBBY:
        return "; ".join(_missing(frame, sheet)) or _PHASES[Phase.LOBBY]
    countdown_s = frame.countdown_beats * BEAT_S
    return _PHASES.get(Phase(frame.phase), "").format(countdown_s=-(-countdown_s // 1))


def score(frame: Frame) -> str:
    """Format the score: "18 : 20"."""
    return " : ".join(str(seat.score) for seat in frame.seats)


def teams(sheet: Sheet) -> list[str]:
    """Return the teams' names; a seat's id where nobody has joined."""
    return [seat.team or seat.id for seat in sheet.seats]


def standing_key(seat: SeatFrame, sheet: Sheet, index: int) -> str:
    """Say what a robot does: "B key 2, posture 1/4"."""
    text = f"{'AB'[seat.level]} key {seat.key}"
    counts = sheet.seats[index].postures
    if seat.level == Level.LOCOMOTION and seat.key < len(counts) and counts[seat.key] > 1:
        text += f", posture {seat.posture + 1}/{counts[seat.key]}"
    return text


def place(frame: Frame, sheet: Sheet, seat: str) -> str:
    """Say where a seat's robot is: "  x 0.12 m  y 0.43 m  heading 91°"; "" if it has none."""
    pose = poses(frame, sheet).get(seat)
    if pose is None:
        return ""
    # Adding zero turns a rounded -0.00 into 0.00.
    x_m, y_m = (round(pose[name], 2) + 0.0 for name in ("x_m", "y_m"))
    return f"  x {x_m:.2f} m  y {y_m:.2f} m  heading {pose['heading_deg']:.0f}°"


def seat_state(seat: SeatFrame) -> str:
    """Say why a seat's keys do nothing now, or that it is silent; "" if all is well."""
    flags = SeatFlag(seat.flags)
    if SeatFlag.FROZEN in flags:
        return f"frozen by the referee for {_wait_s(seat)} s"
    if seat.locked_ticks:
        return f"restarted: keys again in {_wait_s(seat)} s"
    return "not heard: it stands" if SeatFlag.SILENT in flags else ""


def link(silent_s: float) -> str:
    """Return a banner if no frame comes; "" while they do."""
    if silent_s < SILENT_AFTER_S:
        return ""
    return f"No word from the court for {silent_s:.0f} s - trying again"


def _missing(frame: Frame, sheet: Sheet) -> list[str]:
    missing = []
    for info, seat in zip(sheet.seats, frame.seats, strict=False):
        if not seat.flags & SeatFlag.JOINED:
            missing.append(f"waiting for {info.id} to join")
        elif not seat.flags & SeatFlag.READY:
            missing.append(f"{info.team or info.id} has not said ready")
    return missing


def _wait_s(seat: SeatFrame) -> int:
    return -(-seat.locked_ticks // BEATS_PER_S)
