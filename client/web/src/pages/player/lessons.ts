/** Practice: which lesson is next, and which of its keys have come (workshop 4-4). */

import { useComputed, useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { Court } from "../../core/court";
import { chosenNames } from "../../core/files";
import type { Player } from "../../core/player";
import { remembered } from "../../core/settings";
import { Level, RESTART_KEY } from "../../core/wire";
import type { MessageName } from "../../i18n";

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
/** The lessons that are learnt: how many. */
export const learnt = remembered("lessons", 0);

/** Where the lessons are: which one, and how many of its keys have come. */
export interface Progress {
  lesson: Lesson | null;
  done: number;
  /** The key that comes next, where it does something at the level that is chosen. */
  next: number | null;
}

/** Whether this machine's files take the place of the sample's. */
export function hasOwnFiles(court: Court): boolean {
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
