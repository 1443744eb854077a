/** The map of gaits: a grid of speed and arousal, and the gait of the chosen cell. */

import { figure } from "../../../core/design/trial";
import type { MapReply } from "../../../core/wire";
import { t } from "../../../i18n";
import { classes } from "../names";
import { unit } from "../trials/figures";
import { OtherFacts, speedOf } from "./other";
import type { Others } from "./others";

export function GaitMap({ others, map }: { others: Others; map: MapReply }) {
  const [speed, arousal] = others.cell.value;
  const gaitAt = (x: number, y: number) =>
    map.cells.find((cell) => cell.speed === x && cell.arousal === y)?.gait;
  const chosen = gaitAt(speed, arousal);
  const [wide, high] = [map.speeds_mm_s.length, map.arousals_mm_s.length];
  const choose = (x: number, y: number) => {
    others.cell.value = [inside(x, wide), inside(y, high)];
  };
  const press = (event: KeyboardEvent) => {
    const to = {
      ArrowRight: [speed + 1, arousal],
      ArrowLeft: [speed - 1, arousal],
      ArrowUp: [speed, arousal + 1],
      ArrowDown: [speed, arousal - 1],
      Home: [0, arousal],
      End: [wide - 1, arousal],
    }[event.key] as [number, number] | undefined;
    if (!to) return;
    event.preventDefault();
    choose(...to);
    const { currentTarget } = event;
    requestAnimationFrame(() => {
      (currentTarget as HTMLElement).querySelector<HTMLElement>("[tabindex='0']")?.focus();
    });
  };
  const upward = Array.from({ length: high }, (_, row) => high - 1 - row);
  const speedName = (x: number) => unit(map.speeds_mm_s[x] ?? 0, 0);
  const arousalName = (y: number) => unit(map.arousals_mm_s[y] ?? 0, 0);
  return (
    <div class="gait-map">
      <p class="muted">
        {t("design.map.filled", { filled: map.cells.length, cells: wide * high })}
        {map.cancelled && ` ${t("design.coach.stopped")}`}
      </p>
      {/* biome-ignore-start lint/a11y/useFocusableInteractive: the button in a cell is */}
      {/* biome-ignore-start lint/a11y/noNoninteractiveElementToInteractiveRole: arrow keys go through it */}
      <table class="map-grid" role="grid" aria-label={t("design.map")} onKeyDown={press}>
        <tbody>
          {upward.map((y) => (
            <tr key={y}>
              <th scope="row">
                {y === high - 1 && <b>{t("design.map.excited")}</b>}
                {y === 0 && <b>{t("design.map.calm")}</b>}
                {arousalName(y)}
              </th>
              {map.speeds_mm_s.map((_, x) => {
                const gait = gaitAt(x, y);
                const isOwn = map.own?.[0] === x && map.own[1] === y;
                const isChosen = x === speed && y === arousal;
                const parts = [
                  t("design.map.place", { speed: speedName(x), arousal: arousalName(y) }),
                  gait ? speedOf(gait) : t("design.map.none"),
                ];
                if (isOwn) parts.push(t("design.map.own"));
                return (
                  <td key={x} role="gridcell" aria-selected={isChosen}>
                    <button
                      type="button"
                      tabIndex={isChosen ? 0 : -1}
                      class={classes(gait && "has-gait", isOwn && "own")}
                      aria-label={parts.join(t("design.way.and"))}
                      onClick={() => choose(x, y)}
                    >
                      {gait ? unit(figure(gait.figures, "speed_mm_s") ?? 0, 0) : ""}
                    </button>
                  </td>
                );
              })}
            </tr>
          ))}
        </tbody>
        <tfoot>
          <tr>
            <td />
            {map.speeds_mm_s.map((_, x) => (
              <th key={x} scope="col">
                {speedName(x)}
              </th>
            ))}
          </tr>
        </tfoot>
      </table>
      {/* biome-ignore-end lint/a11y/useFocusableInteractive: see above */}
      {/* biome-ignore-end lint/a11y/noNoninteractiveElementToInteractiveRole: see above */}
      <p class="muted axes">{t("design.map.axes")}</p>
      {chosen ? (
        <OtherFacts
          others={others}
          gait={chosen}
          before={map.before}
          name={t("design.map.name", { speed: speedOf(chosen) })}
        />
      ) : (
        <p class="muted">{t("design.map.none")}</p>
      )}
    </div>
  );
}

function inside(index: number, count: number): number {
  return Math.min(count - 1, Math.max(0, index));
}
