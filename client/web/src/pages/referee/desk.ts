/** The referee's desk: the acting referee, the legal decisions, and their answers. */

import { computed, effect, type ReadonlySignal, signal } from "@preact/signals";
import { keepToken, ownToken } from "../../core/address";
import { Refused, Unanswered } from "../../core/connection";
import type { Court } from "../../core/court";
import { part, phaseOf } from "../../core/match";
import type { Phrase } from "../../core/phrase";
import { remembered } from "../../core/settings";
import { tab } from "../../core/storage";
import {
  type Decision,
  type DecisionName,
  type DecisionReply,
  type Outlook,
  Phase,
  SeatFlag,
} from "../../core/wire";
import { said, sentence, t } from "../../i18n";
import { toast } from "../../ui/toasts";
import type { Draft } from "./drafts";

const RETRY_MS = 1500;
/** Decisions that need a halt, or are mostly made in one. */
const FOR_HALTS = new Set<DecisionName>(["take-back", "restart", "freeze", "set", "adjust"]);

/** The court's newest answer to a decision: done, refused, or no answer. */
export interface Answer {
  tone: "yes" | "no" | "plain";
  what: Phrase | string;
  /** When it came, by `performance.now()`. */
  atMs: number;
}

/** An older answer is not shown any more. */
export const ANSWER_MS = 20_000;
/** A phase within this time belongs to the answer; a later phase hides the answer. */
const BELONGS_MS = 1500;

/** A decision that begins, stops or goes on with play: taken without a question. */
/** Why a match is mostly halted: codes of the table. */
export const COMMON_REASONS = [
  "reason.fell-over",
  "reason.stuck",
  "reason.network",
  "reason.rule",
] as const;

export type Step = "start" | "halt" | "resume";

/** So long after a step a click may still be the second of a double one. */
const SECOND_CLICK_MS = 700;

export class Desk {
  /** True if the court has accepted this page's token. */
  readonly entered = signal(false);
  readonly busy = signal(false);
  /** Why entering failed; "" if it did not. */
  readonly refused = signal<Phrase | string>("");
  /** Kept beside the token, for this tab alone: another tab may be another referee's. */
  readonly by = remembered("referee.name", "", tab);
  /** The name that the card offers: the last one that entered in this browser. */
  readonly lastName = remembered("referee.name", "");
  readonly answer = signal<Answer | null>(null);
  /** Whether this page may decide now. */
  readonly mine: ReadonlySignal<boolean>;
  readonly phase: ReadonlySignal<number>;
  /** The sensible next decision. */
  readonly next: ReadonlySignal<DecisionName>;
  /** The next decision became another a moment ago: a click may have been meant for the last. */
  readonly fresh = signal(true);
  /** What the open dialog asks for. */
  readonly draft = signal<Draft | null>(null);
  /** Match and beat in which the phase began. */
  private readonly since = signal<readonly [match: number, beat: number]>([0, 0]);
  private readonly flagsOf: ReadonlySignal<number>[] = [];
  private justTaken: Step | null = null;
  /** False once another referee's page acted: after a break this page leaves it to that one. */
  private acts = true;

  constructor(readonly court: Court) {
    this.mine = computed(() => this.entered.value && court.referee.value?.mine === true);
    this.phase = phaseOf(court);
    this.next = computed(() => nextStep(this.phase.value));
    const match = part(court, (frame) => frame.match, 0);
    effect(() => {
      this.phase.value; // counts from the frame that brings another phase
      this.since.value = [match.value, court.frame.peek()?.beat ?? 0];
    });
    effect(() => {
      this.phase.value;
      const answer = this.answer.peek();
      if (answer && performance.now() - answer.atMs > BELONGS_MS) this.answer.value = null;
    });
    effect(() => {
      const answer = this.answer.value;
      if (!answer) return;
      const timer = setTimeout(() => {
        this.answer.value = null;
      }, ANSWER_MS);
      return () => clearTimeout(timer);
    });
    effect(() => {
      this.next.value; // counts from each change
      this.fresh.value = true;
      const timer = setTimeout(() => {
        this.fresh.value = false;
      }, SECOND_CLICK_MS);
      return () => clearTimeout(timer);
    });
    effect(() => {
      if (!court.connection.state.value.open) this.entered.value = false;
    });
    effect(() => {
      const state = court.referee.value;
      if (this.entered.value && state?.acting) this.acts = state.mine;
    });
    // A new connection, also after a reload, sits down again with the tab's token.
    effect(() => {
      const token = ownToken();
      const known = court.welcome.value && court.referee.value;
      const away = !this.entered.peek() && !this.busy.peek();
      if (known && token && this.by.peek() && away) this.again(token);
    });
  }

  /** Show a token; kept for this tab if the court takes it. */
  async enter(token: string, by: string, acts = true): Promise<void> {
    this.busy.value = true;
    this.refused.value = "";
    this.by.value = this.lastName.value = by;
    try {
      await this.court.ask("enter", { token, by, acts });
      keepToken(token);
      this.entered.value = true;
    } catch (error) {
      this.refused.value = reasonOf(error);
      if (error instanceof Refused && error.tokenRefused) keepToken(null);
    } finally {
      this.busy.value = false;
    }
  }

  /** Leave the desk: the token is forgotten. */
  leave(): void {
    keepToken(null);
    location.reload();
  }

  async takeOver(): Promise<void> {
    try {
      await this.court.ask("take_over");
      this.say("yes", t("referee.youAct"));
    } catch (error) {
      this.say("no", reasonOf(error));
    }
  }

  /**
   * Decide.
   *
   * @returns Why it can be changed and asked again; "" once it is done, and where the answer was
   *   lost: to ask again could do it twice.
   */
  async decide(decision: Decision, reason: Phrase | string): Promise<Phrase | string> {
    try {
      const reply = await this.court.ask<DecisionReply>("decide", { decision, reason });
      this.say("yes", reply.said);
      return "";
    } catch (error) {
      if (error instanceof Unanswered) {
        this.say("plain", t("referee.unanswered"));
        return "";
      }
      const why = reasonOf(error);
      this.say("no", why);
      return why;
    }
  }

  /** Take a step of the match; the second click of a double one does not take it again. */
  async step(type: Step, reason: Phrase | string = ""): Promise<void> {
    if (this.justTaken === type) return;
    this.justTaken = type;
    await this.decide({ type }, reason);
    setTimeout(() => {
      if (this.justTaken === type) this.justTaken = null;
    }, SECOND_CLICK_MS);
  }

  /** What a take-back would do; nothing is changed. Rejects with `Refused`. */
  tryTakeBack(event: number): Promise<DecisionReply> {
    const decision: Decision = { type: "take-back", event, dry_run: true };
    return this.court.ask<DecisionReply>("decide", { decision, reason: "" });
  }

  /**
   * What would happen if play went on; nothing is changed. Rejects with `Refused`.
   *
   * @param decision What would be decided before; null: nothing.
   */
  lookAhead(decision: Decision | null): Promise<Outlook> {
    return this.court.ask<Outlook>("outlook", { decision });
  }

  /** Why this page can't decide anything now; "" if it can. */
  closed(): string {
    if (!this.court.connection.state.value.open || !this.court.live.value) return t("referee.lost");
    if (!this.entered.value) return t("referee.notEntered");
    if (this.mine.value) return "";
    const acting = this.court.referee.value?.acting;
    return acting ? t("referee.otherActs", { name: acting }) : t("referee.nobodyActs");
  }

  /** Why a decision is not open now, in the reader's language; "" if it is. */
  whyNot(name: DecisionName): string {
    return this.closed() || said(this.illegal(name));
  }

  /** Why a decision about one seat is not open now. */
  whyNotFor(name: DecisionName, seat: number): string {
    const why = this.whyNot(name);
    if (why) return why;
    const flags = this.flags(seat).value;
    if (name === "unfreeze" && !(flags & SeatFlag.FROZEN)) return t("referee.notFrozen");
    if (name !== "ready") return "";
    if (!(flags & SeatFlag.JOINED)) return t("referee.notJoined");
    return flags & SeatFlag.READY ? t("referee.isReady") : "";
  }

  /** The flags of a seat. */
  flags(seat: number): ReadonlySignal<number> {
    this.flagsOf[seat] ??= part(this.court, (frame) => frame.seats[seat]?.flags ?? 0, 0);
    return this.flagsOf[seat];
  }

  private illegal(name: DecisionName): Phrase | string {
    const health = this.court.health.value;
    if (!health) return { code: "hold.lost" };
    const why = health.decisions[name] ?? "";
    // Legality comes twice a second. Where the phase is newer, its one next step is open already, and
    // in a halt what referees halt for; the court itself still judges each decision.
    const [match, beat] = this.since.value;
    const outdated = health.match !== match || health.beat < beat;
    const phase = this.phase.value;
    const isNext = phase >= Phase.READY && this.next.value === name;
    const isForHalt = phase === Phase.HALTED && FOR_HALTS.has(name);
    return outdated && (isNext || isForHalt) ? "" : why;
  }

  private async again(token: string): Promise<void> {
    await this.enter(token, this.by.peek(), this.acts);
    if (this.entered.peek() || ownToken() !== token) return;
    setTimeout(() => {
      const open = this.court.connection.state.peek().open;
      if (open && !this.entered.peek() && !this.busy.peek()) this.again(token);
    }, RETRY_MS);
  }

  private say(tone: Answer["tone"], what: Phrase | string): void {
    this.answer.value = { tone, what, atMs: performance.now() };
    toast(() => sentence(what), tone);
  }
}

/** The sensible next decision of a phase. */
function nextStep(phase: number): DecisionName {
  switch (phase) {
    case Phase.COUNTDOWN:
    case Phase.PLAYING:
      return "halt";
    case Phase.HALTED:
      return "resume";
    case Phase.FINISHED:
      return "official";
    case Phase.OFFICIAL:
    case Phase.VOID:
      return "next";
    default:
      return "start";
  }
}

/** What went wrong, as the court or the gateway said it. */
export function reasonOf(error: unknown): Phrase | string {
  return error instanceof Refused ? error.why : String(error);
}
