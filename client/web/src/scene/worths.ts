/** What markers would bring a robot that goes there now: at each marker, as text of the page. */

import { put } from "./labels";
import type { Model } from "./model";
import type { Placing, Spot } from "./tags";

/** Points by the marker's name. */
export type Worth = Readonly<Record<string, number>>;

export class Worths {
  private readonly layer: HTMLElement;
  private shown: Worth | null = null;
  private sheet: Model["sheet"] | null = null;
  private tags: { tag: HTMLElement; x: number; y: number }[] = [];

  constructor(host: HTMLElement) {
    this.layer = document.createElement("div");
    this.layer.className = "view-tags";
    this.layer.setAttribute("aria-hidden", "true");
    host.append(this.layer);
  }

  /** Put them where the markers are, null hides them; return where they are in the picture. */
  draw(model: Model | null, worth: Worth | null, place: Placing): Spot[] {
    const sheet = model?.sheet ?? null;
    if (worth !== this.shown || sheet !== this.sheet) this.show(worth, sheet);
    return this.tags.flatMap(({ tag, x, y }) => {
      const at = place(x, y, 0);
      put(tag, at);
      return at ? [at] : [];
    });
  }

  end(): void {
    this.layer.remove();
  }

  private show(worth: Worth | null, sheet: Model["sheet"] | null): void {
    this.shown = worth;
    this.sheet = sheet;
    this.tags = (sheet?.markers ?? []).flatMap(({ name, kind, x_m, y_m }) => {
      const points = worth?.[name];
      if (points === undefined) return [];
      const tag = document.createElement("div");
      tag.className = "view-worth";
      tag.dataset.marker = name;
      tag.dataset.kind = kind;
      tag.textContent = `+${points}`;
      return [{ tag, x: x_m, y: y_m }];
    });
    this.layer.replaceChildren(...this.tags.map(({ tag }) => tag));
  }
}
