/**
 * What a key of the keyboard means to a contestant (rules 3).
 *
 * Keys are known by their place (`event.code`), so that AZERTY's digits and a Japanese input
 * method, which hands every key on as "Process", steer like any other keyboard.
 */

/** Level of control; the wire's numbers. */
export type Pressed =
  | { does: "digit"; digit: number }
  | { does: "arrow"; digit: number }
  | { does: "restart" }
  | { does: "leave" }
  | { does: "ready" }
  | { does: "level" }
  | { does: "view" };

/** Arrows stand for digits of level B: the sample's forward, left, right and stand. */
export const ARROWS: Record<string, number> = {
  ArrowUp: 2,
  ArrowLeft: 1,
  ArrowRight: 3,
  ArrowDown: 0,
};

/** Code of the key that leaves. */
export const LEAVE = "KeyZ";

const OTHERS: Record<string, Pressed> = {
  KeyX: { does: "restart" },
  [LEAVE]: { does: "leave" },
  KeyR: { does: "ready" },
  Tab: { does: "level" },
  Space: { does: "view" },
};

const IME_KEY_CODE = 229;

/** The action of a key; null if it is not one of ours, or meant for the browser. */
export function readKey(event: KeyboardEvent): Pressed | null {
  if (event.ctrlKey || event.altKey || event.metaKey) return null;
  const digit = /^(?:Digit|Numpad)([0-9])$/.exec(event.code)?.[1];
  if (digit !== undefined) return { does: "digit", digit: Number(digit) };
  const arrow = ARROWS[event.code];
  if (arrow !== undefined) return { does: "arrow", digit: arrow };
  if (event.code === "Tab" && event.shiftKey) return null; // the way back out of the field
  return OTHERS[event.code] ?? null;
}

/** Whether an input method took the key before the page got it. */
export function isFromInputMethod(event: KeyboardEvent): boolean {
  return event.isComposing || event.key === "Process" || event.keyCode === IME_KEY_CODE;
}
