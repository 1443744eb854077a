/** A contestant: holds a seat through a gateway, sends keys, sees what became of them. */

import { batch, computed, effect, type ReadonlySignal, signal, untracked } from "@preact/signals";
import { Refused } from "./connection";
import type { Court } from "./court";
import { chosenFiles, chosenSequences, MOST_BYTES } from "./files";
import { PosData } from "./posdata";
import { tab } from "./storage";
import { type Frame, Phase, SeatFlag, type SeatFrame, type SentFile, sameBytes } from "./wire";

/** The seat that this page wants to hold; it is asked for again after every break. */
export interface Wish {
  court: string;
  seat: string;
  /** null: the one that was named on the command line. */
  token: string | null;
  name: string;
}

/** Where the page stands with its seat. */
export type Standing = "watching" | "outside" | "joining" | "seated" | "lost" | "left";

/** What the player has to say: a sentence of the court, or the number of a refusal. */
export type Word =
  | { text: string; tone: "plain" | "yes" | "no" }
  | { refused: number; key: number };

const KEPT_AS = "lacoc.wish";
const HELD = "held";
const SILENT_COURT = "the court does not answer";
const AGAIN_MS = 1500;
const MOST_TRIES = 8;
const REMEMBERED = 64;

interface Sent {
  key: number;
  atMs: number;
}

export class Player {
  readonly level: ReadonlySignal<number>;
  readonly standing: ReadonlySignal<Standing>;
  /** Index of the held seat; -1: none. */
  readonly index: ReadonlySignal<number>;
  /** Whether a first join is asked for, now or as soon as there is a court. */
  readonly isWaiting: ReadonlySignal<boolean>;
  /** Whether keys go anywhere now. */
  readonly canSteer: ReadonlySignal<boolean>;
  /** Why a join was refused. */
  readonly refusal = signal<Refused | null>(null);
  /** Why the seat was lost. */
  readonly lostWhy = signal("");
  /** From the newest key to the frame that shows it, as this page saw both. */
  readonly tripMs = signal<number | null>(null);
  /** The newest keys that were sent, the newest last. */
  readonly pressed = signal<readonly { level: number; key: number }[]>([]);
  /** How many keys were sent. */
  readonly sentCount = signal(0);
  /** Rows for Pos-data.txt. */
  data: PosData | null = null;
  /** Whether a join is under way. */
  readonly asking = signal(false);
  /** Whom `join` could be asked for again. */
  lastWish: Wish | null = null;
  private readonly wish = signal<Wish | null>(kept());
  /** Whether the wish was granted once: a break of it is to be mended without a word. */
  private readonly granted = signal(this.wish.peek() !== null);
  /** The wish, unless it is known to be for another court: a tab's address may change. */
  private readonly wishHere: ReadonlySignal<Wish | null>;
  private readonly greeted = signal(false);
  private readonly hasLeft = signal(false);
  private readonly chosenLevel = signal<number | null>(null);
  private first = false;
  private tries = 0;
  private dataMatch = 0;
  private newest = 0;
  private isFresh = true;
  private readonly sent = new Map<number, Sent>();
  /** Sequence numbers that frames have shown already, and when: a reply may come after its frame. */
  private readonly shown: { seq: number; atMs: number }[] = [];
  private reported = 0;
  private readying = false;

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
      const wish = this.wish.value;
      const welcome = court.welcome.value;
      return !welcome || welcome.court === wish?.court ? wish : null;
    });
    this.index = computed(() => (this.isHeld() ? (court.seat.value?.index ?? -1) : -1));
    this.standing = computed(() => this.stand());
    this.isWaiting = computed(() => this.wishHere.value !== null && !this.granted.value);
    this.level = computed(() => this.levelNow());
    this.canSteer = computed(
      () =>
        court.seat.value?.hold === HELD && court.live.value && court.connection.state.value.open,
    );
    this.follow();
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
    this.first = true;
    this.tries = 0;
    batch(() => {
      this.refusal.value = null;
      this.lostWhy.value = "";
      this.hasLeft.value = false;
      this.granted.value = false;
      this.wish.value = wish;
    });
  }

  /** Bring the chosen files anew; the court says what becomes of them. */
  async rejoin(): Promise<void> {
    const wish = this.wish.peek();
    if (!wish) return;
    this.first = true;
    if (this.alone && this.isHeld()) {
      // A match keeps the files that it began with. Nobody minds when one of practice ends: the
      // next opens at once, and the seat is asked for again because it is wished for still.
      await this.court.ask("leave").catch(() => undefined);
      return;
    }
    await this.ask(wish);
  }

  /** Go back to the card, from having left or lost the seat. */
  forget(): void {
    batch(() => {
      this.lostWhy.value = "";
      this.hasLeft.value = false;
    });
  }

  /** Say ready, or take it back. */
  async ready(ready: boolean): Promise<void> {
    try {
      await this.court.ask("ready", { ready });
    } catch (error) {
      this.say({ text: (error as Refused).message, tone: "no" });
    }
  }

  /** Give the seat up. */
  async leave(): Promise<void> {
    const wish = this.wish.peek();
    this.keep(null); // first: nothing may ask for it again
    try {
      const { text } = await this.court.ask<{ text: string }>("leave");
      // Practice and a lobby free the seat: that it stays one's own is news in a match only.
      if (!this.alone && text) this.say({ text, tone: "plain" });
    } catch (error) {
      this.say({ text: (error as Refused).message, tone: "no" });
      if (this.isHeld()) {
        this.keep(wish);
        return;
      }
    }
    batch(() => {
      this.lastWish = wish;
      this.hasLeft.value = true;
      this.pressed.value = [];
    });
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
    const reply = this.court.ask<{ seq: number }>("key", { level, key });
    batch(() => {
      this.pressed.value = [...this.pressed.peek().slice(1 - REMEMBERED), { level, key }];
      this.sentCount.value += 1;
    });
    try {
      const { seq } = await reply;
      this.sent.set(seq, { key, atMs });
      if (this.sent.size > REMEMBERED) this.sent.delete(this.sent.keys().next().value!);
      const shown = this.shown.find((one) => one.seq >= seq);
      if (shown) this.compare(shown.seq, shown.atMs);
      const seat = this.seatNow();
      if (seat) this.hearRefusal(seat);
    } catch (error) {
      this.say({ text: (error as Refused).message, tone: "no" });
    }
  }

  private isHeld(): boolean {
    const hold = this.court.seat.value?.hold;
    return hold === HELD || hold === SILENT_COURT;
  }

  private stand(): Standing {
    const welcome = this.court.welcome.value;
    if (this.isHeld()) return "seated";
    if (welcome && !welcome.can_act) return "watching";
    if (this.lostWhy.value) return "lost";
    if (this.wishHere.value && this.granted.value) return "joining";
    return this.hasLeft.value ? "left" : "outside";
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
    // Also after a break of the page, the gateway or the link; a court that was only restarted is
    // asked again by the gateway.
    effect(() => {
      const wish = this.wishHere.value;
      const welcome = court.welcome.value;
      const link = court.link.value;
      if (!wish || !this.greeted.value || !welcome?.can_act || this.asking.value) return;
      if (link?.connected && !this.isHeld()) {
        untracked(() => void this.ask(wish));
      }
    });
    effect(() => {
      const seat = court.seat.value;
      if (seat && (seat.hold === "replaced" || seat.hold === "refused")) {
        this.lastWish = this.wish.peek();
        this.keep(null);
        this.lostWhy.value = seat.reason || seat.hold;
      }
    });
    effect(() => {
      const frame = court.frame.value;
      if (frame) untracked(() => this.see(frame));
    });
  }

  private async ask(wish: Wish): Promise<void> {
    if (this.asking.peek()) return;
    this.asking.value = true;
    try {
      const { seat, token, name } = wish;
      const files = chosenFiles();
      checkSizes(Object.values(files));
      const fields = { seat, token, name, ...files, sequences: chosenSequences() };
      const joined = await this.court.ask<{ notes: string[]; index: number }>("join", fields);
      this.begin(wish, joined.index);
      for (const note of this.alone ? [] : joined.notes) this.say({ text: note, tone: "plain" });
    } catch (error) {
      await this.notJoined(wish, error as Refused);
    } finally {
      this.asking.value = false;
    }
  }

  private begin(wish: Wish, index: number): void {
    this.tries = 0;
    this.first = false;
    // Sequence numbers begin anew with a new controller.
    this.newest = this.reported = 0;
    this.isFresh = true;
    this.sent.clear();
    this.shown.length = 0;
    batch(() => {
      this.granted.value = true;
      this.keep(wish);
      // The gateway says so in its next message; until then nothing may ask again.
      this.court.seat.value = {
        seat: wish.seat,
        index,
        hold: HELD,
        reason: "",
        round_trip_ms: null,
      };
    });
  }

  private async notJoined(wish: Wish, refused: Refused): Promise<void> {
    const broke = !this.court.connection.state.peek().open;
    const isFinal = refused.mistakes.length > 0 || /token|too large/i.test(refused.message);
    const waits = refused.again || (!isFinal && ++this.tries < MOST_TRIES);
    if (broke || (waits && !this.first)) {
      await new Promise((resolve) => setTimeout(resolve, AGAIN_MS));
      return; // asked again once there is a court
    }
    batch(() => {
      this.court.seat.value = null; // the gateway gave up the older hold for this one
      this.refusal.value = refused;
      this.lastWish = wish;
      this.keep(null);
    });
  }

  private keep(wish: Wish | null): void {
    this.wish.value = wish;
    tab.write(KEPT_AS, wish && JSON.stringify(wish));
  }

  private see(frame: Frame): void {
    const index = this.index.peek();
    const seat = frame.seats[index];
    if (!seat) return;
    this.collect(frame, index);
    if (this.isFresh) {
      this.isFresh = false;
      const isOn = frame.phase === Phase.PLAYING && seat.applied_seq > 0;
      if (isOn && this.chosenLevel.peek() === null) this.chosenLevel.value = seat.level;
    }
    const seq = Math.max(seat.applied_seq, seat.refused_seq);
    if (seq > this.newest) {
      this.newest = seq;
      this.shown.push({ seq, atMs: performance.now() });
      if (this.shown.length > REMEMBERED) this.shown.shift();
      this.compare(seq, performance.now());
    }
    this.hearRefusal(seat);
    if (this.alone) this.sayReady(frame, seat);
  }

  private compare(seq: number, atMs: number): void {
    const sent = this.sent.get(seq);
    if (sent) this.tripMs.value = Math.max(0, atMs - sent.atMs);
  }

  private hearRefusal(seat: SeatFrame): void {
    const sent = this.sent.get(seat.refused_seq);
    if (!sent || seat.refused_seq <= this.reported) return;
    this.reported = seat.refused_seq;
    this.say({ refused: seat.refused_why, key: sent.key });
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

  private collect(frame: Frame, index: number): void {
    const sheet = this.court.sheet.peek();
    if (!sheet || !frame.poses.length || !sameBytes(frame.scene, sheet.scene)) return;
    const joints = sheet.seats.map((seat) => 3 * seat.legs.length);
    const isOther =
      this.dataMatch !== frame.match ||
      this.data?.seat !== index ||
      this.data.joints.some((count, seat) => count !== joints[seat]);
    if (!this.data || isOther) {
      this.data = new PosData(index, joints);
      this.dataMatch = frame.match;
    }
    this.data.add(frame);
  }
}

/** A longer message would only cost the connection. */
function checkSizes(files: readonly (SentFile | null)[]): void {
  const bytes = files.reduce((sum, file) => sum + (file?.data.length ?? 0), 0);
  if (bytes <= MOST_BYTES) return;
  const [size, most] = [bytes, MOST_BYTES].map((count) => Math.ceil(count / 1024));
  throw new Refused(
    `Your files are too large together: ${size} KiB, at most ${most} KiB travel. ` +
      "Shorten the gait files.",
  );
}

function kept(): Wish | null {
  try {
    return JSON.parse(tab.read(KEPT_AS) ?? "null") as Wish | null;
  } catch {
    return null;
  }
}

/** Whether a refusal is about the token. */
export function isAboutToken(refused: Refused): boolean {
  return !refused.mistakes.length && /token/i.test(refused.message);
}
