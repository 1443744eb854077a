/** The gait of a link: what this page shares, and what somebody else has shared with it. */

import { signal } from "@preact/signals";
import { pagesUrl, takePart } from "../../../core/address";
import { columnsOf, fromWire } from "../../../core/design/table";
import { fragmentOf, GIVEN, type Given, givenIn, hasGiven } from "../../../core/given";
import type { SentFile } from "../../../core/wire";
import { t } from "../../../i18n";
import { toast } from "../../../ui/toasts";
import type { Files, Parsed } from "../files/files";
import { keysFrom, sentGait } from "../files/gait";
import type { Gateway } from "../gateway";
import type { RobotInUse } from "../robot/robot";
import type { Sheet } from "../table/sheet";
import type { Trials } from "../trials/trials";

/** A gait that somebody else has shared. */
interface SharedGait extends Pick<Given, "sequences" | "key"> {
  gait: SentFile;
  /** null: the workshop's hexapod. */
  robot: SentFile | null;
}

export class Friend {
  /** The gait that the reader has not answered yet; null: none. */
  readonly offered = signal<SharedGait | null>(null);

  constructor(
    private readonly gateway: Gateway,
    private readonly sheet: Sheet,
    private readonly robot: RobotInUse,
    private readonly files: Files,
    private readonly trials: Trials,
  ) {}

  /** Offer the gait of this page's address, once. */
  lookAtAddress(): void {
    if (hasGiven(location.hash)) void this.offer(`#${GIVEN}=${takePart(GIVEN)}`);
  }

  /** Offer the gait of a text. */
  async offer(text: string): Promise<void> {
    const { files, sequences = null, key = null } = (await givenIn(text)) ?? {};
    const gait = files?.postures ?? files?.locomotion;
    this.offered.value = gait ? { gait, robot: files!.robot, sequences, key } : null;
    if (!gait) toast(t("design.friend.damaged"), "no");
  }

  putOff(): void {
    this.offered.value = null;
  }

  /** Put it in place of the own table and robot, in one step, and let it walk. */
  async take({ gait, robot: file, sequences, key }: SharedGait): Promise<void> {
    this.offered.value = null;
    try {
      const text = file && new TextDecoder().decode(file.data);
      const read = await this.robot.read(file?.name ?? "", text);
      const { table: wire } = await this.gateway.ask<Parsed>("parse", { ...gait });
      if (!wire) return;
      const table = fromWire(wire, columnsOf(read.reply));
      const keys = keysFrom(table, sequences);
      const step = t("design.step.take", { name: gait.name });
      this.sheet.put(step, table, "paste", { keys, robot: { ...read, isEdited: file !== null } });
      if (key !== null) this.trials.press(key);
      await this.trials.tryIt();
    } catch (error) {
      this.gateway.refuse(error);
    }
  }

  /** The address that has the own table, its robot and the key; null while a cell has no angle. */
  async link(): Promise<string | null> {
    const sent = sentGait(this.sheet, this.robot);
    if (!sent) return null;
    const { table, robot, sequences } = sent;
    const name = this.files.usualName().replace(/\.[^.]*$/, ".txt");
    const { data } = await this.gateway.ask<{ data: Uint8Array }>("write", { name, table });
    const slots = { postures: null, locomotion: null, [table.kind]: { name, data } };
    const fragment = await fragmentOf({
      files: { robot, ...slots },
      sequences,
      key: this.sheet.key.peek(),
    });
    return `${pagesUrl()}/design${fragment}`;
  }
}
