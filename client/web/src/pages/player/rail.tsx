/** The right rail: ready, keys, board, events. */

import { useComputed } from "@preact/signals";
import { useMemo } from "preact/hooks";
import type { Court } from "../../core/court";
import { phaseOf } from "../../core/match";
import type { Player } from "../../core/player";
import type { TryOut } from "../../core/try_out";
import { type Event, Level, Phase, SeatFlag } from "../../core/wire";
import { t } from "../../i18n";
import { Board } from "../../ui/board";
import { Kbd } from "../../ui/kbd";
import { later } from "../../ui/later";
import { EventLog } from "../../ui/log";
import { useMedia } from "../../ui/screen";
import { Brief } from "./brief";
import { STACKED } from "./field";
import { FilesChanged } from "./files";
import { useLessons } from "./lessons";
import { Outcome } from "./outcome";
import { Pad } from "./pad";

/** Only practice has it. */
const Coach = later(() => import("./coach").then((it) => it.Coach));

interface Props {
  court: Court;
  player: Player;
  alone: boolean;
  tryOut: TryOut | null;
  onKey: (key: number, atMs: number) => void;
  onLevel: (level: number) => void;
  onView: () => void;
  onLeave: () => void;
  onLinkTest: () => void;
  onSave: () => void;
}

/** What the page shows elsewhere already. */
const QUIET = new Set(["phase", "key-refused", "heard"]);

/** Whether the log has an event. */
export function isTold(event: Event): boolean {
  return !QUIET.has(event.kind);
}

export function Rail(props: Props) {
  const { court, player, alone, onSave } = props;
  const progress = useLessons(court, player);
  const isStacked = useMedia(STACKED);
  return (
    <aside class="rail">
      {!alone && isStacked && <Outcome {...{ court, player, onSave }} isLast />}
      {alone ? <Coach court={court} player={player} progress={progress} /> : <Before {...props} />}
      <FilesChanged court={court} player={player} alone={alone} />
      <NoKeys court={court} player={player} />
      <div class="hands">
        <Pad {...props} hinted={alone ? progress.next : null} />
        <div class="map">
          <Board match={court} worth={player.gains.value?.points ?? null} />
        </div>
      </div>
      {!alone && (
        // biome-ignore lint/a11y/noNoninteractiveTabindex: what scrolls must be reached by keys
        <section class="events" aria-label={t("log.title")} tabIndex={0}>
          <EventLog match={court} most={30} only={isTold} toldElsewhere />
        </section>
      )}
    </aside>
  );
}

/** What there is to do before a match. */
function Before(props: Props) {
  const { court, player, onLinkTest } = props;
  const isStacked = useMedia(STACKED);
  const phase = useMemo(() => phaseOf(court), [court]).value;
  if (phase !== Phase.LOBBY && phase !== Phase.READY) return null;
  return (
    <>
      <Ready {...props} />
      {isStacked && <Brief court={court} player={player} />}
      <button class="button quiet small" type="button" onClick={onLinkTest}>
        {t("linktest.test")}
      </button>
    </>
  );
}

function Ready({ player }: Props) {
  const isReady = useMemo(
    () => player.part((seat) => Boolean(seat.flags & SeatFlag.READY), false),
    [player],
  ).value;
  const canSteer = player.canSteer.value;
  if (!isReady) {
    return (
      <button
        class="button strong ready"
        type="button"
        disabled={!canSteer}
        onClick={() => void player.ready(true)}
      >
        {t("ready.say")} <Kbd>r</Kbd>
      </button>
    );
  }
  return (
    <div class="ready said">
      <span>✓ {t("ready.said")}</span>
      <button
        class="button"
        type="button"
        disabled={!canSteer}
        onClick={() => void player.ready(false)}
      >
        {t("ready.takeBack")}
      </button>
    </div>
  );
}

/** A gait without keys at an open level can't walk: to be known before the match. */
function NoKeys({ court, player }: { court: Court; player: Player }) {
  const file = useComputed(() => {
    const sheet = court.sheet.value;
    const seat = sheet?.seats[player.index.value];
    if (!sheet || !seat?.robot) return "";
    if (sheet.levels.some((level) => seat.keys[level as 0 | 1]?.length)) return "";
    return sheet.levels.includes(Level.POSTURE) ? "Loco-data" : "LocoTra-data";
  }).value;
  return file ? (
    <p class="warning" role="alert">
      {t("files.noKey", { file })}
    </p>
  ) : null;
}
