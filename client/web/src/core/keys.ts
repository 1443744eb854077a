/**
 * What a key of the keyboard means to a contestant (rules 3).
 *
 * Digits are known by their place, so that AZERTY's digits steer like those of any other keyboard.
 * Letters and signs are known by what they type: on QWERTZ "z" is where others have "y".
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

const OTHERS: Record<string, Pressed> = {
  KeyX: { does: "restart" },
  KeyZ: { does: "leave" },
  KeyR: { does: "ready" },
  Tab: { does: "level" },
  Space: { does: "view" },
};

const IME_KEY_CODE = 229;

const DIGIT = /^(?:Digit|Numpad)([0-9])$/;
const SIGNS: Record<string, string> = {
  ",": "Comma",
  ".": "Period",
  "-": "Minus",
  "+": "Equal",
  "=": "Equal",
  " ": "Space",
};

/** Places of signs on a US keyboard, where other keyboards have others. */
const OF_SIGNS: ReadonlySet<string> = new Set(["Comma", "Period", "Minus", "Equal"]);

/**
 * The name that a key has on a US keyboard (as `event.code`).
 *
 * An input method hands every key on as "Process", so those are known by their place. Programs that
 * type for a person may send no place, and a browser that fills in a form sends neither.
 */
export function nameOfKey({ key = "", code = "" }: Partial<KeyboardEvent>): string {
  if (DIGIT.test(code)) return code;
  if (/^[a-z]$/i.test(key)) return `Key${key.toUpperCase()}`;
  if (key.length === 1 && OF_SIGNS.has(code)) return SIGNS[key] ?? key;
  return SIGNS[key] ?? (code || (/^[0-9]$/.test(key) ? `Digit${key}` : key));
}

/** The action of a key; null if it is not one of ours, or meant for the browser. */
export function readKey(event: KeyboardEvent): Pressed | null {
  if (event.ctrlKey || event.altKey || event.metaKey) return null;
  const name = nameOfKey(event);
  const digit = DIGIT.exec(name)?.[1];
  if (digit !== undefined) return { does: "digit", digit: Number(digit) };
  const arrow = ARROWS[name];
  if (arrow !== undefined) return { does: "arrow", digit: arrow };
  if (name === "Tab" && event.shiftKey) return null; // the way back out of the field
  return OTHERS[name] ?? null;
}

/** Whether an input method took the key before the page got it. */
export function isFromInputMethod(event: KeyboardEvent): boolean {
  return event.isComposing || event.key === "Process" || event.keyCode === IME_KEY_CODE;
}
