/** The coach: which numbers matter, and a better gait; both only after one's own guess. */

import { said, t } from "../../../i18n";
import { allows, type Can } from "../can";
import type { Sheet } from "../table/sheet";
import { Better } from "./better";
import { type Coach, type Found, GOALS, type Goal, SIZES } from "./coach";
import { Matters } from "./matters";
import "./coach.css";

interface Props {
  coach: Coach;
  sheet: Sheet;
}

export function CoachPanel({ coach, sheet, can }: Props & { can: Can }) {
  const found = coach.found.value;
  const sizes = SIZES.filter((size) => allows(can, size));
  const isCurrent = found?.version === sheet.version.value;
  return (
    <section class="coach" aria-label={t("design.coach")}>
      <label class="field inline">
        <span>{t("design.coach.goal")}</span>
        <select
          value={coach.goal.value}
          onChange={(event) => coach.aim(event.currentTarget.value as Goal)}
        >
          {GOALS.map((name) => (
            <option key={name} value={name}>
              {t(`design.goal.${name}`)}
            </option>
          ))}
        </select>
      </label>
      {coach.job.value ? (
        <Working coach={coach} job={coach.job.value} />
      ) : (
        <div class="asks">
          {allows(can, "matters") && (
            <button class="button" type="button" onClick={() => void coach.ask(null)}>
              {t("design.coach.matters")}
            </button>
          )}
          {sizes.length > 0 && <p class="muted">{t("design.coach.improve")}</p>}
          <div class="sizes">
            {sizes.map((size) => (
              <button key={size} class="button" type="button" onClick={() => void coach.ask(size)}>
                <b>{t(`design.coach.${size}`)}</b>
                <small>{t(`design.coach.${size}.hint`)}</small>
              </button>
            ))}
          </div>
          {!allows(can, "matters") && <p>{said({ code: "class.coach-closed" })}</p>}
          {allows(can, "matters") && sizes.length < SIZES.length && (
            <p class="muted">{t("design.class.coachPart")}</p>
          )}
        </div>
      )}
      {found && !isCurrent && <p class="muted">{t("design.coach.old")}</p>}
      {found && isCurrent && <Answer coach={coach} sheet={sheet} found={found} />}
    </section>
  );
}

function Working({ coach, job }: { coach: Coach; job: string }) {
  const progress = coach.progress.value;
  const mine = progress?.job === job ? progress : null;
  const stage = mine?.stage ?? "matters";
  const name = `design.coach.stage.${stage}` as "design.coach.stage.matters";
  return (
    <div class="working" role="status">
      <p>
        {t(name)}
        {mine && <small class="muted"> {t("design.coach.trials", { count: mine.trials })}</small>}
      </p>
      <progress value={mine?.done ?? 0} max={1} aria-label={t(name)} />
      <button class="button" type="button" onClick={() => coach.stop()}>
        {t("design.coach.stop")}
      </button>
    </div>
  );
}

function Answer({ coach, sheet, found }: Props & { found: Found }) {
  const table = sheet.table.value;
  if (!table) return null;
  return found.size === null ? (
    <Matters coach={coach} sheet={sheet} table={table} found={found} />
  ) : (
    <Better coach={coach} sheet={sheet} table={table} found={found} />
  );
}
