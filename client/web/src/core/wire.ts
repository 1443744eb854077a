/** Messages between the gateway and a page: a kind byte, then msgpack (docs/gateway.md). */

import { decode, encode } from "@msgpack/msgpack";
import type { Phrase } from "./phrase";
import {
  type Card,
  type Event,
  type FileTable,
  type FolderFile,
  FRAME_FIELDS,
  type Frame,
  HASH_BYTES,
  type Health,
  MESSAGE_KINDS,
  type Mistake,
  type Phases,
  type Progress,
  type RobotReply,
  type Scene,
  SEATFRAME_FIELDS,
  type SeatFrame,
  type Sheet,
  type StudentRules,
  type TournamentState,
  type TrialReply,
} from "./wire.gen";

export * from "./wire.gen";

/** The gateway's first message. */
export interface Welcome {
  protocol: number;
  version: string;
  courts: string[];
  court: string | null;
  can_act: boolean;
  home: "venue" | "player" | "practice";
  /** The contest's name; "" if it has none. */
  contest: string;
  /** Whether there is the page /enter. */
  desk: boolean;
  /** Whether people who watch may cheer. */
  cheers: boolean;
  prefill: Prefill | null;
}

/** What was named on the command line that started the gateway. */
export interface Prefill {
  seat: string;
  name: string;
  has_token: boolean;
}

/** The files on the machine of the gateway, which a join brings unless it has others. */
export interface OwnFiles {
  /** Names; "" where there is none. */
  robot: string;
  postures: string;
  locomotion: string;
  /** Grows whenever they are saved again. */
  version: number;
  /** The version with which this page joined its seat; null if this message does not say. */
  used: number | null;
  /** The files that the newest version changed. */
  changed: string[];
  /** Why the newest version can't be used; "" if it can. */
  error: Phrase | null;
  mistakes: Mistake[];
}

/** Who watches the event, and what was cheered in the last second. */
export interface Crowd {
  watching: number;
  /** How often, by symbol. */
  cheers: number[];
}

/** The gateway's own link to the court. */
export interface Link {
  court: string;
  connected: boolean;
  silent_s: number;
  /** Why it is not connected. */
  why: Phrase | null;
  /** A new number means that a new log of events begins; all its events follow. */
  log: number;
}

/** The seat that this page holds. */
export interface HeldSeat {
  seat: string;
  index: number;
  /** The name of `hold.*`. */
  hold: string;
  reason: Phrase | null;
  /** Number of the court's session that holds the seat; 0: unknown. */
  session: number;
}

/** What the organiser of a contest tells everybody. */
export interface Notice {
  /** A line to all; "" if there is none. */
  text: string;
  /** Whether no game is called before somebody says so. */
  paused: boolean;
  /** No game is called before this time, in milliseconds since 1970; 0: at any time. */
  until_ms: number;
  reason: string;
}

/** Who acts as referee through this gateway. */
export interface RefereeState {
  acting: string | null;
  mine: boolean;
}

/** What a picture of the director shows, for the pages that follow it. */
export interface Programme {
  court: string;
  /** Why this court is shown: name of a message `director.why.…`; "" if it is not. */
  why: string;
  /** False: there is no second picture now. */
  is_shown: boolean;
  /** How much later all is shown than it is played [s]. */
  behind_s: number;
  /** The programme begins in so many seconds; 0: it has begun. */
  begins_s: number;
  /** The newest results, the newest first. */
  results: ShownResult[];
}

/** How a match at some court ended. */
export interface ShownResult {
  court: string;
  match: string;
  /** Title of the game. */
  title: string;
  /** What the match is in its contest. */
  fixture: Phrase | null;
  /** Names by seat. */
  teams: string[];
  scores: number[];
  phase: number;
}

/** The gait and robot files of the folder that `lacoc design` was started with. */
export interface Folder {
  /** Its path. */
  folder: string;
  files: FolderFile[];
  /** The files that came, went or changed since the last message. */
  changed: string[];
}

/** Whether there is a studio to let robots walk. */
export interface StudioState {
  present: boolean;
  /** Why there is none. */
  why: Phrase | null;
}

/** The class; its cards come only with the first of these messages. */
export interface ClassState {
  code: string;
  /** What students type into their browsers. */
  addresses: string[];
  /** The first of them as a QR code, in SVG; "": there is none. */
  qr: string;
  rules: StudentRules;
  trouble: Phrase | null;
  studios: number;
  /** Why there is no studio. */
  why: Phrase | null;
  handed: { number: number; title: string } | null;
  groups: ClassGroup[];
  cards: Card[] | null;
}

/** A student's robot on the big screen. */
export interface ShowReply {
  name: string;
  robot: RobotReply;
  trial: TrialReply;
}

/** A shared table as a page begins with it. */
export interface OpenedTable {
  /** Which table; "": the student's own. */
  table: string;
  /** Which document of it: only updates of the same one can be merged. */
  epoch: string;
  /** Number of the newest update. */
  seq: number;
  /** The document, as Yjs writes it; empty: it has no table yet. */
  state: Uint8Array;
  /** How many other pages have it open. */
  others: number;
}

/** What happened to a shared table. */
export interface TableNews {
  table: string;
  epoch: string;
  seq: number;
  update?: Uint8Array;
  /** Another document takes the place of the one that was there. */
  state?: Uint8Array;
  /** Cells into which this page and another one typed without having seen each other's. */
  clash?: { cells: string[]; by: number };
}

export interface GroupMember {
  name: string;
  /** What the member designs: "forward" rows 1 to 4, "turn" rows 5 to 8; "": nothing special. */
  role: "" | "forward" | "turn";
  online: boolean;
}

/** The groups of a class, and a student's own. */
export interface GroupNews {
  /** All groups, with the count of their members. */
  groups: { name: string; members: number }[];
  /** null: the student works alone. */
  group: {
    name: string;
    members: GroupMember[];
    words: { word: string; by: string; votes: number }[];
    /** The word with most votes; "": none. */
    word: string;
    /** The word for which this student has voted; "": none. */
    voted: string;
    /** Number of the newest handed-out table that a member has taken for all. */
    taken: number;
  } | null;
}

/** A group as the teacher sees it. */
export interface ClassGroup {
  name: string;
  members: string[];
  roles: Record<string, GroupMember["role"]>;
  word: string;
  /** Title of the last table that was handed out to it; null: none. */
  handed: string | null;
}

/** A page at a shared table. */
export interface Person {
  /** Counts the pages of the table, from 1. */
  id: number;
  /** "" for whoever designs alone. */
  name: string;
  /** -1: nowhere. */
  row: number;
  col: number;
  /** What is being typed; null: nothing is. */
  typing: string | null;
}

/** A table that the teacher of a class handed out. */
export interface HandedTable {
  /** Counts the tables of the class, from 1. */
  number: number;
  title: string;
  table: FileTable;
  /** The digits of each key; null: the sample's, or the table itself has them. */
  sequences: number[][] | null;
}

interface GoodReply {
  id: number;
  ok: true;
  value: unknown;
}

export interface BadReply {
  id: number;
  ok: false;
  error: Phrase;
  mistakes: Mistake[];
  /** The court does not take this token: to show it again is of no use. */
  token_refused: boolean;
  /** The court can't take it now: the same may be taken later. */
  again: boolean;
  /** The court was asked, and its answer is missing: it may have done it. */
  unanswered: boolean;
}

/** A message from the gateway. */
export type Message =
  | { kind: "welcome"; body: Welcome }
  | { kind: "frame"; body: Frame }
  | { kind: "event"; body: Event }
  | { kind: "sheet"; body: Sheet }
  | { kind: "scene"; body: Scene; hash: Uint8Array }
  | { kind: "health"; body: Health }
  | { kind: "link"; body: Link }
  | { kind: "seat"; body: HeldSeat }
  | { kind: "notice"; body: Notice }
  | { kind: "crowd"; body: Crowd }
  | { kind: "reply"; body: GoodReply | BadReply }
  | { kind: "referee"; body: RefereeState }
  | { kind: "files"; body: OwnFiles }
  | { kind: "folder"; body: Folder }
  | { kind: "progress"; body: Progress & { job: string } }
  | { kind: "studio"; body: StudioState }
  | { kind: "phases"; body: Phases }
  | { kind: "class"; body: ClassState }
  | { kind: "card"; body: Card }
  | { kind: "gone"; body: { name: string } }
  | { kind: "programme"; body: Programme }
  | { kind: "tournament"; body: TournamentState }
  | { kind: "handed"; body: HandedTable }
  | { kind: "forgotten"; body: Record<string, never> }
  | { kind: "table"; body: TableNews }
  | { kind: "group"; body: GroupNews }
  | { kind: "people"; body: { me: number; people: Person[] } };

/** What a page asks for; each request is answered by a reply with its id. */
export type Request =
  | "watch"
  | "rate"
  | "ping"
  | "join"
  | "where"
  | "ready"
  | "leave"
  | "key"
  | "saw"
  | "cheer"
  | "try"
  | "enter"
  | "take_over"
  | "outlook"
  | "decide"
  | DesignRequest
  | ClassRequest
  | DeskRequest;

/** What a page of /design asks for. */
type DesignRequest =
  | "hello"
  | "answer"
  | "step"
  | "read"
  | "sample"
  | "parse"
  | "save"
  | "write"
  | "robot"
  | "set_robot"
  | "trial"
  | "coach"
  | "map"
  | "variants"
  | "cancel"
  | "table"
  | "place"
  | "group"
  | "edit"
  | "check"
  | "play"
  | "hand_on"
  | "phase"
  | "name"
  | "vote"
  | "hand";

/** What the teacher's page asks for. */
type ClassRequest =
  | "rules"
  | "hand_out"
  | "lower"
  | "seat"
  | "admit"
  | "forget"
  | "new_code"
  | "show"
  | "export"
  | "stop_play";

/** What the pages of an organiser and of teams ask for. */
type DeskRequest = "desk" | "link" | "links";

/** A file on its way to the court. */
export interface SentFile {
  name: string;
  data: Uint8Array;
}

/** Read a message; null for a kind of a newer gateway. */
export function readMessage(bytes: Uint8Array): Message | null {
  const kind = MESSAGE_KINDS[bytes[0] ?? 0];
  if (!kind) return null;
  let rest = bytes.subarray(1);
  if (kind === "scene") {
    const hash = rest.slice(0, HASH_BYTES);
    rest = rest.subarray(HASH_BYTES);
    return { kind, hash, body: decode(rest) as Scene };
  }
  const body = kind === "frame" ? readFrame(rest) : decode(rest);
  return { kind, body } as Message;
}

/** Read a frame: an array on the wire. */
export function readFrame(bytes: Uint8Array): Frame {
  const frame = named<Frame>(decode(bytes) as unknown[], FRAME_FIELDS);
  frame.seats = (frame.seats as unknown as unknown[][]).map((seat) =>
    named<SeatFrame>(seat, SEATFRAME_FIELDS),
  );
  return frame;
}

/** Write a request. */
export function writeRequest(id: number, what: Request, fields: object): Uint8Array<ArrayBuffer> {
  return encode({ id, do: what, ...fields });
}

/** The states of `count` markers, from two bits each. */
export function unpackStates(packed: Uint8Array, count: number): number[] {
  const states = new Array<number>(count);
  for (let index = 0; index < count; index++) {
    states[index] = ((packed[index >> 2] ?? 0) >> ((index & 3) * 2)) & 3;
  }
  return states;
}

/** Whether two runs of bytes are the same. */
export function sameBytes(one: Uint8Array, other: Uint8Array): boolean {
  return one.length === other.length && one.every((byte, index) => byte === other[index]);
}

function named<T>(values: unknown[], names: readonly string[]): T {
  return Object.fromEntries(names.map((name, index) => [name, values[index]])) as T;
}
