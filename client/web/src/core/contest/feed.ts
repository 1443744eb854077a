/** Gets the newest sheet of a contest again and again: from a gateway, or from a published folder. */

import { signal } from "@preact/signals";
import { answerOf } from "../answer";
import { type ContestSheet, stateOf, VERSION } from "./sheet";

/** Beside the page, wherever that is. */
const ADDRESS = "contest.json";
const AGAIN_MS = 2000;
/** After the end nothing changes but by a decision. */
const OVER_MS = 20_000;

/** Why there is no newer sheet: name of a message `contest.trouble.…`. */
export type Trouble = "missing" | "lost" | "outdated";

export class Feed {
  readonly sheet = signal<ContestSheet | null>(null);
  readonly trouble = signal<Trouble | null>(null);
  /** How much later a newer sheet is shown: no result may come before its late picture [ms]. */
  behindMs = 0;
  #newest: ContestSheet | null = null;
  #text = "";
  #timer = -1;
  #users = 0;

  /** Begin; the function that is returned ends it. Several parts of a page may use one feed. */
  start(): () => void {
    if (this.#users++ === 0) {
      this.#timer = 0;
      document.addEventListener("visibilitychange", this.#back);
      void this.#look();
    }
    let isUsed = true;
    return () => {
      if (isUsed && --this.#users === 0) {
        document.removeEventListener("visibilitychange", this.#back);
        clearTimeout(this.#timer);
        this.#timer = -1;
      }
      isUsed = false;
    };
  }

  #back = () => {
    if (!document.hidden) void this.#look();
  };

  async #look(): Promise<void> {
    clearTimeout(this.#timer);
    if (!document.hidden) this.trouble.value = await this.#get();
    if (this.#timer < 0) return;
    clearTimeout(this.#timer); // two looks at once
    const now = this.#newest;
    const waitMs = now && stateOf(now) === "over" ? OVER_MS : AGAIN_MS;
    this.#timer = window.setTimeout(() => void this.#look(), waitMs);
  }

  /** Show a sheet; at once if there is none yet. */
  #show(sheet: ContestSheet): void {
    this.#newest = sheet;
    const show = () => {
      this.sheet.value = sheet;
    };
    if (this.behindMs && this.sheet.peek()) window.setTimeout(show, this.behindMs);
    else show();
  }

  async #get(): Promise<Trouble | null> {
    try {
      // The browser asks whether its copy is still the newest, and gets it again only if not.
      const response = await answerOf(ADDRESS, { cache: "no-cache" });
      if (response.status === 404) return "missing";
      if (!response.ok) return "lost";
      const text = await response.text();
      if (text === this.#text) return null;
      const sheet = JSON.parse(text) as ContestSheet;
      if (sheet.version !== VERSION) return "outdated";
      this.#text = text;
      this.#show(sheet);
      return null;
    } catch {
      return "lost"; // no answer, or half a file
    }
  }
}

/** The sheet of the contest for pages that show a match of it. */
export const eventFeed = new Feed();
