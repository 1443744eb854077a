/** Who meets at once when a stage is drawn. Pure. */

import type { ToDraw } from "./desk.gen";

/** The pairs that have met in the stage before, and meet at once if the teams have this order. */
export function meetAgain(
  { meet, met }: Pick<ToDraw, "meet" | "met">,
  order: readonly string[],
): [string, string][] {
  const known = new Set(met.map((pair) => JSON.stringify(pair.toSorted())));
  return meet
    .map(([one, other]): [string, string] => [order[one]!, order[other]!])
    .filter((pair) => known.has(JSON.stringify(pair.toSorted())));
}
