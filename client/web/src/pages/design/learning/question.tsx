/** The question that a phase asks before it is done, and what came of the last answer. */

import { useSignal } from "@preact/signals";
import { useId } from "preact/hooks";
import type { PhaseState } from "../../../core/wire";
import { said, t } from "../../../i18n";
import { classes } from "../names";
import type { Learning } from "./learning";

interface Props {
  learning: Learning;
  phase: PhaseState;
}

export function Question({ learning, phase: { number, asked } }: Props) {
  const answer = learning.answer.value;
  const title = useId();
  const isAsking = useSignal(false);
  const told = answer?.phase === number ? answer : null;
  return (
    <>
      {asked && (
        <section class="phase-question" aria-labelledby={title}>
          <p id={title}>{said(asked.ask)}</p>
          {asked.choices.map((choice, index) => (
            <button
              key={`${asked.name} ${index}`}
              class="button"
              type="button"
              disabled={isAsking.value}
              onClick={async () => {
                isAsking.value = true;
                await learning.say(number, asked.name, index);
                isAsking.value = false;
              }}
            >
              {said(choice)}
            </button>
          ))}
        </section>
      )}
      <p
        role="status"
        class={classes("verdict", "phase-verdict", told && (told.right ? "right" : "wrong"))}
      >
        {told &&
          !asked &&
          t(told.right ? "design.question.right" : "design.question.wrong", {
            was: told.was.map(said).join(t("design.question.or")),
            because: said(told.because),
          })}
      </p>
    </>
  );
}
