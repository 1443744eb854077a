/** The three angles of a leg in an address: the lesson gives them to the table of /design. */

import type { Three } from "./leg";

/** The name of the address's setting. */
export const GIVEN_LEG = "leg";

export interface GivenLeg {
  /** The leg's label, such as "R,F". */
  label: string;
  angles: Three;
}

/** "R,F 45 20 0" */
export function written({ label, angles }: GivenLeg): string {
  return [label, ...angles].join(" ");
}

/** The opposite of `written`; null: the text is none. */
export function readGiven(text: string): GivenLeg | null {
  const [label, ...angles] = text.split(" ");
  const numbers = angles.map(Number);
  if (!label || numbers.length !== 3 || !numbers.every(Number.isFinite)) return null;
  return { label, angles: numbers as unknown as Three };
}
