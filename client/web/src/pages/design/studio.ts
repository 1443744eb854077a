/** What the page knows, by nouns, and how the nouns hear of each other. */

import { computed, signal } from "@preact/signals";
import { runKey } from "../../core/address";
import { type Shown, source } from "../../core/design/sources";
import type { Phrase } from "../../core/phrase";
import type { Message, SentFile } from "../../core/wire";
import { ALL, type Can } from "./can";
import { Coach } from "./coach/coach";
import { Files } from "./files/files";
import { sentGait } from "./files/gait";
import { Opening } from "./files/opening";
import { Gateway } from "./gateway";
import { Learning } from "./learning/learning";
import { RobotInUse } from "./robot/robot";
import { Sheet } from "./table/sheet";
import { Trials } from "./trials/trials";
import { Showing } from "./walk/showing";

export class Studio {
  readonly can = signal<Can>(ALL);
  /** Whether a studio answers; null: not known yet. */
  readonly present = signal<boolean | null>(null);
  /** Why no studio answers. */
  readonly why = signal<Phrase | null>(null);

  readonly gateway = new Gateway(
    () => this.greet(),
    (message) => this.take(message),
  );
  readonly robot = new RobotInUse(this.gateway);
  readonly showing = new Showing();
  readonly sheet: Sheet = new Sheet({
    before: (by) => this.learning.tell(by),
    changed: (by, size) => this.learning.edited(by, size),
    legsChanged: () => this.trials.forget(),
    worked: () => this.showing.rest(),
  });
  readonly learning: Learning = new Learning(this.gateway, () => sentGait(this.sheet, this.robot));
  readonly trials: Trials = new Trials(
    this.gateway,
    this.sheet,
    this.robot,
    this.learning,
    this.showing,
  );
  readonly coach = new Coach(this.gateway, this.sheet, this.robot, this.trials);
  readonly files = new Files(this.gateway, this.sheet, this.robot, this.can);

  /** What the picture shows. */
  readonly picture = source(
    computed(() => {
      const { watching, shown } = this.showing;
      return (watching.value && shown.value?.robot) || this.robot.robot.value;
    }),
    computed<Shown | null>(() => {
      const { watching, shown, tick } = this.showing;
      if (watching.value && shown.value) return { trial: shown.value.trial, tick: tick.value };
      const { table, active, draft } = this.sheet;
      const cells = table.value?.rows[active.value.row]?.cells;
      if (!cells) return null;
      return { cells: draft.value === null ? cells : cells.with(active.value.col, draft.value) };
    }),
  );

  private readonly opening = new Opening(
    this.gateway,
    this.files,
    this.robot,
    () => this.trials.all.peek().length > 0,
  );
  /** The robot of the command line, null where it names none; undefined: not greeted yet. */
  private given: SentFile | null | undefined;

  private async greet(): Promise<void> {
    const hello = { key: runKey() ?? "" };
    const { robot } = await this.gateway.ask<{ robot: SentFile | null }>("hello", hello);
    this.given = robot;
    this.learning.greet();
    this.openFirst();
  }

  private take({ kind, body }: Message): void {
    if (kind === "studio") {
      this.present.value = body.present;
      this.why.value = body.why;
      this.openFirst();
    } else if (kind === "phases") {
      this.learning.phases.value = body;
    } else if (kind === "progress") {
      this.coach.progress.value = body;
    } else if (kind === "folder") {
      const { folder, files, changed } = body;
      this.files.folder.value = { folder, files };
      this.openFirst();
      for (const name of changed) void this.opening.changed(name);
    }
  }

  /** Open the first things to see, as soon as there is a studio that knows robots. */
  private openFirst(): void {
    if (this.given !== undefined && this.present.peek()) void this.opening.first(this.given);
  }
}
