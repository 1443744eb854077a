/** Which other pages the gateway of this page has, and where they are for others. */

import { ownPage } from "./address";

/** Whether there is a page at a path, such as "/design". */
export async function hasPage(path: string): Promise<boolean> {
  try {
    const health: { pages?: string[] } = await (await fetch("healthz")).json();
    return health.pages?.includes(path) ?? false;
  } catch {
    return false; // no gateway, or none that answers
  }
}

/**
 * The address of a contest's pages as other machines can open it: this one may have been opened at
 * another. "": teams enter nowhere here.
 */
export async function pagesForAll(): Promise<string> {
  if (ownPage || !(await hasPage("/enter"))) return "";
  try {
    const { pages }: { pages: string } = await (await fetch("enter.json")).json();
    return pages;
  } catch {
    return "";
  }
}
