/** The way of a token: it finds its seat, and in a contest its court, again and again. */

import { computed, effect, type ReadonlySignal, signal, untracked } from "@preact/signals";
import { goToCourt, keepToken, ownToken } from "./address";
import type { Refused } from "./connection";
import type { Court } from "./court";
import type { Player } from "./player";
import { Driver, isDriven, type Move, nextMove } from "./way";
import { Phase, type Whereabouts } from "./wire";

const ASK_MS = 2000;
const LOOK_MS = 250;
/** So long a result stays before the page goes on. */
const RESULT_MS = 8000;
const AGAIN_MS = 2500;
const NO_TEAM = "refused.no-team-token";

export class Team {
  /** The token; null: nobody has given one here. */
  readonly token = signal<string | null>(ownToken());
  /** Whether this page has a token, its own or that of the command line. */
  readonly isOn: ReadonlySignal<boolean>;
  /** What a court said last of the token. */
  readonly there = signal<Whereabouts | null>(null);
  /** Whether the team plays no more, as far as is decided. */
  readonly isOver = computed(() => ["out", "over"].includes(this.there.value?.state ?? ""));
  /** Why the token was refused. */
  readonly refusal = signal<Refused | null>(null);
  /** Whether somebody else drives the team's seat now, and this page must not take it unasked. */
  readonly driven = signal(false);
  /** Why the court of the call gives the page no seat yet, however often it asks. */
  readonly unseated = signal<Refused | null>(null);
  /** The court to which the page goes now; "": it stays. */
  readonly going = signal("");
  private mine = "";
  /** The call whose seat a person takes from whoever drives it. */
  private taken = "";
  private readonly driver = new Driver();
  /** The call of the newest request for a seat. */
  private asked = "";
  private officialMs = 0;
  private triedMs = 0;
  private isAsking = false;

  constructor(
    private readonly court: Court,
    private readonly player: Player,
  ) {
    this.isOn = computed(
      () => this.token.value !== null || Boolean(court.welcome.value?.prefill?.has_token),
    );
    effect(() => {
      const canAsk = court.welcome.value?.can_act && court.live.value;
      if (this.isOn.value && canAsk) untracked(() => void this.ask());
    });
    addEventListener("hashchange", () => {
      // A team's link, opened in the tab of this page: nothing but the fragment changes.
      if (location.hash.includes("token=")) location.reload();
    });
    setInterval(() => void this.ask(), ASK_MS);
    setInterval(() => this.look(), LOOK_MS);
  }

  /** Follow the team of this token. */
  enter(token: string): void {
    keepToken(token);
    this.refusal.value = null;
    this.token.value = token;
    void this.ask();
  }

  /** Ask for the token again. */
  forget(): void {
    keepToken(null);
    this.token.value = null;
    this.there.value = null;
  }

  /** Sit down at the open seat of the token. */
  sit(name: string): void {
    const there = this.there.peek();
    if (!there?.open) return;
    const { court, seat } = there;
    this.player.join({ court, seat, token: this.token.peek(), name });
  }

  /** Take the seat from whoever drives it now. */
  takeOver(): void {
    this.taken = this.there.peek()?.call ?? "";
    this.look();
  }

  private async ask(): Promise<void> {
    if (!this.isOn.peek() || this.isAsking || !this.court.live.peek()) return;
    this.isAsking = true;
    const token = this.token.peek();
    try {
      const there = await this.court.ask<Whereabouts>("where", { token });
      if (token !== this.token.peek()) return;
      this.there.value = there;
      this.refusal.value = null;
    } catch (error) {
      if ((error as Refused).why.code === NO_TEAM) {
        this.forget();
        this.refusal.value = error as Refused;
      }
    } finally {
      this.isAsking = false;
    }
    this.look();
  }

  private look(): void {
    const there = this.there.peek();
    const frame = this.court.frame.peek();
    const phase = frame?.phase ?? 0;
    const now = performance.now();
    if (phase < Phase.OFFICIAL) this.officialMs = now;
    const at = this.court.welcome.peek()?.court;
    if (!there || !at) return;
    const { held, wanted } = this.player.seats(at);
    const isHeard = isDriven(this.court.health.peek(), there.seat);
    const move = nextMove({
      there,
      court: at,
      call: this.court.sheet.peek()?.call ?? "",
      seat: held || wanted,
      mine: this.mine,
      seen: now - this.officialMs > RESULT_MS,
      gone: ["left", "lost"].includes(this.player.standing.peek()),
      driven: there.call !== this.taken && (isHeard || this.driver.drives(there.call, now)),
    });
    if (move === "ask" && isHeard) this.driver.heard(there.call, now);
    this.driven.value = move === "ask";
    this.hearRefusal(there.call);
    // Only the court's health says who holds the seat; it comes twice a second.
    if (move === "join" && !this.court.health.peek()) return;
    const isMine = there.open || (there.call && there.call === this.mine);
    this.player.next.value = isMine ? null : there.said;
    this.make(move, there, now);
  }

  /** Keep the newest refusal until a seat is held, so that it does not go with each new request. */
  private hearRefusal(call: string): void {
    const { refusal } = this.player.claim.peek();
    const isSeated = this.player.standing.peek() === "seated";
    if (!call || call !== this.asked || isSeated || this.driven.peek()) this.unseated.value = null;
    else if (refusal) this.unseated.value = refusal;
  }

  private make(move: Move, there: Whereabouts, now: number): void {
    switch (move) {
      case "hold":
        if (this.player.standing.peek() === "seated") {
          this.mine = there.call;
          this.taken = "";
        }
        break;
      case "rest":
        this.player.rest();
        break;
      case "go": {
        const { courts, home } = this.court.welcome.peek()!;
        // The gateway of one court leads to no other; that of one person learns where they are.
        if (home !== "venue" || courts.includes(there.court)) {
          this.going.value = there.court;
          goToCourt(there.court);
        }
        break;
      }
      case "join":
        if (now - this.triedMs < AGAIN_MS) break;
        this.triedMs = now;
        this.asked = there.call;
        this.player.moveTo({
          court: there.court,
          seat: there.seat,
          token: this.token.peek(),
          name: there.team,
        });
        break;
    }
  }
}
