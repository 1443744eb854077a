/** What a contestant does next, in one line. */

import type { Court } from "../../core/court";
import type { Player } from "../../core/player";
import { type Frame, Phase, SeatFlag } from "../../core/wire";
import { said, t } from "../../i18n";
import { BEATS_PER_S, ruleOf, seatName, team } from "../../i18n/words";

/** A line, and how much it matters. */
export interface Step {
  text: string;
  tone: "do" | "wait" | "warn";
}

/** The next step; for a `computed`: it reads the newest frame. */
export function nextStep(court: Court, player: Player, alone: boolean, canTry = false): Step {
  const frame = court.frame.value;
  const sheet = court.sheet.value;
  const index = player.index.value;
  const seat = frame?.seats[index];
  if (player.standing.value === "joining") return { text: t("next.rejoin"), tone: "wait" };
  if (!frame || !sheet || !seat) return { text: t("next.wait"), tone: "wait" };
  if (!player.canSteer.value) {
    const why = player.court.seat.value?.reason;
    return { text: why ? said(why) : t("next.lost"), tone: "warn" };
  }
  const seconds = Math.ceil(seat.locked_ticks / BEATS_PER_S);
  switch (frame.phase) {
    case Phase.LOBBY:
      if (alone) return { text: t("next.practice"), tone: "wait" };
      if (!(seat.flags & SeatFlag.READY)) {
        const ready = othersReady(frame, index);
        if (ready >= 0) {
          return { text: t("next.otherReady", { team: team(sheet, ready) }), tone: "do" };
        }
        return { text: t(canTry ? "next.tryOut" : "next.ready"), tone: "do" };
      }
      return { text: othersMissing(court, index), tone: "wait" };
    case Phase.READY:
      return { text: t(alone ? "next.practice" : "next.start"), tone: "wait" };
    case Phase.COUNTDOWN:
      return { text: t("next.countdown"), tone: "do" };
    case Phase.PLAYING: {
      if (seat.flags & SeatFlag.FROZEN) {
        return { text: t("next.frozen", { seconds }), tone: "warn" };
      }
      if (seconds) return { text: t("next.locked", { seconds }), tone: "warn" };
      if (seat.flags & SeatFlag.SILENT) return { text: t("next.silent"), tone: "warn" };
      return { text: playing(court, player), tone: "do" };
    }
    case Phase.HALTED:
      return { text: t("next.halted"), tone: "warn" };
    case Phase.FINISHED:
      return { text: t("next.finished"), tone: "wait" };
    case Phase.OFFICIAL:
    case Phase.VOID:
      return { text: official(player), tone: "wait" };
    default:
      return { text: t("next.wait"), tone: "wait" };
  }
}

/** What comes after the official result. */
export function official(player: Player): string {
  const next = player.next.value;
  if (next) return said(next);
  return t(player.court.sheet.value?.call ? "next.byOffice" : "next.official");
}

/** Another seat whose player is ready; -1: there is none. */
function othersReady({ seats }: Frame, index: number): number {
  return seats.findIndex(({ flags }, other) => other !== index && flags & SeatFlag.READY);
}

function othersMissing(court: Court, index: number): string {
  const sheet = court.sheet.value!;
  for (const [other, seat] of court.frame.value!.seats.entries()) {
    if (other === index) continue;
    if (!(seat.flags & SeatFlag.JOINED)) {
      return t("next.joining", { seat: seatName(sheet.seats[other]!.id) });
    }
    if (!(seat.flags & SeatFlag.READY)) return t("next.notReady", { team: team(sheet, other) });
  }
  return t("next.start");
}

/** What the robot could do next; the rule of the game where its court does not say. */
function playing(court: Court, player: Player): string {
  const next = player.gains.value?.said;
  return next ? said(next) : ruleOf(court.sheet.value);
}
