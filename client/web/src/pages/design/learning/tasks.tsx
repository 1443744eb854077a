/** What is done for a phase beside editing and trying: guess, choose a word, vote, check. */

import { useSignal } from "@preact/signals";
import type { CheckReply } from "../../../core/wire";
import { type MessageName, t } from "../../../i18n";
import { toast } from "../../../ui/toasts";
import { classes } from "../names";
import type { Sheet } from "../table/sheet";
import type { Learning } from "./learning";

const WAYS = ["forward", "back", "up", "down", "out", "in"] as const;

/** Where does the foot go? Said before the number is changed. */
export function FootGuess({ learning }: { learning: Learning }) {
  const chosen = learning.footGuess.value;
  const judged = learning.judged.value;
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
            learning.footGuess.value = chosen === way ? null : way;
            learning.judged.value = null;
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
export function Concept({ learning, word }: { learning: Learning; word: string }) {
  const draft = useSignal<string | null>(null);
  const text = (draft.value ?? word).trim();
  return (
    <>
      <form
        class="row"
        onSubmit={(event) => {
          event.preventDefault();
          if (text) void learning.send("name", { word: text });
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
              onClick={() => void learning.send("vote", { choice })}
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
export function Check({ learning, sheet }: { learning: Learning; sheet: Sheet }) {
  const check = async () => {
    const gait = learning.gait();
    if (!gait) {
      toast(t("design.badCells", { count: sheet.bad.peek().length }), "no");
      return;
    }
    const reply = await learning.send<CheckReply>("check", gait);
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
