/** The file that the table was read from, and what comes back with a table of another shape. */

import type { Signal } from "@preact/signals";
import type { Table } from "../../../core/design/table";
import type { ReadRobot, RobotInUse } from "../robot/robot";

/** The file that the table was read from. */
export interface OpenFile {
  /** "" while the table has no file. */
  name: string;
  /** The file's version when it was read or saved last. */
  version: string;
  /** The digest of the table that the file has. */
  saved: string;
}

export const NO_FILE = { name: "", version: "" };

/** What stays behind where a table of another kind, or with another number of legs, comes. */
interface Left {
  robot: ReadRobot | null;
  file: OpenFile;
}

/** The robot and the file of each shape of table that steps may lead back to. */
export class Shapes {
  private readonly left = new Map<string, Left>();

  constructor(
    private readonly robot: RobotInUse,
    private readonly file: Signal<OpenFile>,
  ) {}

  /** Take in that a step led to a table of another shape: its robot and file come back with it. */
  turned(before: Table, now: Table): void {
    this.left.set(shapeOf(before), { robot: this.robot.used.peek(), file: this.file.peek() });
    const known = this.left.get(shapeOf(now));
    const legs = this.robot.robot.peek()?.legs.length;
    if (known?.robot && legs !== now.legs.length) this.robot.use(known.robot);
    this.file.value = known?.file ?? { ...NO_FILE, saved: "" };
  }
}

/** Tables of the same shape can be steps of one another with the same robot and file. */
function shapeOf({ kind, legs }: Table): string {
  return `${kind} ${legs.length}`;
}
