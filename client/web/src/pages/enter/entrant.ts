/** What the page knows of a team that enters, and what it asks of the office. */

import { computed, signal } from "@preact/signals";
import { keepToken, ownToken, takePart } from "../../core/address";
import { Refused } from "../../core/connection";
import {
  type AnyRequest,
  Desk,
  type EventInfo,
  type OwnEntry,
  type TeamFiles,
  type TeamLink,
} from "../../core/desk";
import { checkSizes, chosenFiles, chosenNames, forgetAll, keepGiven } from "../../core/files";
import { GIVEN, givenIn } from "../../core/given";
import type { Phrase } from "../../core/phrase";
import type { Mistake, Notice } from "../../core/wire";
import { chosenPicture, forgetPicture } from "./own_picture";

const LOOK_MS = 3000;

/** Keep the files that another page has handed on. */
async function takeGiven(): Promise<void> {
  const given = await givenIn(`#${GIVEN}=${takePart(GIVEN)}`);
  if (given) keepGiven(given.files);
}

export class Entrant {
  readonly desk = new Desk();
  readonly event = signal<EventInfo | null>(null);
  /** What the organiser tells all. */
  readonly notice = computed<Notice | null>(() => {
    const text = (this.entry.value?.event ?? this.event.value)?.announced;
    return text ? { text, paused: false, until_ms: 0, reason: "" } : null;
  });
  /** The entry of the team whose token this browser keeps; null: there is none. */
  readonly entry = signal<OwnEntry | null>(null);
  readonly link = signal<TeamLink | null>(null);
  readonly isWeighing = signal(false);
  /** Why the last files or the last secret were refused. */
  readonly why = signal<Phrase | null>(null);
  readonly mistakes = signal<readonly Mistake[]>([]);
  /** Whether files have just been taken or refused, and nobody was led to the answer yet. */
  readonly answered = signal<"taken" | "refused" | null>(null);

  constructor() {
    void takeGiven();
    // Files that were missing are there now.
    chosenNames.subscribe(() => {
      if (this.why.peek()?.code === "desk.no-files") this.why.value = null;
    });
    setInterval(() => void this.look(), LOOK_MS);
    const { state } = this.desk.connection;
    const stop = state.subscribe(({ open }) => {
      if (open) void this.look();
    });
    addEventListener("pagehide", stop);
  }

  /** Enter with the event's code. */
  apply(code: string, team: string, contact: string, club: string): Promise<boolean> {
    return this.send((files) => ({ do: "apply", secret: code, team, files, contact, club }));
  }

  /** Hand in other files for the team. */
  change(): Promise<boolean> {
    const secret = this.entry.peek()?.token ?? "";
    return this.send((files) => ({ do: "change", secret, files }));
  }

  /** Make room for another team at this computer: it has files of its own. */
  makeRoom(): void {
    forgetAll();
    forgetPicture();
    this.forget();
  }

  private forget(): void {
    keepToken(null);
    this.entry.value = null;
    this.link.value = null;
    this.why.value = null;
    this.mistakes.value = [];
  }

  private async send(request: (files: TeamFiles) => AnyRequest): Promise<boolean> {
    if (this.isWeighing.peek()) return false;
    this.isWeighing.value = true;
    this.why.value = null;
    this.mistakes.value = [];
    try {
      const files = chosenFiles();
      checkSizes(Object.values(files));
      const all = { ...files, picture: chosenPicture() };
      await this.take(await this.desk.ask<OwnEntry>(request(all)));
      this.answered.value = "taken";
      return true;
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      this.why.value = error.why;
      this.mistakes.value = error.mistakes;
      this.answered.value = "refused";
      return false;
    } finally {
      this.isWeighing.value = false;
    }
  }

  private async take(entry: OwnEntry): Promise<void> {
    keepToken(entry.token);
    this.entry.value = entry;
    this.event.value = entry.event;
    if (this.link.peek()?.team !== entry.team) {
      this.link.value = await this.desk.connection.ask<TeamLink>("link", { token: entry.token });
    }
  }

  private async look(): Promise<void> {
    if (!this.desk.connection.state.peek().open || this.isWeighing.peek()) return;
    const token = ownToken();
    try {
      if (token) await this.take(await this.desk.ask<OwnEntry>({ do: "own", secret: token }));
      else this.event.value = await this.desk.ask<EventInfo>({ do: "look" });
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      if (error.why.code !== "desk.no-such-team") return;
      this.forget();
      this.why.value = error.why;
    }
  }
}
