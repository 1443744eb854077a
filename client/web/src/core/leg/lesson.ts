/** The steps of the lesson of one leg, and what is asked in each before it is shown (workshop 3-1). */

import { joint, LEVELS, legAndLevel } from "../design/table";
import type { Flat } from "../hull";
import type { Phrase } from "../phrase";
import {
  bent,
  bodyWay,
  cos,
  points,
  type SampleRobot,
  type Spot,
  sin,
  spots,
  type Three,
} from "./leg";
import { margin } from "./stance";

export type StepName = "joints" | "knee" | "foot" | "swing" | "back" | "reach" | "stand" | "table";

export interface Choice {
  say: Phrase;
  right: boolean;
}

export interface Question {
  ask: Phrase;
  choices: readonly Choice[];
  /** Why the right answer is right. */
  because: Phrase;
}

export interface Step {
  name: StepName;
  questions: readonly Question[];
}

/** The angle of the 1st joint in the step of one link [deg]. */
export const KNEE_DEG = 30;
/** How far Root swings while the foot stands [deg]. */
export const SWING_DEG = 45;
/** A body whose middle is nearer to the edge than this does not stand firmly [mm]. */
const FIRM_MM = 1;

/** The steps for the first leg of a robot. */
export function lesson(robot: SampleRobot): readonly Step[] {
  return [
    { name: "joints", questions: joints(robot) },
    { name: "knee", questions: [knee(robot)] },
    { name: "foot", questions: [foot(robot)] },
    { name: "swing", questions: [swing(robot)] },
    { name: "back", questions: [back(robot)] },
    { name: "reach", questions: [reach(robot)] },
    { name: "stand", questions: standing(robot).map((legs) => stand(robot, legs)) },
    { name: "table", questions: [] },
  ];
}

/** The angles of a leg in the posture in which the robot begins. */
export function startOf({ legs, start_deg }: SampleRobot, leg = 0): Three {
  const angle = (level: number) => start_deg[joint(leg, level, legs.length)]!;
  return [angle(0), angle(1), angle(2)];
}

/** Where all feet are in the start posture, seen from above. */
export function feetOf(robot: SampleRobot): Flat[] {
  return robot.legs.map((leg, index) => {
    const [x, y] = points(leg, startOf(robot, index))[3];
    return [x, y];
  });
}

/** A spot that both bends of the leg reach. */
export function farSpot({ legs }: SampleRobot): Spot {
  const [l0, l1, l2] = legs[0]!.lengths_mm;
  const away = 0.9 * (l1 + l2);
  return { r: Math.round(l0 + away * cos(-25)), z: Math.round(away * sin(-25)) };
}

/** Legs on which the robot shall stand, one set for each question. */
export function standing({ legs }: SampleRobot): number[][] {
  const all = legs.map((_, leg) => leg);
  const half = all.filter((leg) => leg % 2 === 0);
  const side = all.slice(0, all.length / 2);
  return half.length < 3 ? [all.slice(1)] : [half, side];
}

function joints({ legs }: SampleRobot): Question[] {
  const count = legs.length;
  return [count, 2 * count + 1].map((id) => {
    const { leg, level } = legAndLevel(id, count);
    const others = [
      [Math.floor(id / 3), id % 3], // as if joints were counted leg by leg
      [leg, (level + 1) % 3],
      [(leg + 1) % count, level],
      [(leg + 2) % count, level],
    ];
    const taken = others.filter(
      ([other, at], index) =>
        index < 2 || !others.slice(0, index).some((one) => one[0] === other && one[1] === at),
    );
    const choices = [[leg, level], ...taken.slice(0, 3)]
      .sort((one, other) => one[0]! - other[0]! || one[1]! - other[1]!)
      .map(([one, at]) => ({
        say: { code: "leg.joint", values: named(legs[one!]!.label, at!) },
        right: one === leg && at === level,
      }));
    const values = { first: count, second: 2 * count, last: 3 * count - 1, joint: id };
    return {
      ask: { code: "leg.joints.ask", values: { joint: id } },
      choices,
      because: {
        code: "leg.joints.because",
        values: { ...values, ...named(legs[leg]!.label, level) },
      },
    };
  });
}

function named(leg: string, level: number) {
  return { leg, level: LEVELS[level]! };
}

function knee({ legs }: SampleRobot): Question {
  const l1 = legs[0]!.lengths_mm[1];
  const right = l1 * sin(KNEE_DEG);
  const wrong = [(l1 * KNEE_DEG) / 90, l1 * cos(KNEE_DEG), l1];
  return {
    ask: { code: "leg.knee.ask", values: { angle: KNEE_DEG } },
    choices: lengths(right, wrong),
    because: { code: "leg.knee.because", values: { length: l1, angle: KNEE_DEG, height: right } },
  };
}

function foot(robot: SampleRobot): Question {
  const leg = robot.legs[0]!;
  const [, first, second] = startOf(robot);
  const [l0, l1, l2] = leg.lengths_mm;
  const [, up, down] = spots(leg, first, second);
  const shank = first + second;
  const wrong: Spot[] = [
    { r: up.r, z: up.z - l2 }, // the shank hangs straight down
    { r: l0 + l1 * sin(first) + l2 * cos(shank), z: l1 * cos(first) - l2 * sin(shank) },
    { r: l0 + l1, z: -l2 }, // as at 0 and 0
  ];
  const choices = [down, ...wrong]
    .sort((one, other) => one.r - other.r)
    .map((one) => ({ say: { code: "leg.spot", values: { ...one } }, right: one === down }));
  return {
    ask: { code: "leg.foot.ask", values: { first, second } },
    choices,
    because: { code: "leg.foot.because", values: { shank, ...down } },
  };
}

function swing(robot: SampleRobot): Question {
  const [, first, second] = startOf(robot);
  const { r } = spots(robot.legs[0]!, first, second)[2];
  const right = bodyWay(r, SWING_DEG);
  return {
    ask: { code: "leg.swing.ask", values: { r, swing: SWING_DEG } },
    choices: lengths(right, [right / 2, (r * SWING_DEG) / 90, r]),
    because: { code: "leg.swing.because", values: { way: right } },
  };
}

function back(robot: SampleRobot): Question {
  const spot = farSpot(robot);
  const count = bent(robot.legs[0]!, spot).postures.length;
  const choices = ["one", "two", "many"].map((name, index) => ({
    say: { code: `leg.count.${name}` },
    right: index + 1 === count,
  }));
  return {
    ask: { code: "leg.back.ask", values: { ...spot } },
    choices,
    because: { code: "leg.back.because" },
  };
}

function reach({ legs }: SampleRobot): Question {
  const [l0, l1, l2] = legs[0]!.lengths_mm;
  return {
    ask: { code: "leg.reach.ask" },
    choices: lengths(l1 + l2, [l2, Math.hypot(l1, l2), l0 + l1 + l2]),
    because: { code: "leg.reach.because", values: { far: l1 + l2, near: Math.abs(l1 - l2) } },
  };
}

function stand(robot: SampleRobot, legs: readonly number[]): Question {
  const feet = feetOf(robot);
  const found = margin(legs.map((leg) => feet[leg]!)) ?? 0;
  const isIn = found > FIRM_MM;
  return {
    ask: { code: "leg.stand.ask", values: { legs: legs.map((leg) => robot.legs[leg]!.label) } },
    choices: [
      { say: { code: "leg.stand.yes" }, right: isIn },
      { say: { code: "leg.stand.no" }, right: !isIn },
    ],
    because: {
      code: `leg.stand.${isIn ? "inside" : found < -FIRM_MM ? "outside" : "edge"}`,
      values: { margin: Math.abs(found) },
    },
  };
}

/** A right length and wrong ones, the shortest first. */
function lengths(right: number, wrong: readonly number[]): Choice[] {
  return [right, ...wrong]
    .sort((one, other) => one - other)
    .map((mm) => ({ say: { code: "leg.mm", values: { mm } }, right: mm === right }));
}
