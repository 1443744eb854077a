/** The coach: which numbers matter, and a better gait; both only after one's own guess. */

import { signal, useSignal } from "@preact/signals";
import { change } from "../../core/design/table";
import type { CoachReply } from "../../core/wire";
import { t } from "../../i18n";
import { unit } from "./figures";
import { jointName, type Studio } from "./studio";

/** What turning a number up or down does to the score. */
type Effect = "good" | "bad" | "none";

/** How much a number matters, for its cell. */
export interface Marked {
  /** From 0 to 1 of the number that matters most. */
  share: number;
  up: Effect;
  down: Effect;
  text: string;
}

const SIZES = ["cell", "three", "table"] as const;
const GOALS = ["forward", "left", "right"] as const;
const SECONDS = 30;
/** A smaller change of the score [mm/s] is none. */
const SMALL = 2.5;
const KEY_OF: Record<(typeof GOALS)[number], number> = { forward: 2, left: 1, right: 3 };

interface Found {
  reply: CoachReply;
  /** The version of the table, and the rows of the key, that it is about. */
  version: number;
  rows: readonly number[];
  /** What was asked: null: which numbers matter. */
  size: (typeof SIZES)[number] | null;
}

const found = signal<Found | null>(null);
const revealed = signal(false);
const asked = signal<string | null>(null);
let jobs = 0;

/** The marks of the cells by row and joint; null while none are to be seen. */
export function weightsShown(studio: Studio): ReadonlyMap<number, Map<number, Marked>> | null {
  const now = found.value;
  if (!now || !revealed.value || now.size !== null || now.version !== studio.version.value) {
    return null;
  }
  const most = Math.max(1, ...now.reply.matters.map(({ up, down }) => sizeOf(up, down)));
  const marks = new Map<number, Map<number, Marked>>();
  for (const { cell, up, down } of now.reply.matters) {
    const row = now.rows[cell.posture];
    if (row === undefined || sizeOf(up, down) < SMALL) continue;
    const ofRow = marks.get(row) ?? new Map<number, Marked>();
    marks.set(row, ofRow);
    const text = t("design.coach.mark", { up: signed(up), down: signed(down) });
    const share = Number((sizeOf(up, down) / most).toFixed(3));
    ofRow.set(cell.joint, { share, up: effectOf(up), down: effectOf(down), text });
  }
  return marks;
}

export function Coach({ studio }: { studio: Studio }) {
  const goal = useSignal<(typeof GOALS)[number]>("forward");
  const now = found.value;
  const isCurrent = now?.version === studio.version.value;
  const ask = async (size: Found["size"]) => {
    const files = studio.request();
    const rows = studio.sequence.peek();
    if (!files || !rows) {
      void studio.tryIt(); // says what is missing
      return;
    }
    const job = `p${Date.now().toString(36)}-${++jobs}`;
    const version = studio.version.peek();
    found.value = null;
    revealed.value = false;
    asked.value = job;
    studio.progress.value = null;
    try {
      const reply = await studio.connection.ask<CoachReply>("coach", {
        job,
        ...files,
        key: studio.key.peek(),
        goal: goal.peek(),
        size,
        seconds: SECONDS,
        seed: 0,
      });
      if (asked.peek() === job) found.value = { reply, version, rows, size };
    } catch (error) {
      studio.refuse(error);
    } finally {
      if (asked.peek() === job) asked.value = null;
    }
  };
  return (
    <section class="coach" aria-label={t("design.coach")}>
      <label class="field inline">
        <span>{t("design.coach.goal")}</span>
        <select
          value={goal.value}
          onChange={(event) => {
            goal.value = event.currentTarget.value as typeof goal.value;
            studio.key.value = KEY_OF[goal.value];
          }}
        >
          {GOALS.map((name) => (
            <option key={name} value={name}>
              {t(`design.goal.${name}`)}
            </option>
          ))}
        </select>
      </label>
      {asked.value ? (
        <Working studio={studio} job={asked.value} />
      ) : (
        <div class="asks">
          <button class="button" type="button" onClick={() => void ask(null)}>
            {t("design.coach.matters")}
          </button>
          <p class="muted">{t("design.coach.improve")}</p>
          <div class="sizes">
            {SIZES.map((size) => (
              <button key={size} class="button" type="button" onClick={() => void ask(size)}>
                <b>{t(`design.coach.${size}`)}</b>
                <small>{t(`design.coach.${size}.hint`)}</small>
              </button>
            ))}
          </div>
        </div>
      )}
      {now && !isCurrent && <p class="muted">{t("design.coach.old")}</p>}
      {now && isCurrent && now.size === null && <Matters studio={studio} found={now} />}
      {now && isCurrent && now.size !== null && <Better studio={studio} found={now} />}
    </section>
  );
}

function Working({ studio, job }: { studio: Studio; job: string }) {
  const progress = studio.progress.value;
  const mine = progress?.job === job ? progress : null;
  const stage = mine?.stage ?? "matters";
  const name = `design.coach.stage.${stage}` as "design.coach.stage.matters";
  return (
    <div class="working" role="status">
      <p>
        {t(name)}
        {mine && <small class="muted"> {t("design.coach.trials", { count: mine.trials })}</small>}
      </p>
      <progress value={mine?.done ?? 0} max={1} aria-label={t(name)} />
      <button
        class="button"
        type="button"
        onClick={() => void studio.connection.ask("cancel", { job }).catch(() => undefined)}
      >
        {t("design.coach.stop")}
      </button>
    </div>
  );
}

interface FoundProps {
  studio: Studio;
  found: Found;
}

/** First one's own guess: the selected number; then all of them, as colours in the table. */
function Matters({ studio, found: { reply, rows } }: FoundProps) {
  const table = studio.table.value!;
  const guess = useSignal<{ row: number; col: number } | null>(null);
  const { row, col } = studio.active.value;
  const inKey = rows.includes(row);
  const nameOf = (at: number, joint: number) =>
    t("design.place", { key: table.rows[at]?.key ?? "?", joint: jointName(table.legs, joint) });
  if (!revealed.value) {
    return (
      <div class="guess">
        <p>{t("design.coach.guess")}</p>
        <p class="guessed">
          {inKey ? nameOf(row, col) : <span class="muted">{t("design.coach.guessInKey")}</span>}
        </p>
        <button
          class="button strong"
          type="button"
          disabled={!inKey}
          onClick={() => {
            guess.value = { row, col };
            revealed.value = true;
          }}
        >
          {t("design.coach.reveal")}
        </button>
      </div>
    );
  }
  const ranked = reply.matters.filter(({ up, down }) => sizeOf(up, down) >= SMALL);
  const at = guess.value;
  const rank = at
    ? reply.matters.findIndex(({ cell }) => rows[cell.posture] === at.row && cell.joint === at.col)
    : -1;
  return (
    <div class="matters">
      {at && (
        <p class="verdict">
          {rank === 0
            ? t("design.coach.first", { place: nameOf(at.row, at.col) })
            : t("design.coach.rank", {
                place: nameOf(at.row, at.col),
                rank: rank + 1,
                count: reply.matters.length,
              })}
        </p>
      )}
      <p class="legend">
        <span class="swatch" aria-hidden="true" /> {t("design.coach.legend")}
      </p>
      <ol>
        {ranked.slice(0, 5).map(({ cell, up, down }) => {
          const place = rows[cell.posture] ?? 0;
          return (
            <li key={`${cell.posture} ${cell.joint}`}>
              <button
                type="button"
                onClick={() => studio.select({ row: place, col: cell.joint })}
                onPointerEnter={() => studio.point([cell.joint])}
                onPointerLeave={() => studio.point([])}
              >
                <span>{nameOf(place, cell.joint)}</span>
                <small data-effect={effectOf(up)}>+10° {signed(up)}</small>
                <small data-effect={effectOf(down)}>−10° {signed(down)}</small>
              </button>
            </li>
          );
        })}
      </ol>
    </div>
  );
}

const GAINS = ["little", "half", "double"] as const;
type Gain = (typeof GAINS)[number];
/** From how many times the score on a gain is "half", and "double". */
const HALF = 1.25;
const DOUBLE = 1.75;

function gainOf({ score_before, score_after }: CoachReply): Gain {
  const times = score_before > 0 ? score_after / score_before : Number.POSITIVE_INFINITY;
  return times >= DOUBLE ? "double" : times >= HALF ? "half" : "little";
}

/** A better gait: first how much better it will be, then its changes. */
function Better({ studio, found: { reply, rows, size } }: FoundProps) {
  const table = studio.table.value!;
  const guess = useSignal<Gain | null>(null);
  const gain = reply.score_after - reply.score_before;
  if (!reply.changes.length) return <p>{t("design.coach.nothing")}</p>;
  if (!revealed.value) {
    return (
      <div class="guess">
        <p>{t("design.coach.guessGain", { size: t(`design.coach.${size ?? "cell"}`) })}</p>
        <div class="row">
          {GAINS.map((name) => (
            <button
              key={name}
              class="button"
              type="button"
              onClick={() => {
                guess.value = name;
                revealed.value = true;
              }}
            >
              {t(`design.coach.gain.${name}`)}
            </button>
          ))}
        </div>
      </div>
    );
  }
  const apply = () => {
    studio.edit(
      t("design.step.coach"),
      (now) =>
        reply.changes.reduce((made, { cell, to_deg }) => {
          const row = rows[cell.posture] ?? 0;
          const area = { top: row, bottom: row, left: cell.joint, right: cell.joint };
          return change(made, area, () => to_deg);
        }, now),
      null,
      "coach",
      size,
    );
    found.value = null;
    void studio.tryIt();
  };
  return (
    <div class="better">
      {guess.value && (
        <p class={`verdict ${guess.value === gainOf(reply) ? "right" : "wrong"}`}>
          {guess.value === gainOf(reply)
            ? t("design.verdict.right", { was: t(`design.coach.gain.${guess.value}`) })
            : t("design.verdict.wrong", {
                guess: t(`design.coach.gain.${guess.value}`),
                was: t(`design.coach.gain.${gainOf(reply)}`),
              })}
        </p>
      )}
      <p class="verdict">
        {t("design.coach.gained", {
          before: unit(reply.score_before, 0),
          after: unit(reply.score_after, 0),
          gain: signed(gain),
        })}
        {reply.cancelled && <small class="muted"> {t("design.coach.stopped")}</small>}
      </p>
      <button class="button strong" type="button" onClick={apply}>
        {t("design.coach.apply")}
      </button>
      <ul>
        {reply.changes.map(({ cell, from_deg, to_deg }) => {
          const row = rows[cell.posture] ?? 0;
          return (
            <li key={`${cell.posture} ${cell.joint}`}>
              <button
                type="button"
                onClick={() => studio.select({ row, col: cell.joint })}
                onPointerEnter={() => studio.point([cell.joint])}
                onPointerLeave={() => studio.point([])}
              >
                <span>
                  {t("design.place", {
                    key: table.rows[row]?.key ?? "?",
                    joint: jointName(table.legs, cell.joint),
                  })}
                </span>
                <small>
                  {degrees(from_deg)} → <b>{degrees(to_deg)}</b>
                </small>
              </button>
            </li>
          );
        })}
      </ul>
    </div>
  );
}

function degrees(angle: number): string {
  return `${unit(angle, Number.isInteger(angle) ? 0 : 1)}°`;
}

function sizeOf(up: number, down: number): number {
  return Math.max(Math.abs(up), Math.abs(down));
}

function effectOf(by: number): Effect {
  if (Math.abs(by) < SMALL) return "none";
  return by > 0 ? "good" : "bad";
}

function signed(by: number): string {
  return `${by < 0 ? "−" : "+"}${Math.abs(by).toFixed(1)}`;
}
