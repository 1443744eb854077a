/** Files: open, take in, save, download. */

import { useSignal } from "@preact/signals";
import { useId } from "preact/hooks";
import { PARSE_MAX_BYTES } from "../../../core/wire";
import { t } from "../../../i18n";
import { Dialog } from "../../../ui/dialog";
import { toast } from "../../../ui/toasts";
import type { Can } from "../can";
import type { Handed } from "../class/handed";
import type { Membership } from "../class/membership";
import type { RobotInUse } from "../robot/robot";
import type { Sheet } from "../table/sheet";
import type { Court } from "./court";
import { CourtButton } from "./court_button";
import type { Files } from "./files";
import { HandOn } from "./hand_on";
import "./files.css";

/** Take files that were dropped or picked. */
export async function takeFiles(files: Files, taken: Iterable<File>): Promise<void> {
  for (const file of taken) {
    if (file.size > PARSE_MAX_BYTES) {
      toast(t("files.tooLarge", { name: file.name }), "no");
      continue;
    }
    try {
      const data = new Uint8Array(await file.arrayBuffer());
      await files.parse(file.name, data);
    } catch {
      toast(t("files.unreadable", { name: file.name }), "no"); // such as a folder
    }
  }
}

interface Props {
  files: Files;
  robot: RobotInUse;
  sheet: Sheet;
  can: Can;
  membership: Membership;
  handed: Handed;
  court: Court;
  onClose: () => void;
}

export function FilesDialog(props: Props) {
  const { files, robot, sheet, can, membership, handed, court, onClose } = props;
  const newest = handed.newest.value;
  const inFolder = can.save ? files.folder.value.files : [];
  const gaits = inFolder.filter(({ slot }) => slot !== "robot");
  const robots = inFolder.filter(({ slot }) => slot === "robot");
  /** Close, and do what was chosen. */
  const open = (act: () => unknown) => () => {
    onClose();
    void act();
  };
  return (
    <Dialog title={t("design.files")} onClose={onClose}>
      <div class="design-files">
        <section aria-label={t("design.gaits")}>
          <h3>{t("design.gaits")}</h3>
          {can.save && !files.isSaved.value && <p class="warning">{t("design.unsavedHint")}</p>}
          <ul>
            {gaits.map(({ name, slot }) => (
              <Choice
                key={name}
                label={name}
                hint={t(`files.${slot}`)}
                isOpen={files.file.value.name === name}
                onOpen={open(() => files.open(name))}
              />
            ))}
            {newest && (
              <Choice
                label={newest.title}
                hint={t("design.handed.hint")}
                onOpen={open(() => handed.take(newest))}
              />
            )}
            {can.sample && (
              <Choice
                label={t("design.sample")}
                hint={t("design.sampleHint")}
                onOpen={open(() => files.openSample())}
              />
            )}
            <Choice
              label={t("design.new")}
              hint={t("design.newHint")}
              onOpen={open(() => files.openNew())}
            />
          </ul>
          <Picker onPick={(picked) => open(() => takeFiles(files, picked))()} />
          <p class="muted">{t("design.dropHint")}</p>
        </section>
        <section aria-label={t("design.saveAs")}>
          <h3>{t("design.saveAs")}</h3>
          {can.save && <SaveAs files={files} onSave={(name) => open(() => files.save(name))()} />}
          <div class="row">
            <button class="button" type="button" onClick={() => void files.download(".txt")}>
              {t("design.download", { kind: ".txt" })}
            </button>
            {sheet.table.value?.kind === "postures" && (
              <button class="button" type="button" onClick={() => void files.download(".xlsx")}>
                {t("design.download", { kind: ".xlsx" })}
              </button>
            )}
          </div>
          <CourtButton court={court} />
          <HandOn court={court} />
          <h3>{t("design.robots")}</h3>
          <ul>
            {robots.map(({ name }) => (
              <Choice
                key={name}
                label={name}
                hint={t("files.robot")}
                isOpen={robot.name.value === name}
                onOpen={open(() => files.open(name))}
              />
            ))}
            <Choice
              label={t("design.workshopRobot")}
              hint=""
              isOpen={!robot.name.value}
              onOpen={open(() => files.openWorkshopRobot())}
            />
          </ul>
          {membership.name.value && (
            <>
              <h3>{t("design.class.who", { name: membership.name.value })}</h3>
              <p class="muted">{t("design.class.leaveHint")}</p>
              <button class="button" type="button" onClick={() => membership.leave()}>
                {t("design.class.leave")}
              </button>
            </>
          )}
        </section>
      </div>
    </Dialog>
  );
}

interface ChoiceProps {
  label: string;
  hint: string;
  isOpen?: boolean;
  onOpen: () => void;
}

/** Something that can be opened. */
function Choice({ label, hint, isOpen = false, onOpen }: ChoiceProps) {
  return (
    <li>
      <button type="button" aria-current={isOpen} onClick={onOpen}>
        <b>{label}</b>
        <span class="muted">{hint}</span>
      </button>
    </li>
  );
}

function Picker({ onPick }: { onPick: (files: File[]) => void }) {
  const input = useId();
  return (
    <>
      <label class="button" for={input}>
        {t("design.pick")}
      </label>
      <input
        id={input}
        class="hidden-text"
        type="file"
        accept=".txt,.xlsx,.toml,.tsv,.csv"
        onChange={(event) => onPick([...(event.currentTarget.files ?? [])])}
      />
    </>
  );
}

/** Save under a name of the folder. */
function SaveAs({ files, onSave }: { files: Files; onSave: (name: string) => void }) {
  const name = useSignal(files.usualName());
  return (
    <>
      <form
        class="row"
        onSubmit={(event) => {
          event.preventDefault();
          onSave(name.peek());
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
      <p class="muted">{t("design.folder", { folder: files.folder.value.folder })}</p>
    </>
  );
}
