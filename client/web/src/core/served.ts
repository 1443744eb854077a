/** Which other pages the gateway of this page has. */

/** Whether there is a page at a path, such as "/design". */
export async function hasPage(path: string): Promise<boolean> {
  try {
    const health: { pages?: string[] } = await (await fetch("healthz")).json();
    return health.pages?.includes(path) ?? false;
  } catch {
    return false; // no gateway, or none that answers
  }
}
