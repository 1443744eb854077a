/**
 * Reads records of matches (MCAP): packed files, segments of a running or crashed court, whole or
 * cut. The same reading as `lacoc_shared/record/{stream,reader}.py`, but what can be had of a
 * damaged file is shown rather than refused. Runs in a worker (record.worker.ts).
 */

import { McapStreamReader } from "@mcap/core";
import { decode } from "@msgpack/msgpack";
import { decompress } from "fzstd";
import {
  BEAT_NS,
  type Event,
  type Header,
  type HealthVerdict,
  RECORD_FORMAT,
  RECORD_PROFILE,
  type Result,
  readFrame,
  type Scene,
  type Sheet,
} from "./wire";

/** A file as it was dropped or fetched. */
export interface RecordFile {
  name: string;
  data: Uint8Array;
}

/** Something by the beat from which it is valid. */
export interface Since<T> {
  beat: number;
  value: T;
}

/** A fault of a record that can still be played. */
export type Note =
  | { what: "cut"; file: string; beat: number }
  | { what: "damaged"; file: string; beat: number }
  | { what: "gap"; segment: number };

/** A match: the reader's `Record`, without what only a court understands. */
export interface MatchRecord {
  header: Header;
  files: string[];
  events: Event[];
  sheets: Since<Sheet>[];
  scenes: Since<Scene>[];
  result: Result | null;
  /** How the match was held, at its end; null: nothing is known of that. */
  verdict: HealthVerdict | null;
  frames: PackedFrames;
  /** Where the scores changed, and to what. */
  scores: Since<readonly number[]>[];
  /** Where the phase changed, and to which. */
  phases: Since<number>[];
  /** The last beat of which anything is known. */
  lastBeat: number;
  notes: Note[];
}

/** All frames in one piece of memory, as they were published: 3 minutes are 3 MB. */
export interface PackedFrames {
  /** In rising order. */
  beats: Uint32Array<ArrayBuffer>;
  /** Where each frame begins, and where the last one ends. */
  starts: Uint32Array<ArrayBuffer>;
  bytes: Uint8Array<ArrayBuffer>;
}

/** Why files can't be played: the names of messages of the page (texts/replay.toml). */
export type Why = "notMcap" | "notLacoc" | "format" | "noHeader" | "otherMatch" | "nothing";

/** There is nothing to play, and why. */
export class Unplayable extends Error {
  constructor(
    readonly why: Why,
    readonly holes: Record<string, string | number>,
  ) {
    super(why);
  }
}

const MAGIC = [0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a];
/** No record has a larger chunk; a damaged size must not take all memory. */
const CHUNK_MOST_BYTES = 1 << 26;
/** A file may unpack to this many bytes, and to this many times its own size, as stream.py has it. */
const UNPACKED_BYTES = 1 << 22;
const UNPACKED_RATIO = 50;
/** A file may have so many lists and maps, and so many for each of its bytes. */
const VALUES = 500_000;
const VALUES_RATIO = 0.5;
/** Longer texts are cut: a page takes seconds to draw some hundred thousand signs in one line. */
const TEXT_MOST = 1000;

interface FrameBytes {
  beat: number;
  bytes: Uint8Array;
  scores: readonly number[];
  phase: number;
}

/** A segment begins with a header; a court that is started again writes another one. */
interface Segment {
  file: string;
  header: Header;
  events: Event[];
  sheets: Since<Sheet>[];
  scenes: Since<Scene>[];
  results: Result[];
  verdict: HealthVerdict | null;
  frames: FrameBytes[];
  lastBeat: number;
  note: Note | null;
}

/**
 * Read a match.
 *
 * @param files A packed file, or the segments of one match, in any order.
 * @throws Unplayable if there is no match in them, or more than one.
 */
export function readRecord(files: readonly RecordFile[]): MatchRecord {
  const segments = inOrder(files.flatMap(readFile));
  const [first] = segments;
  if (!first) throw new Unplayable("noHeader", { name: files.map(({ name }) => name).join(", ") });
  for (const { header, file } of segments) {
    if (header.match_id !== first.header.match_id) {
      throw new Unplayable("otherMatch", {
        name: file,
        match: header.match_id,
        other: first.header.match_id,
      });
    }
  }
  const joined = join(segments);
  if (!joined.frames.length || !joined.sheets.length) {
    throw new Unplayable("nothing", { name: first.file });
  }
  return {
    header: first.header,
    files: [...new Set(segments.map(({ file }) => file))],
    events: joined.events,
    sheets: joined.sheets,
    scenes: joined.scenes,
    result: joined.results.at(-1) ?? null,
    verdict: joined.verdict,
    frames: pack(joined.frames),
    ...changes(joined.frames),
    lastBeat: joined.lastBeat,
    notes: notesOf(segments),
  };
}

/** The segments of a file; its note stands at the last of them. */
function readFile({ name, data }: RecordFile): Segment[] {
  if (!startsAsMcap(data)) throw new Unplayable("notMcap", { name });
  const segments: Segment[] = [];
  const topics = new Map<number, string>();
  const budget = new Budget(data.length);
  const zstd = (packed: Uint8Array, size: bigint) => budget.unpack(packed, size);
  const reader = new McapStreamReader({ decompressHandlers: { zstd } });
  let closed = false;
  let broken = false;
  try {
    reader.append(data);
    for (let record = reader.nextRecord(); record && !closed; record = reader.nextRecord()) {
      if (record.type === "Message") {
        const beat = Number(record.logTime / BigInt(BEAT_NS));
        const topic = topics.get(record.channelId);
        if (topic === "/lacoc/header") segments.push(begin(name, record.data, budget));
        else if (topic && segments.length) take(segments.at(-1)!, topic, beat, record.data, budget);
      } else if (record.type === "Channel") topics.set(record.id, record.topic);
      else if (record.type === "DataEnd") closed = true;
      else if (record.type === "Header" && record.profile !== RECORD_PROFILE) {
        throw new Unplayable("notLacoc", { name });
      }
    }
  } catch (error) {
    if (error instanceof Unplayable) throw error;
    // Unreadable: a finished file is damaged here, and an unfinished one ends here.
    broken = endsAsMcap(data);
  }
  const last = segments.at(-1);
  if (last && !closed) {
    last.note = { what: broken ? "damaged" : "cut", file: name, beat: last.lastBeat };
  }
  return segments;
}

function begin(file: string, data: Uint8Array, budget: Budget): Segment {
  const header = budget.read<Header>(data);
  if (header.format !== RECORD_FORMAT) {
    throw new Unplayable("format", {
      name: file,
      format: header.format,
      ours: RECORD_FORMAT,
      version: header.versions?.lacoc ?? "?",
    });
  }
  return {
    file,
    header,
    events: [],
    sheets: [],
    scenes: [],
    results: [],
    verdict: null,
    frames: [],
    lastBeat: header.first_beat - 1,
    note: null,
  };
}

function take(
  segment: Segment,
  topic: string,
  beat: number,
  data: Uint8Array,
  budget: Budget,
): void {
  switch (topic) {
    case "/lacoc/event":
      segment.events.push(asEvent(budget.read(data)));
      break;
    case "/lacoc/frame": {
      const { seats, phase } = readFrame(data); // bytes that are no frame must not wait for the page
      segment.frames.push({ beat, bytes: data, scores: seats.map(({ score }) => score), phase });
      break;
    }
    case "/lacoc/sheet":
      segment.sheets.push({ beat, value: budget.read<Sheet>(data) });
      break;
    case "/lacoc/scene":
      segment.scenes.push({ beat, value: budget.read<Scene>(data) });
      break;
    case "/lacoc/health":
      segment.verdict = budget.read<HealthVerdict>(data);
      break;
    case "/lacoc/result":
      segment.results.push(budget.read<Result>(data));
      return; // its time is that of its match's end, not of its writing
  }
  segment.lastBeat = Math.max(segment.lastBeat, beat);
}

/** An event; one of protocol 1 has its sentence in English alone. */
function asEvent({ text, ...event }: Event & { text?: string }): Event {
  return text === undefined ? event : { ...event, said: { code: "plain.text", values: { text } } };
}

/** Sort by number; keep the fuller of two equal ones (a packed file and its segments). */
function inOrder(segments: Segment[]): Segment[] {
  const found = new Map<string, Segment>();
  for (const segment of segments) {
    const key = `${segment.header.match_id} ${segment.header.segment}`;
    const other = found.get(key);
    if (!other || other.lastBeat < segment.lastBeat) found.set(key, segment);
  }
  return [...found.values()].sort((one, other) => one.header.segment - other.header.segment);
}

/** Drop a segment's messages from the next one's first beat on: nobody got them. */
function join(segments: readonly Segment[]): Omit<Segment, "file" | "header" | "note"> {
  const all: ReturnType<typeof join> = {
    events: [],
    sheets: [],
    scenes: [],
    results: [],
    verdict: null,
    frames: [],
    lastBeat: -1,
  };
  for (const segment of segments) {
    const first = segment.header.first_beat;
    if (all.lastBeat >= first) {
      all.events = all.events.filter(({ beat }) => beat < first);
      all.sheets = all.sheets.filter(({ beat }) => beat < first);
      all.scenes = all.scenes.filter(({ beat }) => beat < first);
      all.frames = all.frames.filter(({ beat }) => beat < first);
      all.results = all.results.filter(({ beats }) => beats <= first);
    }
    all.events.push(...segment.events);
    all.sheets.push(...segment.sheets);
    all.scenes.push(...segment.scenes);
    all.results.push(...segment.results);
    all.verdict = segment.verdict ?? all.verdict;
    all.frames = all.frames.concat(segment.frames);
    all.lastBeat = segment.lastBeat;
  }
  return all;
}

function notesOf(segments: readonly Segment[]): Note[] {
  const notes: Note[] = [];
  let expected = 0;
  for (const [index, { header, note }] of segments.entries()) {
    for (; expected < header.segment; expected++) notes.push({ what: "gap", segment: expected });
    expected = header.segment + 1;
    // A court that was killed leaves a segment cut; the next one goes on where it stopped.
    if (note && (note.what === "damaged" || index === segments.length - 1)) notes.push(note);
  }
  return notes;
}

function pack(frames: readonly FrameBytes[]): PackedFrames {
  const beats = Uint32Array.from(frames, ({ beat }) => beat);
  const starts = new Uint32Array(frames.length + 1);
  for (const [index, { bytes }] of frames.entries()) {
    starts[index + 1] = starts[index]! + bytes.length;
  }
  const all = new Uint8Array(starts[frames.length]!);
  for (const [index, { bytes }] of frames.entries()) all.set(bytes, starts[index]!);
  return { beats, starts, bytes: all };
}

function changes(frames: readonly FrameBytes[]): Pick<MatchRecord, "scores" | "phases"> {
  const found: Pick<MatchRecord, "scores" | "phases"> = { scores: [], phases: [] };
  for (const { beat, scores, phase } of frames) {
    if (String(found.scores.at(-1)?.value) !== String(scores)) {
      found.scores.push({ beat, value: scores });
    }
    if (found.phases.at(-1)?.value !== phase) found.phases.push({ beat, value: phase });
  }
  return found;
}

/** What one file may cost: its records come from anybody. */
class Budget {
  private bytes: number;
  private values: number;

  constructor(size: number) {
    this.bytes = UNPACKED_BYTES + UNPACKED_RATIO * size;
    this.values = VALUES + VALUES_RATIO * size;
  }

  unpack(data: Uint8Array, size: bigint): Uint8Array {
    this.bytes -= Number(size);
    if (size > CHUNK_MOST_BYTES || this.bytes < 0) throw new Error("too large");
    return decompress(data, new Uint8Array(Number(size)));
  }

  read<T>(data: Uint8Array): T {
    for (const byte of data) {
      // The bytes with which a list or a map begins in msgpack; ASCII text has none of them.
      if ((byte >= 0x80 && byte < 0xa0) || (byte >= 0xdc && byte < 0xe0)) this.values--;
    }
    if (this.values < 0) throw new Error("too many values");
    return shortened(decode(data)) as T;
  }
}

function shortened(value: unknown): unknown {
  if (typeof value === "string") {
    return value.length > TEXT_MOST ? `${value.slice(0, TEXT_MOST)}…` : value;
  }
  if (Array.isArray(value)) return value.map(shortened);
  if (value === null || typeof value !== "object" || ArrayBuffer.isView(value)) return value;
  return Object.fromEntries(Object.entries(value).map(([name, one]) => [name, shortened(one)]));
}

function startsAsMcap(data: Uint8Array): boolean {
  return MAGIC.every((byte, index) => data[index] === byte);
}

function endsAsMcap(data: Uint8Array): boolean {
  const end = data.length - MAGIC.length;
  return end > MAGIC.length && MAGIC.every((byte, index) => data[end + index] === byte);
}
