/** What can be done on this page. It is not the same wherever the page is opened. */

import { COACHES, OPEN_RULES } from "../../core/class";
import type { StudentRules } from "../../core/wire";

export interface Can {
  /** Open and save the files of a folder; else they are only dropped and downloaded. */
  save: boolean;
  /** Open the sample gait. */
  sample: boolean;
  /** Ask the coach. */
  coach: boolean;
  /** Work on the six phases. */
  learn: boolean;
  /** What the teacher allows in a class. */
  rules: StudentRules;
}

/** On one's own machine. */
export const ALL: Can = {
  save: true,
  sample: true,
  coach: true,
  learn: true,
  rules: OPEN_RULES,
};

/** Whether the coach may help so much. */
export function allows({ rules }: Can, help: StudentRules["coach"]): boolean {
  return COACHES.indexOf(help) <= COACHES.indexOf(rules.coach);
}

/** Whether the teacher has closed a phase. */
export function isClosed({ rules }: Can, phase: number): boolean {
  return rules.closed.includes(phase);
}
