// Made by client/web/make_wire.py from the Python structs; not edited by hand.

import type { Phrase } from "./phrase";

export const PROTOCOL = 2;
export const RECORD_FORMAT = 1;
export const RECORD_PROFILE = "lacoc";
export const BEAT_S = 0.02;
export const BEAT_NS = 20000000;
export const BEATS_PER_S = 50;
export const REPEATS_HZ = 10;
export const SILENT_AFTER_S = 1;
export const RESTART_KEY = 10;
export const RECORDED = "-";
export const ROOT_FLOATS = 7;
export const TRY_OUT_TICKS = 3000;
export const TRY_OUT_ASKED_TICKS = 150;
export const TRY_OUT_KEYS = 64;
export const HASH_BYTES = 8;
export const JOIN_MAX_BYTES = 65536;
export const NAME_MAX = 24;
export const MAX_KEYS = 10;
export const MAX_POSTURES_PER_KEY = 100;
export const MAX_FREEZE_S = 600;
export const MAX_CLOCK_S = 3600;
export const MAX_POINTS = 1000;
export const LEAST_HZ = 1;
export const USUAL_HZ = 25;
export const MOST_HZ = 50;
export const TRY_LATER = 1013;
export const PIECE_MS = 1000;
export const DESIGN_MAX_BYTES = 131072;
export const PARSE_MAX_BYTES = 1052672;
export const SAME_MM_S = 3;
export const SAME_SHARE = 0.05;
export const STRAIGHT_DEG_S = 3;
export const SEAM_DEG = 12;
export const SEAM_RATIO = 1.6;

export const Phase = {
  CREATED: 0,
  LOBBY: 1,
  READY: 2,
  COUNTDOWN: 3,
  PLAYING: 4,
  HALTED: 5,
  FINISHED: 6,
  OFFICIAL: 7,
  VOID: 8,
} as const;

export const SeatFlag = {
  JOINED: 1,
  READY: 2,
  SILENT: 4,
  FROZEN: 8,
} as const;

export const No = {
  NONE: 0,
  NOT_PLAYING: 1,
  LEVEL_CLOSED: 2,
  NO_SUCH_KEY: 3,
  RESTARTED: 4,
  FROZEN: 5,
} as const;

export const Level = {
  POSTURE: 0,
  LOCOMOTION: 1,
} as const;

export const MARKER_STATES = ["neutral", "left", "right", "down"] as const;

/** What a message of the gateway is, by its first byte; 0 is none. */
export const MESSAGE_KINDS = [
  "",
  "welcome",
  "frame",
  "event",
  "sheet",
  "scene",
  "health",
  "link",
  "seat",
  "reply",
  "referee",
  "files",
  "folder",
  "progress",
  "studio",
  "phases",
  "handed",
  "forgotten",
  "class",
  "card",
  "gone",
  "tournament",
  "programme",
  "notice",
  "crowd",
  "table",
  "people",
  "group",
] as const;

/** Why a key was refused, by its `No`: codes of the table. */
export const WHY_NO: Readonly<Record<number, string>> = {
  1: "key.not-playing",
  2: "key.level-closed",
  3: "key.no-such-key",
  4: "key.restarted",
  5: "key.frozen",
};

export interface SeatFrame {
  flags: number;
  score: number;
  level: number;
  key: number;
  posture: number;
  locked_ticks: number;
  applied_seq: number;
  applied_beat: number;
  refused_seq: number;
  refused_why: number;
}

export interface Frame {
  match: number;
  beat: number;
  phase: number;
  countdown_beats: number;
  clock_ticks: number;
  seats: SeatFrame[];
  markers: Uint8Array;
  poses: Uint8Array;
  scene: Uint8Array;
  digest: Uint8Array;
}

export interface Event {
  number: number;
  match: number;
  beat: number;
  clock_ticks: number;
  kind: string;
  said: Phrase;
  seat: number;
  data: Record<string, unknown>;
}

export interface SheetSeat {
  id: string;
  team: string;
  colour: string;
  pattern: string;
  robot: string;
  legs: string[];
  keys: [number[], number[]];
  postures: number[];
}

export interface MarkerInfo {
  name: string;
  kind: string;
  x_m: number;
  y_m: number;
  radius_m: number;
  points: number;
}

export interface Sheet {
  protocol: number;
  version: string;
  court: string;
  match: number;
  match_id: string;
  arena: string;
  title: string;
  duration_s: number;
  levels: number[];
  settings: Record<string, unknown>;
  seats: SheetSeat[];
  markers: MarkerInfo[];
  scene: Uint8Array;
  call: string;
  fixture: Phrase | null;
  rule: Phrase | null;
}

export interface SceneBody {
  name: string;
  parent: number;
  pos: [number, number, number];
  quat: [number, number, number, number];
  seat: number;
  joint: number;
  axis: [number, number, number];
}

export interface SceneGeom {
  body: number;
  type: string;
  size: [number, number, number];
  pos: [number, number, number];
  quat: [number, number, number, number];
  rgba: [number, number, number, number];
  marker: number;
  state: number;
  seat: number;
}

export interface Scene {
  bodies: SceneBody[];
  geoms: SceneGeom[];
}

export interface Gains {
  said: Phrase | null;
  points: Record<string, number>;
}

export interface SeatHealth {
  id: string;
  joined: boolean;
  session: number;
  heard_ms: number | null;
  commands_hz: number;
  refused: Record<string, number>;
  round_trip_p50_ms: number | null;
  round_trip_p95_ms: number | null;
  late: number;
}

export interface LinkVerdict {
  id: string;
  silences: number;
  silent_s: number;
  expected: number;
  arrived: number;
  refused: Record<string, number>;
  walked_m: number;
  keys: Record<string, number>;
}

export interface HealthVerdict {
  played_beats: number;
  real_time_factor: number;
  slow_beats: number;
  worst_late_ms: number;
  faults: number;
  resumptions: number;
  seats: LinkVerdict[];
  advice: (Phrase | string)[];
}

export interface Health {
  match: number;
  beat: number;
  real_time_factor: number;
  slow_beats: number;
  worst_late_ms: number;
  seats: SeatHealth[];
  dropped: Record<string, number>;
  decisions: Record<string, Phrase | null>;
  verdict: HealthVerdict | null;
  record_trouble: Phrase | null;
  input_delay_ms: number;
  events: number;
  sheet: Uint8Array;
  gains: Gains[];
  moves: string[][];
}

export interface TryOutReply {
  scene: Uint8Array;
  drawn: Scene | null;
  first: number;
  every: number;
  poses: Uint8Array[];
}

export interface DecisionReply {
  beat: number;
  event: number | null;
  said: Phrase;
  scores: number[];
  changes: Phrase[];
}

export interface Outlook {
  beat: number;
  clock_ticks: number;
  before: number[];
  scores: number[];
  seconds: number;
  phase: number;
  events: Event[];
}

export interface Mistake {
  file: string;
  found: Phrase | string;
  expected: Phrase | string;
  row?: number | null;
  column?: number | null;
  joint?: number | null;
  leg?: string | null;
  field?: string | null;
}

export interface SentFile {
  name: string;
  data: Uint8Array;
}

export interface AssignedSeat {
  id: string;
  team: string;
  token_hashes: string[];
  robot: SentFile | null;
  postures: SentFile | null;
  locomotion: SentFile | null;
  colour: string | null;
  pattern: "plain" | "stripes" | "dots" | null;
}

export interface Assigned {
  call: string;
  fixture: Phrase;
  seats: AssignedSeat[];
}

export interface Whereabouts {
  team: string;
  state: "court" | "waits" | "out" | "over";
  said: Phrase;
  court: string;
  address: string;
  seat: string;
  call: string;
  opponent: string;
  fixture: Phrase | null;
  games_before: number | null;
  about_s: number | null;
  open: boolean;
  rank: number;
  news: Phrase | null;
}

export interface ForkSeat {
  seat: string;
  bot: string;
  script: string;
}

export interface ForkChanges {
  seats: ForkSeat[];
  take_back: number | null;
  restart: string[];
  variant: number;
}

export interface Origin {
  match_id: string;
  beat: number;
  record_hash: string;
  changes: ForkChanges | null;
}

export interface Setup {
  match_id: string;
  court: string;
  match: number;
  arena: string;
  settings: Record<string, unknown>;
  limits: Record<string, number>;
  assigned: Assigned | null;
  origin: Origin | null;
}

export interface Header {
  format: number;
  match_id: string;
  segment: number;
  first_beat: number;
  started: string;
  versions: Record<string, string>;
  arithmetic: Record<string, string>;
  setup: Setup;
}

export interface Result {
  match_id: string;
  court: string;
  match: number;
  arena: string;
  teams: string[];
  scores: number[];
  computed: string;
  official: string;
  reason: Phrase | string;
  clock_s: number;
  beats: number;
  digest: string;
  model: string;
}

export interface LegShape {
  label: string;
  position_mm: [number, number, number];
  outward_deg: number;
  lengths_mm: [number, number, number];
  range_deg: [number, number];
}

export interface RobotReply {
  name: string;
  legs: string[];
  shapes: LegShape[];
  ranges_deg: ([number, number])[];
  start_deg: number[];
  start_z_m: number;
  facts: Record<string, unknown>;
  limits: Record<string, [number | null, number | null]>;
  sheet: Sheet;
  scene: Scene;
}

export interface CellPlace {
  posture: number;
  joint: number;
}

export interface Sentence {
  said: Phrase;
  cell: CellPlace | null;
  leg: number;
}

export interface TrialReply {
  level: number;
  key: number;
  figures: Record<string, unknown>;
  explained: Sentence[];
  notes: Phrase[];
  fault: Phrase | null;
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
  score: number | null;
  filled: number | null;
}

export interface Weight {
  cell: CellPlace;
  up: number;
  down: number;
}

export interface CellChange {
  cell: CellPlace;
  from_deg: number;
  to_deg: number;
}

export interface RepairTold {
  said: Phrase;
  cell: CellPlace;
  before: number;
  after: number;
}

export interface CoachReply {
  key: number;
  matters: Weight[];
  changes: CellChange[];
  before: Record<string, unknown>;
  after: Record<string, unknown>;
  repairs: RepairTold[];
  worse: string[];
  score_before: number;
  score_after: number;
  trials: number;
  cancelled: boolean;
}

export interface GaitDifference {
  way: string;
  steps: number;
}

export interface OtherGait {
  table: number[];
  changes: CellChange[];
  differences: GaitDifference[];
  figures: Record<string, unknown>;
}

export interface MapCell {
  speed: number;
  arousal: number;
  gait: OtherGait;
}

export interface MapReply {
  key: number;
  speeds_mm_s: number[];
  arousals_mm_s: number[];
  cells: MapCell[];
  own: [number, number] | null;
  before: Record<string, unknown>;
  trials: number;
  cancelled: boolean;
}

export interface VariantsReply {
  key: number;
  variants: OtherGait[];
  trials: number;
  cancelled: boolean;
}

export interface FileRow {
  key: number;
  posture: number;
  angles_deg: number[];
}

export interface FileTable {
  kind: "postures" | "locomotion";
  legs: number;
  rows: FileRow[];
}

export interface FolderFile {
  name: string;
  slot: "robot" | "postures" | "locomotion";
  version: string;
}

export interface StudentRules {
  closed: number[];
  coach: "none" | "matters" | "cell" | "three" | "table";
  explain_first: boolean;
}

export interface AskedQuestion {
  name: string;
  ask: Phrase;
  choices: Phrase[];
}

export interface PhaseState {
  number: number;
  state: "open" | "met" | "skipped";
  share: number;
  title: Phrase;
  task: Phrase;
  question: Phrase;
  hint: Phrase;
  explanation: Phrase;
  missing: Phrase[];
  asked: AskedQuestion | null;
}

export interface Phases {
  phase: number;
  word: string;
  hand_up: boolean;
  trouble: Phrase | null;
  lesson_step: number;
  phases: PhaseState[];
  rules: StudentRules;
}

export interface TookStep {
  kind: "step";
  step: number;
  robot: string;
  question: number;
  of: number;
  choice: number;
  right: boolean;
}

export interface Card {
  name: string;
  online: boolean;
  seen_s: number;
  phase: number;
  states: ("open" | "met" | "skipped")[];
  lesson_step: number;
  in_lesson: boolean;
  share: number;
  missing: Phrase | null;
  tries: number;
  best_mm_s: number | null;
  last_mm_s: number | null;
  legs: string[];
  feet: (([number, number])[])[] | null;
  said: Phrase | null;
  hand_up_s: number | null;
  stuck: Phrase | null;
  coached: boolean;
  need: "hand" | "stuck" | "quiet" | "";
}

export interface ClassMatch {
  left: string;
  right: string;
  scores: [number, number];
  winner: number | null;
  void: boolean;
  record: string | null;
}

export interface PlayerStanding {
  name: string;
  rank: number;
  won: number;
  drawn: number;
  lost: number;
  points: number;
}

export interface LeftOut {
  name: string;
  mistakes: Mistake[];
  why: Phrase | null;
}

export interface TournamentState {
  state: "none" | "running" | "done" | "stopped";
  arena: string;
  done: number;
  of: number;
  matches: ClassMatch[];
  standings: PlayerStanding[];
  left_out: LeftOut[];
  trouble: Phrase | null;
}

export interface Judged {
  said: string;
  was: string[];
  right: boolean;
}

export interface EditReply {
  guess: Judged | null;
}

export interface AnswerReply {
  right: boolean;
  was: Phrase[];
  because: Phrase;
}

export interface CheckReply {
  keys: number;
  mistakes: Mistake[];
}

export interface PiecesNow {
  run: string;
  closed: number;
  room: boolean;
  share: number;
}

/** `SeatFrame` is an array on the wire: the names of its places. */
export const SEATFRAME_FIELDS = [
  "flags",
  "score",
  "level",
  "key",
  "posture",
  "locked_ticks",
  "applied_seq",
  "applied_beat",
  "refused_seq",
  "refused_why",
] as const;

/** `Frame` is an array on the wire: the names of its places. */
export const FRAME_FIELDS = [
  "match",
  "beat",
  "phase",
  "countdown_beats",
  "clock_ticks",
  "seats",
  "markers",
  "poses",
  "scene",
  "digest",
] as const;

export type DecisionName =
  | "ready"
  | "start"
  | "halt"
  | "resume"
  | "restart"
  | "freeze"
  | "unfreeze"
  | "adjust"
  | "set"
  | "take-back"
  | "clock"
  | "abort"
  | "declare"
  | "official"
  | "next";

export type Decision =
  | { type: "ready"; seat: string }
  | { type: "start" }
  | { type: "halt" }
  | { type: "resume" }
  | { type: "restart"; seat: string }
  | { type: "freeze"; seat: string; seconds: number }
  | { type: "unfreeze"; seat: string }
  | { type: "adjust"; seat: string; points: number }
  | { type: "set"; marker: string; state: string }
  | { type: "take-back"; event: number; dry_run?: boolean }
  | { type: "clock"; gives_s?: number; seconds?: number }
  | { type: "abort" }
  | { type: "declare"; winner: string }
  | { type: "official" }
  | { type: "next" };

/** Decisions that a referee gives a reason for. */
export const NEED_A_REASON: ReadonlySet<DecisionName> = new Set([
  "restart",
  "freeze",
  "adjust",
  "set",
  "take-back",
  "clock",
  "abort",
  "declare",
] as const);
