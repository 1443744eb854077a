/** What will happen? Foretold before the trial shows it. */

import { useEffect } from "preact/hooks";
import type { Guess } from "../../../core/design/predict";
import { t } from "../../../i18n";
import type { Trials } from "../trials/trials";

const PACES = ["faster", "same", "slower"] as const;
const WAYS = ["left", "straight", "right"] as const;

/** What is foretold, in words. */
export function guessName(is: Guess["is"]): string {
  return t(is === "right" ? "design.guess.right.way" : `design.guess.${is}`);
}

interface Props {
  trials: Trials;
  onClose: () => void;
}

export function Foretell({ trials, onClose }: Props) {
  useEffect(() => {
    const press = (event: KeyboardEvent) => event.key === "Escape" && onClose();
    addEventListener("keydown", press);
    return () => removeEventListener("keydown", press);
  }, [onClose]);
  const before = trials.lastOf(trials.pressed());
  const guesses = trials.guesses.value;
  const choose = (guess: Guess) => {
    const others = guesses.filter(({ about }) => about !== guess.about);
    trials.guesses.value = [...others, guess];
  };
  return (
    <section class="foretell" aria-label={t("design.predict")}>
      <p>{t("design.predictText")}</p>
      {before && (
        <fieldset>
          <legend>{t("design.predictPace", { number: before.number })}</legend>
          {PACES.map((is) => (
            <Choice key={is} about="pace" is={is} guesses={guesses} onChoose={choose} />
          ))}
        </fieldset>
      )}
      <fieldset>
        <legend>{t("design.predictWay")}</legend>
        {WAYS.map((is) => (
          <Choice key={is} about="way" is={is} guesses={guesses} onChoose={choose} />
        ))}
      </fieldset>
      <button
        class="button strong"
        type="button"
        disabled={!guesses.length}
        onClick={() => {
          onClose();
          void trials.tryIt();
        }}
      >
        {t("design.try")}
      </button>
    </section>
  );
}

interface ChoiceProps {
  about: Guess["about"];
  is: Guess["is"];
  guesses: readonly Guess[];
  onChoose: (guess: Guess) => void;
}

function Choice({ about, is, guesses, onChoose }: ChoiceProps) {
  return (
    <label class="choice">
      <input
        type="radio"
        name={`guess-${about}`}
        checked={guesses.some((guess) => guess.about === about && guess.is === is)}
        onChange={() => onChoose({ about, is } as Guess)}
      />
      <span>{guessName(is)}</span>
    </label>
  );
}
