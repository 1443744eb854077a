/** What is opened unasked: the first robot and gait, and what other programs save meanwhile. */

import { signal } from "@preact/signals";
import { Refused } from "../../../core/connection";
import { type Content, digestOf } from "../../../core/design/entries";
import { columnsOf, fromWire } from "../../../core/design/table";
import { SAMPLE_SEQUENCES, sequences } from "../../../core/files";
import type { Phrase } from "../../../core/phrase";
import type { FileTable, FolderFile, SentFile } from "../../../core/wire";
import { t } from "../../../i18n";
import { toast } from "../../../ui/toasts";
import type { Greeting } from "../class/membership";
import type { Gateway } from "../gateway";
import type { ReadRobot, RobotInUse } from "../robot/robot";
import type { Sharing } from "../sharing/sharing";
import type { Sheet } from "../table/sheet";
import { type Files, NOTHING, type Parsed, type Read, wireOf } from "./files";

export class Opening {
  /** How far the first things to see are opened. */
  private is: "closed" | "opening" | "open" = "closed";
  /** Why they are not open yet, as long as that may pass by itself; null: nothing is known. */
  readonly waitsFor = signal<Phrase | null>(null);

  /** @param isTried Whether a trial was made with the table that is there. */
  constructor(
    private readonly gateway: Gateway,
    private readonly files: Files,
    private readonly robot: RobotInUse,
    private readonly sheet: Sheet,
    private readonly sharing: Sharing,
    private readonly isTried: () => boolean,
  ) {}

  get isOpen(): boolean {
    return this.is === "open";
  }

  /**
   * Open the first things to see, once: the robot and the table that somebody was working on, or
   * the folder's first gait, else a new table, or the sample if somebody has earned it.
   */
  async first({ robot: given, student, table: shared, earned }: Greeting): Promise<void> {
    if (this.is !== "closed") return;
    this.is = "opening";
    try {
      const there = this.sharing.content();
      const isLive = student !== null || shared.others > 0;
      const own = there && (isLive || !isSaved(there)) ? there : null;
      const robot = await this.firstRobot(given, own);
      // What came meanwhile counts too.
      const newest = own && (this.sharing.content() ?? own);
      if (newest && isLive) {
        const { name, version, digest } = newest.file;
        this.files.beginWith(robot, wireOf(newest), { name, version }, newest.keys);
        this.files.file.value = { name, version, saved: digest };
      } else {
        if (student !== null) sequences.value = SAMPLE_SEQUENCES; // not those of another student
        const name = own ? own.file.name : this.firstGait();
        const known = this.find((file) => file.name === name)?.name ?? "";
        const read = known || earned ? await this.firstTable(known) : null;
        const file = read?.version ? { name, version: read.version } : undefined;
        this.files.beginWith(robot, read?.table ?? null, file);
        this.gateway.tell(read?.notes);
        if (own) this.goOn(own, read);
      }
      this.is = "open";
      this.waitsFor.value = null;
      this.sharing.begin();
      // Its file may have changed while no page looked, or another page asks about it just now.
      if (newest && student === null && newest.file.name) void this.changed(newest.file.name);
    } catch (error) {
      this.is = "closed";
      if (mayPass(error)) this.waitsFor.value = error.why;
      else this.gateway.refuse(error);
    }
  }

  /** Take in that another program saved a file of the folder. */
  async changed(name: string): Promise<void> {
    const { files } = this;
    if (name === this.robot.name.peek()) {
      await this.robotChanged(name);
      return;
    }
    const own = files.file.peek();
    const now = this.find((file) => file.name === name)?.version;
    // The first gait of the folder, or one whose mistakes were corrected.
    const isUntouched = files.isSaved.peek() && !this.isTried();
    const isFree = own.name === "" && isUntouched && !files.isAskedFor;
    if (isFree && now && /^loco/i.test(name)) {
      this.gateway.trouble.value = null;
      await files.open(name);
      return;
    }
    if (name !== own.name || now === own.version || !now) return;
    try {
      const { table, version } = await this.gateway.ask<Read>("read", { name });
      if (!table || version === files.file.peek().version) return;
      if (this.isShown(table)) {
        // Another window of this page has saved it.
        files.file.value = { name, version, saved: this.sheet.digest.peek() };
        return;
      }
      files.conflict.value = { ...NOTHING, name, version, table, when: "open", of: "table" };
      // Nothing of one's own would be lost.
      if (files.isSaved.peek()) {
        await files.takeTheirs();
        toast(t("design.reread", { name }));
      }
    } catch (error) {
      this.gateway.refuse(error);
    }
  }

  /** Take in that another program saved the robot's file. */
  private async robotChanged(name: string): Promise<void> {
    const now = this.find((file) => file.name === name)?.version;
    if (now === this.robot.versionOf(name)) return; // this page saved it
    if (this.robot.isSaved.peek() || !now) {
      await this.files.open(name);
      return;
    }
    try {
      const { robot, version } = await this.gateway.ask<Read>("read", { name });
      if (version === this.robot.versionOf(name)) return;
      const found = { name, version, robot };
      this.files.conflict.value = { ...NOTHING, ...found, when: "open", of: "robot" };
    } catch (error) {
      this.gateway.refuse(error);
    }
  }

  /**
   * Put what was not saved in place of the file's table, in one step. If the file has changed
   * since, ask, as if the page had been open all the time.
   */
  private goOn(content: Content, read: (Parsed & { version: string }) | null): void {
    const { files } = this;
    files.takeUnsaved(t("design.step.draft"), content);
    const { name, version } = content.file;
    const base = files.file.peek();
    if (name && name !== base.name) files.file.value = { name, version: "", saved: "" };
    else if (name && read?.table && version !== base.version) {
      files.file.value = { name, version, saved: "" };
      const { table, version: now } = read;
      files.conflict.value = {
        ...NOTHING,
        name,
        version: now,
        table,
        when: "open",
        of: "table",
      };
      return;
    }
    toast(t("design.draft"));
  }

  /** The robot of the shared table, of the command line, of the folder, or the workshop's. */
  private async firstRobot(given: SentFile | null, own: Content | null): Promise<ReadRobot> {
    try {
      if (own) {
        const { robot, file } = own;
        if (robot && file.robotVersion !== null) {
          if (file.robotVersion) this.robot.learn(robot.name, file.robotVersion, null);
          return { ...(await this.robot.read(robot.name, robot.text)), isEdited: true };
        }
        const name = this.find((one) => one.slot === "robot" && one.name === robot?.name)?.name;
        if (name) return await this.robotOf(name);
        return await this.robot.read(robot?.name ?? "", robot?.text ?? null);
      }
      if (given) return await this.robotIn(given);
      const found = this.find((file) => file.slot === "robot");
      return await (found ? this.robotOf(found.name) : this.robotIn(null));
    } catch (error) {
      if (mayPass(error)) throw error;
      this.gateway.refuse(error);
      return await this.robotIn(null);
    }
  }

  /** The robot of a file of the folder. */
  private async robotOf(name: string): Promise<ReadRobot> {
    const { robot, version } = await this.gateway.ask<Read>("read", { name });
    if (robot !== null) this.robot.learn(name, version, robot);
    return await this.robot.read(name, robot);
  }

  private robotIn(file: SentFile | null): Promise<ReadRobot> {
    return this.robot.read(file?.name ?? "", file && new TextDecoder().decode(file.data));
  }

  /** The table of a file, or of the sample; null where there is none without mistakes. */
  private async firstTable(name: string): Promise<(Parsed & { version: string }) | null> {
    try {
      if (name) return await this.gateway.ask<Read>("read", { name });
      return { ...(await this.gateway.ask<Parsed>("sample")), version: "" };
    } catch (error) {
      if (mayPass(error)) throw error;
      this.gateway.refuse(error);
      return null;
    }
  }

  /** Whether the page shows what a file has. */
  private isShown(table: FileTable): boolean {
    const now = this.sheet.table.peek();
    const robot = this.robot.robot.peek();
    if (!now || !robot) return false;
    return digestOf(fromWire(table, columnsOf(robot))) === digestOf(now);
  }

  private firstGait(): string {
    const gait =
      this.find(({ slot }) => slot === "postures") ??
      this.find(({ slot }) => slot === "locomotion");
    return gait?.name ?? "";
  }

  private find(wanted: (file: FolderFile) => boolean): FolderFile | undefined {
    return this.files.folder.peek().files.find(wanted);
  }
}

/** Whether a file has the table, and all changes of its robot. */
function isSaved(content: Content): boolean {
  return content.file.digest === digestOf(content) && content.file.robotVersion === null;
}

/** Whether something was refused for another reason than what is in a file. */
function mayPass(error: unknown): error is Refused {
  return error instanceof Refused && !error.mistakes.length;
}
