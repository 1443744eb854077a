/** The file that the table comes from: open, take in, save, and what to do where it has changed. */

import { batch, computed, effect, type ReadonlySignal, signal } from "@preact/signals";
import type { Content } from "../../../core/design/entries";
import {
  columnsOf,
  fromWire,
  standing,
  type Table,
  toWire,
  type WireTable,
} from "../../../core/design/table";
import { download, sequences } from "../../../core/files";
import type { Phrase } from "../../../core/phrase";
import type { FileTable, FolderFile, Mistake } from "../../../core/wire";
import { t } from "../../../i18n";
import { toast } from "../../../ui/toasts";
import type { Can } from "../can";
import type { Gateway } from "../gateway";
import type { ReadRobot, RobotInUse } from "../robot/robot";
import type { By, Sheet } from "../table/sheet";
import { keysFrom } from "./gait";
import { NO_FILE, type OpenFile, Shapes } from "./open_file";

/** A file that has another content than the page thought. */
export interface Conflict {
  name: string;
  version: string;
  table: FileTable | null;
  /** The text of a robot file; null: the file has or had a table, or it has gone. */
  robot: string | null;
  mistakes: readonly Mistake[];
  /** What of the page has that file. */
  of: "table" | "robot";
  /** Saving over a file that was opened or over another one, or the file changed while it is open. */
  when: "saving" | "existing" | "open";
}

/** A parsed file or pasted sheet: a gait or a robot. */
export interface Parsed {
  table: FileTable | null;
  robot: string | null;
  notes: Phrase[];
}

/** A file of the folder. */
export interface Read extends Parsed {
  version: string;
}

interface SaveReply {
  version?: string;
  conflict?: Partial<Conflict> & { version: string };
}

/** What a conflict has that says nothing of it. */
export const NOTHING = { table: null, robot: null, mistakes: [] };

const POSTURES = "Loco-data.txt";
const LOCOMOTION = "LocoTra-data.txt";

/** The table of a content. */
export function wireOf({ kind, legs, rows }: Content): WireTable {
  const angles = rows.map(({ key, posture, cells }) => ({ key, posture, angles_deg: cells }));
  return { kind, legs, rows: angles };
}

export class Files {
  readonly folder = signal<{ folder: string; files: readonly FolderFile[] }>({
    folder: "",
    files: [],
  });
  readonly file = signal<OpenFile>({ ...NO_FILE, saved: "" });
  readonly conflict = signal<Conflict | null>(null);
  readonly isSaved = computed(() => this.file.value.saved === this.sheet.digest.value);
  /** Whether somebody chose to begin with a new table or the sample: no file takes its place. */
  isAskedFor = false;
  readonly shapes: Shapes;
  /** Resolves when nothing is being saved. */
  private saving: Promise<void> = Promise.resolve();

  constructor(
    private readonly gateway: Gateway,
    private readonly sheet: Sheet,
    private readonly robot: RobotInUse,
    private readonly can: ReadonlySignal<Can>,
  ) {
    this.shapes = new Shapes(robot, this.file);
    // Another page of the table has answered the question.
    effect(() => {
      const { name, version } = this.file.value;
      const asked = this.conflict.peek();
      const isAnswered = asked?.name === name && asked.version === version;
      if (isAnswered && asked.of === "table") this.conflict.value = null;
    });
  }

  /** The name under which the table is saved without asking. */
  usualName(): string {
    const { name } = this.file.peek();
    return name || (this.sheet.table.peek()?.kind === "locomotion" ? LOCOMOTION : POSTURES);
  }

  // Open

  /** Open a file of the folder. */
  async open(name: string): Promise<void> {
    const slot = this.folder.peek().files.find((file) => file.name === name)?.slot;
    try {
      const read = await this.gateway.ask<Read>("read", { name });
      if (read.robot !== null || slot === "robot") {
        await this.useRobot(name, read.robot ?? "");
        this.robot.learn(name, read.version, read.robot ?? "");
      } else if (read.table) this.show(read.table, { name, version: read.version });
      this.gateway.tell(read.notes);
    } catch (error) {
      this.gateway.refuse(error);
    }
  }

  /** Begin with the sample gait of the robot, where it has one. */
  async openSample(): Promise<void> {
    this.isAskedFor = true;
    try {
      const { table } = await this.gateway.ask<Parsed>("sample");
      if (table && table.legs === this.robot.robot.peek()?.legs.length) this.show(table);
    } catch (error) {
      this.gateway.refuse(error);
    }
  }

  /** Begin with a table in which all postures are that of the robot at its start. */
  openNew(): void {
    this.isAskedFor = true;
    const robot = this.robot.robot.peek();
    if (robot) this.begin(standing(robot));
  }

  /** Put a new table in place of this one: one step, so that undo brings this one back. */
  takeNew(): void {
    const robot = this.robot.robot.peek();
    if (robot) this.replace(t("design.new"), standing(robot));
  }

  /** Put the sample gait in place of this table, as `takeNew` does. */
  async takeSample(): Promise<void> {
    try {
      const { table } = await this.gateway.ask<Parsed>("sample");
      const robot = this.robot.robot.peek();
      if (table && robot && table.legs === robot.legs.length) {
        this.replace(t("design.sample"), fromWire(table, columnsOf(robot)));
      }
    } catch (error) {
      this.gateway.refuse(error);
    }
  }

  /** Take a dropped file, or the text of a pasted sheet. */
  async parse(name: string, data: Uint8Array): Promise<void> {
    try {
      const parsed = await this.gateway.ask<Parsed>("parse", { name, data });
      if (parsed.robot !== null && parsed.robot !== undefined) {
        await this.useRobot(name, parsed.robot);
      } else if (parsed.table) {
        const robot = this.robot.robot.peek();
        const table = robot && fromWire(parsed.table, columnsOf(robot));
        if (table) this.sheet.put(t("design.step.take", { name }), table, "paste");
        this.checkLegs();
      }
      this.gateway.tell(parsed.notes);
    } catch (error) {
      this.gateway.refuse(error);
    }
  }

  /** Walk with the workshop's hexapod. */
  async openWorkshopRobot(): Promise<void> {
    try {
      await this.useRobot("", null);
    } catch (error) {
      this.gateway.refuse(error);
    }
  }

  /**
   * Begin with a robot and a table, where there is one for its legs.
   *
   * @param keys The digits of each key; null: they stay as they are.
   */
  beginWith(
    robot: ReadRobot,
    table: WireTable | null,
    file = NO_FILE,
    keys: readonly string[] | null = null,
  ): void {
    batch(() => {
      this.robot.use(robot);
      if (table?.legs !== robot.reply.legs.length) {
        this.begin(standing(robot.reply));
        return;
      }
      if (keys) sequences.value = keys;
      this.show(table, file);
    });
  }

  /**
   * Put a table in place of this one, in one step.
   *
   * @param name Of the step.
   * @param sent The digits of each key, as they were sent.
   * @returns Whether anything has changed.
   */
  take(name: string, wire: FileTable, sent: number[][] | null, by: By): boolean {
    const robot = this.robot.robot.peek();
    if (!robot) return false;
    const table = fromWire(wire, columnsOf(robot));
    const isChanged = this.sheet.put(name, table, by, { keys: keysFrom(table, sent) });
    this.checkLegs();
    return isChanged;
  }

  /** Walk with the robot of a file, or, where its text is null, with the workshop's hexapod. */
  private async useRobot(name: string, text: string | null): Promise<void> {
    this.takeRobot(t("design.step.otherRobot"), await this.robot.read(name, text));
  }

  /**
   * Walk with another robot: one step.
   *
   * @param gesture Changes in a row with the same gesture are one step.
   */
  takeRobot(step: string, read: ReadRobot, gesture: string | null = null): void {
    batch(() => {
      const table = this.sheet.table.peek();
      if (!table) this.robot.use(read);
      else if (table.legs.length !== read.reply.legs.length) {
        // The student's own table comes back with undo, and its robot with it.
        const name = t("design.step.robot", { name: read.reply.name });
        this.sheet.put(name, standing(read.reply), null, { robot: read });
        this.file.value = { ...NO_FILE, saved: this.sheet.digest.peek() };
      } else {
        const isSaved = this.isSaved.peek();
        this.sheet.refit(step, read, gesture);
        if (isSaved) this.file.value = { ...this.file.peek(), saved: this.sheet.digest.peek() };
      }
    });
  }

  /** Put a table that is in no file in place of this one: one step. */
  private replace(step: string, table: Table): void {
    this.isAskedFor = true;
    batch(() => {
      this.sheet.put(step, table, null);
      this.sheet.mirrors.value = false;
      this.file.value = { ...NO_FILE, saved: "" };
    });
  }

  /** Put what was not saved in place of this table, in one step. */
  takeUnsaved(name: string, content: Content): void {
    const robot = this.robot.robot.peek();
    if (!robot) return;
    const table = fromWire(wireOf(content), columnsOf(robot));
    this.sheet.put(name, table, null, { keys: content.keys });
    this.checkLegs();
  }

  private begin(table: Table, file = NO_FILE): void {
    batch(() => {
      // Without a folder nothing else has the table that was here.
      const isOnly = !this.can.peek().save && this.sheet.table.peek() !== null;
      if (isOnly) this.sheet.put(t("design.step.open"), table, null);
      else this.sheet.open(table);
      this.file.value = { ...file, saved: this.sheet.digest.peek() };
    });
  }

  private show(wire: WireTable, file = NO_FILE): void {
    const robot = this.robot.robot.peek();
    if (!robot) return;
    this.begin(fromWire(wire, columnsOf(robot)), file);
    this.checkLegs();
  }

  /** Say if the table is for a robot with another number of legs. */
  private checkLegs(): void {
    const robot = this.robot.robot.peek();
    const legs = this.sheet.table.peek()?.legs.length ?? 0;
    if (robot && legs !== robot.legs.length) {
      toast(t("design.otherLegs", { legs, robot: robot.name }), "no");
    }
  }

  // Save

  /** Save the table where it belongs: in its file, or, without a folder, as a download. */
  async keep(): Promise<void> {
    if (!this.can.peek().save) return await this.download();
    await this.save(this.usualName());
    await this.robot.settled;
    if (!this.robot.isSaved.peek()) await this.keepRobot();
  }

  /** Save the robot's file, or, without a folder, hand it to the person. */
  keepRobot(force = false): Promise<void> {
    return this.inTurn(() => this.writeRobot(force));
  }

  /** Save the table under a name of the folder. */
  save(name: string, force = false): Promise<void> {
    return this.inTurn(() => this.write(name, force));
  }

  /** Save after what is being saved now: each save must know the version that the one before made. */
  private inTurn(save: () => Promise<void>): Promise<void> {
    this.saving = this.saving.then(save, save);
    return this.saving;
  }

  private async writeRobot(force: boolean): Promise<void> {
    await this.robot.settled;
    const used = this.robot.used.peek();
    if (used?.text == null) return;
    const { name, text } = used;
    if (!this.can.peek().save) return download(name, [text], "application/toml");
    const known = this.robot.versionOf(name);
    try {
      const fields = { name, robot: text, version: known, force };
      const reply = await this.gateway.ask<SaveReply>("save", fields);
      if (reply.conflict) {
        const when = known ? "saving" : "existing";
        this.conflict.value = { ...NOTHING, ...reply.conflict, name, when, of: "robot" };
        return;
      }
      this.robot.learn(name, reply.version ?? "", text);
      this.conflict.value = null;
      toast(t("design.saved", { name }), "yes");
    } catch (error) {
      this.gateway.refuse(error);
    }
  }

  private async write(name: string, force: boolean): Promise<void> {
    const table = this.sent();
    if (!table) return;
    const saved = this.sheet.digest.peek();
    const own = this.file.peek();
    // Over a file that was not opened here nothing is saved unasked.
    const version = own.name === name ? own.version : "";
    try {
      const reply = await this.gateway.ask<SaveReply>("save", { name, table, version, force });
      if (reply.conflict) {
        const when = own.name === name ? "saving" : "existing";
        this.conflict.value = { ...NOTHING, ...reply.conflict, name, when, of: "table" };
        return;
      }
      this.file.value = { name, version: reply.version ?? "", saved };
      this.conflict.value = null;
      toast(t("design.saved", { name }), "yes");
    } catch (error) {
      this.gateway.refuse(error);
    }
  }

  /** Hand the table to the person as a file. */
  async download(suffix = ".txt"): Promise<void> {
    const table = this.sent();
    if (!table) return;
    const name = this.usualName().replace(/\.[^.]*$/, "") + suffix;
    try {
      const { data } = await this.gateway.ask<{ data: Uint8Array }>("write", { name, table });
      download(name, [data.slice()], "application/octet-stream");
    } catch (error) {
      this.gateway.refuse(error);
    }
  }

  /** Take what the file has now; what was on the page can be had back by undo. */
  async takeTheirs(): Promise<void> {
    const conflict = this.conflict.peek();
    if (conflict?.of === "robot" && conflict.robot !== null) {
      this.conflict.value = null;
      try {
        await this.useRobot(conflict.name, conflict.robot);
        this.robot.learn(conflict.name, conflict.version, conflict.robot);
      } catch (error) {
        this.gateway.refuse(error);
      }
      return;
    }
    const robot = this.robot.robot.peek();
    if (!conflict?.table || !robot) return;
    const { name, version } = conflict;
    const table = fromWire(conflict.table, columnsOf(robot));
    this.sheet.put(t("design.step.theirs"), table, null);
    this.file.value = { name, version, saved: this.sheet.digest.peek() };
    this.conflict.value = null;
  }

  /** Keep what is on the page; the next save writes over the file. */
  keepMine(): void {
    const conflict = this.conflict.peek();
    if (!conflict) return;
    if (conflict.of === "robot") this.robot.learn(conflict.name, conflict.version, conflict.robot);
    else this.file.value = { ...this.file.peek(), name: conflict.name, version: conflict.version };
    this.conflict.value = null;
  }

  private sent(): FileTable | null {
    const table = this.sheet.table.peek();
    const wire = table && toWire(table);
    if (table && !wire) toast(t("design.badCells", { count: this.sheet.bad.peek().length }), "no");
    return wire;
  }
}
