/** Practice: what to try next, and how the robot walks (workshop 4-4). */

import { useComputed, useSignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import type { Court } from "../../core/court";
import { chosenNames } from "../../core/files";
import type { Player } from "../../core/player";
import { remembered } from "../../core/settings";
import { type Walk, Walker } from "../../core/walk";
import { Level, RESTART_KEY } from "../../core/wire";
import { type MessageName, t } from "../../i18n";

interface Lesson {
  text: MessageName;
  level: number;
  keys: readonly number[];
}

/** The sample gait's ways: workshop 4-4, Fig. 4-2. */
const LESSONS: readonly Lesson[] = [
  { text: "coach.forward", level: Level.POSTURE, keys: [1, 2, 3, 4] },
  { text: "coach.again", level: Level.POSTURE, keys: [1, 2, 3, 4] },
  { text: "coach.back", level: Level.POSTURE, keys: [4, 3, 2, 1] },
  { text: "coach.turn", level: Level.POSTURE, keys: [5, 6, 7, 8] },
  { text: "coach.level", level: Level.LOCOMOTION, keys: [2] },
];
const SHOWN_KEYS = 8;
const LOOK_MS = 100;

const learnt = remembered("lessons", 0);

/** Where the lessons are: which one, and how many of its keys have come. */
export interface Progress {
  lesson: Lesson | null;
  done: number;
  /** The key that comes next, where it does something at the level that is chosen. */
  next: number | null;
}

function hasOwnFiles(court: Court): boolean {
  const own = court.ownFiles.value;
  return Boolean(own?.robot || own?.postures || own?.locomotion);
}

/** Follows the keys through the lessons. */
export function useLessons(court: Court, player: Player): Progress {
  const isSample = useComputed(
    () =>
      !chosenNames.value.postures &&
      !chosenNames.value.locomotion &&
      !chosenNames.value.robot &&
      !hasOwnFiles(court),
  ).value;
  const done = useSignal(0);
  const seen = useSignal(0);
  useEffect(
    () =>
      player.sentCount.subscribe((count) => {
        if (count <= seen.peek()) {
          seen.value = count;
          return;
        }
        seen.value = count;
        const lesson = LESSONS[learnt.peek()];
        const last = player.pressed.peek().at(-1);
        if (!lesson || !last || last.key === RESTART_KEY) return;
        if (last.level !== lesson.level) {
          // Who walks at level B already needs no more lessons.
          if (last.level === Level.LOCOMOTION && last.key > 0) learnt.value = LESSONS.length;
          return;
        }
        const expected = lesson.keys[done.peek()];
        done.value = last.key === expected ? done.peek() + 1 : last.key === lesson.keys[0] ? 1 : 0;
        if (done.peek() === lesson.keys.length) {
          done.value = 0;
          learnt.value += 1;
        }
      }),
    [player, done, seen],
  );
  const lesson = isSample ? (LESSONS[learnt.value] ?? null) : null;
  const isLevel = lesson?.level === player.level.value;
  return {
    lesson,
    done: done.value,
    next: lesson && isLevel ? (lesson.keys[done.value] ?? null) : null,
  };
}

interface Props {
  court: Court;
  player: Player;
  progress: Progress;
}

export function Coach({ court, player, progress }: Props) {
  const { lesson, done } = progress;
  const hasOwn =
    Boolean(
      chosenNames.value.postures || chosenNames.value.locomotion || chosenNames.value.robot,
    ) || hasOwnFiles(court);
  const text: MessageName = lesson ? lesson.text : hasOwn ? "coach.own" : "coach.free";
  const pressed = player.pressed.value.slice(-SHOWN_KEYS);
  return (
    <section class="coach" aria-label={t("coach.title")}>
      <p class="lesson" role="status">
        {t(text)}
      </p>
      {!lesson && !hasOwn && (
        <button
          class="button quiet small again"
          type="button"
          onClick={() => {
            learnt.value = 0;
          }}
        >
          {t("coach.repeat")}
        </button>
      )}
      {lesson && (
        <ol class="steps">
          {lesson.keys.map((key, index) => (
            <li key={index} class={index < done ? "done" : index === done ? "now" : ""}>
              {key}
            </li>
          ))}
          <li class="skip">
            <button
              class="button quiet small"
              type="button"
              onClick={() => {
                learnt.value += 1;
              }}
            >
              {t("coach.skip")}
            </button>
          </li>
        </ol>
      )}
      <p class="pressed">
        <span class="muted">{t("coach.pressed")}</span>
        {pressed.map(({ level, key }, index) => (
          <kbd key={index} data-level={level}>
            {key === RESTART_KEY ? "x" : key}
          </kbd>
        ))}
      </p>
      <WalkFigures court={court} player={player} />
    </section>
  );
}

function WalkFigures({ court, player }: { court: Court; player: Player }) {
  const index = player.index.value;
  const walker = useMemo(() => new Walker(Math.max(0, index)), [index]);
  const walk = useSignal<Walk | null>(null);
  useEffect(() => {
    const timer = setInterval(() => {
      const frame = court.frame.peek();
      const sheet = court.sheet.peek();
      if (frame && sheet) walk.value = walker.look(frame, sheet, court.events.peek());
    }, LOOK_MS);
    return () => clearInterval(timer);
  }, [court, walker, walk]);
  const now = walk.value;
  return (
    <dl class="figures">
      <Figure name="walk.heading" value={now ? String(now.headingDegrees) : null} unit="°" />
      <Figure name="walk.walked" value={now?.walkedM.toFixed(2) ?? null} unit="m" />
      <Figure name="walk.speed" value={now ? (now.speedMps * 100).toFixed(1) : null} unit="cm/s" />
    </dl>
  );
}

function Figure({ name, value, unit }: { name: MessageName; value: string | null; unit: string }) {
  return (
    <div>
      <dt>{t(name)}</dt>
      <dd>
        {value ?? "–"}
        {value && <small>{unit}</small>}
      </dd>
    </div>
  );
}
