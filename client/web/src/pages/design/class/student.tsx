/** Who works on this page, whether all is kept, and the raised hand. */

import { said, t } from "../../../i18n";
import { Icon } from "../../../ui/icons";
import { isNarrow } from "../../../ui/screen";
import type { Learning } from "../learning/learning";
import "./class.css";

interface Props {
  name: string;
  learning: Learning;
  /** Whether the gateway's disk has the table. */
  isShared: boolean;
  onFiles: () => void;
}

export function StudentName({ name, learning, isShared, onFiles }: Props) {
  const trouble = learning.phases.value?.trouble;
  const isKept = isShared && !trouble;
  const title = trouble ? said(trouble) : t("design.files");
  return (
    <button class="button name" type="button" title={title} onClick={onFiles}>
      <b>{name}</b>
      <small class={isKept ? "" : "unsaved"}>
        {t(isKept ? "design.class.kept" : "design.class.notKept")}
      </small>
    </button>
  );
}

export function HandButton({ learning }: { learning: Learning }) {
  const isUp = learning.phases.value?.hand_up ?? false;
  const text = t(isUp ? "design.hand.up" : "design.hand.raise");
  return (
    <button
      class="button hand"
      type="button"
      aria-pressed={isUp}
      aria-label={isNarrow.value ? text : undefined}
      title={t("design.hand.hint")}
      onClick={() => void learning.send("hand", { up: !isUp })}
    >
      <span class="drawn">
        <Icon name="hand" />
      </span>
      {!isNarrow.value && text}
    </button>
  );
}
