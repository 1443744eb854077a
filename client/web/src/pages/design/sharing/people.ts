/** Who else has the table open, where they are, and what they type there. */

import { computed, effect, signal } from "@preact/signals";
import type { Person } from "../../../core/wire";
import { t } from "../../../i18n";
import { toast } from "../../../ui/toasts";
import type { Membership } from "../class/membership";
import type { Gateway } from "../gateway";
import { placeName } from "../names";
import type { Place, Sheet } from "../table/sheet";

/** Where this page is, is told at most so often. */
const PACE_MS = 150;
export class People {
  private readonly all = signal<readonly Person[]>([]);
  private readonly me = signal(0);
  /** The other pages. */
  readonly others = computed(() => this.all.value.filter(({ id }) => id !== this.me.value));
  /** The others by the cell where they are. */
  readonly places = computed(
    () => new Map(this.others.value.map((person) => [`${person.row} ${person.col}`, person])),
  );
  private told = "";
  private timer = 0;

  constructor(
    private readonly gateway: Gateway,
    private readonly sheet: Sheet,
    private readonly membership: Membership,
  ) {
    effect(() => {
      // Nobody is there who would see it.
      if (!this.others.value.length || !this.sheet.table.value) return;
      const { row, col } = this.sheet.active.value;
      const draft = this.sheet.draft.value;
      this.plan({ row, col, typing: draft === null ? null : String(draft) });
    });
  }

  /** A new connection knows nothing of where this page is. */
  greet(): void {
    this.told = "";
  }

  take({ me, people }: { me: number; people: Person[] }): void {
    this.me.value = me;
    this.all.value = people;
  }

  /** What a page is called here. */
  name({ id, name }: Person): string {
    const isOwn = !name || name === this.membership.name.value;
    return isOwn ? t("design.people.window", { number: id }) : name;
  }

  /** Say that this page and another one typed into the same cells. */
  clashed(places: readonly Place[], by: number): void {
    const table = this.sheet.table.peek();
    const person = this.all.peek().find(({ id }) => id === by);
    const first = places[0];
    if (!table || !person || !first) return;
    const values = {
      name: this.name(person),
      place: placeName(table, first.row, first.col),
      angle: `${table.rows[first.row]!.cells[first.col]}°`,
      count: places.length,
    };
    toast(t(places.length > 1 ? "design.people.clashes" : "design.people.clash", values), "no");
  }

  private plan(place: object): void {
    const now = JSON.stringify(place);
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => {
      if (now === this.told) return;
      this.told = now;
      this.gateway.ask("place", place).catch(() => undefined);
    }, PACE_MS);
  }
}
