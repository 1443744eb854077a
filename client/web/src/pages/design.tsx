/** The studio: a gait is designed here, and tried (workshop 3-2, 4-1, 4-2). */

import { computed, type Signal, signal, useComputed, useSignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import { bodyOf, jointsOfLeg } from "../core/design/parts";
import { trialSource } from "../core/design/sources";
import { pathOf, support } from "../core/design/trial";
import { quality } from "../core/settings";
import { type MessageName, said, t } from "../i18n";
import { type FloorMarks, View } from "../scene/View";
import { useDrop } from "../ui/drop";
import { IconButton } from "../ui/icons";
import { isNarrow } from "../ui/screen";
import { Settings } from "../ui/settings";
import { Toasts } from "../ui/toasts";
import { Bars } from "./design/bars";
import { Coach } from "./design/coach";
import { Result } from "./design/explain";
import { ConflictDialog, Files, TroubleDialog, takeFiles, usualName } from "./design/files";
import { Grid } from "./design/grid";
import { Foretell } from "./design/guess";
import { Keys, keyName, triedKeys } from "./design/keys";
import { PhaseDots, PhasePanel } from "./design/phases";
import { LegPicture, Robot } from "./design/robot";
import { rowName } from "./design/rows";
import { Strip } from "./design/strip";
import { type Pose, Studio, type Tried } from "./design/studio";
import { Trials } from "./design/trials";
import { qualityOfAddress } from "./watch/flags";
import "./design/design.css";

const TABS = ["trials", "phase", "coach", "robot"] as const;
const POSES: readonly Pose[] = ["A1", "A1, A2"];
type Tab = (typeof TABS)[number];

declare global {
  interface Window {
    /** What tests look at. */
    __studio?: Studio;
  }
}

const LEG_GLOW = 0.5;
const dragging = signal(false);
const fineness = qualityOfAddress() ?? quality;

export default function Design() {
  const studio = useMemo(() => new Studio(), []);
  const open = useSignal<"" | "files" | "settings">("");
  const asks = useSignal(false);
  const tab = useSignal<Tab>("trials");
  window.__studio = studio;
  const close = () => {
    open.value = "";
  };
  const tryIt = () => {
    asks.value = false;
    void studio.tryIt();
  };
  useKeys(studio, tryIt);
  useDrop(dragging, (files) => void takeFiles(studio, files));
  useLeaving(studio);
  useEffect(() => {
    document.title = `${studio.file.value.name || t("design.unnamed")} – LACOC`;
  }, [studio.file.value.name]);
  return (
    <main class="design">
      <Banner studio={studio} />
      <header class="bar">
        <FileButtons studio={studio} onFiles={() => (open.value = "files")} />
        <div class="where">
          <PhaseDots
            studio={studio}
            onOpen={() => {
              tab.value = "phase";
              // Where all stands below one another, the task would be out of sight.
              const show = () => document.getElementById("panel-phase")?.scrollIntoView();
              if (isNarrow.peek()) requestAnimationFrame(() => requestAnimationFrame(show));
            }}
          />
          <Task studio={studio} />
        </div>
        <div class="acts">
          <button
            class="button"
            type="button"
            aria-expanded={asks.value}
            title={t("design.predictHint")}
            onClick={() => {
              asks.value = !asks.value;
            }}
          >
            {t("design.predict")}
          </button>
          <KeyChooser studio={studio} />
          <button
            class="button strong try"
            type="button"
            disabled={!studio.present.value}
            aria-busy={studio.trying.value}
            title={t("design.tryKey")}
            onClick={tryIt}
          >
            {t(studio.trying.value ? "design.trying" : "design.try")}
            {!isNarrow.value && <kbd>Ctrl+Enter</kbd>}
          </button>
          <CompareButton studio={studio} />
          <IconButton
            name="settings"
            label={t("settings.title")}
            onClick={() => {
              open.value = "settings";
            }}
          />
        </div>
        {asks.value && (
          <Foretell
            studio={studio}
            onTry={tryIt}
            onClose={() => {
              asks.value = false;
            }}
          />
        )}
      </header>
      <div class="left">
        <Keys studio={studio} />
        <LegPicture studio={studio} />
      </div>
      <Stage studio={studio} />
      <section class="sheet" aria-label={t("design.grid")}>
        <Grid studio={studio} />
        <Strip studio={studio} />
      </section>
      <Bars studio={studio} />
      <Side studio={studio} tab={tab} onTry={tryIt} />
      {open.value === "files" && <Files studio={studio} onClose={close} />}
      {open.value === "settings" && <Settings onClose={close} />}
      <ConflictDialog studio={studio} />
      <TroubleDialog studio={studio} />
      {dragging.value && <div class="dropping">{t("design.drop")}</div>}
      <Toasts />
    </main>
  );
}

/** What the page waits for. */
function Banner({ studio }: { studio: Studio }) {
  const { open, attempt, refused } = studio.connection.state.value;
  const why = studio.why.value;
  const text = refused
    ? said(refused)
    : !open
      ? t(attempt > 1 ? "link.page" : "link.connecting", { attempt })
      : studio.present.value === false
        ? why
          ? said(why)
          : t("design.noStudio")
        : "";
  return text ? (
    <div class="banner" role="status">
      {text}
    </div>
  ) : null;
}

function FileButtons({ studio, onFiles }: { studio: Studio; onFiles: () => void }) {
  const history = studio.history.value;
  const name = studio.file.value.name;
  const isSaved = studio.isSaved.value;
  const undo = history?.undoName.value ?? "";
  const redo = history?.redoName.value ?? "";
  return (
    <div class="file">
      <IconButton name="open" label={t("design.files")} onClick={onFiles} />
      <button class="button name" type="button" title={t("design.files")} onClick={onFiles}>
        <b>{name || t("design.unnamed")}</b>
        <small class={isSaved ? "" : "unsaved"}>
          {t(isSaved ? (name ? "design.isSaved" : "design.notFile") : "design.unsaved")}
        </small>
      </button>
      <button
        class="button"
        type="button"
        disabled={isSaved && name !== ""}
        title={t("design.saveKey")}
        onClick={() => void studio.save(usualName(studio))}
      >
        {t("design.save")}
      </button>
      <button
        class="button icon-button"
        type="button"
        disabled={!history?.canUndo.value}
        aria-label={t("design.undo", { what: undo })}
        title={`${t("design.undo", { what: undo })} (Ctrl+Z)`}
        onClick={() => studio.undo()}
      >
        <Arrow />
      </button>
      <button
        class="button icon-button"
        type="button"
        disabled={!history?.canRedo.value}
        aria-label={t("design.redo", { what: redo })}
        title={`${t("design.redo", { what: redo })} (Ctrl+Y)`}
        onClick={() => studio.redo()}
      >
        <Arrow turned />
      </button>
    </div>
  );
}

function Arrow({ turned = false }: { turned?: boolean }) {
  return (
    <svg class={turned ? "arrow turned" : "arrow"} viewBox="0 0 24 24" aria-hidden="true">
      <path d="M9 5 4 10l5 5 M4 10h9a6 6 0 0 1 0 12h-3" transform="translate(0 -1.5)" />
    </svg>
  );
}

/** What to do next, in a sentence. */
function Task({ studio }: { studio: Studio }) {
  const name = useComputed<MessageName>(() => {
    if (studio.bad.value.length) return "design.task.bad";
    const last = studio.trials.value.at(-1);
    if (!last) return studio.history.value?.canUndo.value ? "design.task.try" : "design.task.edit";
    return last.version === studio.version.value ? "design.task.read" : "design.task.again";
  }).value;
  return (
    <p class="task" role="status">
      {t(name, { count: studio.bad.value.length })}
    </p>
  );
}

function KeyChooser({ studio }: { studio: Studio }) {
  const keys = triedKeys(studio);
  return (
    <label class="chooser">
      <span class="hidden-text">{t("design.pressed")}</span>
      <select
        value={studio.pose.value ?? studio.key.value}
        title={t("design.pressed")}
        onChange={(event) => {
          const { value } = event.currentTarget;
          const pose = POSES.find((one) => one === value) ?? null;
          studio.pose.value = pose;
          if (!pose) studio.key.value = Number(value);
        }}
      >
        {keys.map((key) => (
          <option key={key} value={key}>
            {t("design.keyOption", { name: keyName(key) })}
          </option>
        ))}
        {studio.table.value?.kind === "postures" &&
          POSES.map((pose) => (
            <option key={pose} value={pose}>
              {t("design.keyOption", { name: pose })}
            </option>
          ))}
      </select>
    </label>
  );
}

/** Compare the shown trial with the one before it, or stop comparing. */
function CompareButton({ studio }: { studio: Studio }) {
  const { shown, other } = studio;
  const before = useComputed(() => {
    const trials = studio.trials.value;
    const now = shown.value;
    return trials.findLast((one) => one !== now && (!now || one.number < now.number)) ?? null;
  }).value;
  return (
    <button
      class="button"
      type="button"
      aria-pressed={other.value !== null}
      disabled={!before && !other.value}
      title={t("design.compareHint")}
      onClick={() => {
        other.value = other.value ? null : before;
      }}
    >
      {t("design.compare")}
    </button>
  );
}

/** The robot, in the posture of the active row or in the shown trial. */
function Stage({ studio }: { studio: Studio }) {
  const lit = useComputed(() => {
    const scene = studio.picture.scene.value;
    const legs = studio.robot.value?.legs.length ?? 0;
    const joints = studio.lit.value;
    const glow = new Map<number, number>();
    if (!scene) return glow;
    // The root link is short: the whole leg shows where it is.
    for (const joint of joints.flatMap((one) => jointsOfLeg(one % legs, legs))) {
      glow.set(bodyOf(scene, joint), LEG_GLOW);
    }
    for (const joint of joints) glow.set(bodyOf(scene, joint), 1);
    return glow;
  }).value;
  const isWatching = studio.watching.value;
  const other = studio.other.value;
  const ghost = useMemo(() => (other ? ghostOf(studio, other) : null), [studio, other]);
  const marks = useMemo(() => marksOf(studio), [studio]);
  return (
    <section class="stage" aria-label={t("design.view")}>
      <View
        source={studio.picture}
        camera="robot"
        quality={fineness}
        orbit={!isNarrow.value}
        lit={lit}
        ghost={isWatching ? ghost : null}
        marks={marks}
        onJoint={(joint) => studio.point(joint === null ? [] : [joint])}
        onPick={({ joint }) => {
          if (joint !== undefined) studio.selectBeside(studio.active.peek().row, joint);
        }}
        label={t("design.view")}
      />
      {!studio.table.value && <p class="loading">{t("design.loading")}</p>}
      <p class="shows">
        <ShownName studio={studio} />
      </p>
      {studio.shown.value && (
        <fieldset class="modes" aria-label={t("design.shows")}>
          <button
            type="button"
            aria-pressed={!isWatching}
            onClick={() => {
              studio.clock.pause();
              studio.watching.value = false;
            }}
          >
            {t("design.mode.posture")}
          </button>
          <button
            type="button"
            aria-pressed={isWatching}
            onClick={() => {
              studio.watching.value = true;
            }}
          >
            {t("design.mode.trial")}
          </button>
        </fieldset>
      )}
    </section>
  );
}

function ShownName({ studio }: { studio: Studio }) {
  const tried = studio.shown.value;
  if (studio.watching.value && tried) {
    const other = studio.other.value;
    const name = t("design.trialOf", { number: tried.number, key: tried.key });
    return <>{other ? t("design.withGhost", { name, number: other.number }) : name}</>;
  }
  const table = studio.table.value;
  const row = table?.rows[studio.active.value.row];
  if (!table || !row) return null;
  return <>{t("design.postureOf", { name: rowName(row, table.kind === "locomotion") })}</>;
}

function ghostOf(studio: Studio, other: Tried) {
  const tick = computed(() => Math.min(studio.clock.tick.value, other.trial.ticks - 1));
  return trialSource(other.robot, other.trial, tick).sample;
}

/** The way of the robot and what carries it now, for each picture of a trial. */
function marksOf(studio: Studio): () => FloorMarks | null {
  let way: { of: Tried; points: Float32Array } | null = null;
  return () => {
    const tried = studio.shown.peek();
    if (!tried || !studio.watching.peek() || !tried.trial.ticks) return null;
    if (way?.of !== tried) {
      way = { of: tried, points: new Float32Array(pathOf(tried.trial).flat()) };
    }
    const tick = Math.floor(studio.clock.tick.peek());
    const { corners, centre, marginM } = support(tried.trial, tick);
    return {
      polygon: corners,
      centre,
      isStable: marginM !== null && marginM > 0,
      way: way.points,
      done: tick,
    };
  };
}

/** What a trial showed, and below it the tabs. */
function Side({ studio, tab, onTry }: { studio: Studio; tab: Signal<Tab>; onTry: () => void }) {
  return (
    <aside class="side">
      <Result studio={studio} />
      <div class="tabs" role="tablist" aria-label={t("design.more.title")}>
        {TABS.map((name, index) => (
          <button
            key={name}
            id={`tab-${name}`}
            type="button"
            role="tab"
            aria-selected={tab.value === name}
            aria-controls={`panel-${name}`}
            tabIndex={tab.value === name ? 0 : -1}
            onClick={() => {
              tab.value = name;
            }}
            onKeyDown={(event) => {
              const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
              if (!by) return;
              tab.value = TABS[(index + by + TABS.length) % TABS.length]!;
              document.getElementById(`tab-${tab.value}`)?.focus();
            }}
          >
            {t(`design.tab.${name}`)}
            {name === "trials" && studio.trials.value.length > 0 && (
              <small> {studio.trials.value.length}</small>
            )}
          </button>
        ))}
      </div>
      <div
        id={`panel-${tab.value}`}
        role="tabpanel"
        aria-labelledby={`tab-${tab.value}`}
        class="panel"
      >
        {tab.value === "trials" && <Trials studio={studio} />}
        {tab.value === "phase" && <PhasePanel studio={studio} onTry={onTry} />}
        {tab.value === "coach" && <Coach studio={studio} />}
        {tab.value === "robot" && <Robot studio={studio} />}
      </div>
    </aside>
  );
}

/** Keys that work wherever the focus is. */
function useKeys(studio: Studio, tryIt: () => void): void {
  useEffect(() => {
    const press = (event: KeyboardEvent) => {
      if (event.isComposing || !(event.ctrlKey || event.metaKey) || event.altKey) return;
      if (document.querySelector("dialog[open]")) return;
      const key = event.key.toLowerCase();
      // A field other than the grid's has an undo of its own.
      const isField = (event.target as HTMLElement).matches(
        "input:not(.cell-input):not([type=range])",
      );
      if (key === "enter") tryIt();
      else if (key === "s") void studio.save(usualName(studio));
      else if (key === "z" && !isField) event.shiftKey ? studio.redo() : studio.undo();
      else if (key === "y" && !isField) studio.redo();
      else return;
      event.preventDefault();
    };
    addEventListener("keydown", press);
    return () => removeEventListener("keydown", press);
  }, [studio]);
}

/** Ask before a table is lost. */
function useLeaving(studio: Studio): void {
  useEffect(() => {
    const leave = (event: BeforeUnloadEvent) => {
      if (!studio.isSaved.peek()) event.preventDefault();
    };
    addEventListener("beforeunload", leave);
    return () => removeEventListener("beforeunload", leave);
  }, [studio]);
}
