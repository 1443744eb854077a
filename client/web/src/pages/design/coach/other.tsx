/** A gait that the coach has found: how it differs in words, its figures, and what can be done. */

import { figure } from "../../../core/design/trial";
import type { OtherGait } from "../../../core/wire";
import { type MessageName, t } from "../../../i18n";
import { isNarrow } from "../../../ui/screen";
import { FIGURES, titleOf, unit, written } from "../trials/figures";
import type { Others } from "./others";

type Figures = Record<string, unknown>;

const SHOWN = FIGURES.filter(({ name }) =>
  ["drift_deg_s", "stable_share", "clearance_mm", "margin_mm"].includes(name),
);
const MOST_WORDS = 4;
/** A gait is as fast as another one if their speeds differ by less than this share. */
const SAME_SHARE = 0.1;

/** "42 mm/s" */
export function speedOf({ figures }: OtherGait): string {
  return `${unit(figure(figures, "speed_mm_s") ?? 0, 0)} mm/s`;
}

/**
 * How a gait differs from the own one: "faster", "lower", "longer steps".
 *
 * @param before Figures of the own gait; null: they are not known.
 */
export function wordsOf(gait: OtherGait, before: Figures | null): string[] {
  const was = before && figure(before, "speed_mm_s");
  const is = figure(gait.figures, "speed_mm_s");
  const words = gait.differences.map(({ way, steps }) =>
    t(`design.way.${way}.${steps > 0 ? "more" : "less"}` as MessageName),
  );
  if (was !== null && is !== null && Math.abs(is - was) >= SAME_SHARE * Math.abs(was)) {
    words.unshift(t(is > was ? "design.guess.faster" : "design.guess.slower"));
  }
  return words.slice(0, MOST_WORDS);
}

interface Props {
  others: Others;
  gait: OtherGait;
  before: Figures | null;
  /** What the gait is called in the picture, and in the step that takes it. */
  name: string;
}

export function OtherFacts({ others, gait, before, name }: Props) {
  return (
    <section class="other-gait" aria-label={name}>
      <p class="words" role="status">
        <b>{speedOf(gait)}</b> {wordsOf(gait, before).join(t("design.way.and"))}
      </p>
      <dl>
        {SHOWN.map((one) => (
          <div key={one.name}>
            <dt>{t(titleOf(one))}</dt>
            <dd>
              {written(one, gait.figures)} <small>{one.unit}</small>
            </dd>
          </div>
        ))}
      </dl>
      <Acts others={others} gait={gait} name={name} />
    </section>
  );
}

export function Acts({ others, gait, name }: Omit<Props, "before">) {
  return (
    <div class="row">
      <button
        class="button"
        type="button"
        aria-label={t("design.other.watchName", { name })}
        onClick={() => {
          others.watch(gait, name);
          // Where all stands below one another, the picture would be out of sight.
          if (isNarrow.peek()) document.querySelector(".stage")?.scrollIntoView({ block: "end" });
        }}
      >
        {t("design.other.watch")}
      </button>
      <button
        class="button strong"
        type="button"
        disabled={!gait.changes.length}
        aria-label={t("design.other.takeName", { name })}
        onClick={() => others.take(gait, name)}
      >
        {t("design.other.take")}
      </button>
    </div>
  );
}
