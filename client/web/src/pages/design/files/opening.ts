/** What is opened unasked: the first robot and gait, and what other programs save meanwhile. */

import type { FolderFile, SentFile } from "../../../core/wire";
import { t } from "../../../i18n";
import { toast } from "../../../ui/toasts";
import type { Gateway } from "../gateway";
import type { ReadRobot, RobotInUse } from "../robot/robot";
import type { Files, Parsed, Read } from "./files";

export class Opening {
  private isOpened = false;

  /** @param isTried Whether a trial was made with the table that is there. */
  constructor(
    private readonly gateway: Gateway,
    private readonly files: Files,
    private readonly robot: RobotInUse,
    private readonly isTried: () => boolean,
  ) {}

  /**
   * Open the first things to see, once: a robot, and the folder's first gait, else the sample.
   *
   * @param given The robot of the command line.
   */
  async first(given: SentFile | null): Promise<void> {
    if (this.isOpened) return;
    this.isOpened = true;
    try {
      const robot = await this.firstRobot(given);
      const gait = this.ofFolder("postures") ?? this.ofFolder("locomotion");
      const read = await this.firstTable(gait?.name ?? "");
      const file = read?.version ? { name: gait!.name, version: read.version } : undefined;
      this.files.beginWith(robot, read?.table ?? null, file);
      this.gateway.tell(read?.notes);
    } catch (error) {
      this.isOpened = false;
      this.gateway.refuse(error);
    }
  }

  /** Take in that another program saved a file of the folder. */
  async changed(name: string): Promise<void> {
    if (name === this.robot.name.peek()) {
      await this.files.open(name);
      return;
    }
    const { files } = this;
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
      files.conflict.value = { name, version, table, mistakes: [], when: "open" };
      // Nothing of one's own would be lost.
      if (files.isSaved.peek()) {
        files.takeTheirs();
        toast(t("design.reread", { name }));
      }
    } catch (error) {
      this.gateway.refuse(error);
    }
  }

  /** The robot of the command line, that of the folder, or the workshop's. */
  private async firstRobot(given: SentFile | null): Promise<ReadRobot> {
    try {
      if (given) return await this.robot.read(given.name, new TextDecoder().decode(given.data));
      const own = this.ofFolder("robot");
      if (!own) return await this.robot.read("", null);
      const { name } = own;
      return await this.robot.read(name, (await this.gateway.ask<Read>("read", { name })).robot);
    } catch (error) {
      this.gateway.refuse(error);
      return await this.robot.read("", null);
    }
  }

  /** The table of a file, or of the sample; null where there is none without mistakes. */
  private async firstTable(name: string): Promise<(Parsed & { version: string }) | null> {
    try {
      if (name) return await this.gateway.ask<Read>("read", { name });
      return { ...(await this.gateway.ask<Parsed>("sample")), version: "" };
    } catch (error) {
      this.gateway.refuse(error);
      return null;
    }
  }

  private ofFolder(slot: FolderFile["slot"]): FolderFile | undefined {
    return this.find((file) => file.slot === slot);
  }

  private find(wanted: (file: FolderFile) => boolean): FolderFile | undefined {
    return this.files.folder.peek().files.find(wanted);
  }
}
