/** The field: the drawing from above or the 3D view; what is clicked on it can be acted on. */

import { type Signal, useSignal } from "@preact/signals";
import { useMemo } from "preact/hooks";
import { quality, remembered } from "../../core/settings";
import { t } from "../../i18n";
import type { Hit } from "../../scene/View";
import { Board } from "../../ui/board";
import { later } from "../../ui/later";
import type { Desk } from "./desk";
import { type Picked, PickPopover } from "./pick";

/** The drawing is the first choice: it costs a slow machine nothing, and every disc is in sight. */
const shown = remembered<"board" | "3d">("referee.view", "board");
/** The 3D view is loaded only where it is wanted. */
const View = later(() => import("../../scene/View").then((it) => it.View));

interface Props {
  desk: Desk;
  picked: Signal<Picked | null>;
}

export function FieldCard({ desk, picked }: Props) {
  const { court } = desk;
  const pointer = useSignal({ leftPx: 0, topPx: 0 });
  const close = useMemo(
    () => () => {
      picked.value = null;
    },
    [picked],
  );
  const pick = ({ marker, seat }: Pick<Hit, "marker" | "seat">) => {
    if (marker === undefined && seat === undefined) return;
    picked.value = {
      ...(seat === undefined ? { marker: marker! } : { seat }),
      ...pointer.peek(),
    };
  };
  return (
    <section class="card field-card" aria-labelledby="field-title" data-live={court.live.value}>
      <header>
        <h2 id="field-title">{t("referee.field")}</h2>
        <p class="muted">{t("referee.fieldHelp")}</p>
        <fieldset class="chips" aria-label={t("referee.view")}>
          {(["board", "3d"] as const).map((one) => (
            <label key={one} class="chip">
              <input
                type="radio"
                name="view"
                checked={shown.value === one}
                onChange={() => {
                  shown.value = one;
                }}
              />
              {t(one === "3d" ? "referee.view3d" : "referee.viewBoard")}
            </label>
          ))}
        </fieldset>
      </header>
      <div
        class="field-view"
        onPointerDownCapture={(event) => {
          pointer.value = { leftPx: event.clientX, topPx: event.clientY };
        }}
        onKeyDownCapture={(event) => {
          const box = (event.target as Element).getBoundingClientRect();
          pointer.value = { leftPx: box.right, topPx: box.bottom };
        }}
      >
        {shown.value === "3d" ? (
          <Scene desk={desk} onPick={pick} />
        ) : (
          <Board match={court} onPick={pick} picked={picked.value} />
        )}
        {!court.live.value && <p class="stale">{t("referee.stale")}</p>}
      </div>
      {picked.value && <PickPopover desk={desk} picked={picked.value} onClose={close} />}
    </section>
  );
}

function Scene({ desk, onPick }: { desk: Desk; onPick: (hit: Hit) => void }) {
  const { court } = desk;
  const source = useMemo(
    () => ({
      sheet: court.sheet,
      scene: court.scene,
      sample: (nowMs: number) => court.timeline.sample(nowMs),
    }),
    [court],
  );
  return (
    <View
      source={source}
      camera="arena"
      quality={quality}
      orbit
      labels
      onPick={onPick}
      label={t("board.title")}
    />
  );
}
