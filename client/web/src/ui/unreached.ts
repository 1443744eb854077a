/** Says why a foot can't come to a point. */

import { joint, LEVELS } from "../core/design/table";
import type { Leg, Unreached } from "../core/leg/leg";
import { t } from "../i18n";

/**
 * Say why no posture of a leg reaches a point; the page has the words of /leg.
 *
 * @param index Of the leg in its robot.
 * @param legs How many the robot has.
 */
export function whyNot(unreached: Unreached, leg: Leg, index: number, legs: number): string {
  if (unreached.why !== "range") {
    return t(`leg.unreached.${unreached.why}`, { mm: unreached.by_mm });
  }
  const { level, angle_deg } = unreached;
  const [low, high] = leg.range_deg;
  const values = { joint: joint(index, level, legs), level: LEVELS[level], angle: angle_deg };
  return t("leg.unreached.range", { ...values, low, high });
}
