/** A search of the coach: one at a time, with its progress, and it can be stopped. */

import { signal } from "@preact/signals";
import type { Progress } from "../../../core/wire";
import type { Gateway } from "../gateway";

export class Search {
  /** Name of the search that runs; null: none. */
  readonly job = signal<string | null>(null);
  readonly progress = signal<(Progress & { job: string }) | null>(null);
  private jobs = 0;

  constructor(private readonly gateway: Gateway) {}

  /** Search; null: it was refused, or another search was begun meanwhile. */
  async ask<T>(what: "coach" | "map" | "variants", fields: object): Promise<T | null> {
    const job = `p${Date.now().toString(36)}-${++this.jobs}`;
    this.job.value = job;
    this.progress.value = null;
    try {
      const reply = await this.gateway.ask<T>(what, { job, ...fields });
      return this.job.peek() === job ? reply : null;
    } catch (error) {
      this.gateway.refuse(error);
      return null;
    } finally {
      if (this.job.peek() === job) this.job.value = null;
    }
  }

  /** Stop searching; what was found so far comes as the reply. */
  stop(): void {
    void this.gateway.ask("cancel", { job: this.job.peek() }).catch(() => undefined);
  }
}
