/** The parts of the page's address. */

import { tab } from "./storage";

const KEY = "lacoc-key";
/** Where the tab keeps the token of a link, by the page that it opens. */
const TOKENS: Readonly<Record<string, string>> = {
  referee: "lacoc-referee",
  office: "lacoc-organiser",
};
const TEAM_TOKEN = "lacoc-team-token";
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

/** The key of the gateway's owner. */
export function runKey(): string | null {
  return secret("key", KEY);
}

/** The token of whoever opened this page by link: of a team, a referee or the organiser. */
export function ownToken(): string | null {
  return secret("token", tokenKept());
}

/** Keep the token for this tab; null forgets it. */
export function keepToken(token: string | null): void {
  tab.write(tokenKept(), token);
}

/** Any secret of this tab with which the gateway lets it act: the owner's key first. */
export function anySecret(): string | null {
  return runKey() ?? tab.read(TEAM_TOKEN) ?? tab.read(TOKENS.referee!);
}

function tokenKept(): string {
  return TOKENS[location.pathname.replace(/\/+$/, "").split("/").pop()!] ?? TEAM_TOKEN;
}

/**
 * A secret of the fragment, which is never sent. A reload within the tab finds it in the tab's own
 * storage, so that it need not stay in sight.
 */
function secret(name: string, keptAs: string): string | null {
  const found = takePart(name);
  if (!found) return tab.read(keptAs);
  tab.write(keptAs, found);
  return found;
}

/** Take a part out of the fragment: a reload finds an address without it. */
export function takePart(name: string): string | null {
  const parts = new URLSearchParams(location.hash.slice(1));
  const found = parts.get(name);
  if (!found) return null;
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
