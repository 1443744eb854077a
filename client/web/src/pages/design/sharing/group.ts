/** The student's group: who is in it, who owns which rows, and what is proposed to whom. */

import { computed, signal } from "@preact/signals";
import { guarded, ownersOf } from "../../../core/design/roles";
import { type Row, setCell, type Table } from "../../../core/design/table";
import type { GroupMember, GroupNews } from "../../../core/wire";
import { t } from "../../../i18n";
import { toast } from "../../../ui/toasts";
import type { Membership } from "../class/membership";
import type { Gateway } from "../gateway";
import { placeName } from "../names";
import type { Sheet } from "../table/sheet";
import type { Sharing } from "./sharing";

/** A proposal in the table as it is now. */
export interface Proposal {
  /** Name of its entry. */
  name: string;
  row: number;
  col: number;
  text: string;
  by: string;
  /** Whether this student may take it in. */
  isMine: boolean;
}

export class Group {
  /** null: there is no class. */
  readonly news = signal<GroupNews | null>(null);
  readonly members = computed<readonly GroupMember[]>(() => this.news.value?.group?.members ?? []);
  /** What is proposed for rows that are in the table. */
  readonly proposals = computed<readonly Proposal[]>(() => {
    const table = this.sheet.table.value;
    return this.sharing.proposals.value.flatMap(({ name, key, col, text, by }) => {
      const row = table?.rows.findIndex((one) => one.key === key) ?? -1;
      if (!table || row < 0 || table.kind !== "postures") return [];
      const isMine = !this.isForeign(table, table.rows[row]!);
      return [{ name, row, col, text, by, isMine }];
    });
  });

  constructor(
    private readonly gateway: Gateway,
    private readonly sheet: Sheet,
    private readonly sharing: Sharing,
    private readonly membership: Membership,
  ) {}

  /** Ask the gateway to join, leave, take a role, vote for a word or take what was handed out. */
  async ask(
    act: "join" | "leave" | "role" | "word" | "take",
    text = "",
    number = 0,
  ): Promise<void> {
    try {
      await this.gateway.ask("group", { act, text, number });
    } catch (error) {
      this.gateway.refuse(error);
    }
  }

  /** The nickname. */
  me(): string {
    return this.membership.name.value ?? "";
  }

  /** The members who own a row. */
  owners(table: Table, row: Row): readonly GroupMember[] {
    return ownersOf(table, row, this.members.value);
  }

  /** The colour of a member; 0: no member. */
  colour(name: string): number {
    return this.members.value.findIndex((member) => member.name === name) + 1;
  }

  /** An edit without its changes of rows that others own: those are proposed to them. */
  guard(before: Table, after: Table): Table {
    const { table, proposed } = guarded(before, after, (row) => this.isForeign(before, row));
    const first = proposed[0];
    if (!first) return table;
    this.sharing.propose(before, proposed, this.membership.name.peek() ?? "");
    const at = before.rows.indexOf(first.row);
    const names = this.owners(before, first.row).map(({ name }) => name);
    const values = {
      name: names.join(", "),
      place: placeName(before, at, first.col),
      count: proposed.length,
    };
    toast(t(proposed.length > 1 ? "design.group.proposedMany" : "design.group.proposed", values));
    return table;
  }

  /** Take a proposal in. */
  takeIn(proposal: Proposal): void {
    const { row, col, text, name, by } = proposal;
    this.sheet.edit(
      t("design.group.step", { name: by }),
      (now) => setCell(now, row, col, text),
      null,
      null,
    );
    this.sharing.dismiss([name]);
  }

  /** Let go of proposals. */
  dismiss(proposals: readonly Proposal[]): void {
    this.sharing.dismiss(proposals.map(({ name }) => name));
  }

  private isForeign(table: Table, row: Row): boolean {
    const owners = this.owners(table, row);
    const own = this.membership.name.value;
    return owners.length > 0 && owners.every(({ name }) => name !== own);
  }
}
