/** The figures of a trial: which are shown, how they are written, and which way is better. */

import { figure } from "../../../core/design/trial";
import type { MessageName } from "../../../i18n";

type Figures = Record<string, unknown>;

export interface Figure {
  name: keyof typeof TITLES;
  /** How the number is written. */
  text(value: number): string;
  unit: string;
  /** Whether more is better (1), or what is nearer to 0 (-1); 0: neither. */
  better: 1 | -1 | 0;
}

const TITLES = {
  speed_mm_s: "design.figure.speed",
  lateral_mm_s: "design.figure.lateral",
  drift_deg_s: "design.figure.drift",
  stable_share: "design.figure.stable",
  margin_mm: "design.figure.margin",
  slip_mm_s: "design.figure.slip",
  slip_ratio: "design.figure.slipRatio",
  cost_of_transport: "design.figure.cost",
  clearance_mm: "design.figure.clearance",
  belly_share: "design.figure.belly",
  upright: "design.figure.upright",
} as const satisfies Record<string, MessageName>;

const made = (name: Figure["name"], digits: number, of: string, better: Figure["better"]) => ({
  name,
  unit: of,
  better,
  text: (value: number) => unit(value, digits),
});
const percent = (name: Figure["name"], better: Figure["better"]): Figure => ({
  name,
  unit: "%",
  better,
  text: (value) => unit(100 * value, 0),
});

/** Those that are always in sight. */
export const TILES: readonly Figure[] = [
  made("speed_mm_s", 1, "mm/s", 1),
  made("drift_deg_s", 1, "°/s", -1),
  percent("stable_share", 1),
  made("slip_mm_s", 0, "mm/s", -1),
  made("margin_mm", 0, "mm", 1),
  percent("belly_share", -1),
];

export const FIGURES: readonly Figure[] = [
  ...TILES,
  made("lateral_mm_s", 1, "mm/s", -1),
  made("slip_ratio", 2, "", -1),
  made("cost_of_transport", 1, "", -1),
  made("clearance_mm", 0, "mm", 0),
  made("upright", 2, "", 1),
];

/** The title of a figure by its name in a trial. */
export function shownTitle(name: string): MessageName {
  return TITLES[name as Figure["name"]] ?? "design.figure";
}

export function titleOf({ name }: Figure): MessageName {
  return TITLES[name];
}

/** A figure with its unit; "–" where there is none. */
export function written(of: Figure, figures: Figures): string {
  const value = figure(figures, of.name);
  return value === null ? "–" : of.text(value);
}

export interface Difference {
  text: string;
  is: "better" | "worse" | "same";
}

/** What became of a figure; null where a trial has none. */
export function difference(of: Figure, before: Figures, after: Figures): Difference | null {
  const [was, is] = [figure(before, of.name), figure(after, of.name)];
  if (was === null || is === null) return null;
  const written = of.text(is - was);
  if (!/[1-9]/.test(written)) return { text: "±0", is: "same" };
  const gain = of.better < 0 ? Math.abs(was) - Math.abs(is) : of.better * (is - was);
  const text = is > was ? `+${written}` : written;
  return { text, is: gain > 0 ? "better" : gain < 0 ? "worse" : "same" };
}

/** A number with a real minus; "-0" is "0". */
export function unit(value: number, digits: number): string {
  const text = value.toFixed(digits);
  return /[1-9]/.test(text) ? text.replace("-", "−") : text.replace("-", "");
}
