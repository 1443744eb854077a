/** All keys of a page in a dialog, which `?` opens on every page that has keys. */

import { signal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useEffect } from "preact/hooks";
import { t } from "../i18n";
import { Dialog } from "./dialog";
import { isTyping } from "./shortcuts";
import "./key_help.css";

/** Keys that do the same, as they are called on the keyboard, and what they do. */
export type KeyRow = readonly [keys: readonly string[], does: string];

const isShown = signal(false);

export function showKeys(): void {
  isShown.value = true;
}

export function hideKeys(): void {
  isShown.value = false;
}

interface Props {
  rows: () => readonly KeyRow[];
  /** Another key that opens this dialog. */
  also?: string;
  /** What holds for all of them. */
  text?: string;
  /** What is shown above the keys. */
  children?: ComponentChildren;
  onClose?: () => void;
}

export function KeyHelp({ rows, also, text, children, onClose }: Props) {
  useEffect(() => {
    const press = (event: KeyboardEvent) => {
      // An input method hands the character on as "Process".
      const isAsked = event.key === "?" || (event.code === "Slash" && event.shiftKey);
      if (!isAsked || event.ctrlKey || event.altKey || event.metaKey || isTyping(event)) return;
      if (document.querySelector("dialog[open]") && !isShown.peek()) return;
      event.preventDefault();
      isShown.value = !isShown.peek();
    };
    addEventListener("keydown", press);
    return () => removeEventListener("keydown", press);
  }, []);
  if (!isShown.value) return null;
  const close = () => {
    hideKeys();
    onClose?.();
  };
  const own: KeyRow = [also ? ["?", also] : ["?"], t("keys.help")];
  return (
    <Dialog title={t("keys.title")} onClose={close}>
      {children}
      {text && <p class="muted">{text}</p>}
      <dl class="key-help">
        {[...rows(), own].map(([keys, does]) => (
          <div key={does}>
            <dt>
              {keys.map((key) => (
                <kbd key={key}>{key}</kbd>
              ))}
            </dt>
            <dd>{does}</dd>
          </div>
        ))}
      </dl>
    </Dialog>
  );
}
