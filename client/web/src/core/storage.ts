/** Data that survives a reload. If a browser forbids that, it is kept until the page closes. */

class Kept {
  /** The page's own copy: right even if the browser stores nothing. */
  private readonly here = new Map<string, string | null>();

  /** @param storage Gives the browser's; throws where it is forbidden. */
  constructor(private readonly storage: () => Storage) {}

  /** A text; null if there is none. */
  read(name: string): string | null {
    const here = this.here.get(name);
    if (here !== undefined) return here;
    try {
      return this.storage().getItem(name);
    } catch {
      return null;
    }
  }

  /** Keep a text; null forgets it. */
  write(name: string, text: string | null): void {
    this.here.set(name, text);
    try {
      if (text === null) this.storage().removeItem(name);
      else this.storage().setItem(name, text);
    } catch {
      // It is kept here.
    }
  }
}

/** For this tab: what belongs to one person at one court. */
export const tab = new Kept(() => sessionStorage);

/** For all tabs, and until another day: what somebody likes. */
export const browser = new Kept(() => localStorage);

export type { Kept };
