// Made by client/web/make_wire.py from the Python structs; not edited by hand.

import type { Phrase } from "./phrase";

import type { Mistake, SentFile } from "./wire.gen";

export const TEAM_NAME_MAX = 24;

export interface TeamFiles {
  robot?: SentFile | null;
  postures?: SentFile | null;
  locomotion?: SentFile | null;
  picture?: SentFile | null;
}

export interface LookAtEvent {
  do: "look";
  secret?: string;
}

export interface Apply {
  do: "apply";
  secret?: string;
  team: string;
  files: TeamFiles;
  contact?: string;
  club?: string;
}

export interface ChangeFiles {
  do: "change";
  secret?: string;
  files: TeamFiles;
}

export interface Own {
  do: "own";
  secret?: string;
}

export interface CourtDay {
  do: "court_day";
  secret?: string;
  court: string;
  scores?: [number, number] | null;
  outcome?: "left" | "right" | "draw";
}

export interface Publish {
  do: "publish";
  secret?: string;
}

export interface Overview {
  do: "overview";
  secret?: string;
  known?: string;
}

export interface Approve {
  do: "approve";
  secret?: string;
  teams: string[];
  reason?: string;
}

export interface Decline {
  do: "decline";
  secret?: string;
  teams: string[];
}

export interface NewCode {
  do: "new_code";
  secret?: string;
}

export interface CloseEntries {
  do: "close";
  secret?: string;
}

export interface Draw {
  do: "draw";
  secret?: string;
  stage: string;
  entries: string[];
  how?: "" | "hand" | "lot";
  lot?: string;
  reason?: string;
}

export interface Undraw {
  do: "undraw";
  secret?: string;
  stage: string;
  reason: string;
  really?: boolean;
}

export interface Substitute {
  do: "substitute";
  secret?: string;
  team: string;
  substitute: string;
  reason: string;
  really?: boolean;
}

export interface TakeOut {
  do: "take_out";
  secret?: string;
  team: string;
  reason?: string;
  disqualify?: boolean;
  really?: boolean;
}

export interface SeePicture {
  do: "picture";
  secret?: string;
  team: string;
  remove?: boolean;
}

export interface Rule {
  do: "rule";
  secret?: string;
  kind: "replay" | "result" | "void" | "no-show";
  pairing: string;
  game?: number;
  team?: string;
  scores?: [number, number] | null;
  reason?: string;
  really?: boolean;
}

export interface Move {
  do: "move";
  secret?: string;
  pairing: string;
  court?: string;
  before?: string;
  not_before_ms?: number;
}

export interface PauseContest {
  do: "pause";
  secret?: string;
  until_ms?: number;
  reason?: string;
}

export interface ResumeContest {
  do: "resume";
  secret?: string;
}

export interface Shift {
  do: "shift";
  secret?: string;
  by_ms: number;
  reason?: string;
}

export interface Unshift {
  do: "unshift";
  secret?: string;
  shift: string;
}

export interface Announce {
  do: "announce";
  secret?: string;
  text: string;
}

export interface Staff {
  do: "staff";
  secret?: string;
  name: string;
  remove?: boolean;
}

export interface Tokens {
  do: "tokens";
  secret?: string;
}

export interface EventInfo {
  name: string;
  open: boolean;
  closes_ms: number;
  replays: "at-once" | "after-stage" | "after-contest";
  announced: string;
}

export interface OwnEntry {
  event: EventInfo;
  team: string;
  token: string;
  state: "waits" | "in" | "late" | "left" | "none";
  files: string;
  at_ms: number;
}

export interface TeamRow {
  team: string;
  state: "refused" | "waits" | "late" | "in" | "withdrawn" | "disqualified";
  replaced_by: string;
  files: string;
  bot: string;
  picture: boolean;
  at_ms: number;
  mistakes: Mistake[];
  contact: string;
  club: string;
  substitute: boolean;
  reserve: boolean;
}

export interface CourtRow {
  court: string;
  here: boolean;
}

export interface MatchMove {
  court: string;
  before: string;
  not_before_ms: number;
}

export interface Slot {
  pairing: string;
  fixture: Phrase;
  teams: [string, string];
  who: [Phrase, Phrase] | null;
  court: string;
  at_ms: number;
  running: boolean;
  begun: boolean;
  absent: string[];
  moved: MatchMove | null;
  held: Phrase | null;
}

export interface ToDraw {
  stage: string;
  title: Phrase;
  entries: string[];
  why: Phrase[];
  meet: ([number, number])[];
  met: ([string, string])[];
  apart: string[];
}

export interface Undrawable {
  stage: string;
  title: Phrase;
}

export interface ShiftState {
  shift: string;
  by_ms: number;
}

export interface DayState {
  paused: boolean;
  until_ms: number;
  reason: string;
}

export interface OfficeView {
  version: string;
  event: EventInfo;
  code: string;
  drawn: boolean;
  to_draw: ToDraw | null;
  teams: TeamRow[];
  courts: CourtRow[];
  slots: Slot[];
  day: DayState;
  shift: ShiftState | null;
  announced: string;
  undrawable: Undrawable | null;
  published: string;
  folder: string;
  staff: string[];
  me: string;
}

export interface Overviewed {
  view: OfficeView | null;
}

export interface Effect {
  lines: Phrase[];
  done: boolean;
}

export interface CourtPlan {
  coming: Slot[];
  changes: Phrase[];
}

export interface TeamPicture {
  webp: Uint8Array;
}

export interface Said {
  said: Phrase[];
}

export interface TeamLink {
  team: string;
  link: string;
  qr: string;
}

export interface RefereeLink {
  court: string;
  link: string;
  qr: string;
}

export interface SeatLink {
  court: string;
  seat: string;
  link: string;
  qr: string;
}

export interface StaffLink {
  name: string;
  link: string;
  qr: string;
}

export interface ContestLinks {
  enter: string;
  enter_qr: string;
  teams: TeamLink[];
  referees: RefereeLink[];
  seats: SeatLink[];
  staff: StaffLink[];
}

export interface CourtScore {
  court: string;
  call: string;
  phase: number;
  clock_s: number;
  duration_s: number;
  scores: number[];
}

export type AnyRequest = LookAtEvent | Apply | ChangeFiles | Own | CourtDay | Publish | Overview | Approve | Decline | NewCode | CloseEntries | Draw | Undraw | Substitute | TakeOut | SeePicture | Rule | Move | PauseContest | ResumeContest | Shift | Unshift | Announce | Staff | Tokens;
