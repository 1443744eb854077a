/** The coach: which numbers matter, and a better gait; both only after one's own guess. */

import { said, t } from "../../../i18n";
import { allows, type Can } from "../can";
import type { Sheet } from "../table/sheet";
import type { Trials } from "../trials/trials";
import { Better } from "./better";
import { type Coach, type Found, GOALS, type Goal, SIZES } from "./coach";
import { GaitMap } from "./map";
import { Matters } from "./matters";
import type { Others } from "./others";
import type { Search } from "./search";
import { Variants } from "./variants";
import "./coach.css";
import "./others.css";

interface Props {
  coach: Coach;
  sheet: Sheet;
}

interface PanelProps extends Props {
  can: Can;
  /** The word of phase 5; "": none. */
  word: string;
  trials: Trials;
}

export function CoachPanel({ coach, sheet, can, word, trials }: PanelProps) {
  const { search, others } = coach;
  const looks = others.looks.value;
  const found = looks === null ? coach.found.value : null;
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
      {search.job.value ? (
        <Working search={search} job={search.job.value} />
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
          {allows(can, "table") && (
            <>
              <p class="muted">{t("design.coach.others")}</p>
              <div class="sizes two">
                <button class="button" type="button" onClick={() => void others.askMap()}>
                  <b>{t("design.map")}</b>
                  <small>{t("design.map.hint")}</small>
                </button>
                <button class="button" type="button" onClick={() => void others.askVariants()}>
                  <b>{t("design.variants")}</b>
                  <small>{t("design.variants.hint")}</small>
                </button>
              </div>
            </>
          )}
          {!allows(can, "matters") && <p>{said({ code: "class.coach-closed" })}</p>}
          {allows(can, "matters") && sizes.length < SIZES.length && (
            <p class="muted">{t("design.class.coachPart")}</p>
          )}
        </div>
      )}
      {found && !isCurrent && <p class="muted">{t("design.coach.old")}</p>}
      {looks && allows(can, "table") && (
        <Other others={others} looks={looks} word={word} sheet={sheet} trials={trials} />
      )}
      {found && isCurrent && <Answer coach={coach} sheet={sheet} found={found} />}
    </section>
  );
}

interface OtherProps {
  others: Others;
  looks: "map" | "variants";
  word: string;
  sheet: Sheet;
  trials: Trials;
}

/** The map or the variants, as far as they are there and about the table as it is now. */
function Other({ others, looks, word, sheet, trials }: OtherProps) {
  const map = looks === "map" ? others.map.value : null;
  const round = looks === "variants" ? others.round.value : null;
  if (!map && !round) return null;
  if (!others.isCurrent.value) return <p class="muted">{t("design.coach.old")}</p>;
  if (map) return <GaitMap others={others} map={map} />;
  const own = trials.all.value.findLast((tried) => tried.version === sheet.version.value);
  const before = own?.trial.reply.figures ?? null;
  return <Variants others={others} round={round!} word={word} before={before} />;
}

function Working({ search, job }: { search: Search; job: string }) {
  const progress = search.progress.value;
  const mine = progress?.job === job ? progress : null;
  const stage = mine?.stage ?? "matters";
  const name = `design.coach.stage.${stage}` as "design.coach.stage.matters";
  return (
    <div class="working" role="status">
      <p>
        {t(name)}
        {mine && <small class="muted"> {t("design.coach.trials", { count: mine.trials })}</small>}
        {mine?.stage === "map" && mine.filled !== null && (
          <small class="muted"> · {t("design.map.soFar", { filled: mine.filled })}</small>
        )}
      </p>
      <progress value={mine?.done ?? 0} max={1} aria-label={t(name)} />
      <button class="button" type="button" onClick={() => search.stop()}>
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
