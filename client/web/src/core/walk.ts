/** How far and how fast a robot walks, for a student who tries out a gait. */

import { places } from "./poses";
import { BEATS_PER_S, type Event, type Frame, type Sheet } from "./wire";

/** A robot's walk since it was put on the floor. */
export interface Walk {
  /** As the yaw in Pos-data.txt: 0 where it looks along the field's y, + to the left; -179 to 180. */
  headingDegrees: number;
  /** Length of its way [m]. */
  walkedM: number;
  /** Over the last second [m/s]. */
  speedMps: number;
}

/** A body sways with each step, so its path is measured between points this far apart. */
const STEP_M = 0.01;
const WINDOW_BEATS = BEATS_PER_S;

interface Spot {
  beat: number;
  xM: number;
  yM: number;
}

/** Follows one robot. */
export class Walker {
  private match = -1;
  private beganBeat = 0;
  private corner: Spot | null = null;
  private walkedM = 0;
  private spots: Spot[] = [];

  /** @param seat Index of the robot's seat. */
  constructor(private readonly seat: number) {}

  /**
   * Look at a frame; null while the robot does not stand on the floor.
   *
   * @param events All of the match: one of them may say that the robot was put back to its start.
   */
  look(frame: Frame, sheet: Sheet, events: readonly Event[]): Walk | null {
    const place = places(frame, sheet)[this.seat];
    if (!place) {
      this.begin(null, frame);
      return null;
    }
    const spot = { beat: frame.beat, xM: place.xM, yM: place.yM };
    if (!this.corner || frame.match !== this.match || this.wasPutBack(frame, events)) {
      this.begin(spot, frame);
    }
    this.spots = [...this.spots.filter((one) => spot.beat - one.beat <= WINDOW_BEATS), spot];
    const stepM = this.corner ? apart(this.corner, spot) : 0;
    if (stepM >= STEP_M) {
      this.walkedM += stepM;
      this.corner = spot;
    }
    const first = this.spots[0]!;
    const beats = spot.beat - first.beat;
    return {
      headingDegrees: yawDegrees(place.headingRad),
      walkedM: this.walkedM,
      speedMps: beats ? (apart(first, spot) * BEATS_PER_S) / beats : 0,
    };
  }

  private wasPutBack(frame: Frame, events: readonly Event[]): boolean {
    const last = events.findLast((event) => event.kind === "restart" && event.seat === this.seat);
    return last !== undefined && this.beganBeat < last.beat && last.beat <= frame.beat;
  }

  private begin(spot: Spot | null, frame: Frame): void {
    this.match = frame.match;
    this.beganBeat = frame.beat;
    this.corner = spot;
    this.walkedM = 0;
    this.spots = [];
  }
}

function yawDegrees(headingRad: number): number {
  const turned = (Math.round((headingRad * 180) / Math.PI) + 270) % 360;
  return turned > 180 ? turned - 360 : turned;
}

function apart(one: Spot, other: Spot): number {
  return Math.hypot(one.xM - other.xM, one.yM - other.yM);
}
