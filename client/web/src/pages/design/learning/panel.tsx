/** The task of the phase that the student is at (workshop 3-1, 4-2). */

import { said, t } from "../../../i18n";
import { allows, type Can, isClosed } from "../can";
import type { Court } from "../files/court";
import { CourtButton } from "../files/court_button";
import type { Files } from "../files/files";
import { classes } from "../names";
import type { Sheet } from "../table/sheet";
import { POSE_OF, type Trials } from "../trials/trials";
import { closedText, stateName } from "./dots";
import type { Learning } from "./learning";
import { Question } from "./question";
import { Check, Concept, FootGuess } from "./tasks";
import "./learning.css";

const LESSON = 0;
const ONE_LEG = 1;
const CYCLE = 4;
const LAST = 6;
/** Said where numbers of a trial are not the student's own. */
const FOREIGN = "phases.foreign";
const CONCEPT = 5;
const CREATIVE = 6;

interface Props {
  learning: Learning;
  sheet: Sheet;
  trials: Trials;
  can: Can;
  canTry: boolean;
  court: Court;
  files: Files;
  /** Shows six variants of the gait. */
  onVariants: () => void;
}

export function PhasePanel(props: Props) {
  const { learning, sheet, trials, can, canTry, court, files, onVariants } = props;
  const now = learning.phases.value;
  const phase = now?.phases[now.phase];
  if (!now || !phase) return <p class="muted">{t("design.loading")}</p>;
  const { number, state } = phase;
  const percent = Math.round(100 * phase.share);
  const pose = POSE_OF[number];
  const isFirst = can.rules.explain_first;
  const explanation = (
    <details key={`${number} ${state}`} open={isFirst || state === "met"}>
      <summary>{t("design.phase.explanation")}</summary>
      <p>{said(phase.explanation)}</p>
    </details>
  );
  /** Whether the student can go to a phase that there is. */
  const isOpen = (other: number) => !isClosed(can, other);
  return (
    <section class="learn" aria-label={t("design.phases")}>
      {now.trouble && (
        <p class="learn-trouble" role="status">
          {t("design.phase.notKept")} {said(now.trouble)}
        </p>
      )}
      <h3>
        {number}. {said(phase.title)} <span data-state={state}>{stateName(state)}</span>
      </h3>
      <Question learning={learning} phase={phase} />
      {isFirst && explanation}
      <p class="learn-task">{said(phase.task)}</p>
      <p>{said(phase.question)}</p>
      {number === LESSON && (
        <a class={classes("button", !phase.asked && "strong")} href="leg">
          {phase.asked || state === "met"
            ? t("design.lesson")
            : now.lesson_step
              ? t("design.lesson.goOn", { step: now.lesson_step })
              : t("design.lesson.begin")}
        </a>
      )}
      {number === ONE_LEG && (
        <>
          <a href="leg">{t("design.lesson")}</a>
          <FootGuess learning={learning} />
        </>
      )}
      {pose && sheet.table.value?.kind === "postures" && (
        <button
          class="button"
          type="button"
          disabled={!canTry}
          onClick={() => {
            trials.press(pose);
            void trials.tryIt();
          }}
        >
          {t("design.phase.tryPose", { pose: t(`design.pose.${pose}`) })}
        </button>
      )}
      {number === CONCEPT && <Concept learning={learning} word={now.word} />}
      {number === CONCEPT && now.word && allows(can, "table") && (
        <button class="button" type="button" disabled={!canTry} onClick={onVariants}>
          {t("design.phase.variants", { word: now.word })}
        </button>
      )}
      {number === CREATIVE && (
        <>
          <Check learning={learning} sheet={sheet} />
          <CourtButton court={court} />
        </>
      )}
      {phase.missing.some(({ code }) => code === FOREIGN) && (
        <button class="button" type="button" onClick={() => files.takeNew()}>
          {t("design.phase.newTable")}
        </button>
      )}
      {number === CYCLE && state === "met" && (
        <section class="reward">
          <p>{t("design.phase.reward")}</p>
          <button class="button" type="button" onClick={() => void files.takeSample()}>
            {t("design.phase.openSample")}
          </button>
        </section>
      )}
      <progress max={100} value={percent} aria-label={t("design.phase.share")}>
        {percent} %
      </progress>
      {phase.missing.length > 0 && (
        <ul class="learn-missing" aria-label={t("design.phase.missing")}>
          {phase.missing.map((one, index) => (
            <li key={index}>{said(one)}</li>
          ))}
        </ul>
      )}
      <details>
        <summary>{t("design.phase.hint")}</summary>
        <p>{said(phase.hint)}</p>
      </details>
      {!isFirst && explanation}
      {[number, number + 1]
        .filter((one) => isClosed(can, one))
        .map((one) => (
          <p key={one} class="learn-trouble">
            {closedText(one)}
          </p>
        ))}
      <div class="row">
        <button
          class="button"
          type="button"
          disabled={number === LESSON || !isOpen(number - 1)}
          onClick={() => void learning.goTo(number - 1)}
        >
          {t("design.phase.back")}
        </button>
        <button
          class={classes("button", state === "met" && "strong")}
          type="button"
          disabled={number === LAST || !isOpen(number + 1)}
          onClick={() => void learning.goTo(number + 1)}
        >
          {t("design.phase.next")}
        </button>
      </div>
    </section>
  );
}
