/** What is opened unasked: the first robot and gait, and what other programs save meanwhile. */

import { signal } from "@preact/signals";
import { Refused } from "../../../core/connection";
import { columnsOf, fromWire } from "../../../core/design/table";
import { SAMPLE_SEQUENCES, sequences } from "../../../core/files";
import type { Phrase } from "../../../core/phrase";
import type { Draft, FolderFile, SentFile } from "../../../core/wire";
import { t } from "../../../i18n";
import { toast } from "../../../ui/toasts";
import type { Greeting } from "../class/membership";
import type { Gateway } from "../gateway";
import type { ReadRobot, RobotInUse } from "../robot/robot";
import type { Sheet } from "../table/sheet";
import { type Files, NOTHING, type Parsed, type Read } from "./files";

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
    private readonly isTried: () => boolean,
  ) {}

  get isOpen(): boolean {
    return this.is === "open";
  }

  /**
   * Open the first things to see, once: the robot and the table that somebody was working on, or
   * the folder's first gait, else a new table, or the sample if somebody has earned it.
   */
  async first({ robot: given, student, draft, earned }: Greeting): Promise<void> {
    if (this.is !== "closed") return;
    this.is = "opening";
    try {
      const own = draft && (student !== null || !draft.saved) ? draft : null;
      const robot = await this.firstRobot(given, own);
      if (student !== null && own) {
        this.files.beginWith(robot, own.table, undefined, own.sequences);
        // Also a table for a robot with another number of legs.
        this.files.take(t("design.step.newest"), own.table, own.sequences, null);
      } else {
        if (student !== null) sequences.value = SAMPLE_SEQUENCES; // not those of another student
        const name = own ? own.file : this.firstGait();
        const there = this.find((file) => file.name === name)?.name ?? "";
        const read = there || earned ? await this.firstTable(there) : null;
        const file = read?.version ? { name, version: read.version } : undefined;
        this.files.beginWith(robot, read?.table ?? null, file);
        this.gateway.tell(read?.notes);
        if (own) this.goOn(own, read);
      }
      this.is = "open";
      this.waitsFor.value = null;
    } catch (error) {
      this.is = "closed";
      if (mayPass(error)) this.waitsFor.value = error.why;
      else this.gateway.refuse(error);
    }
  }

  /**
   * Take in, in a class, that the student worked on another page while this one was not connected:
   * the newest table is one step from what is here.
   */
  again(draft: Draft): void {
    const { sheet, files } = this;
    const robot = this.robot.robot.peek();
    const history = sheet.history.peek();
    if (!robot || !history || history.has(fromWire(draft.table, columnsOf(robot)))) return;
    files.take(t("design.step.newest"), draft.table, draft.sequences, null);
    toast(t("design.newest"));
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
  private goOn(draft: Draft, read: (Parsed & { version: string }) | null): void {
    const { files } = this;
    if (!files.take(t("design.step.draft"), draft.table, draft.sequences, null)) return;
    const { file: name, file_version: version } = draft;
    const base = files.file.peek();
    if (name && name !== base.name) files.file.value = { name, version: "", saved: 0 };
    else if (name && read?.table && version !== base.version) {
      files.file.value = { name, version, saved: 0 };
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

  /** The robot of the draft, of the command line, of the folder, or the workshop's. */
  private async firstRobot(given: SentFile | null, draft: Draft | null): Promise<ReadRobot> {
    try {
      if (draft) {
        const robot = draft.robot as SentFile | null;
        if (robot && draft.robot_version !== null) {
          if (draft.robot_version) this.robot.learn(robot.name, draft.robot_version, null);
          return { ...(await this.robotIn(robot)), isEdited: true };
        }
        const name = this.find((file) => file.slot === "robot" && file.name === robot?.name)?.name;
        return await (name ? this.robotOf(name) : this.robotIn(robot));
      }
      if (given) return await this.robotIn(given);
      const own = this.find((file) => file.slot === "robot");
      return await (own ? this.robotOf(own.name) : this.robotIn(null));
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

/** Whether something was refused for another reason than what is in a file. */
function mayPass(error: unknown): error is Refused {
  return error instanceof Refused && !error.mistakes.length;
}
