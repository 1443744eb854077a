/** The robot and gait files: dropped or picked, sorted by what is in them. */

import { signal } from "@preact/signals";
import { useId } from "preact/hooks";
import type { Court } from "../../core/court";
import { choose, chosenNames, forget, MOST_BYTES, SLOTS, type Slot } from "../../core/files";
import { Phase } from "../../core/wire";
import { t } from "../../i18n";
import { toast } from "../../ui/toasts";

/** Whether files are dragged over the page. */
export const dragging = signal(false);

/** Whether a seat's files can be changed now: a match keeps those that it began with. */
export function canChange(court: Court): boolean {
  const phase = court.frame.value?.phase ?? 0;
  const isOn = phase >= Phase.COUNTDOWN && phase <= Phase.HALTED;
  return !(isOn && (court.sheet.value?.duration_s ?? 0) > 0);
}

/** Keep files, each in its slot. */
export async function take(files: Iterable<File>): Promise<void> {
  for (const file of files) {
    if (file.size > MOST_BYTES) {
      toast(t("files.tooLarge", { name: file.name }), "no");
      continue;
    }
    // A folder seems to be a file until it is read.
    await choose(file).catch(() => toast(t("files.unreadable", { name: file.name }), "no"));
  }
}

export function FilePicker({ court, alone }: { court: Court; alone: boolean }) {
  const input = useId();
  const levels = court.sheet.value?.levels ?? [0, 1];
  const given = court.welcome.value?.prefill?.files ?? [];
  const hasOwnGait = Boolean(chosenNames.value.postures || chosenNames.value.locomotion);
  const slots = SLOTS.filter(
    (slot) =>
      alone ||
      slot === "robot" ||
      chosenNames.value[slot] ||
      levels.includes(slot === "postures" ? 0 : 1),
  );
  return (
    <div class={`files${dragging.value ? " over" : ""}`}>
      <p class="drop">
        {t("files.drop")}{" "}
        <label class="link" for={input}>
          {t("files.pick")}
        </label>
        <input
          id={input}
          class="hidden-text"
          type="file"
          multiple
          accept=".txt,.xlsx,.toml,.tsv,.csv"
          onChange={(event) => {
            const picked = event.currentTarget;
            void take([...(picked.files ?? [])]).then(() => {
              picked.value = ""; // the same file again, after it was mended
            });
          }}
        />
      </p>
      <ul>
        {slots.map((slot) => (
          <SlotRow key={slot} slot={slot} otherwise={otherwise(slot, hasOwnGait)} />
        ))}
      </ul>
      {given.length > 0 && !hasOwnGait && (
        <p class="muted">{t("files.given", { names: given.join(", ") })}</p>
      )}
    </div>
  );
}

/** What is used where no file is chosen: without any gait file the robot's sample gait is. */
function otherwise(slot: Slot, hasOwnGait: boolean): string {
  if (slot === "robot") return t("files.contests");
  return t(hasOwnGait ? "files.none" : "files.sample");
}

function SlotRow({ slot, otherwise }: { slot: Slot; otherwise: string }) {
  const name = chosenNames.value[slot];
  return (
    <li>
      <span class="what">{t(`files.${slot}`)}</span>
      <span class={name ? "name" : "name muted"}>{name || otherwise}</span>
      {name && (
        <button
          class="button quiet small"
          type="button"
          aria-label={t("files.remove", { name })}
          title={t("files.remove", { name })}
          onClick={() => forget(slot)}
        >
          ×
        </button>
      )}
    </li>
  );
}
