/** The way of the table to a court: to practice. */

import { signal } from "@preact/signals";
import { enterPage, fragmentOf, type GivenFiles } from "../../../core/given";
import { t } from "../../../i18n";
import { toast } from "../../../ui/toasts";
import type { Gateway } from "../gateway";
import type { RobotInUse } from "../robot/robot";
import type { Sheet } from "../table/sheet";
import { sentGait } from "./gait";

export class Court {
  /** Where it leads; null: nowhere, as in a class. */
  readonly leads = signal<"practice" | null>(null);
  readonly isGoing = signal(false);
  /** Address of the court's page where the browser has let no tab be opened; "": it has. */
  readonly blocked = signal("");

  constructor(
    private readonly gateway: Gateway,
    private readonly sheet: Sheet,
    private readonly robot: RobotInUse,
  ) {}

  /**
   * Take the table to the page on which teams enter a contest, in a new tab. Only a click may call
   * this.
   *
   * @param address Of the contest's pages.
   */
  async handOn(address: string): Promise<void> {
    const { gateway, sheet } = this;
    const page = enterPage(address);
    if (!page) {
      toast(t("design.handOn.noAddress"), "no");
      return;
    }
    const gait = sentGait(sheet, this.robot);
    if (!gait) {
      sheet.select(sheet.bad.peek()[0]!);
      toast(t("design.badCells", { count: sheet.bad.peek().length }), "no");
      return;
    }
    this.blocked.value = "";
    const tab = window.open("about:blank");
    try {
      const files = await gateway.ask<GivenFiles>("hand_on", gait);
      const url = page + (await fragmentOf({ files, sequences: null, key: null }));
      if (tab) tab.location.replace(url);
      else this.blocked.value = url;
    } catch (error) {
      tab?.close();
      gateway.refuse(error);
    }
  }

  /** Take the table there, and open its page in a new tab. Only a click may call this. */
  async go(): Promise<void> {
    const { gateway, sheet } = this;
    if (this.isGoing.peek()) return;
    const gait = sentGait(sheet, this.robot);
    if (!gait) {
      sheet.select(sheet.bad.peek()[0]!);
      toast(t("design.badCells", { count: sheet.bad.peek().length }), "no");
      return;
    }
    this.isGoing.value = true;
    this.blocked.value = "";
    gateway.trouble.value = null;
    // A browser opens a tab only at once after a click, not when the reply comes.
    const tab = window.open("about:blank");
    try {
      const { url } = await gateway.ask<{ url: string }>("play", gait);
      if (tab) tab.location.replace(url);
      else this.blocked.value = url;
    } catch (error) {
      tab?.close();
      gateway.refuse(error);
    } finally {
      this.isGoing.value = false;
    }
  }
}
