/** The teams' names above their robots, as text of the page: crisp at any size. */

import type { Sheet } from "../core/wire";
import type { Model } from "./model";
import { luma, rgb } from "./palette";
import { seatLetters } from "./topview";

const ABOVE_M = 0.11;

/** Where a point [m] is in the picture [px]; null: not in it. */
export type Placing = (
  x: number,
  y: number,
  z: number,
) => { x: number; y: number; far: number } | null;

/** A place in the picture [px]. */
export interface Spot {
  x: number;
  y: number;
}

/** Half the height of what stands at a spot. */
const SPOT_PX = 14;

/** The reader's own robot. */
export interface OwnSeat {
  seat: number;
  /** Above it, in place of its team's name. */
  name: string;
}

export class Tags {
  private readonly layer: HTMLElement;
  private tags: HTMLElement[] = [];

  constructor(host: HTMLElement) {
    this.layer = document.createElement("div");
    this.layer.className = "view-tags";
    this.layer.setAttribute("aria-hidden", "true");
    host.append(this.layer);
  }

  /** Take the teams' names; a name may stand for its team's. */
  name(sheet: Sheet, own: OwnSeat | null): void {
    const letters = seatLetters(sheet);
    this.tags = sheet.seats.map((seat, index) => {
      const tag = document.createElement("div");
      tag.className = "view-tag";
      tag.hidden = true;
      const mark = document.createElement("b");
      mark.textContent = letters[index] ?? "";
      mark.dataset.pattern = seat.pattern;
      mark.style.backgroundColor = seat.colour;
      mark.style.color = luma(rgb(seat.colour)) > 0.5 ? "#16100a" : "#fff";
      const name = document.createElement("span");
      const isOwn = index === own?.seat;
      name.textContent = isOwn ? own.name : seat.team || seat.id;
      tag.classList.toggle("own", isOwn);
      tag.append(mark, name);
      return tag;
    });
    this.layer.replaceChildren(...this.tags);
  }

  /** Put the names where the robots are, above `spots` that they would hide; null hides them. */
  draw(model: Model | null, place: Placing, spots: readonly Spot[]): void {
    for (const [seat, tag] of this.tags.entries()) {
      const robot = model?.robots[seat];
      const at = robot ? place(robot.x, robot.y, robot.z + ABOVE_M) : null;
      if (tag.hidden !== !at) tag.hidden = !at;
      if (!at) continue;
      // On whole pixels: letters stay crisp, and the same moment is always drawn the same.
      const x = Math.round(at.x - tag.offsetWidth / 2);
      const right = x + tag.offsetWidth;
      const hidden = spots.filter(
        (spot) =>
          x - SPOT_PX < spot.x &&
          spot.x < right + SPOT_PX &&
          at.y - tag.offsetHeight - SPOT_PX < spot.y &&
          spot.y < at.y + SPOT_PX,
      );
      const foot = Math.min(at.y, ...hidden.map((spot) => spot.y - SPOT_PX));
      const y = Math.round(foot - tag.offsetHeight);
      tag.style.transform = `translate(${x}px, ${y}px)`;
    }
  }

  end(): void {
    this.layer.remove();
  }
}
