/** This page may do nothing any more: the teacher has deleted the student. */

import { useEffect, useRef } from "preact/hooks";
import { t } from "../../../i18n";
import type { Membership } from "./membership";

export function Forgotten({ membership }: { membership: Membership }) {
  const element = useRef<HTMLDialogElement>(null);
  const is = membership.isForgotten.value;
  useEffect(() => {
    if (is) element.current?.showModal();
  }, [is]);
  if (!is) return null;
  const title = t("design.forgotten");
  return (
    <dialog
      ref={element}
      class="forgotten"
      aria-label={title}
      onCancel={(event) => event.preventDefault()}
      // A browser closes it all the same when Escape is pressed again and again.
      onClose={() => element.current?.showModal()}
    >
      <h2>{title}</h2>
      <p>{t("design.forgotten.text")}</p>
      <div class="row end">
        <button class="button strong" type="button" onClick={() => membership.leave()}>
          {t("design.forgotten.again")}
        </button>
      </div>
    </dialog>
  );
}
