/** A match as a broadcast shows it: the picture, and the score, clock and events over it. */

import { computed, type ReadonlySignal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useMemo } from "preact/hooks";
import type { Match } from "../../core/match";
import type { Replays } from "../../core/replays";
import type { Quality } from "../../core/settings";
import { t } from "../../i18n";
import { team } from "../../i18n/words";
import { type CameraName, type Shutter, View } from "../../scene/View";
import { Board } from "../../ui/board";
import { ChanceBar } from "../../ui/chance";
import { Introductions } from "../../ui/introductions";
import { Countdown, OpeningCard, useOpening } from "../../ui/opening";
import { ResultCard, useResult } from "../../ui/result";
import { Hint, ScoreBug } from "../../ui/score";
import { Sound } from "../../ui/sound";
import { Thirds } from "../../ui/thirds";
import "../../ui/on_air.css";
import "./broadcast.css";

/** What lies over the picture is made for this size; on another screen it is scaled. */
const WIDTH_PX = 1920;
const HEIGHT_PX = 1080;
/** In a tall window the score is as wide as the window: so many of these pixels. */
const SCORE_PX = 1560;
/** In a phone's window, smaller letters could not be read: what lies over the picture has this width. */
const PHONE_PX = 780;
const PHONE_SCALE = 0.5;

/** In a window that is wider than this the result stands beside the picture, not over it. */
const BESIDE = 1.3;
const CARD_PX = 1000;

/** How a broadcast is shown. */
export interface Style {
  camera: CameraName;
  quality: Quality;
  transparent: boolean;
  /** Score, clock, events and cards. */
  hud: boolean;
  /** Two windows, each behind one of the robots. */
  split: boolean;
  /** Says when to draw, for a film. */
  shutter?: Shutter;
}

interface Props {
  match: Match;
  style: Style;
  /** Pixels of the window for each pixel of a screen of 1920 x 1080. */
  scale: ReadonlySignal<number>;
}

/** What else a page shows over the picture. */
interface More {
  belowScore?: ComponentChildren;
  /** Stands for the card of the opening: between the matches of an event. */
  before?: ComponentChildren;
  inCentre?: ComponentChildren;
  /** Stands below an official result. */
  next?: ComponentChildren;
  beside?: ComponentChildren;
  /** Whether no other match follows. */
  isLast?: boolean;
  /** Shows moments again in pauses. */
  replays?: Replays;
}

/** The scale at which what lies over the picture fits into the window. */
export function scaleOfWindow(): number {
  const [width, height] = [innerWidth, innerHeight];
  return Math.max(
    Math.min(width / WIDTH_PX, height / HEIGHT_PX),
    Math.min(width, height) / SCORE_PX,
    width < height ? Math.min(width / PHONE_PX, PHONE_SCALE) : 0,
  );
}

export function Broadcast({ match, style, scale, ...more }: Props & More) {
  const seats = useMemo(() => computed(() => match.sheet.value?.seats.length ?? 0), [match]).value;
  const isSplit = style.split && seats > 1;
  const shown = more.replays?.rewind ?? match;
  const hasCard =
    useResult(match) && style.hud && !more.before && innerWidth > BESIDE * innerHeight;
  return (
    <>
      {isSplit ? (
        <Windows match={shown} style={style} scale={scale} />
      ) : (
        <Whole
          match={shown}
          style={style}
          scale={scale}
          hasCard={hasCard && !more.replays?.shown.value}
        />
      )}
      {style.hud && <Hud match={match} {...more} />}
    </>
  );
}

function Whole({ match, style, scale, hasCard }: Props & { hasCard: boolean }) {
  const { camera, quality, transparent, hud, shutter } = style;
  const edge = hud ? scale.value : 0;
  const opening = useOpening(match);
  return (
    <div class="picture">
      <View
        source={match}
        camera={camera}
        quality={quality}
        transparent={transparent}
        inset={{
          top: (opening ? 140 : 190) * edge,
          bottom: (opening ? 370 : 30) * edge,
          right: hasCard ? CARD_PX * edge : 0,
        }}
        labels={hud}
        label={t("watch.view")}
        {...(shutter && { shutter })}
      />
    </div>
  );
}

/** The workshop's server screen: each contestant's own window, side by side (Fig. 5-11). */
function Windows({ match, style, scale }: Props) {
  const { quality, transparent, hud, shutter } = style;
  const sheet = match.sheet.value;
  return (
    <div class="windows">
      {sheet?.seats.map((seat, index) => (
        <section key={seat.id} class="window" data-seat={index} aria-label={team(sheet, index)}>
          <View
            source={match}
            camera="chase"
            seat={index}
            quality={quality}
            transparent={transparent}
            inset={{ top: 140 * scale.value }}
            label={team(sheet, index)}
            {...(shutter && { shutter })}
          />
        </section>
      ))}
      {hud && sheet?.markers.length ? (
        <div class="inset">
          <Board match={match} />
        </div>
      ) : null}
    </div>
  );
}

type Told = { match: Match } & More;

/** Score and clock are those of now, also while the picture shows a moment again. */
function Hud({ match, belowScore, before, inCentre, next, beside, isLast = false, replays }: Told) {
  const isReplay = !!replays?.shown.value;
  return (
    <div class="hud">
      <header class="head">
        <ScoreBug match={match} />
        <ChanceBar match={match} />
        <Hint match={match} />
        {isReplay ? (
          <p class="on-air" data-why="replay" role="status">
            <b>{t("again.mark")}</b>
          </p>
        ) : (
          belowScore
        )}
      </header>
      <div class="centre">
        <Countdown match={match} />
        <Sound match={match} isQuiet />
        {!isReplay && !before && <ResultCard match={match} isLast={isLast} next={next} />}
        {!isReplay && inCentre}
      </div>
      <div class="before">{before || <OpeningCard match={match} />}</div>
      <div class="lower">
        <Introductions match={match} />
        <Thirds match={match} />
      </div>
      {beside}
    </div>
  );
}
