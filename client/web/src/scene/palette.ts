/** Colours: teams, and the arena's own turned into those of a dark hall. */

import { MARKER_STATES, type Scene, type SceneGeom, SeatFlag, type Sheet } from "../core/wire";

/** Red, green, blue from 0 to 1, as on a screen (sRGB). */
export type Rgb = readonly [number, number, number];

export const PATTERNS = { plain: 0, stripes: 1, dots: 2, edge: 3 } as const;

const SILENT: Rgb = [0.42, 0.43, 0.45];
const FROZEN: Rgb = [0.62, 0.86, 1];
const NEUTRAL: Rgb = [0.42, 0.46, 0.53];
const FALLEN: Rgb = [0.3, 0.33, 0.38];
const EDGE: Rgb = [0.93, 0.94, 0.96];

/** "#rrggbb" in numbers. */
export function rgb(colour: string): Rgb {
  const at = (index: number) => Number.parseInt(colour.slice(index, index + 2), 16) / 255 || 0;
  return [at(1), at(3), at(5)];
}

/** In words of CSS. */
export function css([red, green, blue]: Rgb, alpha = 1): string {
  const [r, g, b] = [red, green, blue].map((part) => Math.round(part * 255));
  return `rgb(${r} ${g} ${b} / ${alpha})`;
}

export function mix(one: Rgb, other: Rgb, part: number): Rgb {
  const at = (index: 0 | 1 | 2) => one[index] + (other[index] - one[index]) * part;
  return [at(0), at(1), at(2)];
}

export function luma([red, green, blue]: Rgb): number {
  return 0.299 * red + 0.587 * green + 0.114 * blue;
}

/** A colour's partner in a pattern: lighter, or darker where it is light already. */
export function partner(colour: Rgb): Rgb {
  return luma(colour) > 0.55 ? mix(colour, [0.16, 0.09, 0], 0.62) : mix(colour, [1, 1, 1], 0.62);
}

/** The second colour of a pattern; the colour itself where there is no pattern. */
export function partnerIn(colour: Rgb, pattern: number): Rgb {
  if (pattern === PATTERNS.plain) return colour;
  return pattern === PATTERNS.edge ? EDGE : partner(colour);
}

/** Number of a pattern, by the name that the sheet has. */
export function patternOf(name: string): number {
  return PATTERNS[name as keyof typeof PATTERNS] ?? PATTERNS.plain;
}

/**
 * The arena's bright greys and beiges as a hall's in the evening: what was light is dark. Team
 * colours and all other strong colours stay.
 */
export function evening([red, green, blue]: Rgb): Rgb {
  const most = Math.max(red, green, blue);
  const strong = most > 0 ? (most - Math.min(red, green, blue)) / most : 0;
  if (strong > 0.38) return [red, green, blue];
  const light = luma([red, green, blue]);
  const turned = light < 0.2 ? light : 0.18 + (1 - light) * 0.6;
  return [turned * 0.8, turned * 0.98, turned * 1.22];
}

/** The colour of a marker's shape that belongs to nobody. */
export function markerColour(state: number, own: Rgb, tall: boolean): Rgb {
  if (MARKER_STATES[state] === "down") return FALLEN;
  return tall ? own : NEUTRAL;
}

/** A robot's colour; it differs while the robot can't be steered. */
export function afflicted(colour: Rgb, flags: number): Rgb {
  if (flags & SeatFlag.FROZEN) return mix(colour, FROZEN, 0.62);
  if (flags & SeatFlag.SILENT && flags & SeatFlag.JOINED) return mix(colour, SILENT, 0.8);
  return colour;
}

/** The colour of a part of a robot that is pointed at. */
export const LIT: Rgb = [1, 0.86, 0.3];

/** The colour of a part of a robot that walks as it did in another trial. */
export function ghostly(colour: Rgb): Rgb {
  return mix(colour, [0.9, 0.93, 1], 0.75);
}

/**
 * For each geom the seat whose colour it takes; -1: none.
 *
 * Of a marker that somebody has, those shapes that look different in its other states: a flag's
 * pole is the same for both teams.
 */
export function teamGeoms(scene: Scene, sheet: Sheet): number[] {
  return scene.geoms.map((geom) => {
    if (geom.seat >= 0) return geom.seat;
    const seat = geom.state - 1;
    if (geom.marker < 0 || seat < 0 || seat >= sheet.seats.length || geom.state === 3) return -1;
    return isSame(scene, geom) ? -1 : seat;
  });
}

/** True if a shape looks the same in another state of its marker, as a flag's pole does. */
export function isSame(scene: Scene, geom: SceneGeom): boolean {
  return scene.geoms.some(
    (other) =>
      other.marker === geom.marker &&
      other.state !== geom.state &&
      other.rgba.every((part, index) => part === geom.rgba[index]),
  );
}
