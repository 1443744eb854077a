/** A dialog over the page: the browser's own, so that Escape and the keyboard work. */

import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { t } from "../i18n";

interface Props {
  title: string;
  onClose: () => void;
  children: ComponentChildren;
}

export function Dialog({ title, onClose, children }: Props) {
  const element = useRef<HTMLDialogElement>(null);
  useEffect(() => {
    const opener = document.activeElement as HTMLElement | null;
    element.current?.showModal();
    // The browser gives the focus back where it closes the dialog, not where that is taken away.
    return () => {
      if (document.activeElement === document.body) opener?.focus();
    };
  }, []);
  return (
    <dialog ref={element} onClose={onClose} aria-label={title}>
      <div class="title">
        <h2>{title}</h2>
        <button class="button quiet" type="button" onClick={() => element.current?.close()}>
          {t("common.close")}
        </button>
      </div>
      {children}
    </dialog>
  );
}
