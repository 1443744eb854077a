/** The student's place in a class: what lets this browser in. All pages of a class share it. */

import { remembered } from "./settings";

export interface Place {
  name: string;
  token: string;
  /** Number of the last handed-out table that was taken or put off. */
  answered: number;
}

/** null: this browser has none. */
export const place = remembered<Place | null>("class", null);
