/** Files that a page hands on to another site's page, in the fragment: no server receives that. */

import { fromBase64, SLOTS, type Slot, toBase64 } from "./files";
import type { SentFile } from "./wire";

export type GivenFiles = Record<Slot, SentFile | null>;

const NAME = "files";
/** The end of a path: a page of the site, which somebody has copied with the address. */
const PAGE = /\/(enter|contest|play|watch|office|referee|replay)?\/*$/;

/** The address of /enter beside the typed page, or below a typed path; "": it is no address. */
export function enterPage(address: string): string {
  const typed = address.trim();
  if (!typed) return "";
  try {
    const { origin, pathname } = new URL(/^https?:\/\//i.test(typed) ? typed : `http://${typed}`);
    return `${origin}${pathname.replace(PAGE, "")}/enter`;
  } catch {
    return "";
  }
}

/** Files as a fragment, without its "#". */
export function filesFragment(files: GivenFiles): string {
  const kept = SLOTS.flatMap((slot) => {
    const file = files[slot];
    return file ? [[slot, file.name, toBase64(file.data)]] : [];
  });
  return `${NAME}=${encodeURIComponent(JSON.stringify(kept))}`;
}

/** The files of a fragment; null: it has none, or they can't be read. */
export function filesOf(hash: string): GivenFiles | null {
  const text = new URLSearchParams(hash.replace(/^#/, "")).get(NAME);
  if (!text) return null;
  const files: GivenFiles = { robot: null, postures: null, locomotion: null };
  try {
    for (const [slot, name, base64] of JSON.parse(text) as [Slot, string, string][]) {
      if (SLOTS.includes(slot)) files[slot] = { name: String(name), data: fromBase64(base64) };
    }
  } catch {
    return null; // nothing that a page of ours wrote
  }
  return files;
}
