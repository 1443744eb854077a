/** The spectators' page: the match as a broadcast shows it; nothing here changes the match. */

import { computed, signal } from "@preact/signals";
import { amount, flag, goToCourt, setting } from "../core/address";
import { Between } from "../core/between";
import { followColours } from "../core/colours";
import { Court } from "../core/court";
import { inPieces } from "../core/pieces";
import { Replays } from "../core/replays";
import { Rewind } from "../core/rewind";
import { quality, remembered } from "../core/settings";
import { LEAST_HZ, MOST_HZ, USUAL_HZ } from "../core/wire";
import { t } from "../i18n";
import { played, team } from "../i18n/words";
import { View } from "../scene/View";
import { isOver, LinkBanner, waitsFor } from "../ui/banner";
import { Board } from "../ui/board";
import { ChanceBar } from "../ui/chance";
import { Introductions } from "../ui/introductions";
import { KeyHelp } from "../ui/key_help";
import { EventLog } from "../ui/log";
import { LatestResults, OnAir } from "../ui/on_air";
import { Countdown, OpeningCard, useOpening } from "../ui/opening";
import { ResultCard } from "../ui/result";
import { Hint, ScoreBug } from "../ui/score";
import { isNarrow, tellHeight } from "../ui/screen";
import { useShortcuts } from "../ui/shortcuts";
import { Sound } from "../ui/sound";
import { Thirds } from "../ui/thirds";
import { Again, againKeys, againRows } from "./watch/again";
import { Aside } from "./watch/aside";
import { Cameras, cameraKeys, cameraRows } from "./watch/cameras";
import { Cheers, CheersSetting, Watching } from "./watch/cheers";
import { Corner, CornerSettings, cornerKeys, cornerRows } from "./watch/corner";
import { EventCard, useEvent } from "./watch/event";
import { cameraOfAddress, DELAY_MOST_S, qualityOfAddress } from "./watch/flags";
import { NextOfTeams } from "./watch/next";
import "./watch/frame.css";

const WIDE_PX = 1280;
/** Stands for the director in the list of courts, whose names are never empty. */
const DIRECTOR = "";

const court = new Court(
  amount("hz", USUAL_HZ, LEAST_HZ, MOST_HZ),
  1000 * amount("delay", 0, 0, DELAY_MOST_S),
  flag("director", false) ? "director" : "court",
  inPieces,
);
/** What is shown of it: live, or some time behind. */
const shown = court.directed ? new Replays(court).rewind : new Rewind(court);
/** The director's second picture. */
const aside = court.directed ? new Court(USUAL_HZ, court.delayMs, "aside", inPieces) : null;
const camera = signal(cameraOfAddress());
const fineness = qualityOfAddress() ?? quality;
const panel = remembered("watch.panel", innerWidth >= WIDE_PX);
const between = new Between(court, shown);
const footPx = signal(52);
/** After the end of a match its last picture does not count as old. */
const isStale = computed(() => court.begun.value && !court.live.value && !isOver(court));
const title = computed(() => {
  const sheet = court.sheet.value;
  const scores = court.frame.value?.seats.map((seat) => seat.score).join(" : ");
  if (!sheet || !scores || sheet.seats.length < 2) return "LACOC";
  return `${scores} · ${team(sheet, 0)} – ${team(sheet, 1)}`;
});
followColours(court);
title.subscribe((text) => {
  document.title = text;
});

const SHORTCUTS = {
  ...cameraKeys(camera, () => court.sheet.peek()),
  ...cornerKeys(panel),
  ...againKeys(shown),
};

export default function Watch() {
  useShortcuts(SHORTCUTS);
  useEvent(court);
  const hud = flag("hud", true);
  const beside = !isNarrow.value && panel.value && hud;
  const opening = useOpening(shown);
  const isShown = court.begun.value || !court.directed;
  const inset = !hud
    ? {}
    : isNarrow.value
      ? { top: opening ? 64 : 92, bottom: 8 }
      : {
          top: opening ? 78 : 108,
          bottom: opening ? 272 : footPx.value + 20,
          right: beside ? 314 : 0,
        };
  return (
    <main class="show watch">
      <div class={`scene${isStale.value ? " stale" : ""}`}>
        <View
          source={shown}
          camera={camera.value}
          quality={fineness}
          inset={inset}
          labels
          orbit={!isNarrow.value}
          label={t("watch.view")}
        />
      </div>
      {!court.begun.value && <Waiting />}
      {hud && <Hud />}
      {hud && isShown && (isNarrow.value || panel.value) && <Panel />}
      <LinkBanner court={court} />
      <Sound match={shown} />
      <CornerSettings>
        <CheersSetting />
      </CornerSettings>
      <KeyHelp rows={() => [...cameraRows(court.sheet.value), ...againRows(), ...cornerRows()]} />
    </main>
  );
}

function Hud() {
  return (
    <>
      <div class="top">
        <Brand />
        <header class="head">
          <ScoreBug match={shown} />
          <ChanceBar match={shown} />
          <Hint match={shown} />
          <OnAir court={court} />
        </header>
      </div>
      <Corner panel={panel} />
      <div class="middle-stage">
        <Countdown match={shown} />
        {!between.isRead.value && (
          <ResultCard
            match={shown}
            withReplay
            isLast={!court.live.value}
            next={court.welcome.value?.desk ? <NextOfTeams court={court} /> : undefined}
            onClose={() => between.begin()}
          />
        )}
        <LatestResults court={court} />
      </div>
      <div class="before">
        {court.begun.value &&
          (between.isOn.value ? <EventCard court={court} /> : <OpeningCard match={shown} />)}
      </div>
      <div class="lower">
        <Introductions match={shown} />
        <Thirds match={shown} />
      </div>
      {aside && <Aside court={aside} />}
      <div class="foot" ref={tellFoot}>
        {(court.begun.value || !court.directed) && (
          <Cameras camera={camera} sheet={court.sheet.value} />
        )}
        {court.begun.value && <Again rewind={shown} />}
        {court.begun.value && <Watching court={court} />}
        {court.begun.value && <Cheers court={court} />}
      </div>
    </>
  );
}

/** What stands above the foot, as the field does, needs to know how high it is: cheers make it two rows. */
const tellFoot = (foot: HTMLElement | null) =>
  tellHeight("--foot", foot, (px) => {
    footPx.value = px;
  });

/** Which court and match this is; with several courts, the way to another one. */
function Brand() {
  const sheet = court.sheet.value;
  const courts = court.welcome.value?.courts ?? [];
  const current = court.welcome.value?.court ?? setting("court");
  const delay = court.behindMs.value / 1000;
  return (
    <div class="corner left">
      <a class="brand" href="./">
        <b>{court.welcome.value?.contest || "LACOC"}</b>
        <small>
          {sheet && played(sheet)}
          {sheet && !sheet.fixture && <span> · {t("watch.match", { number: sheet.match })}</span>}
          {sheet && delay > 0 && " · "}
          {delay > 0 && <span>{t("watch.delayed", { seconds: delay })}</span>}
        </small>
      </a>
      {courts.length > 1 && (
        <label class="field">
          <span class="hidden-text">{t("watch.court")}</span>
          <select
            value={court.directed ? DIRECTOR : current}
            onChange={({ currentTarget: { value } }) =>
              goToCourt(value === DIRECTOR ? null : value)
            }
          >
            <option value={DIRECTOR}>{t("director.name")}</option>
            {courts.map((name) => (
              <option key={name}>{name}</option>
            ))}
          </select>
        </label>
      )}
    </div>
  );
}

function Panel() {
  return (
    <aside class="panel" aria-label={t("watch.panel")}>
      <Board match={shown} />
      <h2>{t("log.title")}</h2>
      <EventLog match={shown} toldElsewhere />
    </aside>
  );
}

/** Shown before the first frame; if something is wrong, the banner says it. */
function Waiting() {
  if (court.directed) {
    return (
      <div class="waiting calm">
        <EventCard court={court} />
      </div>
    );
  }
  return (
    <div class="waiting">
      <h1>LACOC</h1>
      {!waitsFor(court) && <p class="muted">{t("link.connecting")}</p>}
    </div>
  );
}
