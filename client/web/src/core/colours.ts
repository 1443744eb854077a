/** The colours of seats and page, as the viewer has chosen them. */

import { computed, effect, type ReadonlySignal } from "@preact/signals";
import { setting } from "./address";
import type { Match } from "./match";
import { remembered } from "./settings";
import type { Sheet } from "./wire";

/** The colour of each seat; null: the arena's own. */
const PALETTES = {
  arena: null,
  // Told apart with every kind of colour blindness (Okabe and Ito, "Color Universal Design").
  safe: ["#0072b2", "#e69f00"],
  // Far apart in lightness too, from each other and from the dark floor.
  contrast: ["#3f8cff", "#ffe600"],
} as const satisfies Record<string, readonly string[] | null>;

export type PaletteName = keyof typeof PALETTES;
export const PALETTE_NAMES = Object.keys(PALETTES) as PaletteName[];

export const chosenPalette = remembered<PaletteName>("colours", "arena");

/** The address comes first, as for the language: a broadcast has no settings. */
export const palette = computed<PaletteName>(
  () =>
    [setting("colours") as PaletteName, chosenPalette.value].find((name) =>
      PALETTE_NAMES.includes(name),
    ) ?? "arena",
);

/** A sheet in the viewer's colours; the patterns beside them stay. */
export function recoloured(sheet: ReadonlySignal<Sheet | null>): ReadonlySignal<Sheet | null> {
  return computed(() => {
    const colours = PALETTES[palette.value];
    if (!sheet.value || !colours) return sheet.value;
    const seats = sheet.value.seats.map((seat, index) => ({
      ...seat,
      colour: colours[index] ?? seat.colour,
    }));
    return { ...sheet.value, seats };
  });
}

/**
 * Keep `--seat-N` and what can be read on it as the sheet says, until the returned is called.
 *
 * @param element What they hold in.
 */
export function followColours(match: Match, element = document.documentElement): () => void {
  return effect(() => {
    const { style } = element;
    for (const [index, seat] of (match.sheet.value?.seats ?? []).entries()) {
      style.setProperty(`--seat-${index}`, seat.colour);
      style.setProperty(`--ink-${index}`, isLight(seat.colour) ? "#16100a" : "#ffffff");
    }
  });
}

function isLight(colour: string): boolean {
  const [red, green, blue] = [1, 3, 5].map((at) => Number.parseInt(colour.slice(at, at + 2), 16));
  return 0.3 * red! + 0.59 * green! + 0.11 * blue! > 125;
}
