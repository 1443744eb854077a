/** What fills the screen, for the whole room. */

import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { t } from "../../i18n";
import { Kbd } from "../../ui/kbd";
import { toggleFullscreen } from "../../ui/screen";

interface FrameProps {
  label: string;
  onClose: () => void;
  /** More keys, by `event.key`. */
  keys?: Record<string, () => void>;
  /** What gets the focus afterwards, if it is not what had it before. */
  back?: () => HTMLElement | null;
  /** More buttons. */
  buttons?: ComponentChildren;
  children: ComponentChildren;
}

/** Fills the screen until Escape; what is below it can't be reached meanwhile. */
export function Frame({ label, onClose, keys = {}, back, buttons, children }: FrameProps) {
  const element = useRef<HTMLElement>(null);
  // A key takes what was drawn last, also before the page has come to its effects.
  const now = useRef({ onClose, keys, back });
  now.current = { onClose, keys, back };
  useEffect(() => {
    const opener = document.activeElement as HTMLElement | null;
    element.current?.focus();
    if (!document.fullscreenElement) toggleFullscreen();
    return () => {
      if (document.fullscreenElement) toggleFullscreen();
      // What is below can't have the focus yet.
      requestAnimationFrame(() => (now.current.back?.() ?? opener)?.focus());
    };
  }, []);
  useEffect(() => {
    const press = (event: KeyboardEvent) => {
      const { onClose: close, keys: more } = now.current;
      const act = event.key === "Escape" ? close : more[event.key];
      if (!act || event.ctrlKey || event.altKey || event.metaKey) return;
      event.preventDefault();
      act();
    };
    // The browser keeps the Escape to itself that ends its full screen.
    const left = () => {
      if (!document.fullscreenElement) now.current.onClose();
    };
    addEventListener("keydown", press);
    document.addEventListener("fullscreenchange", left);
    return () => {
      removeEventListener("keydown", press);
      document.removeEventListener("fullscreenchange", left);
    };
  }, []);
  return (
    <section
      ref={element}
      class="screen"
      role="dialog"
      aria-modal="true"
      aria-label={label}
      tabIndex={-1}
    >
      {children}
      <div class="screen-acts">
        {buttons}
        <button class="button" type="button" onClick={onClose}>
          {t("class.screen.close")} <Kbd>Esc</Kbd>
        </button>
      </div>
    </section>
  );
}
