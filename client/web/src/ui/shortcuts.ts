/** Keys of a page, by their names (`nameOfKey`). */

import { useEffect } from "preact/hooks";
import { nameOfKey } from "../core/keys";

type Keys = Record<string, (event: KeyboardEvent) => void>;

/** Keys that go on while they are held: they step or skip. All others would switch back and forth. */
const STEPS = /^(Comma|Period|Arrow)/;
const ARROWS = /^(Arrow|Home|End|Page)/;

/**
 * Listen for keys while the page is there.
 *
 * @param keys By name. What a focused control does with a key itself stays its own.
 */
export function useShortcuts(keys: Keys): void {
  useEffect(() => {
    const press = (event: KeyboardEvent) => {
      const name = nameOfKey(event);
      const act = keys[name];
      if (!act || event.ctrlKey || event.altKey || event.metaKey) return;
      if (takesKey(event)) return;
      event.preventDefault();
      if (!event.repeat || STEPS.test(name)) act(event);
    };
    addEventListener("keydown", press);
    return () => removeEventListener("keydown", press);
  });
}

/** Whether a key goes into a field for text. */
export function isTyping({ target }: Event): boolean {
  if (!(target instanceof Element)) return false;
  return Boolean(target.closest("input, select, textarea, [contenteditable], [role=textbox]"));
}

function takesKey({ target, code }: KeyboardEvent): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.closest("dialog")) return true;
  if (target instanceof HTMLInputElement && target.type === "range") return ARROWS.test(code);
  if (target.matches("input, select, textarea")) return true;
  // Space on a button that was reached by keyboard presses it; one that was clicked is done with.
  return code === "Space" && target.matches("button:focus-visible, a:focus-visible");
}
