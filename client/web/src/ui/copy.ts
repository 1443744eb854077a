/** Puts a text on the clipboard. */

import { t } from "../i18n";
import { toast } from "./toasts";

/** Copy a text, and say whether it was copied. */
export async function copy(text: string): Promise<void> {
  const isDone = await isCopied(text);
  toast(t(isDone ? "common.copied" : "common.notCopied"), isDone ? "yes" : "no");
}

/** Without https, browsers copy only from a field. */
async function isCopied(text: string): Promise<boolean> {
  try {
    if (!navigator.clipboard) return isCopiedFromField(text);
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return false;
  }
}

function isCopiedFromField(text: string): boolean {
  const field = document.createElement("textarea");
  const focused = document.activeElement;
  field.value = text;
  // Behind an open dialog nothing can be selected.
  (document.querySelector("dialog[open]") ?? document.body).append(field);
  field.select();
  const isDone = document.execCommand("copy");
  field.remove();
  if (focused instanceof HTMLElement) focused.focus();
  return isDone;
}
