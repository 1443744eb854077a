/** The odds of a match over its course: a curve, and where it moved most. */

/** A moment of a match, as far as pages need it. */
export interface Moment {
  beat: number;
  clock_s: number;
  /** Chance of the first seat to win, 0 to 1; a draw counts half. */
  chance: number;
}

export interface Odds {
  /** From forks that bots played (`lacoc replay odds`), or from score and clock alone. */
  by: "forks" | "score";
  /** In the order of their beats. */
  moments: readonly Moment[];
}

/** Two moments between which the odds only grew or only fell. */
export interface Swing {
  before: Moment;
  after: Moment;
  /** How much the chance of the first seat grew; negative: it fell. */
  change: number;
}

const FORMAT = 1;
/** Where less than this part of a swing happens in a stretch at its end, the swing ends before. */
const SLOW = 0.1;

/** Read the odds of a match; null: another form, another match, or fewer than two moments. */
export function readOdds(data: unknown, matchId: string): Odds | null {
  if (!isObject(data) || data.format !== FORMAT || data.match_id !== matchId) return null;
  if (!Array.isArray(data.moments) || data.moments.length < 2) return null;
  const moments = data.moments.filter(isMoment).sort((a, b) => a.beat - b.beat);
  return moments.length === data.moments.length ? { by: "forks", moments } : null;
}

/** The chance of the first seat at a beat; between two moments it is on the line between them. */
export function chanceAt({ moments }: Odds, beat: number): number {
  const index = moments.findIndex((moment) => moment.beat > beat);
  if (index === 0) return moments[0]!.chance;
  if (index < 0) return moments.at(-1)!.chance;
  const before = moments[index - 1]!;
  const after = moments[index]!;
  const part = (beat - before.beat) / (after.beat - before.beat);
  return before.chance + part * (after.chance - before.chance);
}

/**
 * The stretches in which the odds changed most, the largest change first. In each of them the odds
 * only grew or only fell; its slow beginning and end are left out.
 *
 * @param most Most of them that are returned.
 * @param least Smallest change of the chance that counts.
 */
export function highlights({ moments }: Odds, most = 8, least = 0.05): Swing[] {
  const runs: Swing[][] = [];
  moments.slice(1).forEach((after, index) => {
    const step = swing(moments[index]!, after);
    const run = runs.at(-1);
    if (run && step.change > 0 === run[0]!.change > 0) run.push(step);
    else runs.push([step]);
  });
  return runs
    .map(withoutSlowEnds)
    .filter(({ change }) => Math.abs(change) >= least)
    .sort((a, b) => Math.abs(b.change) - Math.abs(a.change) || a.before.beat - b.before.beat)
    .slice(0, most);
}

function swing(before: Moment, after: Moment): Swing {
  return { before, after, change: after.chance - before.chance };
}

function withoutSlowEnds(run: readonly Swing[]): Swing {
  const least = SLOW * Math.abs(swing(run[0]!.before, run.at(-1)!.after).change);
  const fast = run.filter(({ change }) => Math.abs(change) >= least);
  const kept = fast.length ? fast : run;
  return swing(kept[0]!.before, kept.at(-1)!.after);
}

function isMoment(value: unknown): value is Moment {
  if (!isObject(value)) return false;
  const { beat, clock_s, chance } = value;
  const isNumber = [beat, clock_s, chance].every((one) => Number.isFinite(one));
  return isNumber && (chance as number) >= 0 && (chance as number) <= 1;
}

function isObject(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null;
}
