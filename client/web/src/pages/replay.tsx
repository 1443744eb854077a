/** Recordings: from the server's folder or this machine, without any court. */

import { effect, signal, useComputed, useSignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import { ownPage, runKey, setting } from "../core/address";
import { followColours } from "../core/colours";
import { mayFork } from "../core/forks";
import type { Note, RecordFile } from "../core/record";
import { BadRecord, dropped, fetched, oddsOf, readBeside } from "../core/record_files";
import { Recording } from "../core/recording";
import { quality, remembered } from "../core/settings";
import { type MessageName, t } from "../i18n";
import { BEATS_PER_S, logClock, team } from "../i18n/words";
import { View } from "../scene/View";
import { Board } from "../ui/board";
import { copy } from "../ui/copy";
import { Dropping, useDrop } from "../ui/drop";
import { Icon, IconButton } from "../ui/icons";
import { KeyHelp, type KeyRow } from "../ui/key_help";
import { Countdown } from "../ui/opening";
import { PlayButton, SpeedChooser } from "../ui/playback";
import { ResultCard } from "../ui/result";
import { Hint, ScoreBug } from "../ui/score";
import { isNarrow } from "../ui/screen";
import { useShortcuts } from "../ui/shortcuts";
import { Sound } from "../ui/sound";
import { Thirds } from "../ui/thirds";
import { Toasts, toast } from "../ui/toasts";
import { SeekBar, seconds } from "./replay/bar";
import { Chooser, troubleText } from "./replay/chooser";
import { ForkNote, LineScore } from "./replay/fork";
import { ForkHere } from "./replay/fork_here";
import { ReplayLog } from "./replay/log";
import { ChancesNow, Highlights } from "./replay/odds";
import { Player, SPEEDS } from "./replay/player";
import { Cameras, cameraKeys, cameraRows } from "./watch/cameras";
import { Corner, CornerSettings, cornerKeys, cornerRows } from "./watch/corner";
import { cameraOfAddress, qualityOfAddress } from "./watch/flags";
import "./watch/frame.css";
import "./replay/replay.css";

// The list's link has the key in its fragment; the address of a recording has none.
runKey();

const WIDE_PX = 1280;
/** A new fork is shown from so long before its first own beat. */
const SEEN_BEFORE_BEATS = BEATS_PER_S;

/** What the page is about now. */
type State =
  | { is: "choosing"; trouble: BadRecord | null }
  | { is: "loading"; name: string; part: number }
  | { is: "open"; player: Player; server: string | null };

declare global {
  interface Window {
    /** What tests look at. */
    __replay?: Player | undefined;
  }
}

const state = signal<State>({ is: "choosing", trouble: null });
const camera = signal(cameraOfAddress());
const fineness = qualityOfAddress() ?? quality;
const panel = remembered("replay.panel", innerWidth >= WIDE_PX);
const dragging = signal(false);
/** Counts what was opened, so that an older one that arrives late is not shown. */
let opening = 0;
let unfollow = () => {};

effect(() => {
  const now = state.value;
  window.__replay = now.is === "open" ? now.player : undefined;
  document.title =
    now.is === "open" ? titleOf(now.player.recording) : `${t("replay.title")} – LACOC`;
});

/**
 * Open a recording and show it; without a beat it plays from its beginning.
 *
 * @param get Gets the files; its argument tells whether they are still wanted.
 * @param server Name of the recording on the server; null: it is from this machine.
 * @param beside Whether the origin of a fork is shown beside it.
 */
async function show(
  get: (fresh: () => boolean) => Promise<RecordFile[]>,
  server: string | null,
  beat: number | null,
  beside = false,
) {
  const mine = ++opening;
  const fresh = () => mine === opening;
  try {
    const files = await get(fresh);
    if (!fresh()) return;
    state.value = { is: "loading", name: "", part: 1 };
    const recording = new Recording(await readBeside(files));
    if (!fresh()) return;
    const player = new Player(recording);
    if (beat !== null) player.seek(beat);
    unfollow();
    unfollow = followColours(recording);
    state.value = { is: "open", player, server };
    if (server !== null) {
      const odds = await oddsOf(server, recording.record.header.match_id).catch(() => null);
      if (!fresh()) return;
      if (odds) player.odds.value = odds;
    }
    if (beside) await showBeside(player);
    if (beat === null || beside) player.play();
  } catch (error) {
    if (!fresh()) return;
    const trouble =
      error instanceof BadRecord ? error : new BadRecord("fault", { error: String(error) });
    state.value = { is: "choosing", trouble };
  }
}

/** Show the origin of a fork beside it, at the same beat; or take it away again. */
async function showBeside(player: Player): Promise<void> {
  const { origin } = player.recording.record.header.setup;
  if (player.beside.value || !origin) {
    player.beside.value = null;
    return;
  }
  try {
    const files = await fetched(`${origin.match_id}.mcap`, () => {});
    player.beside.value = new Recording(await readBeside(files));
  } catch (error) {
    const trouble =
      error instanceof BadRecord ? error : new BadRecord("fault", { error: String(error) });
    toast(() => troubleText(trouble), "no");
  }
}

function titleOf({ record }: Recording): string {
  const last = record.sheets.at(-1)!.value;
  const [left, right] = last.seats.map((_, index) => team(last, index));
  return right ? `${left} – ${right}` : `LACOC ${record.header.match_id}`;
}

function openServer(name: string, beat: number | null, push: boolean, beside = false): void {
  if (push) history.pushState(null, "", `?file=${encodeURIComponent(name)}`);
  state.value = { is: "loading", name, part: 0 };
  const get = (fresh: () => boolean) =>
    fetched(name, (part) => {
      if (fresh()) state.value = { is: "loading", name, part };
    });
  void show(get, name, beat, beside);
}

function openFiles(files: readonly File[]): void {
  if (!files.length) return;
  history.pushState(null, "", location.pathname);
  state.value = { is: "loading", name: files[0]!.name, part: 0 };
  void show(() => dropped(files), null, null);
}

/** What the address says: a recording and a moment, or the list. */
function followAddress(): void {
  const query = new URLSearchParams(location.search);
  const file = query.get("file");
  const time = Number(query.get("t") ?? Number.NaN);
  const beat = Number.isFinite(time) ? Math.round(time * BEATS_PER_S) : null;
  opening++;
  if (file) openServer(file, beat, false);
  else {
    if (state.value.is === "open") state.value.player.pause();
    state.value = { is: "choosing", trouble: null };
  }
}

if (setting("file")) followAddress();
addEventListener("popstate", followAddress);

export default function Replay() {
  useDrop(dragging, openFiles);
  const now = state.value;
  return (
    <>
      {now.is === "choosing" && (
        <main class="replay choosing">
          <Chooser
            trouble={now.trouble}
            onServer={(name) => openServer(name, null, true)}
            onFiles={openFiles}
          />
        </main>
      )}
      {now.is === "loading" && <Loading name={now.name} part={now.part} />}
      {now.is === "open" && <Show key={now.player} player={now.player} server={now.server} />}
      <Dropping dragging={dragging}>{t("replay.drop")}</Dropping>
      <Toasts />
    </>
  );
}

function Loading({ name, part }: { name: string; part: number }) {
  const text = part < 1 ? t("replay.loading", { name }) : t("replay.reading");
  return (
    <main class="replay choosing">
      <p role="status">{text}</p>
      <progress value={part < 1 ? part : undefined} aria-label={text} />
    </main>
  );
}

function Show({ player, server }: { player: Player; server: string | null }) {
  const { recording } = player;
  /** The beat from which the open dialog goes on; null: it is closed. */
  const forking = useSignal<number | null>(null);
  useShortcuts(useMemo(() => shortcutsOf(player), [player]));
  useEffect(() => () => player.pause(), [player]);
  const other = player.beside.value;
  useEffect(() => (other ? effect(() => other.seek(recording.beat.value)) : undefined), [other]);
  const narrow = isNarrow.value;
  const forkBeat = forking.value;
  const others = t(ownPage ? "home.contest" : "replay.others");
  const beside = panel.value && !narrow;
  const inset = narrow
    ? { top: other ? 170 : 92, bottom: other ? 40 : 8 }
    : { top: 100, bottom: 186, right: beside && !other ? 314 : 0 };
  return (
    <main class="show replay">
      <div class={`scene${other ? " two" : ""}`}>
        <div class="line">
          <View
            source={recording}
            camera={camera.value}
            quality={fineness}
            inset={inset}
            labels
            orbit={!narrow}
            label={other ? t("replay.besideFork") : t("watch.view")}
          />
          {other && <LineScore name={t("replay.besideFork")} match={recording} />}
        </div>
        {other && (
          <div class="line" key={other}>
            <View
              source={other}
              camera={camera.value}
              quality={fineness}
              inset={narrow ? { top: 8, bottom: 40 } : inset}
              labels
              orbit={!narrow}
              label={t("replay.besideOrigin")}
            />
            <LineScore name={t("replay.besideOrigin")} match={other} />
          </div>
        )}
      </div>
      <div class="top">
        <div class="corner left">
          <a class="button others" href={ownPage ? "./" : "replay"} title={others}>
            <Icon name="open" />
            <span>{others}</span>
          </a>
        </div>
        <header class="head">
          <ScoreBug match={recording} />
          <ForkNote
            recording={recording}
            beside={player.beside}
            server={server}
            {...(server !== null && { onBeside: () => void showBeside(player) })}
          />
          <Notes recording={recording} />
          <Hint match={recording} />
        </header>
      </div>
      <Corner panel={panel}>
        {server !== null && mayFork() && (
          <IconButton
            name="fork"
            label={t("fork.here")}
            onClick={() => {
              player.pause();
              // All matches begin with beat 0: it can't differ.
              forking.value = Math.max(1, Math.floor(recording.beat.value));
            }}
          />
        )}
        <IconButton name="link" label={t("replay.share")} onClick={() => share(player, server)} />
      </Corner>
      <div class="middle-stage">
        <Countdown match={recording} />
        <Sound match={recording} />
        <ResultCard match={recording} isLast />
      </div>
      <div class="lower">
        <Thirds match={recording} />
      </div>
      <div class="foot">
        <Cameras camera={camera} sheet={recording.sheet.value} />
        <Transport player={player} />
      </div>
      {(narrow || panel.value) && (
        <aside class="panel" aria-label={t("watch.panel")}>
          <Board match={recording} />
          {player.odds.value && <Highlights player={player} odds={player.odds.value} />}
          <h2>{t("log.title")}</h2>
          <ReplayLog player={player} />
        </aside>
      )}
      <CornerSettings />
      <KeyHelp rows={() => rowsOf(player)} />
      {server !== null && forkBeat !== null && (
        <ForkHere
          recording={recording}
          name={server}
          beat={forkBeat}
          onMade={(name) => openServer(name, forkBeat - SEEN_BEFORE_BEATS, true, true)}
          onClose={() => {
            forking.value = null;
          }}
        />
      )}
    </main>
  );
}

function Transport({ player }: { player: Player }) {
  return (
    <section class="transport" aria-label={t("replay.transport")}>
      <SeekBar player={player} />
      <div class="controls">
        <Step name="previous" onClick={() => player.jump(-1)} />
        <Step name="back" onClick={() => player.step(-1)} />
        <PlayButton playback={player} title={(what) => t("replay.playKey", { what })} />
        <Step name="ahead" onClick={() => player.step(1)} />
        <Step name="next" onClick={() => player.jump(1)} />
        <Position recording={player.recording} />
        {player.odds.value && <ChancesNow player={player} odds={player.odds.value} />}
        <SpeedChooser playback={player} speeds={SPEEDS} />
      </div>
    </section>
  );
}

/** A component of its own, because it is drawn again at each beat. */
function Position({ recording }: { recording: Recording }) {
  const { firstBeat, lastBeat } = recording;
  const beat = useComputed(() => Math.floor(recording.beat.value)).value;
  return (
    <span class="position">
      <b>{logClock(beat - firstBeat)}</b> / {seconds(lastBeat - firstBeat)}
    </span>
  );
}

interface StepProps {
  name: "previous" | "back" | "ahead" | "next";
  onClick: () => void;
}

function Step({ name, onClick }: StepProps) {
  const label = t(`replay.${name}` as MessageName);
  return <IconButton name={name} label={label} onClick={onClick} />;
}

function Notes({ recording }: { recording: Recording }) {
  const { notes } = recording.record;
  const hidden = useMemo(() => signal(false), [notes]);
  if (!notes.length || hidden.value) return null;
  return (
    <div class="notes" role="alert">
      {notes.map((note, index) => (
        <p key={index}>{noteText(note, recording)}</p>
      ))}
      <button
        class="button quiet"
        type="button"
        onClick={() => {
          hidden.value = true;
        }}
      >
        {t("replay.noteHide")}
      </button>
    </div>
  );
}

function noteText(note: Note, { firstBeat }: Recording): string {
  if (note.what === "gap") return t("replay.noteGap", { segment: note.segment + 1 });
  const name = note.what === "cut" ? "replay.noteCut" : "replay.noteDamaged";
  return t(name, { file: note.file, time: logClock(note.beat - firstBeat) });
}

function share(player: Player, server: string | null): void {
  if (server === null) {
    toast(t("replay.notShared"), "no");
    return;
  }
  player.pause();
  const time = (Math.floor(player.recording.beat.value) / BEATS_PER_S).toFixed(2);
  history.replaceState(null, "", `?file=${encodeURIComponent(server)}&t=${time}`);
  void copy(location.href);
}

function shortcutsOf(player: Player): Record<string, () => void> {
  const { recording } = player;
  return {
    ...cameraKeys(camera, () => recording.sheet.peek()),
    Space: () => player.toggle(),
    KeyK: () => player.toggle(),
    Comma: () => player.step(-1),
    Period: () => player.step(1),
    ArrowLeft: () => player.skip(-5),
    ArrowRight: () => player.skip(5),
    Home: () => player.seek(recording.firstBeat),
    End: () => player.seek(recording.lastBeat),
    KeyN: () => player.jump(1),
    KeyP: () => player.jump(-1),
    Minus: () => player.faster(-1),
    NumpadSubtract: () => player.faster(-1),
    Equal: () => player.faster(1),
    NumpadAdd: () => player.faster(1),
    ...cornerKeys(panel),
  };
}

function rowsOf({ recording }: Player): readonly KeyRow[] {
  return [
    [["Space", "K"], t("replay.keyPlay")],
    [["←", "→"], t("replay.keySkip")],
    [[",", "."], t("replay.keyStep")],
    [["N", "P"], t("replay.keyJump")],
    [["Home", "End"], t("replay.keyEnds")],
    [["-", "+"], t("replay.keySpeed")],
    ...cameraRows(recording.sheet.value),
    ...cornerRows(),
  ];
}
