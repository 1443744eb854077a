/** The robot and gait files: dropped or picked, sorted by what is in them. */

import { signal, useComputed, useSignal } from "@preact/signals";
import { useId } from "preact/hooks";
import type { Court } from "../../core/court";
import {
  choose,
  chosenNames,
  digitsOf,
  forget,
  MOST_BYTES,
  SAMPLE_SEQUENCES,
  SLOTS,
  type Slot,
  sequences,
} from "../../core/files";
import type { Player } from "../../core/player";
import { Level, MAX_KEYS, Phase } from "../../core/wire";
import { said, t } from "../../i18n";
import { Mistakes } from "../../ui/mistakes";
import { PickFiles } from "../../ui/pick";
import { toast } from "../../ui/toasts";
import { ARROW_OF } from "./pad";

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
  const files = filesNow(court);
  const slots = SLOTS.filter(
    (slot) =>
      alone ||
      slot === "robot" ||
      files[slot].name ||
      levels.includes(slot === "postures" ? Level.POSTURE : Level.LOCOMOTION),
  );
  return (
    <div class={`files${dragging.value ? " over" : ""}`}>
      <p class="drop">
        {t("files.drop")}{" "}
        <label class="link" for={input}>
          {t("files.pick")}
        </label>
        <PickFiles id={input} take={take} />
      </p>
      <ul>
        {slots.map((slot) => (
          <SlotRow key={slot} slot={slot} files={files} />
        ))}
      </ul>
      {isLevelBMade(files) && <Sequences />}
    </div>
  );
}

type FilesNow = Record<Slot, { name: string; isGiven: boolean }>;

/** What a join brings now: chosen here, else what lies on this machine. */
function filesNow(court: Court): FilesNow {
  const chosen = chosenNames.value;
  const own = court.ownFiles.value;
  const hasChosenGait = Boolean(chosen.postures || chosen.locomotion);
  const now = (slot: Slot) => {
    const isGiven = !chosen[slot] && (slot === "robot" || !hasChosenGait);
    return { name: chosen[slot] || (isGiven ? (own?.[slot] ?? "") : ""), isGiven };
  };
  return { robot: now("robot"), postures: now("postures"), locomotion: now("locomotion") };
}

/** Whether level B is made of the postures, as no file of its own comes with them. */
function isLevelBMade(files: FilesNow): boolean {
  return Boolean(files.postures.name) && !files.locomotion.name;
}

/** What is used where there is no file: without any gait file the robot's sample gait is. */
function otherwise(slot: Slot, files: FilesNow): string {
  if (slot === "robot") return t("files.contests");
  if (slot === "locomotion" && isLevelBMade(files)) {
    return t("files.made", { name: files.postures.name });
  }
  return t(files.postures.name || files.locomotion.name ? "files.none" : "files.sample");
}

function SlotRow({ slot, files }: { slot: Slot; files: FilesNow }) {
  const { name, isGiven } = files[slot];
  return (
    <li>
      <span class="what">{t(`files.${slot}`)}</span>
      <span class={name ? "name" : "name muted"}>
        {name || otherwise(slot, files)}
        {name && isGiven && <small class="muted"> {t("files.given")}</small>}
      </span>
      {name && !isGiven && (
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

/**
 * The keys of a level B that is made here: which postures each runs through. All keys are always
 * there: a row that came or went as a field loses the focus would move the button under a click.
 */
function Sequences() {
  const keys = sequences.value;
  const change = (digit: number, digits: string) => {
    // Two fields may change before the page is drawn again: what is drawn may be old.
    const changed = [...sequences.peek()];
    while (changed.length <= digit) changed.push("");
    changed[digit] = digits;
    while (changed.length > 1 && !changed.at(-1)) changed.pop();
    sequences.value = changed;
  };
  return (
    <fieldset class="sequences">
      <legend>{t("files.sequences")}</legend>
      <p class="muted">{t("files.sequencesHint")}</p>
      <div>
        {Array.from({ length: MAX_KEYS }, (_, digit) => (
          <Sequence
            key={digit}
            digit={digit}
            digits={keys[digit] ?? ""}
            onChange={(typed) => change(digit, typed)}
          />
        ))}
      </div>
      <button
        class="button quiet small"
        type="button"
        disabled={keys.join() === SAMPLE_SEQUENCES.join()}
        onClick={() => {
          sequences.value = SAMPLE_SEQUENCES;
        }}
      >
        {t("files.sampleSequences")}
      </button>
    </fieldset>
  );
}

/** One key's postures. What is being typed stays, also when the page is drawn again meanwhile. */
function Sequence({ digit, digits, onChange }: SequenceProps) {
  const draft = useSignal<string | null>(null);
  return (
    <label>
      <span>
        {digit} {ARROW_OF.get(digit) ?? ""}
      </span>
      <input
        value={draft.value ?? [...digits].join(" ")}
        inputMode="numeric"
        autocomplete="off"
        aria-label={t("files.sequence", { digit })}
        placeholder="–"
        onInput={(event) => {
          draft.value = event.currentTarget.value;
        }}
        onChange={(event) => {
          draft.value = null;
          onChange(digitsOf(event.currentTarget.value));
        }}
      />
    </label>
  );
}

interface SequenceProps {
  digit: number;
  digits: string;
  onChange: (digits: string) => void;
}

/** Files on this machine that were saved again while the seat is held: offered, with what is wrong. */
export function FilesChanged({ court, player, alone }: ChangedProps) {
  const own = court.ownFiles.value;
  const isOpen = useComputed(() => alone || canChange(court)).value;
  const chosen = chosenNames.value;
  /** The version that was put away. */
  const putAway = useSignal<number | null>(null);
  const isNew = own && own.version > (own.used ?? own.version);
  if (!isNew || !isOpen || chosen.postures || chosen.locomotion) return null;
  if (own.version === putAway.value) return null;
  const names = own.changed.join(", ");
  const count = own.mistakes.length;
  return (
    <section class={`changed${own.error ? " wrong" : ""}`} role={own.error ? "alert" : "status"}>
      <button
        class="button quiet small close"
        type="button"
        aria-label={t("common.close")}
        title={t("common.close")}
        onClick={() => {
          putAway.value = own.version;
        }}
      >
        ×
      </button>
      {!own.error && (
        <>
          <p>{t("files.changed", { names })}</p>
          {alone && <p class="muted">{t("files.beginsAnew")}</p>}
          <button class="button strong" type="button" onClick={() => void player.rejoin()}>
            {t("files.useNew")}
          </button>
        </>
      )}
      {own.error && count === 0 && (
        <p>
          {t("files.changedWrong", { names })} {said(own.error)}
        </p>
      )}
      {own.error && count > 0 && (
        <details>
          <summary>{t("files.mistakes", { names, count })}</summary>
          <p class="muted">{t("files.changedWrong", { names })}</p>
          <Mistakes mistakes={own.mistakes} />
        </details>
      )}
    </section>
  );
}

interface ChangedProps {
  court: Court;
  player: Player;
  alone: boolean;
}
