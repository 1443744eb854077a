/** The file of the table, undo and redo. */

import { t } from "../../../i18n";
import { IconButton } from "../../../ui/icons";
import type { Can } from "../can";
import type { Files } from "../files/files";
import type { Sheet } from "../table/sheet";

interface FileProps {
  sheet: Sheet;
  files: Files;
  can: Can;
  onFiles: () => void;
}

export function FileButtons({ sheet, files, can, onFiles }: FileProps) {
  const history = sheet.history.value;
  const name = files.file.value.name;
  const isSaved = files.isSaved.value;
  const undo = history?.undoName.value ?? "";
  const redo = history?.redoName.value ?? "";
  return (
    <div class="file">
      <IconButton name="open" label={t("design.files")} onClick={onFiles} />
      <button class="button name" type="button" title={t("design.files")} onClick={onFiles}>
        <b>{name || t("design.unnamed")}</b>
        <small class={isSaved ? "" : "unsaved"}>
          {t(isSaved ? (name ? "design.isSaved" : "design.notFile") : "design.unsaved")}
        </small>
      </button>
      <button
        class="button"
        type="button"
        disabled={can.save && isSaved && name !== ""}
        title={t("design.saveKey")}
        onClick={() => void files.keep()}
      >
        {can.save ? t("design.save") : t("design.download", { kind: ".txt" })}
      </button>
      <button
        class="button icon-button"
        type="button"
        disabled={!history?.canUndo.value}
        aria-label={t("design.undo", { what: undo })}
        title={`${t("design.undo", { what: undo })} (Ctrl+Z)`}
        onClick={() => sheet.undo()}
      >
        <Arrow />
      </button>
      <button
        class="button icon-button"
        type="button"
        disabled={!history?.canRedo.value}
        aria-label={t("design.redo", { what: redo })}
        title={`${t("design.redo", { what: redo })} (Ctrl+Y)`}
        onClick={() => sheet.redo()}
      >
        <Arrow turned />
      </button>
    </div>
  );
}

function Arrow({ turned = false }: { turned?: boolean }) {
  return (
    <svg class={turned ? "arrow turned" : "arrow"} viewBox="0 0 24 24" aria-hidden="true">
      <path d="M9 5 4 10l5 5 M4 10h9a6 6 0 0 1 0 12h-3" transform="translate(0 -1.5)" />
    </svg>
  );
}
