/**
 * A page with nothing but the scene; it plays a match from a file.
 *
 * ?match=FILE a msgpack map {sheet, scene, frames}, each as a court publishes it
 * &camera=NAME &q=low|high|auto &views=2 &labels=1 &orbit=1 &transparent=1 &top=60
 * &speed=1 frames arrive by the clock; 0: stand still at &beat=N
 */

import { decode } from "@msgpack/msgpack";
import { type Signal, signal } from "@preact/signals";
import { render } from "preact";
import { ForwardKinematics, jointsPerSeat } from "../../core/fk";
import type { Quality } from "../../core/settings";
import { type Moment, Timeline, Track } from "../../core/timeline";
import { type Frame, readFrame, type Scene, type Sheet } from "../../core/wire";
import { PoseMixer } from "../poses";
import { type CameraName, type Hit, View } from "../View";

const query = new URLSearchParams(location.search);
const text = (name: string, otherwise: string) => query.get(name) ?? otherwise;
const number = (name: string, otherwise: number) => Number(query.get(name) ?? otherwise);

interface MatchFile {
  sheet: Uint8Array;
  scene: Uint8Array;
  frames: Uint8Array[];
}

const sheet = signal<Sheet | null>(null);
const scene = signal<Scene | null>(null);
const camera = signal(text("camera", "arena") as CameraName);
const quality = signal(text("q", "auto") as Quality);
const picked = signal<Hit | null>(null);
const speed = number("speed", 1);
let track = new Track([]);
let beat = number("beat", 0);
let changeFrame: (frame: Frame) => Frame = (frame) => frame;
const timeline = new Timeline();

const source = {
  sheet,
  scene,
  sample(nowMs: number): Moment | null {
    if (speed) return timeline.sample(nowMs);
    const moment = track.sampleAt(beat);
    return (
      moment && { ...moment, before: changeFrame(moment.before), after: changeFrame(moment.after) }
    );
  },
};

function Stand() {
  const common = {
    source,
    quality,
    labels: text("labels", "1") === "1",
    orbit: text("orbit", "1") === "1",
    transparent: text("transparent", "0") === "1",
    inset: { top: number("top", 0) },
    onPick: (hit: Hit) => {
      picked.value = hit;
    },
  };
  if (number("views", 1) < 2) return <View {...common} camera={camera} />;
  return (
    <div class="views">
      <View {...common} camera="left" />
      <View {...common} camera="right" />
    </div>
  );
}

async function load(file: string): Promise<void> {
  const response = await fetch(file);
  const match = decode(new Uint8Array(await response.arrayBuffer())) as MatchFile;
  track = new Track(match.frames.map(readFrame));
  scene.value = decode(match.scene) as Scene;
  sheet.value = decode(match.sheet) as Sheet;
}

/** Let the frames arrive as a court would send them. */
function arrive(): void {
  let next = Math.max(
    0,
    track.frames.findIndex((frame) => frame.beat >= beat),
  );
  const first = track.frames[next]?.beat ?? 0;
  const beganMs = performance.now();
  setInterval(() => {
    const now = first + (performance.now() - beganMs) * 0.05 * speed;
    for (; (track.frames[next]?.beat ?? Number.POSITIVE_INFINITY) <= now; next++) {
      timeline.push(track.frames[next]!, performance.now());
    }
  }, 10);
}

const stand = {
  camera: camera as Signal<string>,
  quality: quality as Signal<string>,
  picked,
  sheet,
  scene,
  ForwardKinematics,
  PoseMixer,
  jointsPerSeat,
  get track() {
    return track;
  },
  seek(to: number) {
    beat = to;
  },
  /** Show other frames than there are: their seats' flags, say. */
  change(how: (frame: Frame) => Frame) {
    changeFrame = how;
  },
  /** Every body by our kinematics, from the numbers of a frame. */
  bodies(numbers: number[]): { pos: number[]; quat: number[] } {
    const fk = new ForwardKinematics(scene.value!, jointsPerSeat(sheet.value!));
    fk.update(Float32Array.from(numbers));
    return { pos: [...fk.pos], quat: [...fk.quat] };
  },
  load,
};

declare global {
  interface Window {
    stand: typeof stand;
  }
}

window.stand = stand;
render(<Stand />, document.getElementById("stand")!);
const file = query.get("match");
if (file) {
  await load(file);
  if (speed) arrive();
}
document.body.dataset.ready = "1";
