/** The gait of a link: what this page shares, and what somebody else has shared with it. */

import { signal } from "@preact/signals";
import { pagesUrl } from "../../../core/address";
import { fragmentOf, gaitIn, hasGait, type LinkedGait } from "../../../core/design/gait_link";
import { columnsOf, fromWire } from "../../../core/design/table";
import { t } from "../../../i18n";
import { toast } from "../../../ui/toasts";
import type { Files, Parsed } from "../files/files";
import { keysFrom, sentGait } from "../files/gait";
import type { Gateway } from "../gateway";
import type { RobotInUse } from "../robot/robot";
import type { Sheet } from "../table/sheet";
import type { Trials } from "../trials/trials";

export class Friend {
  /** The gait that the reader has not answered yet; null: none. */
  readonly offered = signal<LinkedGait | null>(null);

  constructor(
    private readonly gateway: Gateway,
    private readonly sheet: Sheet,
    private readonly robot: RobotInUse,
    private readonly files: Files,
    private readonly trials: Trials,
  ) {}

  /** Offer the gait of this page's address, once: a reload finds an address without it. */
  lookAtAddress(): void {
    if (!hasGait(location.hash)) return;
    void this.offer(location.hash);
    history.replaceState(null, "", location.pathname + location.search);
  }

  /** Offer the gait of a text. */
  async offer(text: string): Promise<void> {
    this.offered.value = await gaitIn(text);
    if (!this.offered.peek()) toast(t("design.friend.damaged"), "no");
  }

  putOff(): void {
    this.offered.value = null;
  }

  /** Put it in place of the own table and robot, in one step, and let it walk. */
  async take({ name, gait, robot, sequences, key }: LinkedGait): Promise<void> {
    this.offered.value = null;
    try {
      const data = new TextEncoder().encode(gait);
      const read = await this.robot.read(robot?.name ?? "", robot?.text ?? null);
      const { table: wire } = await this.gateway.ask<Parsed>("parse", { name, data });
      if (!wire) return;
      const table = fromWire(wire, columnsOf(read.reply));
      const keys = keysFrom(table, sequences);
      const step = t("design.step.take", { name });
      this.sheet.put(step, table, "paste", { keys, robot: { ...read, isEdited: robot !== null } });
      this.trials.press(key);
      await this.trials.tryIt();
    } catch (error) {
      this.gateway.refuse(error);
    }
  }

  /** The address that has the own table, its robot and the key; null while a cell has no angle. */
  async link(): Promise<string | null> {
    const sent = sentGait(this.sheet, this.robot);
    if (!sent) return null;
    const name = this.files.usualName().replace(/\.[^.]*$/, ".txt");
    const { table, sequences } = sent;
    const { data } = await this.gateway.ask<{ data: Uint8Array }>("write", { name, table });
    const used = this.robot.used.peek();
    const fragment = await fragmentOf({
      name,
      gait: new TextDecoder().decode(data),
      robot: used && used.text !== null ? { name: used.name, text: used.text } : null,
      sequences,
      key: this.sheet.key.peek(),
    });
    return `${pagesUrl()}/design${fragment}`;
  }
}
