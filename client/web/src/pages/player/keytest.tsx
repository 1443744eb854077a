/** Which keys arrive, and what they would do: for keyboards that are in doubt. */

import { useSignal } from "@preact/signals";
import { isFromInputMethod, type Pressed, readKey } from "../../core/keys";
import { t } from "../../i18n";

const MOST = 6;

interface Arrived {
  id: number;
  code: string;
  does: string;
  viaInputMethod: boolean;
}

export function KeyTest() {
  const arrived = useSignal<readonly Arrived[]>([]);
  const take = (event: KeyboardEvent) => {
    // Tab and Escape stay the way out of the test.
    if (event.code !== "Tab" && event.code !== "Escape") event.preventDefault();
    if (event.repeat) return;
    const one = {
      id: (arrived.peek()[0]?.id ?? 0) + 1,
      code: event.code || event.key,
      does: inWords(readKey(event)),
      viaInputMethod: isFromInputMethod(event),
    };
    arrived.value = [one, ...arrived.peek()].slice(0, MOST);
  };
  return (
    <div class="field">
      <span id="keytest">{t("keytest.title")}</span>
      {/* biome-ignore-start lint/a11y/noNoninteractiveTabindex: it is there to take keys */}
      {/* biome-ignore lint/a11y/useSemanticElements: a text field would swallow what an input method does */}
      <div class="keytest" role="textbox" aria-labelledby="keytest" tabIndex={0} onKeyDown={take}>
        {!arrived.value.length && <p class="muted">{t("keytest.hint")}</p>}
        {arrived.value.map(({ id, code, does, viaInputMethod }) => (
          <p key={id}>
            <kbd>{code}</kbd> {does}
            {viaInputMethod && <em> {t("keytest.ime")}</em>}
          </p>
        ))}
      </div>
      {/* biome-ignore-end lint/a11y/noNoninteractiveTabindex: see above */}
    </div>
  );
}

function inWords(pressed: Pressed | null): string {
  if (!pressed) return t("keytest.none");
  return "digit" in pressed
    ? t(`keytest.${pressed.does}`, { digit: pressed.digit })
    : t(`keytest.${pressed.does}`);
}
