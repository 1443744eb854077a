/** The picture: the robot in the posture of the active row, or in the shown trial. */

import { computed, type ReadonlySignal, useComputed } from "@preact/signals";
import { useMemo } from "preact/hooks";
import { bodyOf, jointsOfLeg } from "../../../core/design/parts";
import { type Source, trialSource } from "../../../core/design/sources";
import { floorMarks, pathOf } from "../../../core/design/trial";
import { quality } from "../../../core/settings";
import type { RobotReply } from "../../../core/wire";
import { t } from "../../../i18n";
import { type FloorMarks, View } from "../../../scene/View";
import { isNarrow } from "../../../ui/screen";
import { qualityOfAddress } from "../../watch/flags";
import { rowName } from "../names";
import type { Sheet } from "../table/sheet";
import type { Tried } from "../trials/tried";
import { Feet } from "./feet";
import { FeetLayer } from "./feet_layer";
import type { Showing } from "./showing";
import "./stage.css";

const LEG_GLOW = 0.5;
const fineness = qualityOfAddress() ?? quality;

interface Props {
  picture: Source;
  robot: ReadonlySignal<RobotReply | null>;
  sheet: Sheet;
  showing: Showing;
  /** Called with the canvas after each picture. */
  onDrawn: (canvas: HTMLCanvasElement) => void;
}

/** The robot, in the posture of the active row or in the shown trial. */
export function Stage({ picture, robot, sheet, showing, onDrawn }: Props) {
  const lit = useComputed(() => {
    const scene = picture.scene.value;
    const legs = robot.value?.legs.length ?? 0;
    const joints = sheet.lit.value;
    const glow = new Map<number, number>();
    if (!scene) return glow;
    // The root link is short: the whole leg shows where it is.
    for (const joint of joints.flatMap((one) => jointsOfLeg(one % legs, legs))) {
      glow.set(bodyOf(scene, joint), LEG_GLOW);
    }
    for (const joint of joints) glow.set(bodyOf(scene, joint), 1);
    return glow;
  }).value;
  const isWatching = showing.watching.value;
  const other = showing.other.value;
  const ghost = useMemo(() => (other ? ghostOf(showing, other) : null), [showing, other]);
  const marks = useMemo(() => marksOf(showing), [showing]);
  const feet = useMemo(() => new Feet(sheet, robot), [sheet, robot]);
  return (
    <section class="stage" aria-label={t("design.view")}>
      <View
        source={picture}
        camera="robot"
        quality={fineness}
        orbit={!isNarrow.value}
        lit={lit}
        ghost={isWatching ? ghost : null}
        marks={marks}
        annotations={isWatching ? null : feet}
        onDrawn={onDrawn}
        onJoint={(joint) => sheet.point(joint === null ? [] : [joint])}
        onPick={({ joint }) => {
          if (joint !== undefined) sheet.selectBeside(sheet.active.peek().row, joint);
        }}
        label={t("design.view")}
      />
      {!isWatching && <FeetLayer feet={feet} />}
      {!sheet.table.value && <p class="loading">{t("design.loading")}</p>}
      <p class="shows">
        <ShownName sheet={sheet} showing={showing} />
      </p>
      {showing.shown.value && (
        <fieldset class="modes" aria-label={t("design.shows")}>
          <button type="button" aria-pressed={!isWatching} onClick={() => showing.rest()}>
            {t("design.mode.posture")}
          </button>
          <button type="button" aria-pressed={isWatching} onClick={() => showing.watch()}>
            {t("design.mode.trial")}
          </button>
        </fieldset>
      )}
    </section>
  );
}

function ShownName({ sheet, showing }: Pick<Props, "sheet" | "showing">) {
  const tried = showing.shown.value;
  if (showing.watching.value && tried) {
    const other = showing.other.value;
    const name = tried.name || t("design.trialOf", { number: tried.number, key: tried.key });
    return <>{other ? t("design.withGhost", { name, number: other.number }) : name}</>;
  }
  const table = sheet.table.value;
  const row = table?.rows[sheet.active.value.row];
  if (!table || !row) return null;
  return <>{t("design.postureOf", { name: rowName(row, table.kind === "locomotion") })}</>;
}

function ghostOf(showing: Showing, other: Tried) {
  const tick = computed(() => Math.min(showing.tick.value, other.trial.ticks - 1));
  return trialSource(other.robot, other.trial, tick).sample;
}

/** The way of the robot and what carries it now, for each picture of a trial. */
function marksOf(showing: Showing): () => FloorMarks | null {
  let way: { of: Tried; points: Float32Array } | null = null;
  return () => {
    const tried = showing.shown.peek();
    if (!tried || !showing.watching.peek() || !tried.trial.ticks) return null;
    if (way?.of !== tried) {
      way = { of: tried, points: new Float32Array(pathOf(tried.trial).flat()) };
    }
    return floorMarks(tried.trial, Math.floor(showing.tick.peek()), way.points);
  };
}
