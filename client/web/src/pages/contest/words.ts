/** Stages, rounds and places of a contest in words. */

import {
  type Called,
  type Coming,
  type ContestMatch,
  type ContestSheet,
  found,
  isHeld,
  isKnockout,
  isMatch,
  numberOf,
  type Planned,
  type Round,
  type Source,
  type StageView,
} from "../../core/contest/sheet";
import type { Phrase } from "../../core/phrase";
import { isMessage, said, t } from "../../i18n";
import { timeOf } from "../../i18n/words";

/** How a stage is played, beside its title: "Swiss, best of 3"; "" where the title says it. */
export function stageHeading(sheet: ContestSheet, { stage, format, settings }: Planned): string {
  const message = `contest.format.${format}`;
  const words = isMessage(message) ? t(message) : format;
  const games = settings?.games ?? 1;
  if (games > 1) return t("contest.bestOf", { format: words, games });
  return stageTitle(sheet, stage).startsWith(words) ? "" : words;
}

/** About when a game begins, and where; in a pause the time before which it does not; "" if nobody knows. */
export function expected(
  sheet: ContestSheet,
  { at_ms = 0, court = "" }: Pick<Coming, "at_ms" | "court">,
): string {
  if (!at_ms || !court) return "";
  const held = isHeld(sheet, Date.now());
  return t(held ? "contest.notBefore" : "contest.expected", { time: timeOf(at_ms), court });
}

/** Who plays a match to come, as far as that is known. */
export function whoTitle(who: readonly Phrase[]): string {
  return who.map(said).join(" – ");
}

/** About when and where a match begins that is still to come; "" if nobody knows. */
export function expectedOf(sheet: ContestSheet, pairing: string): string {
  const to_come = [...sheet.coming, ...sheet.later];
  const one = to_come.find((one) => one.pairing === pairing);
  return one ? expected(sheet, one) : "";
}

/** How many rounds are still to be drawn; a format may have its own words for that. */
export function roundsLeft({ plan, rounds_to_draw: count }: StageView): string {
  const own = `contest.roundsLeft.${plan.format}`;
  return t(isMessage(own) ? own : "contest.roundsLeft", { count });
}

/** What people call a stage: the organiser's title, or the usual name of its format. */
export function stageTitle(sheet: ContestSheet, name: string): string {
  const title = sheet.titles[name];
  return title ? said(title) : name;
}

/** A rank in words, with the teams that share it. */
export function placeTitle(rank: number, equal: readonly string[]): string {
  if (!equal.length) return t("contest.place", { rank });
  return t("contest.sharedPlace", { rank, teams: listed(equal) });
}

/** Names in a row. */
export function listed(names: readonly string[]): string {
  return names.join(said({ code: "join.comma" }));
}

/** A table's title; "" where the stage has only one. */
export function groupTitle(view: StageView, section: string): string {
  if (view.tables.length < 2 || !section) return "";
  return t("contest.group", { group: section.toUpperCase() });
}

/** A round as a title. */
export function roundTitle(
  view: StageView,
  { section, round, matches }: { section: string; round: number; matches: number },
): string {
  if (!isKnockout(view)) return t("contest.round", { round });
  if (section === "p") return t("contest.thirdPlace");
  if (section === "f") return t(round === 1 ? "contest.final" : "contest.decidingFinal");
  if (section === "l") return t("contest.losersRound", { round });
  // Rounds are told by their number: with byes, the number of matches does not say which it is.
  const last = Math.max(...roundsOf(view, section));
  const double = view.matches.some(({ pairing }) => pairing.section === "l");
  if (!double && section === "w" && round === last) return t("contest.final");
  if (!double && section === "w" && round === last - 1) return t("contest.semiFinals");
  if (!double && section === "w" && round === last - 2 && matches > 1) {
    return t("contest.quarterFinals");
  }
  return t("contest.knockoutRound", { round });
}

function roundsOf(view: StageView, section: string): number[] {
  return view.matches
    .filter(({ pairing }) => pairing.section === section)
    .map(({ pairing }) => pairing.round);
}

/** A round of the schedule as a title. */
export function scheduleTitle(view: StageView, round: Round): string {
  return roundTitle(view, { ...round, matches: round.matches.length });
}

/** What a match is in words, as its court says it. */
export function matchTitle(sheet: ContestSheet, pairing: string): string {
  const phrase = sheet.fixtures[pairing];
  return phrase ? said(phrase) : pairing;
}

/** What a game is in words: "Semi-final 1, game 2 of 3". */
export function gameTitle(sheet: ContestSheet, pairing: string, game: number): string {
  const match = sheet.fixtures[pairing];
  const games = Math.max(game, found(sheet, pairing)?.view.stage.settings.games ?? 1);
  if (!match || games === 1) return matchTitle(sheet, pairing);
  return said({ code: "fixture.game", values: { match, game, games } });
}

/** Where the team of an empty place comes from. */
export function originTitle(sheet: ContestSheet, source: Source): string {
  if (source.source === "entry") return source.team;
  if (source.source === "bye") return t("contest.how.bye");
  const fixture = sheet.fixtures[source.pairing];
  const match = fixture ? said({ ...fixture, values: { ...fixture.values, stage: null } }) : "?";
  return t(source.source === "winner" ? "contest.winnerOf" : "contest.loserOf", { match });
}

/** The same in a bracket, where lines say from which round a winner comes. */
export function shortOrigin(sheet: ContestSheet, source: Source, to: ContestMatch): string {
  const from = source.source === "winner" ? found(sheet, source.pairing)?.match : null;
  if (!from) return originTitle(sheet, source);
  const { section } = from.pairing;
  if (to.pairing.section === "f" && section === "l") return t("contest.winnerOfLosers");
  if (to.pairing.section === "f" && section === "w") return t("contest.winnerOfWinners");
  if (sheet.fixtures[from.pairing.id]?.code !== "fixture.losers") return originTitle(sheet, source);
  return t("contest.winnerOfMatch", { number: numberOf(from) });
}

/** The number that a match of a bracket has in its round; "" where the round has only one. */
export function numberTitle(view: StageView, match: ContestMatch): string {
  const { section, round } = match.pairing;
  const there = view.matches.filter(
    ({ pairing }) => pairing.section === section && pairing.round === round,
  );
  return there.length > 1 && isMatch(match) ? `${numberOf(match)}` : "";
}

/** The court on which a match is played now; "" if none. */
export function courtOf(running: readonly Called[], match: ContestMatch): string {
  return running.find(({ pairing }) => pairing === match.pairing.id)?.court ?? "";
}

/** A number with its sign: "+3", "−2", "0". */
export function signed(value: number): string {
  return value > 0 ? `+${value}` : `${value}`.replace("-", "−");
}

/** What the winners are: teams that are equal in all are first together. */
export function winnersTitle({ length }: readonly string[]): string {
  if (length === 1) return t("contest.winner");
  return t(length === 2 ? "contest.bothFirst" : "contest.allFirst");
}
