/** The broadcast's page: a browser source of OBS. It takes no input and heals by itself. */

import { computed, effect, signal, useComputed } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import { amount, flag } from "../core/address";
import { followColours } from "../core/colours";
import { Court } from "../core/court";
import { reloadWhenServed } from "../core/reload";
import { USUAL_HZ } from "../core/wire";
import { t } from "../i18n";
import { team } from "../i18n/words";
import { View } from "../scene/View";
import { isOver, waitsFor } from "../ui/banner";
import { Board } from "../ui/board";
import { Countdown, OpeningCard, useOpening } from "../ui/opening";
import { ResultCard } from "../ui/result";
import { Hint, ScoreBug } from "../ui/score";
import { Thirds } from "../ui/thirds";
import { cameraOfAddress, DELAY_MOST_S, qualityOfAddress } from "./watch/flags";
import "./overlay.css";

/** What is drawn has this size; on another screen it is scaled. */
const WIDTH_PX = 1920;
const HEIGHT_PX = 1080;

const court = new Court(USUAL_HZ, 1000 * amount("delay", 0, 0, DELAY_MOST_S));
const camera = cameraOfAddress();
const quality = qualityOfAddress() ?? "auto";
const transparent = flag("transparent", false);
const split = flag("split", false);
const hud = flag("hud", true);
const scale = signal(scaleOfWindow());

followColours(court);
addEventListener("resize", () => {
  scale.value = scaleOfWindow();
});
effect(() => {
  if (court.outdated.value) void reloadWhenServed();
});
document.documentElement.classList.add("broadcast");
document.documentElement.classList.toggle("transparent", transparent);

function scaleOfWindow(): number {
  return Math.min(innerWidth / WIDTH_PX, innerHeight / HEIGHT_PX);
}

export default function Overlay() {
  const seats = useMemo(() => computed(() => court.sheet.value?.seats.length ?? 0), []).value;
  const over = useComputed(() => isOver(court)).value;
  const stale = court.begun.value && !court.live.value && !over;
  useEffect(() => {
    document.title = "LACOC";
  }, []);
  return (
    <main class={`overlay${stale ? " stale" : ""}`} style={`--scale: ${scale.value}`}>
      {split && seats > 1 ? <Windows /> : <Whole />}
      {hud && <Hud />}
      <Waiting />
    </main>
  );
}

function Whole() {
  const edge = hud ? scale.value : 0;
  const opening = useOpening(court);
  return (
    <div class="picture">
      <View
        source={court}
        camera={camera}
        quality={quality}
        transparent={transparent}
        inset={{ top: (opening ? 140 : 190) * edge, bottom: (opening ? 370 : 30) * edge }}
        labels={hud}
        label={t("watch.view")}
      />
    </div>
  );
}

/** The workshop's server screen: each contestant's own window, side by side (Fig. 5-11). */
function Windows() {
  const sheet = court.sheet.value;
  return (
    <div class="windows">
      {sheet?.seats.map((seat, index) => (
        <section key={seat.id} class="window" data-seat={index} aria-label={team(sheet, index)}>
          <View
            source={court}
            camera="chase"
            seat={index}
            quality={quality}
            transparent={transparent}
            inset={{ top: 140 * scale.value }}
            label={team(sheet, index)}
          />
        </section>
      ))}
      {hud && sheet?.markers.length ? (
        <div class="inset">
          <Board match={court} />
        </div>
      ) : null}
    </div>
  );
}

function Hud() {
  return (
    <div class="sheet-of-1080">
      <header class="head">
        <ScoreBug match={court} />
        <Hint match={court} />
      </header>
      <div class="centre">
        <Countdown match={court} />
        <ResultCard match={court} />
      </div>
      <div class="before">
        <OpeningCard match={court} />
      </div>
      <div class="lower">
        <Thirds match={court} />
      </div>
    </div>
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
