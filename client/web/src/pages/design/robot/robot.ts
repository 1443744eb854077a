/** The robot that walks on this page. */

import { computed, signal } from "@preact/signals";
import type { RobotReply, SentFile } from "../../../core/wire";
import type { Gateway } from "../gateway";
import type { RobotNumber } from "./units";

/** Name of the file that a change of the workshop's hexapod begins. */
const NEW_FILE = "robot.toml";

/** A number, and its value in the unit of its name. */
export type Change = readonly [number: RobotNumber, value: number];

/** A robot that was read. */
export interface ReadRobot {
  /** Name of its file; "": the workshop's hexapod. */
  name: string;
  /** What stands in the file; null: the workshop's hexapod. */
  text: string | null;
  reply: RobotReply;
  /** Whether numbers were changed on this page. */
  isEdited: boolean;
}

/** What a file of the folder has, as far as the page knows. */
interface Known {
  version: string;
  /** null: the page never saw it. */
  text: string | null;
}

export class RobotInUse {
  /** null: not known yet. */
  readonly used = signal<ReadRobot | null>(null);
  readonly robot = computed<RobotReply | null>(() => this.used.value?.reply ?? null);
  /** Name of the robot's file; "": the workshop's hexapod. */
  readonly name = computed(() => this.used.value?.name ?? "");

  /** Settles when no change of a number is under way. */
  settled: Promise<unknown> = Promise.resolve();
  private readonly known = signal<ReadonlyMap<string, Known>>(new Map());
  /** Whether nothing would be lost without this page. */
  readonly isSaved = computed(() => {
    const used = this.used.value;
    if (!used || used.text === null) return true;
    const known = this.known.value.get(used.name);
    return known ? known.text === used.text : !used.isEdited;
  });

  constructor(private readonly gateway: Gateway) {}

  /** Read a robot file; the text null is the workshop's hexapod. */
  async read(name: string, text: string | null): Promise<ReadRobot> {
    const robot = text === null ? null : { name, data: new TextEncoder().encode(text) };
    const reply = await this.gateway.ask<RobotReply>("robot", { robot });
    return { name: text === null ? "" : name, text, reply, isEdited: false };
  }

  /** The robot with other numbers; rejects with `Refused` if no robot may have them. */
  async changed(used: ReadRobot, changes: readonly Change[]): Promise<ReadRobot> {
    const name = used.name || NEW_FILE;
    let { text } = used;
    for (const [{ entry, leg }, value] of changes) {
      const fields = { robot: fileOf({ name, text }), entry, leg: leg ?? 0, value };
      text = (await this.gateway.ask<{ robot: string }>("set_robot", fields)).robot;
    }
    return { ...(await this.read(name, text)), isEdited: true };
  }

  /** Take in what a file of the folder has. */
  learn(name: string, version: string, text: string | null): void {
    this.known.value = new Map(this.known.peek()).set(name, { version, text });
  }

  /** The version of the robot's file that the page knows; "": it knows none. */
  versionOf(name: string): string {
    return this.known.peek().get(name)?.version ?? "";
  }

  use(robot: ReadRobot): void {
    this.used.value = robot;
  }

  /** The robot as a request sends it; null: the workshop's hexapod. */
  sent(): SentFile | null {
    const used = this.used.peek();
    return used && fileOf(used);
  }
}

function fileOf({ name, text }: Pick<ReadRobot, "name" | "text">): SentFile | null {
  return text === null ? null : { name, data: new TextEncoder().encode(text) };
}
