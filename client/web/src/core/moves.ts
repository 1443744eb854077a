/** What the keys of level B of the page's own robot do, as its court tried them. */

import { computed, type ReadonlySignal } from "@preact/signals";
import type { Court } from "./court";
import { Phase } from "./wire";

type Known = Pick<Court, "frame" | "health" | "sheet">;

/**
 * For each key a word, up to the first that was not tried.
 *
 * A court tries keys before the match begins only. If it is restarted in the match, what it said
 * before still holds: files do not change any more.
 */
export function movesOf(
  court: Known,
  index: ReadonlySignal<number>,
): ReadonlySignal<readonly string[]> {
  let kept: readonly string[] = [];
  let robot = "";
  const hasBegun = computed(() => (court.frame.value?.phase ?? 0) > Phase.READY);
  return computed(() => {
    const sheet = court.sheet.value;
    const seat = sheet?.seats[index.value];
    if (!seat) return [];
    const told = court.health.value?.moves[index.value] ?? [];
    const now = JSON.stringify([sheet.match_id, seat.team, seat.robot, seat.keys, seat.postures]);
    if (!hasBegun.value || now !== robot || told.length >= kept.length) kept = told;
    robot = now;
    return kept;
  });
}
