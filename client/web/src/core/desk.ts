/** The connection to the desk of a contest's office; the gateway passes requests on. */

import { socketUrl } from "./address";
import { Connection } from "./connection";
import type { AnyRequest } from "./desk.gen";

export * from "./desk.gen";

const PING_MS = 2000;

export class Desk {
  readonly connection: Connection;

  constructor() {
    this.connection = new Connection(
      socketUrl("office/ws"),
      () => this.connection.ask("ping"),
      () => undefined,
    );
    setInterval(() => this.connection.ask("ping").catch(() => undefined), PING_MS);
  }

  /** Ask the desk; rejects with `Refused`. */
  ask<T>(request: AnyRequest): Promise<T> {
    return this.connection.ask<T>("desk", { request });
  }
}
