/** How far and how fast a robot walks: what a student watches while a gait is tried out. */

import { places } from "./poses";
import type { Frame, Sheet } from "./wire";

/** A robot's walk since it was put on the floor. */
export interface Walk {
  /** 0 along the field's x, 90 along its y; 0 to 359. */
  headingDegrees: number;
  /** Length of its way [m]. */
  walkedM: number;
  /** As the crow flies from where it began [m]. */
  awayM: number;
  /** Over the last second [m/s]. */
  speedMps: number;
}

const BEATS_PER_S = 50;
/** A body sways with each step: its way is taken between points so far apart. */
const STEP_M = 0.01;
const WINDOW_BEATS = BEATS_PER_S;
/** What goes faster does not walk: it was put back to the start. */
const JUMP_MPS = 0.6;

interface Spot {
  beat: number;
  xM: number;
  yM: number;
}

/** Follows one robot. */
export class Walker {
  private match = -1;
  private start: Spot | null = null;
  private corner: Spot | null = null;
  private walkedM = 0;
  private spots: Spot[] = [];

  /** @param seat Index of the robot's seat. */
  constructor(private readonly seat: number) {}

  /** Look at a frame; null while the robot does not stand on the floor. */
  look(frame: Frame, sheet: Sheet): Walk | null {
    const place = places(frame, sheet)[this.seat];
    if (!place) {
      this.begin(null, frame.match);
      return null;
    }
    const spot = { beat: frame.beat, xM: place.xM, yM: place.yM };
    const last = this.spots.at(-1);
    if (!last || frame.match !== this.match || isJump(last, spot)) {
      this.begin(spot, frame.match);
    }
    this.spots = [...this.spots.filter((one) => spot.beat - one.beat <= WINDOW_BEATS), spot];
    const stepM = apart(this.corner!, spot);
    if (stepM >= STEP_M) {
      this.walkedM += stepM;
      this.corner = spot;
    }
    const first = this.spots[0]!;
    const beats = spot.beat - first.beat;
    return {
      headingDegrees: (Math.round((place.headingRad * 180) / Math.PI) + 360) % 360,
      walkedM: this.walkedM,
      awayM: apart(this.start!, spot),
      speedMps: beats ? (apart(first, spot) * BEATS_PER_S) / beats : 0,
    };
  }

  private begin(spot: Spot | null, match: number): void {
    this.match = match;
    this.start = this.corner = spot;
    this.walkedM = 0;
    this.spots = [];
  }
}

function isJump(from: Spot, to: Spot): boolean {
  const seconds = Math.max(1, to.beat - from.beat) / BEATS_PER_S;
  return apart(from, to) > JUMP_MPS * seconds + STEP_M;
}

function apart(one: Spot, other: Spot): number {
  return Math.hypot(one.xM - other.xM, one.yM - other.yM);
}
