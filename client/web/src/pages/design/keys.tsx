/** The keys of level B: what each runs through, and which of them a trial presses. */

import { useSignal } from "@preact/signals";
import { keysOf, rowsOfKey } from "../../core/design/rows";
import { digitsOf, sequences } from "../../core/files";
import { MAX_KEYS } from "../../core/wire";
import { type MessageName, t } from "../../i18n";
import { classes } from "./rows";
import type { Studio } from "./studio";

/** The sample's meaning of a key (Fig. 4-2). */
const NAMED = 4;

/** "2 forward" */
export function keyName(key: number): string {
  return key < NAMED ? `${key} ${t(`design.key.${key}` as MessageName)}` : String(key);
}

/** The keys that can be tried. */
export function triedKeys(studio: Studio): number[] {
  const table = studio.table.value;
  if (!table) return [];
  if (table.kind === "locomotion") return keysOf(table);
  return sequences.value.flatMap((digits, key) => (digits ? [key] : []));
}

export function Keys({ studio }: { studio: Studio }) {
  const table = studio.table.value;
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
          <li key={key} class={classes(studio.key.value === key && "chosen")}>
            <button
              type="button"
              aria-pressed={studio.key.value === key}
              aria-label={t("design.chooseKey", { name: keyName(key) })}
              onClick={() => {
                studio.key.value = key;
                studio.pose.value = null;
                const row = studio.sequence.peek()?.[0];
                if (row !== undefined) studio.select({ row, col: studio.active.peek().col });
              }}
            >
              <b>{key}</b>
              <span>{key < NAMED ? t(`design.key.${key}` as MessageName) : ""}</span>
            </button>
            {isMade ? (
              <Sequence studio={studio} digit={key} />
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
function Sequence({ studio, digit }: { studio: Studio; digit: number }) {
  const draft = useSignal<string | null>(null);
  const digits = sequences.value[digit] ?? "";
  const there = new Set(keysOf(studio.table.value!).map(String));
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
        sequences.value = changed;
      }}
    />
  );
}
