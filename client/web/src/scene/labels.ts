/** The names of columns, rows, corners and flags in the picture, as text of the page. */

import { type Border, borderOf, ownLabel } from "../core/border";
import type { Sheet } from "../core/wire";
import type { Model } from "./model";
import type { Placing } from "./tags";

/** How far outside of the floor the border is written. */
const OUT_M = 0.06;
const FLAG_M = 0.3;
const NO_BORDER: Border = { columns: [], rows: [] };

export class Labels {
  private readonly layer: HTMLElement;
  private border = NO_BORDER;
  private columns: HTMLElement[] = [];
  private rows: HTMLElement[] = [];
  /** By marker; only those that the border does not name. */
  private own = new Map<number, HTMLElement>();

  constructor(host: HTMLElement) {
    this.layer = document.createElement("div");
    this.layer.className = "view-tags";
    this.layer.setAttribute("aria-hidden", "true");
    host.append(this.layer);
  }

  /** Take the board. */
  name({ markers }: Sheet): void {
    this.border = borderOf(markers);
    this.columns = this.border.columns.map(([text]) => label(text));
    this.rows = this.border.rows.map(([text]) => label(text));
    this.own = new Map(
      markers.flatMap((marker, index) => {
        const text = ownLabel(marker);
        return text ? [[index, label(text)]] : [];
      }),
    );
    this.layer.replaceChildren(...this.columns, ...this.rows, ...this.own.values());
  }

  /** Put the labels where the board is; null hides them. */
  draw(model: Model | null, place: Placing): void {
    this.layer.hidden = !model;
    if (!model) return;
    const { x, y, halfX, halfY } = model.field;
    // The edge that is lower in the picture: the robots stand in front of the other one.
    const edge = (one: ReturnType<Placing>, other: ReturnType<Placing>) =>
      (one?.y ?? 0) >= (other?.y ?? 0);
    const below = -halfY - OUT_M;
    const near = edge(place(x, y + below, 0), place(x, y - below, 0)) ? below : -below;
    for (const [index, [, at]] of this.border.columns.entries()) {
      put(this.columns[index]!, place(at, y + near, 0));
    }
    const left = place(x - halfX - OUT_M, y, 0);
    const right = place(x + halfX + OUT_M, y, 0);
    const beside = (left?.x ?? 0) <= (right?.x ?? 0) ? -halfX - OUT_M : halfX + OUT_M;
    for (const [index, [, at]] of this.border.rows.entries()) {
      put(this.rows[index]!, place(x + beside, at, 0));
    }
    for (const [index, element] of this.own) {
      const { x_m, y_m, radius_m } = model.sheet.markers[index]!;
      const stands = radius_m < OUT_M && !model.states[index];
      put(element, place(x_m, y_m, stands ? FLAG_M : 0));
    }
  }

  end(): void {
    this.layer.remove();
  }
}

function label(text: string): HTMLElement {
  const element = document.createElement("div");
  element.className = "view-label";
  element.textContent = text;
  return element;
}

/** Put the middle of an element at a place of the picture; without a place it is hidden. */
export function put(element: HTMLElement, at: ReturnType<Placing>): void {
  if (element.hidden !== !at) element.hidden = !at;
  // On whole pixels, as the teams' names; the style puts its middle there.
  if (at) element.style.translate = `${Math.round(at.x)}px ${Math.round(at.y)}px`;
}
