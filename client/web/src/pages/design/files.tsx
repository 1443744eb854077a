/** Files: open, save, download, take in; and what to do where a file has changed meanwhile. */

import { useSignal } from "@preact/signals";
import { useId } from "preact/hooks";
import { PARSE_MAX_BYTES } from "../../core/wire";
import { t } from "../../i18n";
import { Dialog } from "../../ui/dialog";
import { Mistakes } from "../../ui/mistakes";
import { toast } from "../../ui/toasts";
import { LegPicture } from "./robot";
import type { Studio } from "./studio";

const POSTURES = "Loco-data.txt";
const LOCOMOTION = "LocoTra-data.txt";

/** The name under which the table is saved without asking. */
export function usualName(studio: Studio): string {
  const { name } = studio.file.peek();
  return name || (studio.table.peek()?.kind === "locomotion" ? LOCOMOTION : POSTURES);
}

/** Take files that were dropped or picked. */
export async function takeFiles(studio: Studio, files: Iterable<File>): Promise<void> {
  for (const file of files) {
    if (file.size > PARSE_MAX_BYTES) {
      toast(t("files.tooLarge", { name: file.name }), "no");
      continue;
    }
    try {
      const data = new Uint8Array(await file.arrayBuffer());
      await studio.parse(file.name, data);
    } catch {
      toast(t("files.unreadable", { name: file.name }), "no"); // such as a folder
    }
  }
}

export function Files({ studio, onClose }: { studio: Studio; onClose: () => void }) {
  const { folder, files } = studio.folder.value;
  const name = useSignal(usualName(studio));
  const input = useId();
  const gaits = files.filter(({ slot }) => slot !== "robot");
  const robots = files.filter(({ slot }) => slot === "robot");
  const open = (act: () => unknown) => {
    onClose();
    void act();
  };
  const row = (label: string, hint: string, isOpen: boolean, act: () => unknown) => (
    <li key={label}>
      <button type="button" aria-current={isOpen} onClick={() => open(act)}>
        <b>{label}</b>
        <span class="muted">{hint}</span>
      </button>
    </li>
  );
  return (
    <Dialog title={t("design.files")} onClose={onClose}>
      <div class="design-files">
        <section aria-label={t("design.gaits")}>
          <h3>{t("design.gaits")}</h3>
          {!studio.isSaved.value && <p class="warning">{t("design.unsavedHint")}</p>}
          <ul>
            {gaits.map((file) =>
              row(file.name, t(`files.${file.slot}`), studio.file.value.name === file.name, () =>
                studio.open(file.name),
              ),
            )}
            {row(t("design.sample"), t("design.sampleHint"), false, () =>
              studio.openSample().catch((error) => studio.refuse(error)),
            )}
            {row(t("design.new"), t("design.newHint"), false, () => studio.openNew())}
          </ul>
          <label class="button" for={input}>
            {t("design.pick")}
          </label>
          <input
            id={input}
            class="hidden-text"
            type="file"
            accept=".txt,.xlsx,.toml,.tsv,.csv"
            onChange={(event) => {
              const picked = [...(event.currentTarget.files ?? [])];
              open(() => takeFiles(studio, picked));
            }}
          />
          <p class="muted">{t("design.dropHint")}</p>
        </section>
        <section aria-label={t("design.saveAs")}>
          <h3>{t("design.saveAs")}</h3>
          <form
            class="row"
            onSubmit={(event) => {
              event.preventDefault();
              open(() => studio.save(name.peek()));
            }}
          >
            <input
              aria-label={t("design.fileName")}
              value={name.value}
              maxLength={100}
              onInput={(event) => {
                name.value = event.currentTarget.value;
              }}
            />
            <button class="button strong" type="submit">
              {t("design.save")}
            </button>
          </form>
          <p class="muted">{t("design.folder", { folder })}</p>
          <div class="row">
            <button class="button" type="button" onClick={() => void give(studio, ".txt")}>
              {t("design.download", { kind: ".txt" })}
            </button>
            {studio.table.value?.kind === "postures" && (
              <button class="button" type="button" onClick={() => void give(studio, ".xlsx")}>
                {t("design.download", { kind: ".xlsx" })}
              </button>
            )}
          </div>
          <h3>{t("design.robots")}</h3>
          <ul>
            {robots.map((file) =>
              row(file.name, t("files.robot"), studio.robotName.value === file.name, () =>
                studio.open(file.name),
              ),
            )}
            {row(t("design.workshopRobot"), "", !studio.robotName.value, () =>
              studio.useRobot("", null).catch((error) => studio.refuse(error)),
            )}
          </ul>
        </section>
      </div>
    </Dialog>
  );
}

/** Hand the table to the person as a file. */
async function give(studio: Studio, suffix: string): Promise<void> {
  const name = usualName(studio).replace(/\.[^.]*$/, "") + suffix;
  const data = await studio.bytes(name);
  if (!data) return;
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([data.slice()]));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** The file has another content than the page thought: nothing is lost without being asked for. */
export function ConflictDialog({ studio }: { studio: Studio }) {
  const conflict = studio.conflict.value;
  if (!conflict) return null;
  const { name, when, table, mistakes } = conflict;
  const saving = when !== "open";
  // A browser says only with its next picture that a dialog has closed: there may be another by then.
  const close = () => {
    if (studio.conflict.peek() === conflict) studio.conflict.value = null;
  };
  return (
    <Dialog
      key={conflict}
      title={t(when === "existing" ? "design.exists" : "design.conflict")}
      onClose={close}
    >
      <p>{t(`design.conflict.${when}`, { name })}</p>
      {mistakes.length > 0 && <Mistakes mistakes={mistakes} />}
      {!table && !mistakes.length && <p>{t("design.conflictGone", { name })}</p>}
      <div class="row end">
        <button class="button" type="button" disabled={!table} onClick={() => studio.takeTheirs()}>
          {t("design.takeTheirs")}
        </button>
        <button
          class="button strong"
          type="button"
          onClick={() => {
            if (saving) void studio.save(name, true);
            else studio.keepMine();
          }}
        >
          {t(saving ? "design.overwrite" : "design.keepMine")}
        </button>
      </div>
    </Dialog>
  );
}

/** Every mistake of a file or a table, with its place. */
export function TroubleDialog({ studio }: { studio: Studio }) {
  const trouble = studio.trouble.value;
  if (!trouble) return null;
  return (
    <Dialog
      title={t("design.trouble")}
      onClose={() => {
        studio.trouble.value = null;
        studio.point([]);
      }}
    >
      <Mistakes
        mistakes={trouble.mistakes}
        onPoint={(mistake) => studio.point(mistake?.joint == null ? [] : [mistake.joint])}
      />
      {trouble.mistakes.some(({ joint }) => joint != null) && <LegPicture studio={studio} />}
    </Dialog>
  );
}
