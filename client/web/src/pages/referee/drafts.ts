/** Decisions that are asked about before they are taken: what the dialog says and collects. */

import type { Court } from "../../core/court";
import {
  BEATS_PER_S,
  type Decision,
  type DecisionName,
  MAX_CLOCK_S,
  MAX_FREEZE_S,
  MAX_POINTS,
} from "../../core/wire";
import { t } from "../../i18n";
import { clock, clockTicks, markerName, outcome, seatName, team } from "../../i18n/words";

/** A number that a decision needs. */
interface Amount {
  label: string;
  value: number;
  least: number;
  most: number;
  whole: boolean;
  /** Often taken ones, a click each. */
  usual: readonly number[];
  /** What the number would make. */
  shows: (value: number) => string;
}

/** A decision to be confirmed, perhaps with a number. */
export interface Draft {
  name: DecisionName;
  title: string;
  text: string;
  confirm: string;
  /** It can't be undone. */
  final?: boolean;
  amount?: Amount;
  /** Of a decision about the result: who wins; null: whoever has won by the rules. */
  winner?: string | null;
  /** Of a take-back: the event. */
  event?: number;
  build: (amount: number) => Decision;
}

function names(court: Court, seat: number): { id: string; team: string } {
  const sheet = court.sheet.value;
  return { id: sheet?.seats[seat]?.id ?? "", team: sheet ? team(sheet, seat) : "" };
}

export function official(court: Court): Draft {
  return {
    name: "official",
    title: t("decide.official"),
    // Read as it is drawn: what becomes final is what stands there at that moment.
    get text() {
      const scores = court.frame.value?.seats.map((seat) => seat.score).join(" : ");
      return t("ask.official", { result: [scores, outcome(court)].filter(Boolean).join(" · ") });
    },
    confirm: t("decide.official"),
    final: true,
    winner: null,
    build: () => ({ type: "official" }),
  };
}

export function next(): Draft {
  return {
    name: "next",
    title: t("decide.next"),
    text: t("ask.next"),
    confirm: t("decide.next"),
    final: true,
    build: () => ({ type: "next" }),
  };
}

export function abort(): Draft {
  return {
    name: "abort",
    title: t("decide.abort"),
    text: t("ask.abort"),
    confirm: t("decide.abort"),
    final: true,
    build: () => ({ type: "abort" }),
  };
}

/** @param seat The winner's; null for a draw. */
export function declare(court: Court, seat: number | null): Draft {
  const winner = seat === null ? null : names(court, seat);
  return {
    name: "declare",
    title: winner ? t("decide.declareTeam", { team: winner.team }) : t("decide.declareDraw"),
    text: t("ask.declare"),
    confirm: t("ask.confirm"),
    final: true,
    winner: winner?.id ?? "draw",
    build: () => ({ type: "declare", winner: winner?.id ?? "draw" }),
  };
}

export function restart(court: Court, seat: number): Draft {
  const { id, team } = names(court, seat);
  return {
    name: "restart",
    title: t("ask.restartTitle", { team }),
    text: t("ask.restart"),
    confirm: t("decide.restart"),
    build: () => ({ type: "restart", seat: id }),
  };
}

export function freeze(court: Court, seat: number): Draft {
  const { id, team } = names(court, seat);
  return {
    name: "freeze",
    title: t("ask.freezeTitle", { team }),
    text: t("ask.freeze"),
    confirm: t("decide.freeze"),
    amount: {
      label: t("ask.seconds"),
      value: 10,
      least: 0.1,
      most: MAX_FREEZE_S,
      whole: false,
      usual: [5, 10, 30],
      shows: () => "",
    },
    build: (seconds) => ({ type: "freeze", seat: id, seconds }),
  };
}

export function adjust(court: Court, seat: number, points: number): Draft {
  const { id, team } = names(court, seat);
  return {
    name: "adjust",
    title: t("ask.adjustTitle", { team }),
    text: t("ask.adjust"),
    confirm: t("ask.confirm"),
    amount: {
      label: t("ask.points"),
      value: points,
      least: -MAX_POINTS,
      most: MAX_POINTS,
      whole: true,
      usual: [-5, -1, 1, 5],
      shows: (value) => {
        const now = court.frame.value?.seats.map(({ score }) => score) ?? [];
        const then = now.map((score, index) => (index === seat ? score + value : score));
        return `${now.join(" : ")} → ${then.join(" : ")}`;
      },
    },
    build: (value) => ({ type: "adjust", seat: id, points: value }),
  };
}

/** @param given Seconds to give; less than 0 takes them. */
export function moveClock(court: Court, given: number): Draft {
  return {
    name: "clock",
    title: t("ask.clockTitle"),
    text: t("ask.clock"),
    confirm: t("ask.confirm"),
    amount: {
      label: t("ask.seconds"),
      value: given,
      least: -MAX_CLOCK_S,
      most: MAX_CLOCK_S,
      whole: false,
      usual: [-30, -10, 10, 30],
      shows: (value) => {
        const { frame, sheet } = { frame: court.frame.value, sheet: court.sheet.value };
        if (!frame || !sheet) return "";
        const left = clockTicks(frame, sheet);
        const then = left + value * BEATS_PER_S;
        if (then <= 0 && value > 0) return t("ask.clockOwed", { left: clock(-then) });
        if (then <= 0) return t("ask.clockEnds", { left: clock(left) });
        return `${clock(left)} → ${clock(then)}`;
      },
    },
    build: (value) => ({ type: "clock", gives_s: value }),
  };
}

export function setMarker(court: Court, marker: number, state: string): Draft {
  const name = court.sheet.value?.markers[marker]?.name ?? "";
  const title = { marker: markerTitle(court, marker), state: stateName(court, state) };
  return {
    name: "set",
    title: t("ask.setTitle", title),
    text: t("ask.set"),
    confirm: t("ask.confirm"),
    build: () => ({ type: "set", marker: name, state }),
  };
}

export function takeBack(event: number): Draft {
  return {
    name: "take-back",
    title: t("ask.takeBackTitle", { event }),
    text: t("ask.takeBack"),
    confirm: t("ask.takeBackGo"),
    event,
    build: () => ({ type: "take-back", event }),
  };
}

/** A marker at the beginning of a line: "Corner 2"; what pages have no words for, with its kind. */
export function markerTitle(court: Court, marker: number): string {
  const { kind, name } = court.sheet.value?.markers[marker] ?? { kind: "", name: "" };
  const words = markerName(name).trim();
  return words === name ? `${kind} ${name}` : words.charAt(0).toUpperCase() + words.slice(1);
}

/** A marker's state in words: a seat's is named with its team. */
export function stateName(court: Court, state: string): string {
  const sheet = court.sheet.value;
  const seat = sheet?.seats.findIndex((one) => one.id === state) ?? -1;
  if (!sheet || seat < 0) return state === "down" ? t("pick.state.down") : t("pick.state.neutral");
  const side = seatName(state);
  const name = team(sheet, seat);
  return name === side ? side : `${name} (${side})`;
}
