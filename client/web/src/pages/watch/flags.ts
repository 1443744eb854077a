/** The options in the address of a page that shows a match. */

import { setting } from "../../core/address";
import type { Quality } from "../../core/settings";
import { CAMERAS, type CameraName } from "../../scene/View";

const QUALITIES: readonly Quality[] = ["auto", "low", "high"];

/** Longest delay that an address can ask for [s]. */
export const DELAY_MOST_S = 600;

/** The camera of the address; the automatic one else. */
export function cameraOfAddress(): CameraName {
  const wanted = setting("cam", "auto") as CameraName;
  return CAMERAS.includes(wanted) ? wanted : "auto";
}

/** The quality in the address; null: none is given. */
export function qualityOfAddress(): Quality | null {
  return QUALITIES.find((name) => name === setting("q")) ?? null;
}
