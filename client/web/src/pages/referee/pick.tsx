/** The popover of what was clicked on the field: a disc, corner or flag, or a robot. */

import { useSignal } from "@preact/signals";
import { useLayoutEffect, useMemo, useRef } from "preact/hooks";
import { markerStates } from "../../core/match";
import { MARKER_STATES } from "../../core/wire";
import { t } from "../../i18n";
import { team } from "../../i18n/words";
import { SeatMark } from "../../ui/score";
import { Act } from "./act";
import type { Desk } from "./desk";
import * as drafts from "./drafts";
import { RobotActs } from "./seats";

/** What was picked, and where on the screen. */
export interface Picked {
  marker?: number;
  seat?: number;
  leftPx: number;
  topPx: number;
}

interface Props {
  desk: Desk;
  picked: Picked;
  onClose: () => void;
}

const WIDTH_PX = 290;

export function PickPopover({ desk, picked, onClose }: Props) {
  const element = useRef<HTMLDivElement>(null);
  const heightPx = useSignal(0);
  // Before anything is drawn, because a quick user may press Escape at once.
  useLayoutEffect(() => {
    const before = document.activeElement;
    heightPx.value = element.current?.offsetHeight ?? 0; // long names take more lines
    element.current?.querySelector<HTMLElement>("button:not([aria-disabled])")?.focus();
    const outside = (event: PointerEvent) => {
      if (!element.current?.contains(event.target as Node)) onClose();
    };
    // Also where the focus has gone out of it.
    const leave = (event: KeyboardEvent) => {
      if (event.key === "Escape" && !document.querySelector("dialog[open]")) onClose();
    };
    document.addEventListener("pointerdown", outside);
    document.addEventListener("keydown", leave);
    return () => {
      document.removeEventListener("pointerdown", outside);
      document.removeEventListener("keydown", leave);
      // Back to the disc or robot from which a keyboard came here.
      if (before?.isConnected && before !== document.body) (before as HTMLElement).focus?.();
    };
  }, [onClose, heightPx]);
  const left = Math.max(8, Math.min(picked.leftPx + 12, innerWidth - WIDTH_PX - 8));
  const top = Math.max(8, Math.min(picked.topPx + 12, innerHeight - heightPx.value - 8));
  return (
    <div
      ref={element}
      class="card pick"
      role="dialog"
      aria-labelledby="pick-title"
      tabIndex={-1}
      style={`left: ${left}px; top: ${top}px; width: ${WIDTH_PX}px`}
    >
      {picked.marker !== undefined && (
        <MarkerActs desk={desk} marker={picked.marker} then={onClose} />
      )}
      {picked.seat !== undefined && <RobotPick desk={desk} seat={picked.seat} then={onClose} />}
      <button class="button quiet close" type="button" onClick={onClose}>
        {t("common.close")}
      </button>
    </div>
  );
}

function RobotPick({ desk, seat, then }: { desk: Desk; seat: number; then: () => void }) {
  const sheet = desk.court.sheet.value;
  if (!sheet) return null;
  return (
    <>
      <h2 id="pick-title">
        <SeatMark sheet={sheet} index={seat} /> {t("pick.robot", { team: team(sheet, seat) })}
      </h2>
      <RobotActs desk={desk} seat={seat} then={then} />
    </>
  );
}

function MarkerActs({ desk, marker, then }: { desk: Desk; marker: number; then: () => void }) {
  const { court } = desk;
  const now = useMemo(() => markerStates(court), [court]).value[marker] ?? 0;
  const info = court.sheet.value?.markers[marker];
  const sheet = court.sheet.value;
  if (!info || !sheet) return null;
  const stateNow = MARKER_STATES[now] ?? "neutral";
  return (
    <>
      <h2 id="pick-title">
        {drafts.markerTitle(court, marker)}
        {info.points > 1 && (
          <span class="muted"> · {t("pick.points", { points: info.points })}</span>
        )}
      </h2>
      <p class="muted">{t("pick.is", { state: drafts.stateName(court, stateNow) })}</p>
      <div class="states">
        {MARKER_STATES.map((state) => {
          const seat = sheet.seats.findIndex((one) => one.id === state);
          const why =
            desk.whyNot("set") ||
            (state === stateNow ? t("pick.state.now") : "") ||
            (state === "down" && info.kind !== "flag" ? t("pick.state.cannot") : "");
          return (
            <Act
              key={state}
              why={why}
              onAct={() => {
                then();
                desk.draft.value = drafts.setMarker(court, marker, state);
              }}
            >
              {seat >= 0 && <SeatMark sheet={sheet} index={seat} />}
              <span class="cut">{drafts.stateName(court, state)}</span>
            </Act>
          );
        })}
      </div>
    </>
  );
}
