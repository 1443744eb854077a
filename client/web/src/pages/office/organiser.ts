/** What the organiser's page knows of the contest, and what it asks of the office. */

import { computed, signal } from "@preact/signals";
import { ownToken, pagesUrl } from "../../core/address";
import { Refused } from "../../core/connection";
import { Feed } from "../../core/contest/feed";
import {
  type AnyRequest,
  type ContestLinks,
  Desk,
  type Effect,
  type OfficeView,
  type Overviewed,
  type Said,
  type TeamRow,
} from "../../core/desk";
import type { Phrase } from "../../core/phrase";
import { pagesForAll } from "../../core/served";
import { said, sentence, t } from "../../i18n";
import { toast } from "../../ui/toasts";

const LOOK_MS = 1500;
/** More answers than this become one toast with their number. */
const MANY = 2;

/** The dialog or the paper that is open. */
export type Over =
  | { is: "team"; team: string }
  | { is: "leave"; team: string }
  | { is: "approve"; team: string }
  | { is: "decline"; teams: string[] }
  | { is: "code" }
  | { is: "move"; pairing: string }
  | { is: "rule"; pairing: string }
  | { is: "close" }
  | { is: "draw" }
  | { is: "pause" }
  | { is: "later" }
  | { is: "line" }
  | { is: "undraw" }
  | { is: "staff" }
  | { is: "substitute"; team: string }
  | { is: "paper"; paper: Paper };

export const PAPERS = ["schedule", "results", "certificates", "links"] as const;
/** What can be printed. */
export type Paper = (typeof PAPERS)[number];

/** A request as a part of the page makes it. */
type Wish = AnyRequest extends infer R ? (R extends AnyRequest ? Omit<R, "secret"> : never) : never;

export class Organiser {
  readonly desk = new Desk();
  readonly feed = new Feed();
  readonly view = signal<OfficeView | null>(null);
  readonly links = signal<ContestLinks | null>(null);
  /** Address of the pages for everybody: this page may have been opened at another one. */
  readonly pages = signal(pagesUrl());
  readonly over = signal<Over | null>(null);
  /** Why the last request for the overview failed; null: it did not. */
  readonly trouble = signal<Phrase | null>(null);
  /** The teams that wait for the organiser's decision. */
  readonly waiting = computed<readonly TeamRow[]>(
    () => this.view.value?.teams.filter(({ state }) => state === "waits" || state === "late") ?? [],
  );
  /** Whether closing entries does not draw the first stage: the organiser does that afterwards. */
  readonly closesOnly = computed(() => this.feed.sheet.value?.planned[0]?.draw === "organiser");
  private readonly key = ownToken() ?? "";
  private timer = 0;

  constructor() {
    this.feed.start();
    this.again(0);
  }

  /** Send a request; a refusal is shown in a toast, and the answer is then null. */
  async act<T = Said>(wish: Wish): Promise<T | null> {
    try {
      const answer = await this.desk.ask<T>({ ...wish, secret: this.key } as AnyRequest);
      void this.look();
      return answer;
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      toast(() => sentence(error.why), "no");
      return null;
    }
  }

  /** Send a request, and show in toasts what was done; false: it was refused. */
  async do(wish: Wish): Promise<boolean> {
    const answer = await this.act<Said>(wish);
    const lines = answer?.said ?? [];
    const many = wish.do === "decline" ? "office.doneDeclined" : "office.done";
    if (lines.length > MANY) toast(t(many, { count: lines.length }), "yes");
    else for (const line of lines) toast(() => said(line), "yes");
    return answer !== null;
  }

  /** Ask what a decision would change; null: the question was refused. */
  preview(wish: Wish): Promise<Effect | null> {
    return this.act<Effect>(wish);
  }

  close(): void {
    this.over.value = null;
  }

  /** Get the links of teams, with their QR codes: of one team, or of all. */
  async getLinks(team = ""): Promise<void> {
    this.links.value = null;
    try {
      const wanted = { secret: this.key, team };
      this.links.value = await this.desk.connection.ask<ContestLinks>("links", wanted);
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      toast(() => sentence(error.why), "no");
    }
  }

  private async getPages(): Promise<void> {
    this.pages.value = (await pagesForAll()) || this.pages.peek();
  }

  private again(afterMs: number): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.look(), afterMs);
  }

  private async look(): Promise<void> {
    clearTimeout(this.timer);
    const known = this.view.peek()?.version ?? "";
    try {
      const wish: AnyRequest = { do: "overview", known, secret: this.key };
      const { view } = await this.desk.ask<Overviewed>(wish);
      if (view && !this.view.peek()) await this.getPages();
      if (view) this.view.value = view;
      this.trouble.value = null;
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      // While the connection opens the banner says enough.
      if (this.desk.connection.state.peek().open) this.trouble.value = error.why;
    }
    this.again(LOOK_MS);
  }
}
