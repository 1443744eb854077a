/** The six phases of the workshop (4-2): where a student is, and what there is to do. */

import { useSignal } from "@preact/signals";
import type { CheckReply, PhaseState } from "../../core/wire";
import { type MessageName, said, t } from "../../i18n";
import { toast } from "../../ui/toasts";
import { classes } from "./rows";
import type { Pose, Studio } from "./studio";

const WAYS = ["forward", "back", "up", "down", "out", "in"] as const;
/** What is to be tried in a phase. */
const POSE_OF: Readonly<Record<number, Pose>> = { 2: "A1", 3: "A1, A2" };
const ONE_LEG = 1;
const CONCEPT = 5;
const CREATIVE = 6;

/** The phases as dots; each opens its task. */
export function PhaseDots({ studio, onOpen }: { studio: Studio; onOpen: () => void }) {
  const now = studio.phases.value;
  if (!now) return null;
  return (
    <nav class="phase-dots" aria-label={t("design.phases")}>
      {now.phases.map((phase) => (
        <button
          key={phase.number}
          type="button"
          data-state={phase.state}
          aria-current={phase.number === now.phase ? "step" : undefined}
          aria-label={phaseName(phase)}
          title={phaseName(phase)}
          onClick={() => {
            if (phase.number !== now.phase) void studio.goTo(phase.number);
            onOpen();
          }}
        >
          {phase.state === "met" ? "✓" : phase.number}
        </button>
      ))}
    </nav>
  );
}

/** "2 Three legs, done" */
function phaseName({ number, title, state }: PhaseState): string {
  return t("design.phase.name", { number, title: said(title), state: stateName(state) });
}

function stateName(state: string): string {
  return t(`design.phase.${state}` as MessageName);
}

/** The task of the phase that the student is at. */
export function PhasePanel({ studio, onTry }: { studio: Studio; onTry: () => void }) {
  const now = studio.phases.value;
  const phase = now?.phases[now.phase - 1];
  if (!now || !phase) return <p class="muted">{t("design.loading")}</p>;
  const { number, state } = phase;
  const percent = Math.round(100 * phase.share);
  const pose = POSE_OF[number];
  return (
    <section class="learn" aria-label={t("design.phases")}>
      {now.trouble && (
        <p class="learn-trouble" role="status">
          {t("design.phase.notKept")} {said(now.trouble)}
        </p>
      )}
      <h3>
        {number} {said(phase.title)} <span data-state={state}>{stateName(state)}</span>
      </h3>
      <p class="learn-task">{said(phase.task)}</p>
      <p>{said(phase.question)}</p>
      {number === ONE_LEG && <FootGuess studio={studio} />}
      {pose && studio.table.value?.kind === "postures" && (
        <button
          class="button"
          type="button"
          disabled={!studio.present.value}
          onClick={() => {
            studio.pose.value = pose;
            onTry();
          }}
        >
          {t("design.phase.tryPose", { pose })}
        </button>
      )}
      {number === CONCEPT && <Concept studio={studio} word={now.word} />}
      {number === CREATIVE && <Check studio={studio} />}
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
      <details key={`${number} ${state}`} open={state === "met"}>
        <summary>{t("design.phase.explanation")}</summary>
        <p>{said(phase.explanation)}</p>
      </details>
      <div class="row">
        <button
          class="button"
          type="button"
          disabled={number === 1}
          onClick={() => void studio.goTo(number - 1)}
        >
          {t("design.phase.back")}
        </button>
        <button
          class={classes("button", state === "met" && "strong")}
          type="button"
          disabled={number === now.phases.length}
          onClick={() => void studio.goTo(number + 1)}
        >
          {t("design.phase.next")}
        </button>
      </div>
    </section>
  );
}

/** Where does the foot go? Said before the number is changed. */
function FootGuess({ studio }: { studio: Studio }) {
  const chosen = studio.footGuess.value;
  const judged = studio.judged.value;
  return (
    <fieldset class="foot-guess">
      <legend>{t("design.foot.ask")}</legend>
      {WAYS.map((way) => (
        <button
          key={way}
          class="button"
          type="button"
          aria-pressed={chosen === way}
          onClick={() => {
            studio.footGuess.value = chosen === way ? null : way;
            studio.judged.value = null;
          }}
        >
          {t(`design.foot.${way}`)}
        </button>
      ))}
      <p role="status" class={classes("verdict", judged && (judged.right ? "right" : "wrong"))}>
        {chosen
          ? t("design.foot.now")
          : judged &&
            t(judged.right ? "design.verdict.right" : "design.verdict.wrong", {
              guess: footName(judged.said),
              was: judged.was.map(footName).join(t("design.foot.and")),
            })}
      </p>
    </fieldset>
  );
}

function footName(way: string): string {
  return t(`design.foot.${way}` as MessageName);
}

/** A word for how the robot shall walk, and the vote whether it does. */
function Concept({ studio, word }: { studio: Studio; word: string }) {
  const draft = useSignal<string | null>(null);
  const text = (draft.value ?? word).trim();
  return (
    <>
      <form
        class="row"
        onSubmit={(event) => {
          event.preventDefault();
          if (text) void studio.evidence("name", { word: text });
          draft.value = null;
        }}
      >
        <input
          value={draft.value ?? word}
          maxLength={40}
          autocomplete="off"
          aria-label={t("design.phase.word")}
          placeholder={t("design.phase.word")}
          onInput={(event) => {
            draft.value = event.currentTarget.value;
          }}
        />
        <button class="button" type="submit" disabled={!text || text === word}>
          {t("design.phase.keepWord")}
        </button>
      </form>
      {word && (
        <fieldset class="foot-guess">
          <legend>{t("design.phase.vote", { word })}</legend>
          {(["A", "B"] as const).map((choice) => (
            <button
              key={choice}
              class="button"
              type="button"
              onClick={() => void studio.evidence("vote", { choice })}
            >
              {t(`design.phase.vote${choice}`)}
            </button>
          ))}
        </fieldset>
      )}
    </>
  );
}

/** Check the table, as a contest would. */
function Check({ studio }: { studio: Studio }) {
  const check = async () => {
    const files = studio.request();
    if (!files) {
      toast(t("design.badCells", { count: studio.bad.peek().length }), "no");
      return;
    }
    const reply = await studio.evidence<CheckReply>("check", { ...files });
    const first = reply?.mistakes[0];
    if (reply && !first) toast(t("design.phase.checked", { keys: reply.keys }), "yes");
    else if (first) toast(t("design.phase.mistakes", { count: reply.mistakes.length }), "no");
  };
  return (
    <button class="button" type="button" onClick={() => void check()}>
      {t("design.phase.check")}
    </button>
  );
}
