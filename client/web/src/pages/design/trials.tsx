/** The history of trials; each belongs to a version of the table. */

import { t } from "../../i18n";
import { difference, TILES, written } from "./figures";
import { classes } from "./rows";
import type { Studio, Tried } from "./studio";

const [SPEED, DRIFT, STABLE] = TILES;

export function Trials({ studio }: { studio: Studio }) {
  const trials = studio.trials.value;
  if (!trials.length) return <p class="muted empty">{t("design.noTrials")}</p>;
  return (
    <ol class="trials" reversed>
      {trials.toReversed().map((tried) => (
        <TrialRow key={tried.number} studio={studio} tried={tried} />
      ))}
    </ol>
  );
}

function TrialRow({ studio, tried }: { studio: Studio; tried: Tried }) {
  const isShown = studio.shown.value === tried;
  const isOther = studio.other.value === tried;
  const isCurrent = tried.version === studio.version.value;
  const { figures } = tried.trial.reply;
  const before = studio.trials.value.findLast(
    (one) => one.number < tried.number && one.key === tried.key,
  );
  const by = before && difference(SPEED!, before.trial.reply.figures, figures);
  const name = t("design.trialOf", { number: tried.number, key: tried.key });
  return (
    <li class={classes(isShown && "shown", isOther && "other")}>
      <button
        class="look"
        type="button"
        aria-current={isShown}
        aria-label={t("design.showTrial", { name })}
        onClick={() => studio.look(tried)}
      >
        <b class="number">{tried.number}</b>
        <span class="what">
          <span>
            <b>{written(SPEED!, figures)}</b> mm/s
            {by && by.is !== "same" && <i data-is={by.is}> {by.text}</i>}
          </span>
          <small>
            {t("design.trialKey", { key: tried.key })} · {written(DRIFT!, figures)} °/s ·{" "}
            {written(STABLE!, figures)} % {t("design.stable")}
          </small>
        </span>
      </button>
      <span class="acts">
        {isCurrent ? (
          <span class="badge">{t("design.thisTable")}</span>
        ) : (
          <button
            class="button quiet small"
            type="button"
            aria-label={t("design.restoreTrial", { name })}
            onClick={() => studio.restore(tried)}
          >
            {t("design.restore")}
          </button>
        )}
        {!isShown && (
          <button
            class="button quiet small"
            type="button"
            aria-pressed={isOther}
            aria-label={t("design.compareTrial", { name })}
            onClick={() => {
              studio.other.value = isOther ? null : tried;
            }}
          >
            {t("design.compare")}
          </button>
        )}
      </span>
    </li>
  );
}
