/** The broadcast's page: a browser source of OBS. It takes no input and heals by itself. */

import { effect, signal, useComputed } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { amount, flag } from "../core/address";
import { Between } from "../core/between";
import { followColours } from "../core/colours";
import { Court } from "../core/court";
import { inPieces } from "../core/pieces";
import { reloadWhenServed } from "../core/reload";
import { Replays } from "../core/replays";
import { USUAL_HZ } from "../core/wire";
import { t } from "../i18n";
import { isOver, waitsFor } from "../ui/banner";
import { LatestResults, OnAir } from "../ui/on_air";
import { Aside } from "./watch/aside";
import { Broadcast, type Style, scaleOfWindow } from "./watch/broadcast";
import { EventCard, useEvent } from "./watch/event";
import { cameraOfAddress, DELAY_MOST_S, qualityOfAddress } from "./watch/flags";
import { Decided } from "./watch/next";

/** For so long a stream shows the result; then what comes next. */
const READ_MS = 15_000;

const court = new Court(
  USUAL_HZ,
  1000 * amount("delay", 0, 0, DELAY_MOST_S),
  flag("director", false) ? "director" : "court",
  inPieces,
);
/** The director's second picture. */
const aside = court.directed ? new Court(USUAL_HZ, court.delayMs, "aside", inPieces) : null;
const replays = new Replays(court);
const between = new Between(court, court);
between.beginAfter(READ_MS);
const style: Style = {
  camera: cameraOfAddress(),
  quality: qualityOfAddress() ?? "auto",
  transparent: flag("transparent", false),
  hud: flag("hud", true),
  split: flag("split", false),
};
const scale = signal(scaleOfWindow());

followColours(court);
addEventListener("resize", () => {
  scale.value = scaleOfWindow();
});
effect(() => {
  if (court.outdated.value) void reloadWhenServed();
});
document.documentElement.classList.add("broadcast");
document.documentElement.classList.toggle("transparent", style.transparent);

export default function Overlay() {
  const over = useComputed(() => isOver(court)).value;
  useEvent(court);
  const stale = court.begun.value && !court.live.value && !over;
  useEffect(() => {
    document.title = "LACOC";
  }, []);
  return (
    <main class={`overlay${stale ? " stale" : ""}`} style={`--scale: ${scale.value}`}>
      <Broadcast
        match={court}
        style={style}
        scale={scale}
        before={between.isOn.value && <EventCard court={court} />}
        belowScore={<OnAir court={court} withMatch />}
        next={court.welcome.value?.desk ? <Decided court={court} /> : undefined}
        inCentre={<LatestResults court={court} />}
        replays={replays}
        beside={aside && <Aside court={aside} />}
      />
      <Waiting />
    </main>
  );
}

/** In a corner: viewers of a stream need no alarm, its operator needs to see it. */
function Waiting() {
  const over = useComputed(() => isOver(court)).value;
  const shown = court.begun.value && (court.live.value || over);
  const text = shown ? "" : waitsFor(court) || t("link.connecting");
  return text ? (
    <p class="waits" role="status">
      {text}
    </p>
  ) : null;
}
