/**
 * The chance to win by score and clock alone. Pure.
 *
 * A lead wanders as play goes on, now this way and now that. So the lead at the end is normally
 * distributed around the lead of now, and the longer the rest, the wider. The arena's file says how
 * far a lead usually wanders (`lead_volatility`).
 */

import type { Moment } from "./odds";
import type { MatchRecord } from "./record";
import { BEATS_PER_S, type Frame, Phase, type Sheet } from "./wire";

/** After so much play a chance is told for the first time: before, it says nothing. */
const FIRST_S = 10;

/**
 * The chance of the side that leads, 0 to 1; a draw counts half.
 *
 * @param lead Points of this side less those of the other.
 * @param restS Play that is left [s].
 * @param volatility Standard deviation of the change of a lead in a second of play [points].
 */
export function chanceOf(lead: number, restS: number, volatility: number): number {
  const spread = volatility * Math.sqrt(Math.max(0, restS));
  if (spread === 0) return lead === 0 ? 0.5 : Number(lead > 0);
  return normal(lead / spread);
}

/** The chance of the first seat of a match that is played; null: none is told. */
export function chanceNow(frame: Frame, sheet: Sheet): number | null {
  const playedS = frame.clock_ticks / BEATS_PER_S;
  const isPlayed = frame.phase === Phase.PLAYING || frame.phase === Phase.HALTED;
  const volatility = volatilityOf(sheet);
  if (!isPlayed || playedS < FIRST_S || !volatility) return null;
  const [first, second] = frame.seats.map(({ score }) => score);
  return chanceOf(first! - second!, sheet.duration_s - playedS, volatility);
}

/** The chances over a recorded match, at each second of play and at each change of the score. */
export function chancesOf(record: MatchRecord): Moment[] {
  const sheet = record.sheets.at(-1)?.value;
  const volatility = sheet ? volatilityOf(sheet) : 0;
  if (!sheet || !volatility) return [];
  const moments: Moment[] = [];
  let played = 0;
  for (const [index, { beat: from, value }] of record.phases.entries()) {
    if (value !== Phase.PLAYING) continue;
    const until = record.phases[index + 1]?.beat ?? record.lastBeat;
    for (const beat of beatsToTell(record, from, until)) {
      const clock_s = (played + beat - from) / BEATS_PER_S;
      const chance = chanceOf(leadAt(record, beat), sheet.duration_s - clock_s, volatility);
      moments.push({ beat, clock_s, chance });
    }
    played += until - from;
  }
  return moments;
}

/** The beats of a stretch of play: each second, the changes of the score, and those just before. */
function beatsToTell({ scores }: MatchRecord, from: number, until: number): number[] {
  const beats = new Set([until]);
  for (let beat = from; beat < until; beat += BEATS_PER_S) beats.add(beat);
  for (const { beat } of scores) {
    if (beat > from && beat < until) beats.add(beat - 1).add(beat);
  }
  return [...beats].sort((a, b) => a - b);
}

function leadAt({ scores }: MatchRecord, beat: number): number {
  const [first = 0, second = 0] = scores.findLast((one) => one.beat <= beat)?.value ?? [];
  return first - second;
}

/** 0: the arena does not say, or the match has no two sides or no end. */
function volatilityOf({ seats, duration_s, settings }: Sheet): number {
  const said = (settings.match as { lead_volatility?: unknown } | undefined)?.lead_volatility;
  return seats.length === 2 && duration_s && typeof said === "number" ? said : 0;
}

/** The distribution function of the normal distribution (Abramowitz and Stegun 26.2.17). */
function normal(z: number): number {
  const t = 1 / (1 + 0.2316419 * Math.abs(z));
  const series = [1.330274429, -1.821255978, 1.781477937, -0.356563782, 0.31938153];
  const sum = t * series.reduce((rest, factor) => rest * t + factor, 0);
  const tail = (Math.exp((-z * z) / 2) / Math.sqrt(2 * Math.PI)) * sum;
  return z > 0 ? 1 - tail : tail;
}
