/** The history of trials; each belongs to a version of the table. */

import type { RobotReply } from "../../../core/wire";
import { t } from "../../../i18n";
import { classes } from "../names";
import type { Showing } from "../walk/showing";
import { difference, TILES, written } from "./figures";
import type { Trials } from "./trials";
import type { Tried } from "./tried";
import "./trials.css";

const [SPEED, DRIFT, STABLE] = TILES;

interface ListProps {
  trials: Trials;
  /** The robot that the next trial lets walk. */
  robot: RobotReply | null;
  showing: Showing;
  /** The version of the table. */
  version: number;
}

export function TrialList(props: ListProps) {
  const all = props.trials.all.value;
  if (!all.length) return <p class="muted empty">{t("design.noTrials")}</p>;
  return (
    <ol class="trials" reversed>
      {all.toReversed().map((tried) => (
        <TrialRow key={tried.number} {...props} tried={tried} />
      ))}
    </ol>
  );
}

/** Whether two robots are equal in all that their page shows. */
function isSame(one: RobotReply, other: RobotReply | null): boolean {
  const shown = (robot: RobotReply) => JSON.stringify([robot.facts, robot.shapes]);
  return one === other || (other !== null && shown(one) === shown(other));
}

function TrialRow(props: ListProps & { tried: Tried }) {
  const { trials, robot, showing, version, tried } = props;
  const isShown = showing.shown.value === tried;
  const isOther = showing.other.value === tried;
  const isCurrent = tried.version === version;
  const { figures } = tried.trial.reply;
  const before = trials.before(tried);
  const by = before && difference(SPEED!, before.trial.reply.figures, figures);
  const name = t("design.trialOf", { number: tried.number, key: tried.key });
  return (
    <li class={classes(isShown && "shown", isOther && "other")}>
      <button
        class="look"
        type="button"
        aria-current={isShown}
        aria-label={t("design.showTrial", { name })}
        onClick={() => showing.look(tried)}
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
          <span class="badge">
            {t(isSame(tried.robot, robot) ? "design.thisTable" : "design.otherRobot")}
          </span>
        ) : (
          <button
            class="button quiet small"
            type="button"
            aria-label={t("design.restoreTrial", { name })}
            onClick={() => trials.restore(tried)}
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
              showing.other.value = isOther ? null : tried;
            }}
          >
            {t("design.compare")}
          </button>
        )}
      </span>
    </li>
  );
}
