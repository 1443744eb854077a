/** The robot that walks on this page. */

import { computed, signal } from "@preact/signals";
import type { RobotReply, SentFile } from "../../../core/wire";
import type { Gateway } from "../gateway";

/** A robot that was read. */
export interface ReadRobot {
  /** Name of its file; "": the workshop's hexapod. */
  name: string;
  /** What stands in the file; null: the workshop's hexapod. */
  text: string | null;
  reply: RobotReply;
}

export class RobotInUse {
  /** null: not known yet. */
  readonly used = signal<ReadRobot | null>(null);
  readonly robot = computed<RobotReply | null>(() => this.used.value?.reply ?? null);
  /** Name of the robot's file; "": the workshop's hexapod. */
  readonly name = computed(() => this.used.value?.name ?? "");

  constructor(private readonly gateway: Gateway) {}

  /** Read a robot file; the text null is the workshop's hexapod. */
  async read(name: string, text: string | null): Promise<ReadRobot> {
    const robot = text === null ? null : { name, data: new TextEncoder().encode(text) };
    const reply = await this.gateway.ask<RobotReply>("robot", { robot });
    return { name: text === null ? "" : name, text, reply };
  }

  use(robot: ReadRobot): void {
    this.used.value = robot;
  }

  /** The robot as a request sends it; null: the workshop's hexapod. */
  sent(): SentFile | null {
    const text = this.used.peek()?.text ?? null;
    if (text === null) return null;
    return { name: this.name.peek(), data: new TextEncoder().encode(text) };
  }
}
