/** The keys of level B: what each runs through, and which of them a trial presses. */

import { useSignal } from "@preact/signals";
import { keysOf, rowsOfKey } from "../../../core/design/rows";
import { digitsOf, sequences } from "../../../core/files";
import { MAX_KEYS } from "../../../core/wire";
import { t } from "../../../i18n";
import { classes, keyMeaning, keyName } from "../names";
import type { Sheet } from "../table/sheet";
import "./keys.css";

/** The keys that can be tried. */
export function triedKeys(sheet: Sheet): number[] {
  const table = sheet.table.value;
  if (!table) return [];
  if (table.kind === "locomotion") return keysOf(table);
  return sequences.value.flatMap((digits, key) => (digits ? [key] : []));
}

interface Props {
  sheet: Sheet;
  onChoose: (key: number) => void;
}

export function Keys({ sheet, onChoose }: Props) {
  const table = sheet.table.value;
  if (!table) return null;
  const isMade = table.kind === "postures";
  const shown = isMade
    ? Array.from({ length: Math.min(MAX_KEYS, sequences.value.length + 1) }, (_, key) => key)
    : keysOf(table);
  return (
    <section class="keys" aria-labelledby="keys-title">
      <h2 id="keys-title">{t("design.keys")}</h2>
      <ul>
        {shown.map((key) => (
          <li key={key} class={classes(sheet.key.value === key && "chosen")}>
            <button
              type="button"
              aria-pressed={sheet.key.value === key}
              aria-label={t("design.chooseKey", { name: keyName(key) })}
              onClick={() => {
                onChoose(key);
                const row = sheet.sequence.peek()?.[0];
                if (row !== undefined) sheet.select({ row, col: sheet.active.peek().col });
              }}
            >
              <b>{key}</b>
              <span>{keyMeaning(key)}</span>
            </button>
            {isMade ? (
              <Sequence sheet={sheet} digit={key} />
            ) : (
              <small>{t("design.postures", { count: rowsOfKey(table, key).length })}</small>
            )}
          </li>
        ))}
      </ul>
      <p class="muted">{t(isMade ? "design.keysHint" : "design.keysHintB")}</p>
    </section>
  );
}

/** The postures of a key. What is being typed stays, also when the page is drawn again meanwhile. */
function Sequence({ sheet, digit }: { sheet: Sheet; digit: number }) {
  const draft = useSignal<string | null>(null);
  const digits = sequences.value[digit] ?? "";
  const there = new Set(keysOf(sheet.table.value!).map(String));
  const isWrong = [...digits].some((one) => !there.has(one));
  return (
    <input
      class={isWrong ? "wrong" : ""}
      value={draft.value ?? [...digits].join(" ")}
      inputMode="numeric"
      autocomplete="off"
      aria-label={t("files.sequence", { digit })}
      aria-invalid={isWrong}
      title={isWrong ? t("design.noPosture") : ""}
      placeholder={digit === sequences.value.length ? t("files.newKey") : ""}
      onInput={(event) => {
        draft.value = event.currentTarget.value;
      }}
      onChange={(event) => {
        draft.value = null;
        const changed = [...sequences.peek()];
        while (changed.length <= digit) changed.push("");
        changed[digit] = digitsOf(event.currentTarget.value);
        while (changed.length > 1 && !changed.at(-1)) changed.pop();
        sheet.setKeys(changed);
      }}
    />
  );
}
