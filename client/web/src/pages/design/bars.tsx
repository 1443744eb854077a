/** Which feet are down, tick by tick, with the moment that is shown (Hildebrand's bars). */

import { useComputed } from "@preact/signals";
import { useMemo } from "preact/hooks";
import { jointsOfLeg } from "../../core/design/parts";
import { footBars, postureRuns, type Trial } from "../../core/design/trial";
import { BEATS_PER_S } from "../../core/wire";
import { t } from "../../i18n";
import { Icon, IconButton } from "../../ui/icons";
import { SPEEDS } from "./clock";
import { unit } from "./figures";
import { classes, rowName } from "./rows";
import type { Studio, Tried } from "./studio";

const ROW = 10;
const BAR = 7;
/** Of the other trial, below each bar. */
const THIN = 2;
const MARGIN_ROWS = 2.2;
const PAGE_TICKS = 25;

export function Bars({ studio }: { studio: Studio }) {
  const tried = studio.shown.value;
  if (!tried?.trial.ticks) {
    return (
      <section class="bars empty" aria-label={t("design.bars")}>
        <p class="muted">{t("design.noBars")}</p>
      </section>
    );
  }
  return (
    <section class="bars" aria-label={t("design.bars")}>
      <Transport studio={studio} tried={tried} />
      <Track studio={studio} tried={tried} />
    </section>
  );
}

function Transport({ studio, tried }: { studio: Studio; tried: Tried }) {
  const { clock } = studio;
  const word = t(clock.playing.value ? "replay.pause" : "replay.play");
  return (
    <div class="transport-row">
      <IconButton name="back" label={t("design.tickBack")} onClick={() => step(studio, -1)} />
      <button
        class="button strong"
        type="button"
        aria-label={word}
        title={word}
        onClick={() => {
          studio.watching.value = true;
          clock.toggle();
        }}
      >
        <Icon name={clock.playing.value ? "pause" : "play"} />
      </button>
      <IconButton name="ahead" label={t("design.tickAhead")} onClick={() => step(studio, 1)} />
      <Now studio={studio} tried={tried} />
      <label class="speed">
        <span class="hidden-text">{t("replay.speed")}</span>
        <select
          value={clock.speed.value}
          onChange={(event) => {
            clock.speed.value = Number(event.currentTarget.value);
          }}
        >
          {SPEEDS.map((speed) => (
            <option key={speed} value={speed}>
              {speed}×
            </option>
          ))}
        </select>
      </label>
    </div>
  );
}

function step(studio: Studio, ticks: number): void {
  studio.watching.value = true;
  studio.clock.step(ticks);
}

/** The numbers of the moment that is shown; apart, as it is drawn anew with each tick. */
function Now({ studio, tried }: { studio: Studio; tried: Tried }) {
  const { trial, rows, table } = tried;
  const tick = useComputed(() => Math.floor(studio.clock.tick.value)).value;
  const margin = trial.marginM[tick] ?? Number.NaN;
  const posture = table.rows[rows[trial.posture[tick] ?? -1] ?? -1];
  const isBegun = tick >= (trial.reply.starts[0] ?? 0) && posture !== undefined;
  const name = posture ? rowName(posture, table.kind === "locomotion") : "";
  return (
    <p class="now">
      <span>
        <b>{(tick / BEATS_PER_S).toFixed(2)}</b> / {(trial.ticks / BEATS_PER_S).toFixed(1)} s
      </span>
      <span>{isBegun ? t("design.posture", { name }) : t("design.standing")}</span>
      <span class={classes("margin", margin < 0 && "falls")}>
        {t("design.marginNow", { mm: Number.isNaN(margin) ? "–" : unit(1000 * margin, 0) })}
      </span>
    </p>
  );
}

function Track({ studio, tried }: { studio: Studio; tried: Tried }) {
  const { trial, robot } = tried;
  const legs = robot.legs.length;
  const other = studio.other.value?.robot.legs.length === legs ? studio.other.value : null;
  // What does not move is made once, not with each tick.
  const still = useMemo(() => <Still trial={trial} other={other?.trial ?? null} />, [trial, other]);
  const last = trial.ticks - 1;
  const litLegs = new Set(studio.lit.value.map((joint) => joint % legs));
  const tick = useComputed(() => Math.floor(studio.clock.tick.value)).value;
  /** A click on a bar selects the leg, and the row whose posture was the target then. */
  const select = (event: MouseEvent) => {
    const input = event.currentTarget as HTMLInputElement;
    const high = input.clientHeight - input.clientHeight * (MARGIN_ROWS / (legs + MARGIN_ROWS));
    const leg = Math.floor((event.offsetY / high) * legs);
    const row = tried.rows[trial.posture[Number(input.value)] ?? -1];
    if (leg < 0 || leg >= legs || row === undefined) return;
    if (tried.version === studio.version.peek()) studio.selectBeside(row, leg);
  };
  return (
    <div class="track" style={`--rows: ${legs}`}>
      <ul class="leg-names" aria-hidden="true">
        {robot.legs.map((name, leg) => (
          <li
            key={name}
            class={litLegs.has(leg) ? "lit" : ""}
            onPointerEnter={() => studio.point(jointsOfLeg(leg, legs))}
            onPointerLeave={() => studio.point([])}
          >
            {name}
          </li>
        ))}
        <li class="margin-name">{t("design.margin")}</li>
      </ul>
      <Postures studio={studio} tried={tried} />
      <div class="lanes">
        {still}
        <div class="cursor" style={`left: ${(100 * (tick + 0.5)) / trial.ticks}%`} />
        <input
          type="range"
          min={0}
          max={last}
          step={1}
          value={tick}
          aria-label={t("design.moment")}
          aria-valuetext={t("design.momentText", { seconds: (tick / BEATS_PER_S).toFixed(2) })}
          onInput={(event) => {
            studio.clock.pause();
            studio.seek(Number(event.currentTarget.value));
          }}
          onClick={select}
          onKeyDown={(event) => {
            const by = { PageUp: PAGE_TICKS, PageDown: -PAGE_TICKS }[event.key];
            if (!by) return;
            event.preventDefault();
            step(studio, by);
          }}
        />
      </div>
    </div>
  );
}

/** The target postures over time; each leads to its row. */
function Postures({ studio, tried }: { studio: Studio; tried: Tried }) {
  const { trial, rows, table } = tried;
  const runs = useMemo(() => postureRuns(trial), [trial]);
  const first = trial.reply.starts[0] ?? 0;
  return (
    <div class="postures">
      {runs.map(({ from, to, posture }) => {
        const begun = Math.max(from, first);
        const row = rows[posture];
        if (to <= first || row === undefined) return null;
        const found = table.rows[row]!;
        return (
          <button
            key={from}
            type="button"
            tabIndex={-1}
            data-row={row}
            style={`left: ${(100 * begun) / trial.ticks}%; width: ${(100 * (to - begun)) / trial.ticks}%`}
            onClick={() => {
              studio.clock.pause();
              studio.seek(begun);
              if (tried.version === studio.version.peek())
                studio.selectBeside(row, studio.active.peek().col);
            }}
          >
            {table.kind === "locomotion" ? found.posture + 1 : found.key}
          </button>
        );
      })}
    </div>
  );
}

interface StillProps {
  trial: Trial;
  other: Trial | null;
}

function Still({ trial, other }: StillProps) {
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
