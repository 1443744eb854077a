/** A trial that was made on this page. */

import type { Guess, Verdict } from "../../../core/design/predict";
import type { Table } from "../../../core/design/table";
import type { Trial } from "../../../core/design/trial";
import type { RobotReply } from "../../../core/wire";
import { t } from "../../../i18n";

export interface Tried {
  number: number;
  /** The name of a gait that the coach has found and that is only watched; "": it is the student's. */
  name: string;
  /** The version of the table that it belongs to. */
  version: number;
  table: Table;
  /** A key of level B, or such as "A1" of level A. */
  key: number | string;
  /** The rows that the key ran through. */
  rows: readonly number[];
  robot: RobotReply;
  trial: Trial;
  /** What was foretold, and what came of it. */
  verdicts: readonly { guess: Guess; verdict: Verdict }[];
}

/** What a trial is called: "Trial 3". */
export function triedName({ number, name }: Tried): string {
  return name || t("design.trial", { number });
}
