/** The table that the teacher handed out last. */

import { computed, signal } from "@preact/signals";
import type { HandedTable } from "../../../core/wire";
import { t } from "../../../i18n";
import type { Files } from "../files/files";
import type { Group } from "../sharing/group";
import type { Membership } from "./membership";

export class Handed {
  /** The newest; null: none. */
  readonly newest = signal<HandedTable | null>(null);
  /** The one that neither the student nor the group has answered yet; null: none. */
  readonly offered = computed(() => {
    const { value } = this.newest;
    const taken = this.group.news.value?.group?.taken ?? 0;
    return value && value.number > Math.max(taken, this.membership.answered) ? value : null;
  });

  constructor(
    private readonly membership: Membership,
    private readonly group: Group,
    private readonly files: Files,
  ) {}

  /** Put it in place of the student's table, in one step. */
  take({ number, title, table, sequences }: HandedTable): void {
    this.files.take(t("design.step.take", { name: title }), table, sequences, "paste");
    this.membership.answer(number);
    // The others' work of now would be gone if each of them took it again.
    if (this.group.news.peek()?.group) void this.group.ask("take", "", number);
  }

  /** Go on with one's own table. */
  putOff({ number }: HandedTable): void {
    this.membership.answer(number);
  }
}
