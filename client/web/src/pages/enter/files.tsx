/** The files of a team that enters: dropped or picked, sorted by what is in them. */

import { useId } from "preact/hooks";
import { choose, chosenNames, forget, MOST_BYTES, SLOTS, type Slot } from "../../core/files";
import { t } from "../../i18n";
import { PickFiles } from "../../ui/pick";
import { toast } from "../../ui/toasts";
import { choosePicture, chosenPictureUrl, forgetPicture, isPicture } from "./own_picture";

/** Stands beside the pages. */
const SAMPLE = "Loco-data.txt";

/** Keep files, each in its slot; a picture becomes the team's. */
export async function take(files: Iterable<File>): Promise<void> {
  for (const file of files) {
    const { name } = file;
    if (isPicture(file)) {
      await choosePicture(file).catch(() => toast(t("enter.noPicture", { name }), "no"));
    } else if (file.size > MOST_BYTES) toast(t("files.tooLarge", { name }), "no");
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
  const picture = chosenPictureUrl();
  return (
    <fieldset class="files">
      <legend>{t("enter.files")}</legend>
      <p>{t("enter.drop")}</p>
      <label class="button" for={input}>
        {t("enter.pick")}
      </label>
      <PickFiles id={input} take={take} more=",image/*" />
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
        <li>
          <span class="muted">{t("enter.picture")}</span>
          {picture ? <img src={picture} alt={t("enter.picture")} /> : <b>{t("enter.none")}</b>}
          {picture && (
            <button
              class="button quiet small"
              type="button"
              aria-label={t("enter.remove", { name: t("enter.picture") })}
              onClick={forgetPicture}
            >
              ×
            </button>
          )}
        </li>
      </ul>
    </fieldset>
  );
}
