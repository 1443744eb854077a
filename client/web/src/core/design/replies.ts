/** What a studio answers (shared/lacoc_shared/studio.py has the same structs, with what they mean). */

import type { Phrase } from "../phrase";
import type { Scene, Sheet } from "../wire";

export interface RobotReply {
  name: string;
  legs: string[];
  ranges_deg: [number, number][];
  start_deg: number[];
  start_z_m: number;
  facts: Record<string, unknown>;
  limits: Record<string, unknown>;
  sheet: Sheet;
  scene: Scene;
}

export interface CellPlace {
  posture: number;
  joint: number;
}

export interface Sentence {
  said: Phrase;
  cell?: CellPlace | null;
  leg?: number;
}

export interface TrialReply {
  level: number;
  key: number;
  figures: Record<string, unknown>;
  explained: Sentence[];
  notes?: Phrase[];
  fault?: Phrase | null;
  ticks: number;
  first: number;
  end: number;
  starts: number[];
  posture: Uint8Array;
  down: Uint8Array;
  poses: Uint8Array;
  commanded_rad: Uint8Array;
  contact_w_m: Uint8Array;
  centre_w_m: Uint8Array;
  margin_m: Uint8Array;
  slip_m_s: Uint8Array;
  tip_m: Uint8Array;
  digest: Uint8Array;
}

export interface Progress {
  stage: string;
  done: number;
  trials: number;
  score?: number | null;
}

export interface Weight {
  cell: CellPlace;
  up: number;
  down: number;
}

export interface Change {
  cell: CellPlace;
  from_deg: number;
  to_deg: number;
}

export interface CoachReply {
  key: number;
  matters: Weight[];
  changes: Change[];
  before: Record<string, unknown>;
  after: Record<string, unknown>;
  score_before: number;
  score_after: number;
  trials: number;
  cancelled?: boolean;
}
