/** One student's robot walks on the big screen, with its foot bars and what explains its walk. */

import { useComputed, useSignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import { barsPath, looped } from "../../core/class";
import { Refused } from "../../core/connection";
import { trialSource } from "../../core/design/sources";
import {
  figure,
  floorMarks,
  footBars,
  pathOf,
  readTrial,
  type Trial,
} from "../../core/design/trial";
import type { Phrase } from "../../core/phrase";
import { quality } from "../../core/settings";
import { BEATS_PER_S, type RobotReply } from "../../core/wire";
import { said, t } from "../../i18n";
import { View } from "../../scene/View";
import { IconButton } from "../../ui/icons";
import { qualityOfAddress } from "../watch/flags";
import { speed } from "./card";
import { Frame } from "./frame";
import type { Teacher } from "./teacher";

interface Shown {
  robot: RobotReply;
  trial: Trial;
}

const fineness = qualityOfAddress() ?? quality;

export function Walk({ teacher, name }: { teacher: Teacher; name: string }) {
  const shown = useSignal<Shown | null>(null);
  const refused = useSignal<Phrase | string>("");
  useEffect(() => {
    let isWanted = true;
    shown.value = null;
    refused.value = "";
    teacher.show(name).then(
      ({ robot, trial }) => {
        if (isWanted) shown.value = { robot, trial: readTrial(trial, robot.legs.length) };
      },
      (error) => {
        if (isWanted) refused.value = error instanceof Refused ? error.why : String(error);
      },
    );
    return () => {
      isWanted = false;
    };
  }, [teacher, name, shown, refused]);
  const go = (by: number) => {
    const names = teacher.order.peek().map((card) => card.name);
    const index = names.indexOf(name);
    const next = names[(Math.max(0, index) + by + names.length) % names.length];
    if (next !== undefined) teacher.screen.value = { shows: "robot", name: next };
  };
  const label = teacher.name(name);
  return (
    <Frame
      label={label}
      onClose={() => {
        teacher.screen.value = null;
      }}
      back={() => document.querySelector(`[data-student="${CSS.escape(name)}"]`)}
      keys={{ ArrowRight: () => go(1), ArrowLeft: () => go(-1) }}
      buttons={
        <>
          <IconButton name="previous" label={t("class.screen.previous")} onClick={() => go(-1)} />
          <IconButton name="next" label={t("class.screen.next")} onClick={() => go(1)} />
        </>
      }
    >
      <div class="walking">
        <h2>{label}</h2>
        {shown.value ? (
          <Trying key={name} shown={shown.value} />
        ) : (
          <p class="waits" role="status">
            {refused.value ? teacher.reason(refused.value) : t("class.screen.wait")}
          </p>
        )}
      </div>
    </Frame>
  );
}

function Trying({ shown }: { shown: Shown }) {
  const { robot, trial } = shown;
  const tick = useSignal(0);
  const source = useMemo(() => trialSource(robot, trial, tick), [robot, trial, tick]);
  const marks = useMemo(() => {
    const way = new Float32Array(pathOf(trial).flat());
    return () => (trial.ticks ? floorMarks(trial, Math.floor(tick.peek()), way) : null);
  }, [trial, tick]);
  useEffect(() => repeat(trial, (now) => (tick.value = now)), [trial, tick]);
  const { explained, fault, figures } = trial.reply;
  const first = explained[0];
  return (
    <>
      <div class="picture">
        <View
          source={source}
          camera="robot"
          quality={fineness}
          orbit
          marks={marks}
          label={t("design.view")}
        />
      </div>
      <p class="big-speed">
        <b>{speed(figure(figures, "speed_mm_s"))}</b> mm/s
        <small>{t("class.screen.speed")}</small>
      </p>
      <p class="big-said">{fault ? said(fault) : first ? said(first.said) : ""}</p>
      <BigFeet shown={shown} tick={tick} />
    </>
  );
}

function BigFeet({ shown, tick }: { shown: Shown; tick: { value: number } }) {
  const { trial, robot } = shown;
  const path = useMemo(() => {
    const share = (at: number) => at / Math.max(1, trial.ticks);
    const runs = footBars(trial).map((leg) =>
      leg.map(({ from, to }) => [share(from), share(to)] as const),
    );
    return barsPath(runs);
  }, [trial]);
  const left = useComputed(() => `left: ${(100 * tick.value) / Math.max(1, trial.ticks)}%`);
  return (
    <div class="big-feet">
      <ul aria-hidden="true">
        {robot.legs.map((leg) => (
          <li key={leg}>{leg}</li>
        ))}
      </ul>
      <div>
        <svg
          viewBox={`0 0 100 ${trial.legs}`}
          preserveAspectRatio="none"
          role="img"
          aria-label={t("class.feet")}
        >
          <path d={path} />
        </svg>
        <i style={left} />
      </div>
    </div>
  );
}

/** Run through a trial again and again; returns what ends it. */
function repeat({ reply, ticks }: Trial, show: (tick: number) => void): () => void {
  const first = reply.starts[0] ?? 0;
  const beginMs = performance.now();
  let handle = 0;
  const draw = (nowMs: number) => {
    const passed = (Math.max(0, nowMs - beginMs) / 1000) * BEATS_PER_S;
    show(looped(first + passed, first, ticks - 1));
    handle = requestAnimationFrame(draw);
  };
  handle = requestAnimationFrame(draw);
  return () => cancelAnimationFrame(handle);
}
