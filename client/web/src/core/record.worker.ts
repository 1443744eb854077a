/** Reads records in a worker, so that the page goes on drawing. */

import { type MatchRecord, type RecordFile, readRecord, Unplayable, type Why } from "./record";

/** What the worker answers. */
export type Answer =
  | { record: MatchRecord }
  | { why: Why; holes: Record<string, string | number> }
  | { fault: string };

// The page's types have `window`, not a worker's own scope.
const scope = self as unknown as {
  onmessage: ((message: MessageEvent<RecordFile[]>) => void) | null;
  postMessage(answer: Answer, transfer: Transferable[]): void;
};

scope.onmessage = ({ data: files }) => {
  try {
    const record = readRecord(files);
    const { beats, starts, bytes } = record.frames;
    scope.postMessage({ record }, [beats.buffer, starts.buffer, bytes.buffer]);
  } catch (error) {
    scope.postMessage(
      error instanceof Unplayable
        ? { why: error.why, holes: error.holes }
        : { fault: String(error) },
      [],
    );
  }
};
