/** Practice: what to try next, and how the robot walks (workshop 4-4). */

import { useSignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import type { Court } from "../../core/court";
import { chosenNames } from "../../core/files";
import type { Player } from "../../core/player";
import { type Walk, Walker } from "../../core/walk";
import { RESTART_KEY } from "../../core/wire";
import { type MessageName, t } from "../../i18n";
import { hasOwnFiles, learnt, type Progress } from "./lessons";

const SHOWN_KEYS = 8;
const LOOK_MS = 100;

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
