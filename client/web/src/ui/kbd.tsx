/** The name of a key beside what it does, where a keyboard is likely. */

import type { ComponentChildren } from "preact";
import { hasKeyboard } from "./screen";

/** All hints to keys are this, or ask `hasKeyboard` themselves: a touch phone shows none. */
export function Kbd({ children }: { children: ComponentChildren }) {
  return hasKeyboard.value ? <kbd>{children}</kbd> : null;
}
