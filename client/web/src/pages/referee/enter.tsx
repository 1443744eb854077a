/** Sitting down at the desk, and who sits there. */

import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { ownToken } from "../../core/address";
import { said, t } from "../../i18n";
import { Dialog } from "../../ui/dialog";
import type { Desk } from "./desk";

/** Asks for name and token; nothing once the court has taken them. */
export function EnterCard({ desk }: { desk: Desk }) {
  const token = useSignal(ownToken() ?? ""); // a referee's link has it
  const name = useSignal(desk.by.value || desk.lastName.value);
  const welcome = desk.court.welcome.value;
  if (!welcome || desk.entered.value) return null;
  const refused = desk.refused.value;
  return (
    <section class="card enter" aria-labelledby="enter-title">
      <h2 id="enter-title">{t("referee.enterTitle")}</h2>
      <p class="muted">{t("referee.enterText")}</p>
      <form
        onSubmit={(event) => {
          event.preventDefault();
          desk.enter(token.value.trim(), name.value.trim());
        }}
      >
        <label class="field">
          <span>{t("referee.name")}</span>
          <input
            name="by"
            required
            maxLength={40}
            autocomplete="name"
            value={name.value}
            onInput={(event) => {
              name.value = event.currentTarget.value;
            }}
          />
        </label>
        <label class="field">
          <span>{t("referee.token")}</span>
          <input
            name="token"
            type="password"
            required
            maxLength={200}
            autocomplete="off"
            spellcheck={false}
            value={token.value}
            aria-invalid={refused ? "true" : undefined}
            aria-describedby={refused ? "token-refused" : undefined}
            onInput={(event) => {
              token.value = event.currentTarget.value;
            }}
          />
          {refused && (
            <span id="token-refused" class="refused" role="alert">
              {said(refused)}
            </span>
          )}
        </label>
        <button class="button strong" type="submit" disabled={desk.busy.value}>
          {desk.busy.value ? t("referee.entering") : t("referee.enter")}
        </button>
      </form>
    </section>
  );
}

/** Who acts, and the way to act oneself; nothing before one has entered. */
export function ActingBar({ desk }: { desk: Desk }) {
  /** Whom the open question is about; "" while none is open. */
  const asking = useSignal("");
  const state = desk.court.referee.value;
  const acting = (desk.entered.value && state?.acting) || "";
  useEffect(() => {
    asking.value = ""; // a question about somebody else is over
  }, [acting]);
  if (!desk.entered.value || !state) return null;
  if (desk.mine.value) {
    return (
      <div class="acting mine">
        <span>
          {t("referee.youAct")} · {desk.by.value}
        </span>
        <button
          class="button quiet"
          type="button"
          title={t("referee.leaveText")}
          onClick={() => desk.leave()}
        >
          {t("referee.leave")}
        </button>
      </div>
    );
  }
  return (
    <div class="acting other" role="status">
      <span>
        <strong>{acting ? t("referee.acts", { name: acting }) : t("referee.nobody")}</strong>
        <br />
        {t("referee.watching")}
      </span>
      <button
        class="button strong"
        type="button"
        onClick={() => {
          if (acting) asking.value = acting;
          else desk.takeOver();
        }}
      >
        {t("referee.takeOver")}
      </button>
      {asking.value && (
        <Dialog
          title={t("referee.takeOverTitle", { name: asking.value })}
          onClose={() => {
            asking.value = "";
          }}
        >
          <p>{t("referee.takeOverText", { name: asking.value })}</p>
          <div class="dialog-end">
            <button
              class="button strong"
              type="button"
              onClick={() => {
                asking.value = "";
                desk.takeOver();
              }}
            >
              {t("referee.takeOver")}
            </button>
          </div>
        </Dialog>
      )}
    </div>
  );
}
