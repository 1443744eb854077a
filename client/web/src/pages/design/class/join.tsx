/** The door of a class: its code and a nickname let a student in. */

import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { said, t } from "../../../i18n";
import { waitsForGateway } from "../../../ui/banner";
import { IconButton } from "../../../ui/icons";
import type { Gateway } from "../gateway";
import type { Door, Membership } from "./membership";
import "./class.css";

/** How often the gateway hears of a page on which somebody is typing. */
const ALIVE_MS = 2000;

interface Props {
  door: Door;
  membership: Membership;
  gateway: Gateway;
  onSettings: () => void;
}

export function Join({ door, membership, gateway, onSettings }: Props) {
  const code = useSignal("");
  const name = useSignal(door.name);
  const isAsking = useSignal(false);
  const first = useRef<HTMLInputElement>(null);
  useEffect(() => {
    first.current?.focus();
    const timer = setInterval(() => void gateway.ask("ping").catch(() => undefined), ALIVE_MS);
    return () => clearInterval(timer);
  }, [gateway]);
  const join = async () => {
    if (isAsking.peek()) return;
    isAsking.value = true;
    membership.type(code.peek(), name.peek());
    await gateway.greetAgain();
    isAsking.value = false;
  };
  const { state } = gateway;
  const waits = state.value.open ? "" : waitsForGateway({ ...state.value, refused: null });
  const why = waits || (door.why ? said(door.why) : "");
  const isName = door.why?.code === "class.bad-name" || door.why?.code === "class.name-taken";
  return (
    <main class="join">
      <form
        class="card"
        aria-labelledby="join-title"
        onSubmit={(event) => {
          event.preventDefault();
          void join();
        }}
      >
        <h1 id="join-title">{t("design.join")}</h1>
        <p>{t("design.join.text")}</p>
        <label class="field">
          <span>{t("design.join.code")}</span>
          <input
            ref={first}
            class="class-code"
            value={code.value}
            autocomplete="off"
            autocapitalize="characters"
            autocorrect="off"
            spellcheck={false}
            maxLength={40}
            aria-invalid={door.why?.code === "class.wrong-code"}
            aria-describedby="join-why"
            onInput={(event) => {
              code.value = event.currentTarget.value;
            }}
          />
        </label>
        <label class="field">
          <span>{t("design.join.name")}</span>
          <input
            value={name.value}
            autocomplete="off"
            spellcheck={false}
            maxLength={40}
            aria-invalid={isName}
            aria-describedby="join-why"
            onInput={(event) => {
              name.value = event.currentTarget.value;
            }}
          />
        </label>
        <p id="join-why" class="join-why" role="alert">
          {why}
        </p>
        <button class="button strong" type="submit" aria-busy={isAsking.value}>
          {t("design.join.go")}
        </button>
        <p class="muted">{t("design.join.kept")}</p>
      </form>
      <IconButton name="settings" label={t("settings.title")} onClick={onSettings} />
    </main>
  );
}
