/** This page may do nothing any more: the student works elsewhere, or was deleted. */

import { useEffect, useRef } from "preact/hooks";
import { t } from "../../../i18n";
import type { Membership } from "./membership";

export function Elsewhere({ membership }: { membership: Membership }) {
  const element = useRef<HTMLDialogElement>(null);
  const is = membership.elsewhere.value;
  useEffect(() => {
    if (is) element.current?.showModal();
  }, [is]);
  if (!is) return null;
  const title = t(is.forgotten ? "design.forgotten" : "design.elsewhere");
  return (
    <dialog
      ref={element}
      class="elsewhere"
      aria-label={title}
      onCancel={(event) => event.preventDefault()}
      // A browser closes it all the same when Escape is pressed again and again.
      onClose={() => element.current?.showModal()}
    >
      <h2>{title}</h2>
      <p>{t(is.forgotten ? "design.forgotten.text" : "design.elsewhere.text")}</p>
      <div class="row end">
        <button
          class="button strong"
          type="button"
          onClick={() => {
            if (is.forgotten) membership.leave();
            else location.reload();
          }}
        >
          {t(is.forgotten ? "design.forgotten.again" : "design.elsewhere.here")}
        </button>
      </div>
    </dialog>
  );
}
