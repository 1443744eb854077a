/** The field and what lies over it. */

import { type Signal, useComputed, useSignal } from "@preact/signals";
import type { ComponentChildren, Ref } from "preact";
import { useMemo } from "preact/hooks";
import type { Court } from "../../core/court";
import { phaseOf } from "../../core/match";
import type { Player } from "../../core/player";
import { quality } from "../../core/settings";
import type { TryOut } from "../../core/try_out";
import { Phase } from "../../core/wire";
import { t } from "../../i18n";
import { played } from "../../i18n/words";
import { View } from "../../scene/View";
import { Countdown } from "../../ui/opening";
import { ScoreBug } from "../../ui/score";
import { hasKeyboard, keepHeight, useMedia } from "../../ui/screen";
import { Sound } from "../../ui/sound";
import { Thirds } from "../../ui/thirds";
import { Brief, isBrief } from "./brief";
import { Outcome } from "./outcome";
import { nextStep } from "./steps";

export const VIEWS = ["arena", "top", "chase"] as const;
export type ViewName = (typeof VIEWS)[number];

/** Room for two lines of a message between the score and the arena [px]. */
const MESSAGE_PX = 66;
/** What the arena leaves free below it [px]: the line with the badge, and the card before play. */
const BELOW = { line: 52, brief: 266, narrow: 6 };
const NARROW = matchMedia("(max-width: 820px)");
/** The field stands above the keys, and is too small for a card (player.css). */
export const STACKED = matchMedia("(max-width: 520px), (max-width: 820px) and (min-height: 641px)");
const INSET_OUTSIDE = {};

interface Props {
  court: Court;
  player: Player;
  alone: boolean;
  /** null: practice has none. */
  tryOut: TryOut | null;
  view: Signal<ViewName>;
  hasFocus: Signal<boolean>;
  hasInputMethod: Signal<boolean>;
  field: Ref<HTMLDivElement>;
  /** What is more urgent than the next step, the most urgent first; it stands in its place. */
  urgent: ComponentChildren;
  onView: () => void;
  onSave: () => void;
}

export function Field(props: Props) {
  const { court, player, alone, tryOut, view, field, urgent, onView, onSave } = props;
  const isNarrow = useMedia(NARROW);
  const isStacked = useMedia(STACKED);
  const standing = player.standing.value;
  const isIn = standing === "seated" || standing === "joining";
  const hasLevels = (court.sheet.value?.levels.length ?? 0) > 1;
  const phase = useMemo(() => phaseOf(court), [court]).value;
  const hasBrief = !alone && !isStacked && !tryOut?.standing.value && isBrief(phase);
  const scorePx = useSignal(0);
  const keepScore = useMemo(
    () => (element: HTMLElement | null) =>
      keepHeight(element, (px) => {
        scorePx.value = px;
      }),
    [scorePx],
  );
  const inset = {
    top: scorePx.value + MESSAGE_PX,
    bottom: BELOW[isNarrow ? "narrow" : hasBrief ? "brief" : "line"],
  };
  return (
    <div class="stage">
      {/* biome-ignore-start lint/a11y/noNoninteractiveTabindex: the field takes the game's keys */}
      <div
        ref={field}
        class="field3d"
        tabIndex={isIn ? 0 : -1}
        role="application"
        aria-label={t(hasLevels ? "field.labelLevels" : "field.label")}
      >
        <View
          source={tryOut ?? court}
          camera={isIn ? view : "arena"}
          seat={Math.max(0, player.index.value)}
          quality={quality}
          labels={!alone}
          own={!alone && isIn ? { seat: player.index.value, name: t("tag.own") } : null}
          worth={player.gains.value?.points ?? null}
          inset={isIn ? inset : INSET_OUTSIDE}
          label={t("views.label")}
        />
      </div>
      {/* biome-ignore-end lint/a11y/noNoninteractiveTabindex: see above */}
      {isIn && (
        <>
          <div class="on-stage">
            <div class="score" ref={keepScore}>
              <ScoreBug match={court} />
              {isNarrow && court.sheet.value?.call && (
                <p class="fixture">{played(court.sheet.value)}</p>
              )}
            </div>
            <div class="told">
              {urgent}
              <InputMethodHint {...props} />
              <NextStep {...props} isNarrow={isNarrow} />
            </div>
            {hasBrief && <Brief court={court} player={player} />}
            {!alone && <Countdown match={court} />}
            {!alone && <Sound match={court} own={player.index.value} />}
            {!alone && !isStacked && <Outcome {...{ court, player, onSave }} isLast={isNarrow} />}
          </div>
          <div class="under-field">
            <button class="badge" type="button" onClick={onView}>
              {t("views.badge", { number: VIEWS.indexOf(view.value) + 1 })}
              <span>{t(`views.${view.value}`)}</span>
            </button>
            {!alone && <Thirds match={court} most={1} toldElsewhere />}
            {hasKeyboard.value && (
              <p class="way-out">{t(hasLevels ? "field.outByEscape" : "field.outByTab")}</p>
            )}
          </div>
          <Curtain {...props} />
        </>
      )}
    </div>
  );
}

function NextStep({ court, player, alone, tryOut, isNarrow }: Props & { isNarrow: boolean }) {
  const text = useComputed(() => {
    const step = nextStep(court, player, alone, tryOut?.isOpen.value);
    return `${step.tone}|${step.text}`;
  }).value;
  const [tone, ...words] = text.split("|");
  const isOver = useMemo(() => phaseOf(court), [court]).value >= Phase.FINISHED;
  // The coach says it, or the result card does where it has room for that.
  if (alone ? tone === "do" : isOver && !isNarrow) return null;
  return <p class={`next ${tone}`}>{words.join("|")}</p>;
}

function InputMethodHint({ hasInputMethod }: Props) {
  if (!hasInputMethod.value) return null;
  return (
    <p class="ime" role="status">
      {t("ime.on")}
    </p>
  );
}

/** Keys go elsewhere while another window has the keyboard: say so where the eyes are. */
function Curtain({ court, hasFocus }: Props) {
  const phase = useMemo(() => phaseOf(court), [court]).value;
  const matters = phase >= Phase.READY && phase <= Phase.HALTED;
  if (hasFocus.value || !matters || !hasKeyboard.value) return null;
  return (
    <button class="curtain" type="button" onClick={() => window.focus()}>
      <b>{t("focus.steer")}</b>
      <span>{t("focus.why")}</span>
    </button>
  );
}
