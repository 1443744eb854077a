/** The feet over the picture: handles to drag, and the ways through the key's postures. */

import type { Three } from "../../../core/leg/leg";
import { t } from "../../../i18n";
import { whyNot } from "../../../ui/unreached";
import { type Feet, showsWays } from "./feet";
import "./feet.css";

/** What a key does to a foot: right, forward, up. */
const WAYS: Readonly<Record<string, Three>> = {
  ArrowLeft: [-1, 0, 0],
  ArrowRight: [1, 0, 0],
  ArrowUp: [0, 1, 0],
  ArrowDown: [0, -1, 0],
  PageUp: [0, 0, 1],
  PageDown: [0, 0, -1],
};
const STEP_MM = 2;
const LONG_STEP_MM = 10;

export function FeetLayer({ feet }: { feet: Feet }) {
  const legs = feet.legs.value;
  const places = feet.places.value;
  const unreached = feet.unreached.value;
  const lines = feet.lines.value;
  return (
    <>
      <div class="feet">
        <svg aria-hidden="true">
          {lines.map(({ kind, leg }, index) => (
            <polyline
              key={`${kind} ${leg}`}
              class={kind}
              data-leg={leg}
              ref={(line) => {
                feet.strokes[index] = line;
              }}
            />
          ))}
        </svg>
        {places.map((place, leg) => (
          <Handle key={leg} feet={feet} leg={leg} label={legs[leg]!.label} place={place} />
        ))}
        <p class="why" role="status">
          {unreached && whyNot(unreached.why, legs[unreached.leg]!, unreached.leg, legs.length)}
        </p>
      </div>
      <button
        type="button"
        class="ways"
        aria-pressed={showsWays.value}
        title={t("design.foot.waysHint")}
        onClick={() => {
          showsWays.value = !showsWays.value;
        }}
      >
        {t("design.foot.ways")}
        {showsWays.value && (
          <>
            <i class="before">{t("design.foot.before")}</i>
            <i class="after">{t("design.foot.after")}</i>
          </>
        )}
      </button>
    </>
  );
}

interface HandleProps {
  feet: Feet;
  leg: number;
  label: string;
  place: Three;
}

function Handle({ feet, leg, label, place: [x, y, z] }: HandleProps) {
  const at = (event: PointerEvent) => {
    const box = (event.currentTarget as HTMLElement).parentElement!.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top] as const;
  };
  return (
    <button
      type="button"
      class="foot"
      ref={(handle) => {
        feet.handles[leg] = handle;
      }}
      aria-label={t("design.foot", { leg: label, x, y, z })}
      title={t("design.foot.hint")}
      onFocus={() => feet.choose(leg)}
      onPointerDown={(event) => {
        if (event.button !== 0) return;
        event.currentTarget.setPointerCapture(event.pointerId);
        feet.take(leg, ...at(event));
      }}
      onPointerMove={(event) => {
        if (event.currentTarget.hasPointerCapture(event.pointerId)) feet.pull(leg, ...at(event));
      }}
      onLostPointerCapture={() => feet.leave()}
      onKeyDown={(event) => {
        const way = WAYS[event.key];
        if (!way) return;
        event.preventDefault();
        const step = event.shiftKey ? LONG_STEP_MM : STEP_MM;
        feet.step(leg, way.map((one) => step * one) as unknown as Three);
      }}
    >
      <span aria-hidden="true">{t("design.foot.place", { leg: label, x, y, z })}</span>
    </button>
  );
}
