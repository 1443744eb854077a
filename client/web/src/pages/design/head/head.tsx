/** The head of the page: the file, the task, and what lets the robot walk. */

import { useSignal, useSignalEffect } from "@preact/signals";
import { type MessageName, t } from "../../../i18n";
import { IconButton } from "../../../ui/icons";
import { Kbd } from "../../../ui/kbd";
import { PhaseDots } from "../learning/dots";
import type { Learning } from "../learning/learning";
import { keyName } from "../names";
import type { Studio } from "../studio";
import type { Sheet } from "../table/sheet";
import { triedKeys } from "../trials/keys";
import { POSES, type Trials } from "../trials/trials";
import type { Showing } from "../walk/showing";
import { FileButtons } from "./file_buttons";
import { Foretell } from "./foretell";
import "./head.css";

interface Props {
  studio: Studio;
  onFiles: () => void;
  onPhase: () => void;
  onSettings: () => void;
}

export function Head({ studio, onFiles, onPhase, onSettings }: Props) {
  const { sheet, trials, showing } = studio;
  const can = studio.can.value;
  const asks = useSignal(false);
  const close = () => {
    asks.value = false;
  };
  useSignalEffect(() => {
    if (trials.trying.value) close();
  });
  return (
    <header class="bar">
      <FileButtons studio={studio} onFiles={onFiles} />
      <div class="where">
        {can.learn && <PhaseDots learning={studio.learning} can={can} onOpen={onPhase} />}
        <Task sheet={sheet} trials={trials} learning={can.learn ? studio.learning : null} />
      </div>
      <div class="acts">
        <button
          class="button"
          type="button"
          aria-expanded={asks.value}
          title={t("design.predictHint")}
          onClick={() => {
            asks.value = !asks.value;
          }}
        >
          {t("design.predict")}
        </button>
        <KeyChooser sheet={sheet} trials={trials} />
        <button
          class="button strong try"
          type="button"
          disabled={!studio.present.value}
          aria-busy={trials.trying.value}
          title={t("design.tryKey")}
          onClick={() => void trials.tryIt()}
        >
          {t(trials.trying.value ? "design.trying" : "design.try")}
          <Kbd>Ctrl+Enter</Kbd>
        </button>
        <CompareButton trials={trials} showing={showing} />
        <IconButton name="settings" label={t("settings.title")} onClick={onSettings} />
      </div>
      {asks.value && <Foretell trials={trials} onClose={close} />}
    </header>
  );
}

interface TaskProps {
  sheet: Sheet;
  trials: Trials;
}

/** The phases before anything walks. */
const LESSON = 0;
const ONE_LEG = 1;

/** What to do next, in a sentence. */
function Task({ sheet, trials, learning }: TaskProps & { learning: Learning | null }) {
  const phases = learning?.phases.value;
  const now = phases?.phases[phases.phase];
  const next = now?.state === "met" ? phases?.phases[now.number + 1] : undefined;
  const last = trials.all.value.at(-1);
  const name = ((): MessageName => {
    if (sheet.bad.value.length) return "design.task.bad";
    if (now?.asked) return "design.task.question";
    if (next) return "design.task.next";
    if (now?.number === LESSON && now.state !== "met") return "design.task.lesson";
    const isStill = now?.number === ONE_LEG && now.state !== "met"; // there nothing walks yet
    if (!last && isStill) return "design.task.edit";
    if (!last) return sheet.history.value?.canUndo.value ? "design.task.try" : "design.task.edit";
    if (last.version !== sheet.version.value) return "design.task.again";
    return last.trial.reply.explained.length ? "design.task.read" : "design.task.change";
  })();
  return (
    <p class="task" role="status">
      {t(name, {
        count: sheet.bad.value.length,
        phase: now?.number ?? 0,
        next: next?.number ?? 0,
      })}
    </p>
  );
}

/** What the next trial presses. */
function KeyChooser({ sheet, trials }: TaskProps) {
  const keys = triedKeys(sheet);
  return (
    <label class="chooser">
      <span class="hidden-text">{t("design.pressed")}</span>
      <select
        value={trials.pressed()}
        title={t("design.pressed")}
        onChange={(event) => {
          const { value } = event.currentTarget;
          trials.press(POSES.find((pose) => pose === value) ?? Number(value));
        }}
      >
        {keys.map((key) => (
          <option key={key} value={key}>
            {t("design.keyOption", { name: keyName(key) })}
          </option>
        ))}
        {sheet.table.value?.kind === "postures" &&
          POSES.map((pose) => (
            <option key={pose} value={pose}>
              {t(`design.pose.${pose}`)}
            </option>
          ))}
      </select>
    </label>
  );
}

/** Compare the shown trial with the one before it, or stop comparing. */
function CompareButton({ trials, showing }: { trials: Trials; showing: Showing }) {
  const { other } = showing;
  const before = trials.beforeShown();
  return (
    <button
      class="button"
      type="button"
      aria-pressed={other.value !== null}
      disabled={!before && !other.value}
      title={t("design.compareHint")}
      onClick={() => {
        other.value = other.value ? null : before;
      }}
    >
      {t("design.compare")}
    </button>
  );
}
