/**
 * The keyboard of a contestant.
 *
 * Digits, x and z steer wherever the focus is, except in a text field or a dialog: after a click
 * on "Ready" the next digit must count. Tab and Space belong to whatever has the focus, so that
 * the page can be used without a mouse; only on the field, which takes the focus when play begins,
 * does Space change the view, and Tab the level where there are two. Where there is one, Tab leads
 * out of the field, as Shift+Tab and Escape always do.
 */

import type { Signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { isFromInputMethod, nameOfKey, type Pressed, readKey } from "../../core/keys";
import { isTyping } from "../../ui/shortcuts";

const INPUT_METHOD_MS = 8000;

export interface Steering {
  /** Whether keys mean the game now. */
  isOn(): boolean;
  /** Whether there is another level of control to change to. */
  hasLevels(): boolean;
  act(pressed: Pressed, atMs: number): void;
  /** The key that leaves goes up, or this window loses the keyboard. */
  leaveReleased(): void;
  /** Escape on the field. */
  leaveField(): void;
}

export function useKeyboard(
  field: { current: HTMLElement | null },
  steering: Steering,
  hasInputMethod: Signal<boolean>,
): void {
  useEffect(() => {
    let timer = 0;
    const take = (event: KeyboardEvent) => {
      // A browser may not tell that z goes up beside one of these.
      if (event.ctrlKey || event.altKey || event.metaKey) steering.leaveReleased();
      if (!steering.isOn() || document.querySelector("dialog[open]")) return;
      const target = event.target as HTMLElement;
      if (isTyping(event)) return;
      const isOnField = target === document.body || Boolean(field.current?.contains(target));
      if (isOnField && event.code === "Escape") {
        steering.leaveField();
        return;
      }
      const pressed = readKey(event);
      if (!pressed || (pressed.does === "level" && !steering.hasLevels())) return;
      if (!isOnField && (pressed.does === "level" || pressed.does === "view")) return;
      if (isFromInputMethod(event)) {
        hasInputMethod.value = true;
        clearTimeout(timer);
        timer = window.setTimeout(() => {
          hasInputMethod.value = false;
        }, INPUT_METHOD_MS);
      }
      event.preventDefault();
      if (!event.repeat) steering.act(pressed, event.timeStamp);
    };
    const release = (event: Event) => {
      // Any letter: with an input method a key may go up under another name than it went down.
      if (event instanceof KeyboardEvent && !nameOfKey(event).startsWith("Key")) return;
      steering.leaveReleased();
    };
    window.addEventListener("keydown", take);
    window.addEventListener("keyup", release);
    window.addEventListener("blur", release);
    return () => {
      window.removeEventListener("keydown", take);
      window.removeEventListener("keyup", release);
      window.removeEventListener("blur", release);
      clearTimeout(timer);
    };
  }, []);
}

/** Keep a signal on whether this window has the keyboard. */
export function useWindowFocus(hasFocus: Signal<boolean>): void {
  useEffect(() => {
    const look = (now: boolean) => () => {
      hasFocus.value = now;
    };
    const [got, lost] = [look(true), look(false)];
    hasFocus.value = document.hasFocus();
    window.addEventListener("focus", got);
    window.addEventListener("pointerdown", got);
    window.addEventListener("keydown", got);
    window.addEventListener("blur", lost);
    return () => {
      window.removeEventListener("focus", got);
      window.removeEventListener("pointerdown", got);
      window.removeEventListener("keydown", got);
      window.removeEventListener("blur", lost);
    };
  }, [hasFocus]);
}
