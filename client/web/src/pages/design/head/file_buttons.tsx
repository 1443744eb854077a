/** The file of the table, undo and redo. */

import { t } from "../../../i18n";
import { IconButton } from "../../../ui/icons";
import { HandButton, StudentName } from "../class/student";
import type { Files } from "../files/files";
import type { Studio } from "../studio";

interface Props {
  studio: Studio;
  onFiles: () => void;
}

export function FileButtons({ studio, onFiles }: Props) {
  const { sheet, learning } = studio;
  const history = sheet.history.value;
  const student = studio.membership.name.value;
  const undo = history?.undoName.value ?? "";
  const redo = history?.redoName.value ?? "";
  return (
    <div class="file">
      <IconButton name="open" label={t("design.files")} onClick={onFiles} />
      {student === null ? (
        <OwnFile files={studio.files} canSave={studio.can.value.save} onFiles={onFiles} />
      ) : (
        <>
          <StudentName
            name={student}
            learning={learning}
            isShared={studio.sharing.isKept.value}
            onFiles={onFiles}
          />
          <HandButton learning={learning} />
        </>
      )}
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

interface OwnProps {
  files: Files;
  canSave: boolean;
  onFiles: () => void;
}

/** The file of somebody who designs alone, and what saves it. */
function OwnFile({ files, canSave, onFiles }: OwnProps) {
  const name = files.file.value.name;
  const isSaved = files.isSaved.value;
  return (
    <>
      <button class="button name" type="button" title={t("design.files")} onClick={onFiles}>
        <b>{name || t("design.unnamed")}</b>
        <small class={isSaved ? "" : "unsaved"}>
          {t(isSaved ? (name ? "design.isSaved" : "design.notFile") : "design.unsaved")}
        </small>
      </button>
      <button
        class="button"
        type="button"
        disabled={canSave && isSaved && name !== ""}
        title={t("design.saveKey")}
        onClick={() => void files.keep()}
      >
        {canSave ? t("design.save") : t("design.download", { kind: ".txt" })}
      </button>
    </>
  );
}

function Arrow({ turned = false }: { turned?: boolean }) {
  return (
    <svg class={turned ? "arrow turned" : "arrow"} viewBox="0 0 24 24" aria-hidden="true">
      <path d="M9 5 4 10l5 5 M4 10h9a6 6 0 0 1 0 12h-3" transform="translate(0 -1.5)" />
    </svg>
  );
}
