/** The odds of a match as a curve: the first seat above, the second below. */

import { chanceAt, type Odds } from "../core/odds";
import { t } from "../i18n";
import "./odds.css";

const HEIGHT = 100;

interface Props {
  odds: Odds;
  /** The beats at both ends of the picture. */
  first: number;
  last: number;
}

export function OddsCurve({ odds, first, last }: Props) {
  const points = odds.moments.map(({ beat, chance }) => `${beat},${HEIGHT * (1 - chance)}`);
  return (
    <svg
      class="odds-curve"
      viewBox={`${first} 0 ${last - first} ${HEIGHT}`}
      preserveAspectRatio="none"
      role="img"
      aria-label={t("odds.curve")}
    >
      <line x1={first} x2={last} y1={HEIGHT / 2} y2={HEIGHT / 2} class="even" />
      <polyline points={points.join(" ")} />
    </svg>
  );
}

/** The chances of both seats at a beat, as whole numbers that add up: "62 : 38 %". */
export function chancesAt(odds: Odds, beat: number): string {
  const first = Math.round(100 * chanceAt(odds, beat));
  return t("odds.now", { first, second: 100 - first });
}
