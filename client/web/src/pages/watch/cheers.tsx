/** Who watches, and cheers: a symbol rises for each, and nobody is named. */

import { signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { Court } from "../../core/court";
import { remembered } from "../../core/settings";
import { type MessageName, t } from "../../i18n";
import "./cheers.css";

/** The symbols in the gateway's order: what each says, and its drawing. */
const SYMBOLS = [
  ["cheers.star", "M12 3l2.7 5.8 6.3.8-4.6 4.4 1.2 6.3-5.6-3.1-5.6 3.1 1.2-6.3L3 9.6l6.3-.8z"],
  ["cheers.heart", "M12 20S4 15 4 9a4.4 4.4 0 0 1 8-2.7A4.4 4.4 0 0 1 20 9c0 6-8 11-8 11z"],
  ["cheers.bolt", "M13 2 5 13.5h6L10 22l9-12h-6.5z"],
  ["cheers.wow", "M12 3a9 9 0 1 0 .01 0z M9 10v.01 M15 10v.01 M12 14a1.7 2.2 0 1 0 .01 0z"],
] as const satisfies readonly (readonly [MessageName, string])[];
/** A gateway counts one in this time. */
const PAUSE_MS = 1000;
/** However many cheer, so many symbols of a kind rise in a second. */
const RISING_MOST = 6;
const RISES_MS = 2600;

/** Whether this reader wants to see and send cheers. */
export const wantsCheers = remembered("cheers", true);

interface Rising {
  id: number;
  symbol: number;
  /** Where it rises, from 0 (left) to 1. */
  at: number;
  afterMs: number;
}

const rising = signal<readonly Rising[]>([]);
let lastId = 0;

function rise(counts: readonly number[]): void {
  const found = SYMBOLS.flatMap((_, symbol) =>
    Array.from(
      { length: Math.min(RISING_MOST, counts[symbol] ?? 0) },
      (): Rising => ({
        id: ++lastId,
        symbol,
        at: Math.random(),
        afterMs: Math.random() * PAUSE_MS,
      }),
    ),
  );
  if (!found.length) return;
  rising.value = [...rising.peek(), ...found];
  setTimeout(() => {
    rising.value = rising.peek().filter((one) => !found.includes(one));
  }, RISES_MS + PAUSE_MS);
}

const rests = signal(false);

function Drawing({ symbol }: { symbol: number }) {
  const [name, path] = SYMBOLS[symbol]!;
  return (
    <svg class="cheer" data-symbol={name} viewBox="0 0 24 24" aria-hidden="true">
      <path d={path} />
    </svg>
  );
}

/** Buttons to cheer with, and what others cheer. */
export function Cheers({ court }: { court: Court }) {
  const may = court.welcome.value?.cheers && wantsCheers.value;
  useEffect(
    () =>
      court.crowd.subscribe((crowd) => {
        if (crowd && wantsCheers.peek()) rise(crowd.cheers);
      }),
    [court],
  );
  if (!may) return null;
  const cheer = (symbol: number) => {
    court.cheer(symbol);
    rests.value = true;
    setTimeout(() => {
      rests.value = false;
    }, PAUSE_MS);
  };
  return (
    <>
      <fieldset class="cheers">
        <legend class="hidden-text">{t("cheers.title")}</legend>
        {SYMBOLS.map(([name], symbol) => (
          <button
            key={name}
            class="button"
            type="button"
            aria-label={t(name)}
            title={t(name)}
            aria-disabled={rests.value}
            onClick={() => !rests.peek() && cheer(symbol)}
          >
            <Drawing symbol={symbol} />
          </button>
        ))}
      </fieldset>
      <div class="rising" aria-hidden="true">
        {rising.value.map(({ id, symbol, at, afterMs }) => (
          <span key={id} style={`left: ${100 * at}%; animation-delay: ${afterMs}ms`}>
            <Drawing symbol={symbol} />
          </span>
        ))}
      </div>
    </>
  );
}

/** Whether to see cheers, among the settings. */
export function CheersSetting() {
  return (
    <label class="field">
      <span>{t("cheers.setting")}</span>
      <select
        value={wantsCheers.value ? "on" : "off"}
        onChange={({ currentTarget: { value } }) => {
          wantsCheers.value = value === "on";
        }}
      >
        <option value="on">{t("cheers.on")}</option>
        <option value="off">{t("cheers.off")}</option>
      </select>
    </label>
  );
}

/** How many watch the event. */
export function Watching({ court }: { court: Court }) {
  const count = court.crowd.value?.watching ?? 0;
  return count > 0 ? <span class="watching">{t("cheers.watching", { count })}</span> : null;
}
