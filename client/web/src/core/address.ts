/** The parts of the page's address. */

import { tab } from "./storage";

const KEY = "lacoc-key";
/** The page, where its own file says it: in a published folder, which has no gateway. */
export const ownPage = globalThis.document?.body.dataset.page ?? null;

const query = new URLSearchParams(location.search);

/** A setting of the address: `?q=low`. */
export function setting(name: string, otherwise = ""): string {
  return query.get(name) ?? otherwise;
}

/** A switch of the address: `?split=1`. */
export function flag(name: string, otherwise: boolean): boolean {
  const value = query.get(name);
  return value === null ? otherwise : !["0", "no", "false", "off"].includes(value);
}

/** A number of the address, kept within bounds. */
export function amount(name: string, otherwise: number, least: number, most: number): number {
  const value = Number(query.get(name) ?? Number.NaN);
  return Number.isFinite(value) ? Math.min(most, Math.max(least, value)) : otherwise;
}

/**
 * The gateway's key, which lets a page act. It stands in the fragment, which is never sent; a
 * reload within the tab finds it in the tab's own storage, so that it need not stay in sight.
 */
export function runKey(): string | null {
  const found = new URLSearchParams(location.hash.slice(1)).get("key");
  if (found) {
    tab.write(KEY, found);
    history.replaceState(null, "", location.pathname + location.search);
    return found;
  }
  return tab.read(KEY);
}

/** Where a WebSocket of the gateway is. */
export function socketUrl(path = "/ws"): string {
  return `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}${path}`;
}
