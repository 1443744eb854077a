/** The drawing of a trial's foot bars and support margin: it does not move. */

import { footBars, type Trial } from "../../../core/design/trial";
import { t } from "../../../i18n";

const ROW = 10;
const BAR = 7;
/** Of the other trial, below each bar. */
const THIN = 2;
/** How many rows high the margin is. */
export const MARGIN_ROWS = 2.2;

interface StillProps {
  trial: Trial;
  other: Trial | null;
}

export function Still({ trial, other }: StillProps) {
  const { ticks, legs, reply } = trial;
  const height = (legs + MARGIN_ROWS) * ROW;
  const bars = footBars(trial);
  const others = other ? footBars(other, 0, Math.min(ticks, other.ticks)) : [];
  return (
    <svg
      viewBox={`0 0 ${ticks} ${height}`}
      preserveAspectRatio="none"
      role="img"
      aria-label={t("design.barsText")}
    >
      <rect
        class="measured"
        x={reply.first}
        y={0}
        width={reply.end - reply.first}
        height={height}
      />
      {bars.map((runs, leg) => (
        <g key={leg} class="bar" data-leg={leg}>
          {runs.map(({ from, to }) => (
            <rect key={from} x={from} y={leg * ROW + 1} width={to - from} height={BAR} />
          ))}
          {others[leg]?.map(({ from, to }) => (
            <rect
              key={`other ${from}`}
              class="other"
              x={from}
              y={leg * ROW + ROW - THIN}
              width={to - from}
              height={THIN}
            />
          ))}
        </g>
      ))}
      {reply.starts.map((start) => (
        <line key={start} class="cycle" x1={start} x2={start} y1={0} y2={height} />
      ))}
      <Margin trial={trial} top={legs * ROW} />
    </svg>
  );
}

/** The support margin over time; below its line the robot falls. */
function Margin({ trial, top }: { trial: Trial; top: number }) {
  const { marginM, ticks, reply } = trial;
  const high = MARGIN_ROWS * ROW;
  const zero = top + 0.68 * high;
  // The scale is that of the walk: at the start, on all feet, the margin is far larger.
  const known = [...marginM.slice(reply.first, reply.end)].filter((one) => !Number.isNaN(one));
  const scale = (0.6 * high) / Math.max(0.02, ...known);
  const points = Array.from({ length: ticks }, (_, tick) => {
    const margin = marginM[tick]!;
    const y = Number.isNaN(margin) ? zero : zero - scale * margin;
    return `${tick} ${Math.min(top + high, Math.max(top, y)).toFixed(1)}`;
  });
  return (
    <g class="margin-line">
      <path class="area" d={`M 0 ${zero} L ${points.join(" L ")} L ${ticks - 1} ${zero} Z`} />
      <line x1={0} x2={ticks} y1={zero} y2={zero} />
    </g>
  );
}
