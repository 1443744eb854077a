/** The files of a team that enters: dropped or picked, sorted by what is in them. */

import { useId } from "preact/hooks";
import { choose, chosenNames, forget, MOST_BYTES, SLOTS, type Slot } from "../../core/files";
import { t } from "../../i18n";
import { PickFiles } from "../../ui/pick";
import { toast } from "../../ui/toasts";

/** Stands beside the pages. */
const SAMPLE = "Loco-data.txt";

/** Keep files, each in its slot. */
export async function take(files: Iterable<File>): Promise<void> {
  for (const file of files) {
    const { name } = file;
    if (file.size > MOST_BYTES) toast(t("files.tooLarge", { name }), "no");
    // A folder seems to be a file until it is read.
    else await choose(file).catch(() => toast(t("files.unreadable", { name }), "no"));
  }
}

/** Keep the sample gait, which can be replaced later by the team's own. */
async function takeSample(): Promise<void> {
  const reply = await fetch(SAMPLE).catch(() => null);
  if (reply?.ok) await take([new File([await reply.blob()], SAMPLE)]);
  else toast(t("files.unreadable", { name: SAMPLE }), "no");
}

/** What is used in a slot without a file. */
function unnamed(slot: Slot, postures: string): string {
  if (slot === "robot") return t("enter.contests");
  // The office makes level B with the sample's sequences, as a court's page does by default.
  if (slot === "locomotion" && postures) return t("files.made", { name: postures });
  return t("enter.none");
}

export function Files() {
  const input = useId();
  const names = chosenNames.value;
  return (
    <fieldset class="files">
      <legend>{t("enter.files")}</legend>
      <p>{t("enter.drop")}</p>
      <label class="button" for={input}>
        {t("enter.pick")}
      </label>
      <PickFiles id={input} take={take} />
      {!names.postures && !names.locomotion && (
        <button class="button" type="button" onClick={() => void takeSample()}>
          {t("enter.sample")}
        </button>
      )}
      <ul>
        {SLOTS.map((slot) => (
          <li key={slot}>
            <span class="muted">{t(`enter.${slot}`)}</span>
            <b>{names[slot] || unnamed(slot, names.postures)}</b>
            {names[slot] && (
              <button
                class="button quiet small"
                type="button"
                aria-label={t("enter.remove", { name: names[slot] })}
                onClick={() => forget(slot)}
              >
                ×
              </button>
            )}
          </li>
        ))}
      </ul>
    </fieldset>
  );
}
