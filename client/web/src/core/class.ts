/** A class as its teacher sees it: who needs help first, names on a projector, times. */

import type { Card, ClassGroup, StudentRules } from "./wire";

/** The reasons for help, the most urgent first. */
const NEEDS: readonly Card["need"][] = ["hand", "stuck", "quiet", ""];

/** The numbers of the phases; 0 is the lesson of one leg. */
export const PHASES = [0, 1, 2, 3, 4, 5, 6] as const;

/** How many steps the lesson has. */
export const LESSON_STEPS = 8;

/** What a coach may do, the least first. */
export const COACHES = ["none", "matters", "cell", "three", "table"] as const;

/** What holds before the gateway has said anything. */
export const OPEN_RULES: StudentRules = { closed: [], coach: "table", explain_first: false };

/** How long something has lasted, in the unit that one says it in. */
export interface Elapsed {
  unit: "moment" | "min" | "h";
  count: number;
}

/** Sort by who needs help: those who are here, by need; then whoever has come least far. */
export function byNeed(one: Card, other: Card): number {
  return (
    Number(other.online) - Number(one.online) ||
    NEEDS.indexOf(one.need) - NEEDS.indexOf(other.need) ||
    (one.need === "hand" ? (one.hand_up_s ?? 0) - (other.hand_up_s ?? 0) : 0) ||
    one.phase - other.phase ||
    one.share - other.share ||
    one.name.localeCompare(other.name)
  );
}

/**
 * Put cards in order.
 *
 * @param shown The names as they stand on the page.
 * @param holds Whether those that stand there keep their places: new ones follow them.
 */
export function placed(shown: readonly string[], cards: readonly Card[], holds: boolean): Card[] {
  const sorted = cards.toSorted(byNeed);
  if (!holds) return sorted;
  const place = (card: Card) => {
    const index = shown.indexOf(card.name);
    return index < 0 ? shown.length : index;
  };
  return sorted.toSorted((one, other) => place(one) - place(other));
}

/** A card of a group has those of its members; whoever works alone has one without a group. */
export interface Dealt {
  group: ClassGroup | null;
  cards: Card[];
}

/** Put the cards of a group together, where the first of them stands. */
export function dealt(cards: readonly Card[], groups: readonly ClassGroup[]): Dealt[] {
  const found: Dealt[] = [];
  const known = new Map<ClassGroup, Dealt>();
  for (const card of cards) {
    const group = groups.find(({ members }) => members.includes(card.name)) ?? null;
    const there = group && known.get(group);
    if (there) {
      there.cards.push(card);
      continue;
    }
    const one = { group, cards: [card] };
    if (group) known.set(group, one);
    found.push(one);
  }
  return found;
}

/** Replace a student's card, or add it. */
export function withCard(cards: readonly Card[], card: Card): Card[] {
  const index = cards.findIndex(({ name }) => name === card.name);
  return index < 0 ? [...cards, card] : cards.with(index, card);
}

/**
 * Give each student a place in a list, by which a projector calls them. A place is never given
 * twice: whoever has left leaves "".
 */
export function numbered(known: readonly string[], names: readonly string[]): readonly string[] {
  const left = known.map((name) => (names.includes(name) ? name : ""));
  const added = names.filter((name) => !known.includes(name));
  const same = !added.length && left.every((name, index) => name === known[index]);
  return same ? known : [...left, ...added];
}

/** A text in which something else stands for each name: `label` gets the name's index. */
export function masked(
  text: string,
  names: readonly string[],
  label: (index: number) => string,
): string {
  const found = names.filter(Boolean).toSorted((one, other) => other.length - one.length);
  if (!found.length) return text;
  const pattern = new RegExp(found.map(asWord).join("|"), "gu");
  return text.replace(pattern, (name) => label(names.indexOf(name)));
}

/** How long ago a moment was; clocks of two machines may differ a little. */
export function elapsed(nowS: number, thenS: number): Elapsed {
  const minutes = Math.floor(Math.max(0, nowS - thenS) / 60);
  if (minutes < 1) return { unit: "moment", count: 0 };
  if (minutes < 60) return { unit: "min", count: minutes };
  return { unit: "h", count: Math.floor(minutes / 60) };
}

/** Open a phase, or close it. */
export function toggled(rules: StudentRules, phase: number): StudentRules {
  const { closed } = rules;
  const others = closed.filter((one) => one !== phase);
  const now = others.length === closed.length ? [...closed, phase] : others;
  return { ...rules, closed: now.toSorted((one, other) => one - other) };
}

/**
 * Draw foot bars, a row for each leg.
 *
 * @param feet For each leg the runs with its foot down, as shares of the width.
 * @returns The `d` of an SVG path of 100 by the number of legs.
 */
export function barsPath(feet: readonly (readonly (readonly [number, number])[])[]): string {
  return feet
    .flatMap((runs, leg) =>
      runs.map(([from, to]) => {
        const [left, right] = [from, to].map((share) => +(100 * share).toFixed(1));
        return `M${left} ${leg + 0.15}H${right}V${leg + 0.85}H${left}Z`;
      }),
    )
    .join("");
}

/** A moment within a stretch that is shown again and again. */
export function looped(tick: number, from: number, to: number): number {
  return to <= from ? from : from + ((((tick - from) % (to - from)) + to - from) % (to - from));
}

/** A pattern for a name; one in Latin letters is no part of a longer word. */
function asWord(name: string): string {
  const [before, after] = [/^[a-z\d]/i, /[a-z\d]$/i].map((edge) => edge.test(name));
  const plain = name.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
  return `${before ? "(?<![A-Za-z\\d])" : ""}${plain}${after ? "(?![A-Za-z\\d])" : ""}`;
}
