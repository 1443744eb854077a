/** The robot's numbers: which there are, and how they are shown. */

import type { RobotReply } from "../../../core/wire";

/** Names of the numbers, and whether a person can change them: the others follow from these. */
export const NUMBERS: readonly (readonly [name: string, isFree: boolean])[] = [
  ["legs", false],
  ["width_m", false],
  ["length_m", false],
  ["height_m", false],
  ["mass_kg", false],
  ["body_width_m", true],
  ["body_length_m", true],
  ["body_height_m", true],
  ["root_link_m", true],
  ["first_link_m", true],
  ["second_link_m", true],
  ["link_radius_m", true],
  ["body_mass_kg", true],
  ["root_link_kg", true],
  ["first_link_kg", true],
  ["second_link_kg", true],
  ["range_low_deg", true],
  ["range_high_deg", true],
  ["drop_m", true],
  ["ang_min_deg_s", true],
  ["hold_s", true],
  ["torque_n_m", true],
  ["kp", true],
  ["kv", true],
  ["damping", true],
  ["armature", true],
  ["friction", true],
];

/** Where a leg is fixed to the body and where it points: its own numbers. */
export const OF_A_LEG = ["leg_x_m", "leg_y_m", "leg_z_m", "leg_outward_deg"] as const;

/** A number of the robot, or of one leg of it. */
export interface RobotNumber {
  /** Its name, as requests have it. */
  entry: string;
  /** From 0; null: it is of the whole robot. */
  leg: number | null;
}

/** How a number is shown and stepped. */
export interface Unit {
  /** The end of the number's name. */
  of: string;
  shown: string;
  /** What is shown, over what is sent. */
  times: number;
  /** An arrow key's step, as shown. */
  step: number;
}

const UNITS: readonly Unit[] = [
  { of: "_n_m", shown: "N m", times: 1, step: 0.1 },
  { of: "_deg_s", shown: "°/s", times: 1, step: 5 },
  { of: "_m", shown: "mm", times: 1000, step: 1 },
  { of: "_kg", shown: "g", times: 1000, step: 5 },
  { of: "_deg", shown: "°", times: 1, step: 5 },
  { of: "_s", shown: "s", times: 1, step: 0.02 },
  { of: "kp", shown: "", times: 1, step: 1 },
  { of: "armature", shown: "", times: 1, step: 0.001 },
  { of: "damping", shown: "", times: 1, step: 0.01 },
  { of: "", shown: "", times: 1, step: 0.1 },
];

/** The unit of a number, by the end of its name. */
export function unitOf(name: string): Unit {
  return UNITS.find(({ of }) => name.endsWith(of))!;
}

/** The lowest and highest value of a number in all legs. */
export function pairOf(robot: RobotReply, { entry, leg }: RobotNumber): [number, number] {
  const shape = leg === null ? undefined : robot.shapes[leg];
  const axis = OF_A_LEG.indexOf(entry as (typeof OF_A_LEG)[number]);
  const value = shape
    ? (shape.position_mm[axis] ?? 1000 * shape.outward_deg) / 1000
    : robot.facts[entry];
  return (Array.isArray(value) ? value : [value, value]) as [number, number];
}

/** A number as it is shown, without its unit. */
export function textOf(value: number, { times }: Unit): string {
  return String(Number((value * times).toPrecision(4)));
}

/** What the contest allows, as it is shown, without the unit. */
export function limitText(limits: [number | null, number | null] | undefined, unit: Unit): string {
  const [low, high] = (limits ?? [null, null]).map((end) => end !== null && textOf(end, unit));
  if (low && high) return `${low} – ${high}`;
  if (low) return `≥ ${low}`;
  return high ? `≤ ${high}` : "–";
}
