/** The parts of the page's address. */

import { tab } from "./storage";

const KEY = "lacoc-key";
const TOKEN = "lacoc-team-token";
const ORGANISER = "lacoc-organiser";
const REFEREE = "lacoc-referee";
const query = new URLSearchParams(location.search);

/** The page, where its own file says it: in a published folder, which has no gateway. */
export const ownPage = globalThis.document?.body.dataset.page ?? null;

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

/** The gateway's key, which lets a page act. */
export function runKey(): string | null {
  return secret("key", KEY);
}

/** The token of a team, for the whole contest. */
export function teamToken(): string | null {
  return secret("token", TOKEN);
}

/** The token of a court's referee. */
export function refereeToken(): string | null {
  return secret("token", REFEREE);
}

/** Keep a referee's token for this tab; null forgets it. */
export function keepRefereeToken(token: string | null): void {
  tab.write(REFEREE, token);
}

/** The organiser's key, which opens the office. */
export function organiserKey(): string | null {
  return secret("organiser", ORGANISER);
}

/** Keep a team's token for this tab; null forgets it. */
export function keepTeamToken(token: string | null): void {
  tab.write(TOKEN, token);
}

/**
 * A secret of the fragment, which is never sent. A reload within the tab finds it in the tab's own
 * storage, so that it need not stay in sight.
 */
function secret(name: string, keptAs: string): string | null {
  const parts = new URLSearchParams(location.hash.slice(1));
  const found = parts.get(name);
  if (!found) return tab.read(keptAs);
  tab.write(keptAs, found);
  parts.delete(name);
  const rest = parts.toString();
  history.replaceState(null, "", location.pathname + location.search + (rest && `#${rest}`));
  return found;
}

/** Another court is another address: a reload then comes back to it. Null: follow the director. */
export function goToCourt(court: string | null): void {
  const query = new URLSearchParams(location.search);
  query.delete("director");
  if (court === null) {
    query.delete("court");
    query.set("director", "1");
  } else query.set("court", court);
  location.search = query.toString();
}

/**
 * Where a WebSocket of the gateway is. All pages stand side by side, and all their addresses are
 * relative, because a proxy may have put them below a path.
 */
export function socketUrl(path = "ws"): string {
  const url = new URL(path, location.href);
  url.protocol = url.protocol.replace("http", "ws");
  url.hash = "";
  return url.href;
}

/** An address without what every browser adds by itself. */
export function short(address: string): string {
  return address.replace(/^https?:\/\//, "");
}

/** The address of the pages as this page was opened, without a slash at its end. */
export function pagesUrl(): string {
  return new URL(".", location.href).href.replace(/\/$/, "");
}
