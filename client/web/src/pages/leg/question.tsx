/** A question of the lesson: a guess first, then whether it was right, and why. */

import type { Question } from "../../core/leg/lesson";
import { said, t } from "../../i18n";
import type { Lesson } from "./lesson";

interface Props {
  lesson: Lesson;
  question: Question;
  /** Its place in the step. */
  at: number;
}

export function Ask({ lesson, question, at }: Props) {
  const chosen = lesson.answerOf(at);
  const choice = chosen === null ? null : question.choices[chosen]!;
  return (
    <fieldset class="ask">
      <legend>{said(question.ask)}</legend>
      <div class="choices">
        {question.choices.map((one, index) => {
          const isTold = choice !== null && (one.right || index === chosen);
          return (
            <button
              key={index}
              class="button"
              type="button"
              aria-pressed={chosen === index}
              aria-disabled={choice !== null || undefined}
              data-verdict={isTold ? (one.right ? "right" : "wrong") : undefined}
              onClick={() => {
                if (choice === null) lesson.answer(at, index);
              }}
            >
              {isTold && <span aria-hidden="true">{one.right ? "✓" : "✗"}</span>}
              {said(one.say)}
            </button>
          );
        })}
      </div>
      <p class="because" role="status">
        {choice ? (
          <>
            <strong data-verdict={choice.right ? "right" : "wrong"}>
              {t(choice.right ? "leg.right" : "leg.wrong")}
            </strong>{" "}
            {said(question.because)}
          </>
        ) : (
          <span class="muted">{t("leg.guess")}</span>
        )}
      </p>
    </fieldset>
  );
}
