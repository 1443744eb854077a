/** The director's picture on a projector, as a broadcast shows it. */

import { effect, type Signal, signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { followColours } from "../../core/colours";
import { eventFeed } from "../../core/contest/feed";
import { stateOf } from "../../core/contest/sheet";
import { Turns } from "../../core/contest/turns";
import { Court } from "../../core/court";
import { inPieces } from "../../core/pieces";
import { reloadWhenServed } from "../../core/reload";
import { Replays } from "../../core/replays";
import { USUAL_HZ } from "../../core/wire";
import { OnAir, OnlyMatch } from "../../ui/on_air";
import { Aside } from "../watch/aside";
import { Broadcast, type Style, scaleOfWindow } from "../watch/broadcast";
import { qualityOfAddress } from "../watch/flags";
import { Decided } from "../watch/next";

const LOOK_MS = 200;

const court = new Court(USUAL_HZ, 0, "director", inPieces);
/** The director's second picture. */
const aside = new Court(USUAL_HZ, 0, "aside", inPieces);
const turns = new Turns();
const replays = new Replays(court);
const style: Style = {
  camera: "auto",
  quality: qualityOfAddress() ?? "auto",
  transparent: false,
  hud: true,
  split: false,
};
const scale = signal(scaleOfWindow());

followColours(court);
addEventListener("resize", () => {
  scale.value = scaleOfWindow();
});
effect(() => {
  if (court.outdated.value) void reloadWhenServed();
});

/** @param shown Becomes true while the picture fills the screen. */
export function Picture({ shown }: { shown: Signal<boolean> }) {
  useEffect(() => {
    const timer = setInterval(() => {
      const phase = court.frame.peek()?.phase;
      const on = court.programme.peek()?.court ?? "";
      const live = court.live.peek() && phase !== undefined ? { court: on, phase } : null;
      const sheet = eventFeed.sheet.peek();
      const isOver = sheet !== null && stateOf(sheet) === "over";
      shown.value = turns.isPicture(performance.now(), live, isOver);
    }, LOOK_MS);
    return () => clearInterval(timer);
  }, [shown]);
  return (
    <div
      class={`overlay${court.live.value ? "" : " stale"}`}
      data-shown={shown.value}
      style={`--scale: ${scale.value}`}
    >
      <Broadcast
        match={court}
        style={style}
        scale={scale}
        belowScore={
          severalCourts() ? (
            <OnAir court={court} withMatch isSeen={shown.value} />
          ) : (
            <OnlyMatch court={court} />
          )
        }
        next={<Decided court={court} />}
        beside={severalCourts() && <Aside court={aside} />}
        replays={replays}
      />
    </div>
  );
}

function severalCourts(): boolean {
  return (court.welcome.value?.courts.length ?? 0) > 1;
}
