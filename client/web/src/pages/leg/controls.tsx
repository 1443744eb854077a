/** What is turned and pressed in the lesson. */

import { LEVELS } from "../../core/design/table";
import { t } from "../../i18n";
import { hasKeyboard } from "../../ui/screen";
import { whyNot } from "../../ui/unreached";
import type { Lesson } from "./lesson";
import { mm } from "./svg";

interface SliderProps {
  name: string;
  value: number;
  low: number;
  high: number;
  onChange: (value: number) => void;
}

export function Slider({ name, value, low, high, onChange }: SliderProps) {
  return (
    <label class="slider">
      <span>{name}</span>
      <output>{mm(value, 0)}°</output>
      <input
        type="range"
        min={low}
        max={high}
        step={1}
        value={Math.round(value)}
        aria-valuetext={t("leg.angle", { name, angle: Math.round(value) })}
        onInput={(event) => onChange(Number(event.currentTarget.value))}
      />
    </label>
  );
}

/** Sliders of joints of the leg, by their level: 0 is Root. */
export function Joints({ lesson, levels }: { lesson: Lesson; levels: readonly (0 | 1 | 2)[] }) {
  const [low, high] = lesson.leg.value.range_deg;
  return (
    <>
      {levels.map((level) => (
        <Slider
          key={level}
          name={t(`leg.${LEVELS[level]}`)}
          value={lesson.angles.value[level]}
          low={low}
          high={high}
          onChange={(angle) => lesson.turn(level, angle)}
        />
      ))}
    </>
  );
}

/** The pairs of angles that bring the foot to its spot, or why there is none. */
export function Pairs({ lesson }: { lesson: Lesson }) {
  const { postures, unreached } = lesson.found.value;
  const legs = lesson.robot.value.legs.length;
  const chosen = Math.min(lesson.bend.value, postures.length - 1);
  return (
    <div class="pairs">
      <p class="muted">
        {t("leg.spot", { ...lesson.spot.value })}
        {hasKeyboard.value && ` · ${t("leg.back.keys")}`}
      </p>
      {postures.map(([first, second], index) => (
        <button
          key={index}
          class="button"
          type="button"
          aria-pressed={index === chosen}
          onClick={() => lesson.takePair(index)}
        >
          {t("leg.back.pair", { first, second })}
        </button>
      ))}
      <p class="unreached" role="status">
        {unreached && whyNot(unreached, lesson.leg.value, 0, legs)}
      </p>
    </div>
  );
}
