/** A contestant: holds a seat through a gateway, sends keys, sees what became of them. */

import { batch, computed, effect, type ReadonlySignal, signal, untracked } from "@preact/signals";
import {
  type Claim,
  type ClaimEffect,
  type ClaimEvent,
  type ClaimState,
  claimOf,
  keptWish,
  step,
  type Wish,
} from "./claim";
import type { Refused } from "./connection";
import type { Court } from "./court";
import { checkSizes, chosenFiles, chosenNames, chosenSequences } from "./files";
import { gainsOf } from "./gains";
import { movesOf } from "./moves";
import type { Phrase } from "./phrase";
import { type PosData, PosDataLog } from "./posdata";
import { type RefusedKey, SentKeys } from "./sent_keys";
import { tab } from "./storage";
import { Return } from "./way";
import {
  BEAT_S,
  type Frame,
  type Gains,
  type HeldSeat,
  Phase,
  REPEATS_HZ,
  SeatFlag,
  type SeatFrame,
} from "./wire";

/** The state of the claim to a seat, as the page shows it. */
export type Standing = "watching" | "outside" | "joining" | "seated" | "lost" | "left";

/** What the player has to say: words of the court, or a key that it refused. */
export type Word = { said: Phrase; tone: "plain" | "yes" | "no" } | RefusedKey;

const KEPT_AS = "lacoc.wish";
const HELD = "held";
const LOST = "lost";
/** Seats that are not this page's any more. */
const TAKEN: ReadonlySet<string> = new Set(["replaced", "refused"]);
/** Notes that say which files a seat has, because none were sent. */
const ABOUT_FILES: ReadonlySet<string> = new Set(["note.files-sample", "note.files-kept"]);
const AGAIN_MS = 1500;
/** Frames never come in step with the clock: the one that is nearest to its time counts. */
const SIGN_MS = 1000 / REPEATS_HZ - 500 * BEAT_S;
const REMEMBERED = 64;

/** What a claim shows while no seat is held. */
const SHOWN: Readonly<Record<ClaimState, Standing>> = {
  none: "outside",
  joining: "outside",
  holding: "joining",
  changing: "joining",
  leaving: "outside",
  left: "left",
  lost: "lost",
};

export class Player {
  readonly level: ReadonlySignal<number>;
  readonly standing: ReadonlySignal<Standing>;
  /** Index of the held seat; -1: none. */
  readonly index: ReadonlySignal<number>;
  /** Whether a first join is asked for, now or as soon as there is a court. */
  readonly isWaiting: ReadonlySignal<boolean>;
  /** Whether keys go anywhere now. */
  readonly canSteer: ReadonlySignal<boolean>;
  /** How the claim to a seat stands. */
  readonly claim = signal<Claim>(claimOf(kept()));
  /** Number of the session that held the seat last; 0: unknown. */
  private readonly session = signal(kept()?.session ?? 0);
  private readonly coming = new Return();
  /** From the newest key to the frame that shows it, as this page saw both. */
  readonly tripMs = signal<number | null>(null);
  /** The newest keys that were sent, the newest last. */
  readonly pressed = signal<readonly { level: number; key: number }[]>([]);
  /** What the robot would gain next; null while it can't gain anything. */
  readonly gains: ReadonlySignal<Gains | null>;
  /** What each key of level B does, up to the first that the court has not tried. */
  readonly moves: ReadonlySignal<readonly string[]>;
  /** What comes after this match, as the office says; null: the court goes on with the team. */
  readonly next = signal<Phrase | null>(null);
  /** How many keys were sent. */
  readonly sentCount = signal(0);
  /** The wish, unless it is known to be for another court: a tab's address may change. */
  private readonly wishHere: ReadonlySignal<Wish | null>;
  private readonly greeted = signal(false);
  private readonly chosenLevel = signal<number | null>(null);
  private heeded: HeldSeat | null = null;
  /** Sequence numbers restart with a new controller. */
  private sent = new SentKeys();
  private isFresh = true;
  private readonly posData = new PosDataLog();
  private readying = false;
  private signedMs = Number.NEGATIVE_INFINITY;

  /**
   * @param court The court, watched at 50 Hz.
   * @param say Told what a contestant should hear.
   * @param alone Practice: nobody judges, so the page says ready by itself.
   */
  constructor(
    readonly court: Court,
    private readonly say: (word: Word) => void,
    private readonly alone: boolean,
  ) {
    this.wishHere = computed(() => {
      const { wish } = this.claim.value;
      const welcome = court.welcome.value;
      return !welcome || welcome.court === wish?.court ? wish : null;
    });
    this.index = computed(() => (this.isHeld() ? (court.seat.value?.index ?? -1) : -1));
    this.gains = gainsOf(court, this.index);
    this.moves = movesOf(court, this.index);
    this.standing = computed(() => this.stand());
    this.isWaiting = computed(
      () => this.wishHere.value !== null && this.claim.value.state === "joining",
    );
    this.level = computed(() => this.levelNow());
    this.canSteer = computed(
      () =>
        court.seat.value?.hold === HELD && court.live.value && court.connection.state.value.open,
    );
    this.follow();
  }

  /** Rows for Pos-data.txt. */
  get data(): PosData | null {
    return this.posData.current;
  }

  /** The seat as the newest frame has it; null while none is held. Read it with `peek` only. */
  seatNow(): SeatFrame | null {
    return this.court.frame.peek()?.seats[this.index.peek()] ?? null;
  }

  /** A part of the held seat, as a signal that changes only when the part does. */
  part<T extends string | number | boolean>(of: (seat: SeatFrame) => T, otherwise: T) {
    return computed(() => {
      const seat = this.court.frame.value?.seats[this.index.value];
      return seat ? of(seat) : otherwise;
    });
  }

  /** Ask for a seat as soon as there is a court, and keep it through every break from then on. */
  join(wish: Wish): void {
    this.tell({ is: "join", wish });
  }

  /** Send the chosen files again; the court answers whether it takes them. */
  rejoin(): void {
    // A match keeps the files that it began with. Nobody minds when one of practice ends: the
    // next opens at once.
    this.tell({ is: "change", renews: this.alone && this.isHeld() });
  }

  /** The seat that is held, and the one that is wanted at a court; "": none. */
  seats(court: string): { held: string; wanted: string } {
    const { wish } = this.claim.peek();
    const held = this.isHeld() ? (this.court.seat.peek()?.seat ?? "") : "";
    return { held, wanted: wish?.court === court ? wish.seat : "" };
  }

  /** Take another seat than the one that is held, which belongs to another team now. */
  moveTo(wish: Wish): void {
    this.court.seat.value = null;
    this.join(wish);
  }

  /** The match is over for this team: it has no seat until it joins again. */
  rest(): void {
    this.forget();
    // The gateway ends the hold when it is greeted.
    void this.court.connection.greetAgain();
  }

  /** Go back to the card, from having left or lost the seat. */
  forget(): void {
    this.tell({ is: "forget" });
  }

  /** Give the seat up. */
  leave(): void {
    this.tell({ is: "leave" });
  }

  /** Say ready, or take it back. */
  async ready(ready: boolean): Promise<void> {
    try {
      await this.court.ask("ready", { ready });
    } catch (error) {
      this.say({ said: (error as Refused).why, tone: "no" });
    }
  }

  /** The next of the open levels; that alone sends nothing (rules 3). */
  changeLevel(to?: number): void {
    const levels = this.court.sheet.peek()?.levels ?? [];
    const following = levels[(levels.indexOf(this.level.peek()) + 1) % levels.length];
    this.chosenLevel.value = to ?? following ?? 0;
  }

  /** Send a key: a digit, or `RESTART_KEY`. */
  async press(key: number, atMs: number): Promise<void> {
    if (!this.canSteer.peek()) return;
    const level = this.level.peek();
    // On its way before anything is drawn.
    const seen = this.court.timeline.seen(performance.now());
    const reply = this.court.ask<{ seq: number }>("key", { level, key, ...seen });
    batch(() => {
      this.pressed.value = [...this.pressed.peek().slice(1 - REMEMBERED), { level, key }];
      this.sentCount.value += 1;
    });
    try {
      const { seq } = await reply;
      this.tripMs.value = this.sent.add(seq, key, atMs) ?? this.tripMs.peek();
      const seat = this.seatNow();
      if (seat) this.hearRefusal(seat);
    } catch (error) {
      this.say({ said: (error as Refused).why, tone: "no" });
    }
  }

  private isHeld(): boolean {
    const hold = this.court.seat.value?.hold;
    return hold === HELD || hold === LOST;
  }

  private stand(): Standing {
    const welcome = this.court.welcome.value;
    if (this.isHeld()) return "seated";
    const isElsewhere = this.alone && welcome?.home !== "practice";
    if (welcome && (!welcome.can_act || isElsewhere)) return "watching";
    const { state, wish } = this.claim.value;
    return wish && !this.wishHere.value ? "outside" : SHOWN[state];
  }

  private levelNow(): number {
    const sheet = this.court.sheet.value;
    const levels = sheet?.levels ?? [];
    const chosen = this.chosenLevel.value;
    if (chosen !== null && levels.includes(chosen)) return chosen;
    const keys = sheet?.seats[this.index.value]?.keys;
    return levels.find((level) => keys?.[level as 0 | 1].length) ?? levels[0] ?? 0;
  }

  private follow(): void {
    const { court } = this;
    effect(() => {
      if (!court.connection.state.value.open) this.greeted.value = false;
    });
    effect(() => {
      if (court.welcome.value) this.greeted.value = true;
    });
    const keeps = computed(() => keptWish(this.claim.value));
    effect(() => {
      const held = keeps.value && { ...keeps.value, session: this.session.value };
      tab.write(KEPT_AS, held && JSON.stringify(held));
    });
    const version = computed(() => court.ownFiles.value?.version);
    effect(() => {
      chosenNames.value; // changes also when a file is replaced by one of the same name
      version.value;
      untracked(() => this.tell({ is: "mended" }));
    });
    effect(() => this.heed());
    effect(() => {
      const frame = court.frame.value;
      if (frame) untracked(() => this.see(frame));
    });
  }

  /** Tell the claim what the court says of the seat, and when it can be asked for it. */
  private heed(): void {
    const { court } = this;
    const seat = court.seat.value;
    const isNew = seat !== this.heeded;
    this.heeded = seat;
    // A seat that the page has left for another one is nobody's loss.
    const isOwn = seat?.seat === (untracked(() => this.claim.value.wish)?.seat ?? seat?.seat);
    if (isNew && seat && isOwn && TAKEN.has(seat.hold)) {
      untracked(() =>
        this.tell({ is: "taken", why: seat.reason || { code: `hold.${seat.hold}` } }),
      );
    }
    if (seat?.session) this.session.value = seat.session;
    // Also after a break of the page, the gateway or the link; a court that was only restarted is
    // asked again by the gateway.
    const isOpen =
      this.greeted.value && court.welcome.value?.can_act && court.link.value?.connected;
    const wish = this.wishHere.value;
    if (!isOpen || !wish || this.claim.value.request !== "none" || this.isHeld()) return;
    const to = keptWish(this.claim.value) ? this.lookBack(wish.seat) : "ask";
    if (to === "ask") untracked(() => this.tell({ is: "open" }));
    if (to === "yield") untracked(() => this.tell({ is: "taken", why: { code: "hold.replaced" } }));
  }

  /** Whether the page may take again, unasked, the seat that it held before a break. */
  private lookBack(seat: string) {
    return this.coming.look(this.court.health.value, seat, this.session.value, performance.now());
  }

  private tell(event: ClaimEvent): void {
    batch(() => {
      const [claim, effects] = step(this.claim.peek(), event);
      this.claim.value = claim;
      for (const todo of effects) this.perform(todo, claim, event);
    });
  }

  private perform(todo: ClaimEffect, { wish }: Claim, event: ClaimEvent): void {
    switch (todo) {
      case "ask":
        if (wish) void this.ask(wish);
        break;
      case "begin":
        if (event.is === "granted") this.begin(event.wish.seat, event.index);
        break;
      case "rest":
        setTimeout(() => this.tell({ is: "rested" }), AGAIN_MS);
        break;
      case "drop":
        this.court.seat.value = null;
        break;
      case "renew":
        this.court.ask("leave").catch(() => undefined);
        break;
      case "release":
        void this.release();
        break;
      case "clear":
        this.pressed.value = [];
        break;
    }
  }

  private async ask(wish: Wish): Promise<void> {
    try {
      const { seat, token, name } = wish;
      const files = chosenFiles();
      checkSizes(Object.values(files));
      const fields = { seat, token, name, ...files, sequences: chosenSequences() };
      const joined = await this.court.ask<{ notes: Phrase[]; index: number }>("join", fields);
      this.tell({ is: "granted", wish, index: joined.index });
      for (const note of this.alone ? [] : joined.notes) this.sayNote(note);
    } catch (error) {
      const broke = !this.court.connection.state.peek().open;
      this.tell({ is: "failed", wish, refusal: error as Refused, broke });
    }
  }

  /** Say a note on a join; which files a seat has is no news in a match that goes on with them. */
  private sayNote(note: Phrase): void {
    const phase = this.court.frame.peek()?.phase ?? Phase.LOBBY;
    const isOn = phase > Phase.READY && phase < Phase.FINISHED;
    if (!isOn || !ABOUT_FILES.has(note.code)) this.say({ said: note, tone: "plain" });
  }

  private begin(seat: string, index: number): void {
    this.sent = new SentKeys();
    this.isFresh = true;
    // The gateway says so in its next message; until then nothing may ask again.
    this.court.seat.value = { seat, index, hold: HELD, reason: null, session: 0 };
  }

  private async release(): Promise<void> {
    try {
      const { said } = await this.court.ask<{ said: Phrase | null }>("leave");
      // Practice and a lobby free the seat: that it stays one's own is news in a match only.
      if (!this.alone && said) this.say({ said, tone: "plain" });
    } catch (error) {
      this.say({ said: (error as Refused).why, tone: "no" });
      if (this.isHeld()) return this.tell({ is: "kept" });
    }
    this.tell({ is: "released" });
  }

  private see(frame: Frame): void {
    const index = this.index.peek();
    const seat = frame.seats[index];
    if (!seat) return;
    this.sign();
    this.posData.add(frame, index, this.court.sheet.peek());
    if (this.isFresh) {
      this.isFresh = false;
      const isOn = frame.phase === Phase.PLAYING && seat.applied_seq > 0;
      if (isOn && this.chosenLevel.peek() === null) this.chosenLevel.value = seat.level;
    }
    this.tripMs.value = this.sent.see(seat, performance.now()) ?? this.tripMs.peek();
    this.hearRefusal(seat);
    if (this.alone) this.sayReady(frame, seat);
  }

  /**
   * Show the court that somebody is here, and which frame is shown.
   *
   * A frame is the reason, not a timer: a browser slows the timers of a hidden tab, never its frames.
   */
  private sign(): void {
    const nowMs = performance.now();
    if (nowMs - this.signedMs < SIGN_MS || this.court.seat.peek()?.hold !== HELD) return;
    this.signedMs = nowMs;
    this.court.ask("saw", { ...this.court.timeline.seen(nowMs) }).catch(() => undefined);
  }

  private hearRefusal(seat: SeatFrame): void {
    const refusal = this.sent.refusal(seat);
    if (refusal) this.say(refusal);
  }

  private sayReady(frame: Frame, seat: SeatFrame): void {
    const wanted = frame.phase === Phase.LOBBY && !(seat.flags & SeatFlag.READY);
    if (!wanted || this.readying || !this.canSteer.peek()) return;
    this.readying = true;
    const done = () => {
      this.readying = false;
    };
    this.court.ask("ready", { ready: true }).then(done, () => setTimeout(done, AGAIN_MS));
  }
}

function kept(): (Wish & { session?: number }) | null {
  try {
    return JSON.parse(tab.read(KEPT_AS) ?? "null") as Wish | null;
  } catch {
    return null;
  }
}
