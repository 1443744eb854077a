/** Trials outlive a reload: this browser keeps the newest ones of each student. */

import type { Tried } from "./tried";

const DATABASE = "lacoc";
const STORE = "trials";

/** What is kept of a trial. */
interface Row {
  whose: string;
  tried: Tried;
}

/** The trials of one student, or of one folder. */
export class KeptTrials {
  private whose: string | null = null;

  /** @param most How many trials are kept. */
  constructor(private readonly most: number) {}

  /**
   * Read the trials that are kept; [] where the browser keeps nothing.
   *
   * @param whose Whose trials are read, and kept from now on.
   */
  async open(whose: string): Promise<Tried[]> {
    this.whose = whose;
    const rows = await this.work("readonly", (store) => store.index("whose").getAll(whose));
    return (rows as Row[] | null)?.map(({ tried }) => tried) ?? [];
  }

  async add(tried: Tried): Promise<void> {
    if (this.whose === null) return;
    const row: Row = { whose: this.whose, tried };
    await this.work("readwrite", (store) => store.add(row));
    await this.forget(this.most);
  }

  async clear(): Promise<void> {
    await this.forget(0);
  }

  /** Delete all but the newest ones. */
  private async forget(kept: number): Promise<void> {
    const { whose } = this;
    if (whose === null) return;
    const keys = await this.work("readonly", (store) => store.index("whose").getAllKeys(whose));
    for (const key of keys?.slice(0, Math.max(0, keys.length - kept)) ?? []) {
      await this.work("readwrite", (store) => store.delete(key));
    }
  }

  /** Do something with the browser's store; null: it has none, or it is full. */
  private async work<T>(
    mode: IDBTransactionMode,
    act: (store: IDBObjectStore) => IDBRequest<T>,
  ): Promise<T | null> {
    try {
      const database = await opened();
      try {
        return await done(act(database.transaction(STORE, mode).objectStore(STORE)));
      } finally {
        database.close();
      }
    } catch {
      return null;
    }
  }
}

function opened(): Promise<IDBDatabase> {
  const opening = indexedDB.open(DATABASE, 1);
  opening.onupgradeneeded = () => {
    const store = opening.result.createObjectStore(STORE, { autoIncrement: true });
    store.createIndex("whose", "whose");
  };
  return done(opening);
}

function done<T>(request: IDBRequest<T>): Promise<T> {
  return new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });
}
