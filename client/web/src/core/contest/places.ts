/** The place of each team for its certificate. Pure. */

import { type ContestSheet, champions, equals, isOver, isStillIn } from "./sheet";

/** Where a team came. */
export interface Place {
  team: string;
  rank: number;
  /** The teams with which it shares that rank. */
  equal: string[];
  /** The stage of that rank; "": the only table of the last one, so it is the contest's rank. */
  stage: string;
  /** Group of the stage, such as "a"; "": it has only one. */
  group: string;
  won: boolean;
}

/**
 * The final places, the best first: of each team in the last stage that it reached and that is over
 * for it. Teams without a final place, those that were disqualified, and those that left without
 * a game are left out.
 */
export function places(sheet: ContestSheet): Place[] {
  const found = new Map<string, Place>();
  const best = champions(sheet);
  const absent = neverCame(sheet);
  for (const view of sheet.stages.toReversed()) {
    const last = view === sheet.stages.at(-1) && !sheet.planned.length;
    for (const table of view.tables) {
      for (const row of table.rows) {
        const { team, rank, out } = row;
        const open = !isOver(view) && isStillIn(view, team);
        if (
          out ||
          open ||
          absent.has(team) ||
          found.has(team) ||
          (!isOver(view) && !knockedOut(sheet, team))
        )
          continue;
        found.set(team, {
          team,
          rank,
          equal: equals(table, row),
          stage: last && view.tables.length === 1 ? "" : view.stage.name,
          group: view.tables.length > 1 ? table.section : "",
          won: best.includes(team),
        });
      }
    }
  }
  return [...found.values()];
}

/** The teams that have left the contest and have played no game. */
function neverCame(sheet: ContestSheet): Set<string> {
  const matches = sheet.stages.flatMap((view) => view.matches);
  const played = new Set(matches.flatMap(({ games = [] }) => games.flatMap(({ teams }) => teams)));
  const gone = sheet.teams.filter(({ name, withdrawn }) => withdrawn && !played.has(name));
  return new Set(gone.map(({ name }) => name));
}

/** Whether a team has lost a match after which it is out of a bracket. */
function knockedOut(sheet: ContestSheet, team: string): boolean {
  return sheet.stages.some((view) =>
    view.matches.some(
      ({ pairing, loser, state }) =>
        state === "decided" && loser === team && typeof pairing.loser_place === "number",
    ),
  );
}

/** A step of the podium: all teams of a rank. */
export interface Step {
  rank: number;
  teams: string[];
}

const PODIUM_RANKS = 3;
const MORE_MOST = 6;

/** The first three ranks of the contest, and some teams after them. */
export function podium(sheet: ContestSheet): { steps: Step[]; more: Place[] } {
  const all = places(sheet).filter(({ stage }) => !stage);
  const first = all.filter(({ rank }) => rank <= PODIUM_RANKS);
  const ranks = [...new Set(first.map(({ rank }) => rank))];
  return {
    steps: ranks.map((rank) => ({
      rank,
      teams: first.filter((place) => place.rank === rank).map(({ team }) => team),
    })),
    more: all.filter(({ rank }) => rank > PODIUM_RANKS).slice(0, MORE_MOST),
  };
}
