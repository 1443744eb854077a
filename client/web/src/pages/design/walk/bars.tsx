/** Which feet are down, tick by tick, with the moment that is shown (Hildebrand's bars). */

import { useComputed } from "@preact/signals";
import { useMemo } from "preact/hooks";
import { jointsOfLeg } from "../../../core/design/parts";
import { postureRuns } from "../../../core/design/trial";
import { BEATS_PER_S } from "../../../core/wire";
import { t } from "../../../i18n";
import { IconButton } from "../../../ui/icons";
import { PlayButton, SpeedChooser } from "../../../ui/playback";
import { classes, rowName } from "../names";
import type { Sheet } from "../table/sheet";
import { unit } from "../trials/figures";
import type { Tried } from "../trials/tried";
import { MARGIN_ROWS, Still } from "./drawing";
import { type Showing, SPEEDS } from "./showing";
import "./bars.css";

const PAGE_TICKS = 25;

interface BarsProps {
  sheet: Sheet;
  showing: Showing;
}

export function Bars({ sheet, showing }: BarsProps) {
  const tried = showing.shown.value;
  if (!tried?.trial.ticks) {
    return (
      <section class="bars empty" aria-label={t("design.bars")}>
        <p class="muted">{t("design.noBars")}</p>
      </section>
    );
  }
  return (
    <section class="bars" aria-label={t("design.bars")}>
      <Transport showing={showing} tried={tried} />
      <Track sheet={sheet} showing={showing} tried={tried} />
    </section>
  );
}

function Transport({ showing, tried }: { showing: Showing; tried: Tried }) {
  const { playback } = showing;
  return (
    <div class="transport-row">
      <IconButton name="back" label={t("design.tickBack")} onClick={() => showing.step(-1)} />
      <PlayButton playback={playback} onClick={() => showing.watch()} />
      <IconButton name="ahead" label={t("design.tickAhead")} onClick={() => showing.step(1)} />
      <Now showing={showing} tried={tried} />
      <SpeedChooser playback={playback} speeds={SPEEDS} />
    </div>
  );
}

/** The numbers of the moment that is shown; apart, as it is drawn anew with each tick. */
function Now({ showing, tried }: { showing: Showing; tried: Tried }) {
  const { trial, rows, table } = tried;
  const tick = useComputed(() => Math.floor(showing.tick.value)).value;
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

interface TrackProps extends BarsProps {
  tried: Tried;
}

function Track({ sheet, showing, tried }: TrackProps) {
  const { trial, robot } = tried;
  const legs = robot.legs.length;
  const other = showing.other.value?.robot.legs.length === legs ? showing.other.value : null;
  // What does not move is made once, not with each tick.
  const still = useMemo(() => <Still trial={trial} other={other?.trial ?? null} />, [trial, other]);
  const last = trial.ticks - 1;
  const litLegs = new Set(sheet.lit.value.map((joint) => joint % legs));
  const tick = useComputed(() => Math.floor(showing.tick.value)).value;
  /** A click on a bar selects the leg, and the row whose posture was the target then. */
  const select = (event: MouseEvent) => {
    const input = event.currentTarget as HTMLInputElement;
    const high = input.clientHeight - input.clientHeight * (MARGIN_ROWS / (legs + MARGIN_ROWS));
    const leg = Math.floor((event.offsetY / high) * legs);
    const row = tried.rows[trial.posture[Number(input.value)] ?? -1];
    if (leg < 0 || leg >= legs || row === undefined) return;
    if (tried.version === sheet.version.peek()) sheet.selectBeside(row, leg);
  };
  return (
    <div class="track" style={`--rows: ${legs}`}>
      <ul class="leg-names" aria-hidden="true">
        {robot.legs.map((name, leg) => (
          <li
            key={name}
            class={litLegs.has(leg) ? "lit" : ""}
            onPointerEnter={() => sheet.point(jointsOfLeg(leg, legs))}
            onPointerLeave={() => sheet.point([])}
          >
            {name}
          </li>
        ))}
        <li class="margin-name">{t("design.margin")}</li>
      </ul>
      <Postures sheet={sheet} showing={showing} tried={tried} />
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
            showing.playback.pause();
            showing.seek(Number(event.currentTarget.value));
          }}
          onClick={select}
          onKeyDown={(event) => {
            const by = { PageUp: PAGE_TICKS, PageDown: -PAGE_TICKS }[event.key];
            if (!by) return;
            event.preventDefault();
            showing.step(by);
          }}
        />
      </div>
    </div>
  );
}

/** The target postures over time; each leads to its row. */
function Postures({ sheet, showing, tried }: TrackProps) {
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
              showing.playback.pause();
              showing.seek(begun);
              if (tried.version === sheet.version.peek())
                sheet.selectBeside(row, sheet.active.peek().col);
            }}
          >
            {table.kind === "locomotion" ? found.posture + 1 : found.key}
          </button>
        );
      })}
    </div>
  );
}
