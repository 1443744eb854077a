/** Draws a match into an element, frame by frame: picture, cameras, names, pointing. */

import { pickJoint } from "../core/design/parts";
import type { Match } from "../core/match";
import type { Quality } from "../core/settings";
import type { Annotations, Reaching } from "./annotations";
import { type Action, AutoCamera } from "./autocamera";
import {
  type Aim,
  type CameraName,
  type Frame2d,
  isCalm,
  Rig,
  type ViewAxes,
  viewOf,
} from "./cameras";
import { Labels } from "./labels";
import type { FloorMarks } from "./marks";
import { type Field, Model } from "./model";
import { type Hit, pick, pickFlat, project, rayAt } from "./picking";
import { type Fineness, FrameTimes, firstFineness, rememberSlow, tooSlow } from "./quality";
import type { Exposed, Shutter } from "./shutter";
import type { Ring, Stage } from "./stage";
import { type OwnSeat, type Placing, Tags } from "./tags";
import { type Plan, planOf, TopView } from "./topview";
import { type Worth, Worths } from "./worths";

/** What is drawn. */
export type Source = Pick<Match, "sheet" | "scene" | "sample">;

/** Kept free of the field at the edges, for what lies over the picture [px]. */
export interface Inset {
  top?: number;
  right?: number;
  bottom?: number;
  left?: number;
}

export interface Options {
  source: Source;
  camera: CameraName;
  seat: number;
  quality: Quality;
  transparent: boolean;
  orbit: boolean;
  labels: boolean;
  inset: Inset;
  onPick: ((hit: Hit) => void) | null;
  /** Called with the joint of the link that the pointer comes to; null: it left them all. */
  onJoint: ((joint: number | null) => void) | null;
  /** Bodies of robots that glow, and how strongly, from 0 to 1. */
  lit: ReadonlyMap<number, number>;
  /** The same robots in another trial, drawn translucent. */
  ghost: Source["sample"] | null;
  /** Marks on the floor, now. */
  marks: (() => FloorMarks | null) | null;
  /** What the page writes over the picture. */
  annotations: Annotations | null;
  /** Called with the canvas while it has the picture. */
  onDrawn: ((canvas: HTMLCanvasElement) => void) | null;
  own: OwnSeat | null;
  worth: Worth | null;
  /** Says when to draw; null: whenever the browser shows a picture. Can't change later. */
  shutter: Shutter | null;
}

/** Data for tests: `window.__lacoc.view`. */
export interface ViewHook {
  readonly fps: number;
  readonly frameMsP95: number;
  readonly drawnBeat: number;
  readonly drawnFrames: number;
  readonly camera: string;
  /** Pixels drawn for one of the page, along a side. */
  readonly ratio: number;
  /** "low", "high", or "map" where nothing is drawn in three dimensions. */
  readonly quality: string;
  readonly eye: [number, number, number] | null;
  /** True while a disc turns over or a flag falls. */
  readonly moving: boolean;
  bodyPos(name: string): [number, number, number] | null;
  /** Of the robot of another trial. */
  ghostPos(name: string): [number, number, number] | null;
  /** Names of the bodies that glow most. */
  readonly lit: string[];
  marker(index: number): number;
  /** Where on the page a point of the world is [px]. */
  screen(x: number, y: number, z: number): [number, number] | null;
}

const MOST_RATIO = 2;
/** Low quality has fewer pixels, down to this, where frames come slower than that. */
const LEAST_RATIO = 0.65;
const UNEVEN_MS = 30;
/** A leap in time of more beats shows no movements. */
const LEAP_BEATS = 100;
const RETRY_MS = 1000;
const WEBGL_AGAIN_MS = 5000;
const DRAG_PX = 5;
const EDGE = 0.96;
const FRAME_MS = 180;

export class Viewer implements Exposed {
  private options: Options;
  private canvas: HTMLCanvasElement | null = null;
  private stage: Stage | null = null;
  private map: TopView | null = null;
  private rig = new Rig();
  private autoCamera = new AutoCamera(this.rig);
  private readonly times = new FrameTimes();
  private readonly tags: Tags;
  private readonly labels: Labels;
  private readonly worths: Worths;
  private readonly observer: ResizeObserver;
  private model: Model | null = null;
  private ghost: Model | null = null;
  private joint: number | null = null;
  private axes: ViewAxes | null = null;
  private plan: Plan | null = null;
  private pointer: { x: number; y: number } | null = null;
  private hovered: Hit | null = null;
  private drawn = { beat: -1, match: -1, frames: 0 };
  private actions: Action[] = [];
  private handle = 0;
  private building = false;
  private ended = false;
  private slow = false;
  private noWebgl = false;
  private webglAgainMs = WEBGL_AGAIN_MS;
  private first: Fineness | "none" | null = null;
  private thrift = 1;
  private size = { width: 0, height: 0 };
  private framed: (Frame2d & { width: number; height: number }) | null = null;
  private framedMs = 0;

  /** @param host Is filled with the picture. */
  constructor(
    private readonly host: HTMLElement,
    options: Options,
  ) {
    this.options = options;
    this.labels = new Labels(host);
    this.worths = new Worths(host);
    this.tags = new Tags(host);
    this.observer = new ResizeObserver(() => this.measure());
    this.observer.observe(host);
    this.listen();
    this.measure();
    if (options.shutter) options.shutter.add(this);
    else this.handle = requestAnimationFrame(this.loop);
  }

  /** Go on with other options. */
  update(options: Options): void {
    const before = this.options;
    this.options = options;
    if (before.quality !== options.quality) this.slow = false;
    if (before.quality !== options.quality || before.transparent !== options.transparent) {
      this.drop();
    }
    if (before.source !== options.source) this.model = null;
    const [own, was] = [options.own, before.own];
    if (this.model && (own?.seat !== was?.seat || own?.name !== was?.name)) {
      this.tags.name(this.model.sheet, own);
    }
  }

  /** Stop and take everything away. */
  end(): void {
    this.ended = true;
    cancelAnimationFrame(this.handle);
    this.options.shutter?.remove(this);
    this.observer.disconnect();
    this.drop();
    this.tags.end();
    this.labels.end();
    this.worths.end();
  }

  readonly hook: ViewHook = (() => {
    const viewer = this;
    return {
      get fps() {
        return viewer.times.hz;
      },
      get frameMsP95() {
        return viewer.times.p95Ms;
      },
      get drawnBeat() {
        return viewer.drawn.beat;
      },
      get drawnFrames() {
        return viewer.drawn.frames;
      },
      get camera() {
        return viewer.options.camera;
      },
      get quality() {
        return viewer.map ? "map" : (viewer.stage?.fineness ?? "");
      },
      get ratio() {
        return viewer.stage?.renderer.getPixelRatio() ?? 0;
      },
      get eye() {
        return viewer.axes?.eye ?? null;
      },
      get moving() {
        return viewer.stage?.moving ?? false;
      },
      get lit() {
        const { bodies } = viewer.model?.scene ?? { bodies: [] };
        const glow = [...viewer.options.lit].filter(([, strength]) => strength === 1);
        return glow.map(([body]) => bodies[body]?.name ?? "");
      },
      bodyPos: (name) => viewer.model?.bodyPos(name) ?? null,
      ghostPos: (name) => (viewer.options.ghost && viewer.ghost?.bodyPos(name)) || null,
      marker: (index) => viewer.model?.states[index] ?? -1,
      screen: (x, y, z) => {
        const box = viewer.host.getBoundingClientRect();
        const at = viewer.place(x, y, z);
        return at && [box.left + at.x, box.top + at.y];
      },
    };
  })();

  private get flat(): boolean {
    return this.noWebgl || this.options.camera === "map";
  }

  // Building

  /** The quality of the picture; null without WebGL. */
  private fineness(): Fineness | null {
    const { quality } = this.options;
    // A look at the card first: smooth edges can't be taken back from a context that has them.
    this.first ??= firstFineness(document.createElement("canvas"));
    if (this.first === "none") return null;
    if (quality !== "auto") return quality;
    return this.slow ? "low" : this.first;
  }

  /** Make what draws; the three-dimensional part is loaded when it is needed. */
  private async build(): Promise<void> {
    this.building = true;
    try {
      const fineness = this.flat ? null : this.fineness();
      const made = fineness && (await this.stageOf(fineness));
      // Meanwhile something else may be wanted.
      if (this.ended || (made && (this.flat || this.fineness() !== fineness))) {
        made?.dispose();
        return;
      }
      if (!made) {
        this.noWebgl ||= this.options.camera !== "map";
        if (fineness) this.awaitWebgl();
        const canvas = newCanvas();
        this.map = new TopView(canvas);
        this.show(canvas);
        return;
      }
      this.stage = made;
      if (this.model) made.setModel(this.model);
      this.show(made.canvas);
    } catch (error) {
      // Such as a part that could not be loaded: the next try is not at once.
      await new Promise((resolve) => setTimeout(resolve, RETRY_MS));
      console.warn(error);
    } finally {
      this.building = false;
    }
  }

  /** A driver that restarts gives no context for some time: the map is drawn until it does. */
  private awaitWebgl(): void {
    setTimeout(() => {
      if (this.ended) return;
      if (!document.createElement("canvas").getContext("webgl2")) return this.awaitWebgl();
      this.webglAgainMs *= 2; // the field may ask for more than this canvas
      this.noWebgl = false;
      this.drop();
    }, this.webglAgainMs);
  }

  private async stageOf(fineness: Fineness): Promise<Stage | null> {
    const { transparent } = this.options;
    const { Stage } = await import("./stage");
    const canvas = newCanvas();
    const context = canvas.getContext("webgl2", {
      // Blending the picture into the page costs something, and low quality has no glow below it.
      alpha: transparent || fineness === "high",
      antialias: fineness === "high" || (this.options.shutter?.smooth ?? false),
      powerPreference: "high-performance",
      stencil: false,
    });
    if (!context) return null;
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      // A new canvas is a new context; the old one may never come back.
      if (canvas === this.canvas) setTimeout(() => canvas === this.canvas && this.drop(), RETRY_MS);
    });
    return new Stage(canvas, context, fineness, transparent);
  }

  private show(canvas: HTMLCanvasElement): void {
    this.canvas?.remove();
    this.canvas = canvas;
    this.host.prepend(canvas);
    this.host.dataset.fineness = this.hook.quality;
    this.times.reset();
    this.resize();
  }

  private drop(): void {
    this.stage?.dispose();
    this.stage = null;
    this.map = null;
    this.canvas?.remove();
    this.canvas = null;
  }

  private measure(): void {
    this.size = { width: this.host.clientWidth, height: this.host.clientHeight };
    this.resize();
  }

  private resize(): void {
    const { width, height } = this.size;
    if (!width || !height) return;
    const ratio = Math.min(MOST_RATIO, window.devicePixelRatio || 1);
    const coarse = Math.min(1, ratio) * this.thrift;
    this.stage?.resize(width, height, this.stage.fineness === "low" ? coarse : ratio);
    this.map?.resize(width, height, Math.max(1, window.devicePixelRatio || 1));
  }

  // Drawing

  private readonly loop = (nowMs: number): void => {
    if (this.ended) return;
    this.handle = requestAnimationFrame(this.loop);
    const { width, height } = this.size;
    if (!width || !height) {
      this.times.reset();
      return;
    }
    if (this.flat ? this.stage : this.map) this.drop();
    if (!this.stage && !this.map) {
      if (!this.building) void this.build();
      return;
    }
    this.times.note(nowMs);
    this.judge();
    const animate = this.follow(nowMs);
    if (this.model) this.draw(this.model, nowMs, animate);
  };

  async prepare(): Promise<void> {
    this.measure();
    while (!this.ended && !this.stage && !this.map) await this.build();
  }

  expose(nowMs: number, drawn: boolean): void {
    const animate = this.follow(nowMs);
    if (this.model) this.draw(this.model, nowMs, animate, drawn);
  }

  cut(): void {
    this.rig = new Rig();
    this.autoCamera = new AutoCamera(this.rig);
    this.drawn.beat = Number.NEGATIVE_INFINITY;
    this.actions = [];
    this.framed = null;
    this.stage?.cut();
  }

  /** Bring the model to what is to be shown; whether time went on evenly since the last picture. */
  private follow(nowMs: number): boolean {
    const { source } = this.options;
    const [sheet, scene] = [source.sheet.peek(), source.scene.peek()];
    let elsewhere = false;
    if (sheet && scene && (this.model?.sheet !== sheet || this.model.scene !== scene)) {
      elsewhere = this.model !== null && this.model.sheet.court !== sheet.court;
      if (elsewhere) this.rig.cut();
      this.model = new Model(scene, sheet);
      this.stage?.setModel(this.model);
      this.tags.name(sheet, this.options.own);
      this.labels.name(sheet);
    }
    const moment = source.sample(nowMs);
    if (!moment || !this.model?.apply(moment)) return false;
    const { beat, match } = this.drawn;
    const passed = moment.beat - beat;
    this.drawn.beat = moment.beat;
    this.drawn.match = moment.before.match;
    return !elsewhere && match === moment.before.match && Math.abs(passed) < LEAP_BEATS;
  }

  /** @param drawn False: cameras and movements go on, but nothing is drawn. */
  private draw(model: Model, nowMs: number, animate: boolean, drawn = true): void {
    if (drawn) this.drawn.frames++;
    const ring = this.point(model);
    if (this.map) {
      this.plan = planOf(this.shownField(model), this.free());
      const { lit, marks, camera } = this.options;
      const near = camera === "robot" ? { lit, marks: marks?.() ?? null } : null;
      if (drawn) this.map.draw(model, this.plan, ring, near);
    } else if (this.stage) {
      const seen = viewOf(this.shot(model, nowMs));
      this.axes = (this.options.annotations?.isHeld && this.axes) || seen;
      const { lit, marks } = this.options;
      const ghost = this.ghostAt(model, nowMs);
      const extras = { lit, ghost, marks: marks?.() ?? null };
      const changed = this.stage.follow(nowMs, animate);
      if (drawn) this.stage.draw(this.axes, nowMs, ring, extras);
      this.actions = animate
        ? changed.flatMap((marker) => {
            const seat = (model.states[marker] ?? 0) - 1;
            return model.sheet.seats[seat] ? [{ seat }] : [];
          })
        : [];
    }
    const named = this.options.labels ? model : null;
    const place: Placing = (x, y, z) => this.place(x, y, z);
    const spots = this.worths.draw(model, this.options.worth, place);
    this.tags.draw(named, place, spots);
    // The map has them in its drawing.
    this.labels.draw(this.map ? null : named, place);
    if (drawn && this.canvas) this.options.onDrawn?.(this.canvas);
    if (drawn) this.options.annotations?.draw(place, () => this.reach());
  }

  /** The robots of the other trial now; null without one, and where it belongs to another scene. */
  private ghostAt(model: Model, nowMs: number): Model | null {
    const moment = this.options.ghost?.(nowMs);
    if (!moment) return null;
    if (this.ghost?.sheet !== model.sheet || this.ghost.scene !== model.scene) {
      this.ghost = new Model(model.scene, model.sheet);
    }
    return this.ghost.apply(moment) ? this.ghost : null;
  }

  /** The part of the field that the drawing from above has. */
  private shownField(model: Model): Field {
    const robot = model.robots[this.options.seat];
    if (this.options.camera !== "robot" || !robot) return model.field;
    return { x: robot.x, y: robot.y, halfX: 0.2, halfY: 0.15, height: 0 };
  }

  private shot(model: Model, nowMs: number) {
    const { camera, seat } = this.options;
    const aspect = this.size.width / this.size.height;
    const aim: Aim = { model, aspect, frame: this.frame(nowMs), seat };
    if (camera === "auto") {
      const { key, shot } = this.autoCamera.shoot(aim, this.actions, nowMs);
      return this.rig.move(key, shot, nowMs, 1300);
    }
    return this.rig.move(`${camera} ${seat}`, this.rig.aim(camera, aim, nowMs), nowMs);
  }

  /** Draw less finely if this machine cannot keep up. */
  private judge(): void {
    if (!this.stage || !this.times.full) return;
    if (this.stage.fineness === "low") {
      if (this.thrift <= LEAST_RATIO || this.times.p95Ms < UNEVEN_MS) return;
      this.thrift *= 0.8;
      this.times.reset();
      this.resize();
    } else if (this.options.quality === "auto" && tooSlow(this.times)) {
      this.slow = true;
      rememberSlow(this.stage.renderer.getContext() as WebGL2RenderingContext);
      this.drop();
    }
  }

  private free(): { left: number; top: number; width: number; height: number } {
    const { top = 0, right = 0, bottom = 0, left = 0 } = this.options.inset;
    const margin = 8;
    return {
      left: left + margin,
      top: top + margin,
      width: Math.max(40, this.size.width - left - right - 2 * margin),
      height: Math.max(40, this.size.height - top - bottom - 2 * margin),
    };
  }

  /** The free part of the picture, in -1 to 1; when it changes, it does so in a moment's glide. */
  private frame(nowMs: number): Frame2d {
    const { top = 0, right = 0, bottom = 0, left = 0 } = this.options.inset;
    const { width, height } = this.size;
    const goal = {
      left: EDGE * (-1 + (2 * left) / width),
      right: EDGE * (1 - (2 * right) / width),
      top: EDGE * (1 - (2 * top) / height),
      bottom: EDGE * (-1 + (2 * bottom) / height),
    };
    const part = isCalm.matches ? 1 : 1 - Math.exp(-(nowMs - this.framedMs) / FRAME_MS);
    this.framedMs = nowMs;
    const now = this.framed;
    if (!now || now.width !== width || now.height !== height) {
      this.framed = { ...goal, width, height };
      return goal;
    }
    for (const side of ["left", "right", "top", "bottom"] as const) {
      const far = goal[side] - now[side];
      now[side] = Math.abs(far) < 0.001 ? goal[side] : now[side] + far * part;
    }
    return now;
  }

  /** Where in the element a point of the world is [px]; null if it is behind the camera. */
  private place(x: number, y: number, z: number): { x: number; y: number; far: number } | null {
    if (this.map) {
      if (!this.plan) return null;
      const { scale } = this.plan;
      return { x: this.plan.x + x * scale, y: this.plan.y - y * scale - z * scale, far: 3 };
    }
    const { width, height } = this.size;
    if (!this.axes || !width) return null;
    const at = project(this.axes, width / height, x, y, z);
    if (at.depth < 0.1) return null;
    return { x: ((at.u + 1) / 2) * width, y: ((1 - at.v) / 2) * height, far: at.depth };
  }

  /** The way back from the picture to the world, with the camera as it is now. */
  private reach(): Reaching | null {
    const { plan, axes, size } = this;
    if (this.map) {
      return (
        plan && ((at, z) => [(at.x - plan.x) / plan.scale, (plan.y - at.y) / plan.scale - z, z])
      );
    }
    if (!axes) return null;
    const { width, height } = size;
    return ({ x, y, far }) => {
      const ray = rayAt(axes, width / height, (2 * x) / width - 1, 1 - (2 * y) / height);
      return [0, 1, 2].map((axis) => axes.eye[axis]! + far * ray[axis]!) as [
        number,
        number,
        number,
      ];
    };
  }

  // Pointing

  private hitAt(x: number, y: number): Hit | null {
    const { model, size } = this;
    if (!model) return null;
    if (this.map) {
      if (!this.plan) return null;
      const { scale } = this.plan;
      return pickFlat(model, (x - this.plan.x) / scale, (this.plan.y - y) / scale);
    }
    if (!this.axes) return null;
    const [u, v] = [(2 * x) / size.width - 1, 1 - (2 * y) / size.height];
    return pick(model, this.axes, size.width / size.height, u, v);
  }

  /** The ring round what the pointer is on. */
  private point(model: Model): Ring | null {
    if (this.options.onJoint) {
      this.pointJoint(model, this.options.onJoint);
      return null;
    }
    const pickable = this.options.onPick !== null && this.pointer !== null;
    this.hovered = pickable ? this.hitAt(this.pointer!.x, this.pointer!.y) : null;
    const { marker, seat } = this.hovered ?? {};
    const on = marker !== undefined || seat !== undefined;
    this.host.style.cursor = on ? "pointer" : "";
    if (seat !== undefined) {
      const robot = model.robots[seat]!;
      return { x: robot.x, y: robot.y, radius: 0.17 };
    }
    const info = marker === undefined ? null : model.sheet.markers[marker];
    return info ? { x: info.x_m, y: info.y_m, radius: Math.max(0.05, 1.06 * info.radius_m) } : null;
  }

  private pointJoint(model: Model, tell: (joint: number | null) => void): void {
    const joint = this.pointer && this.jointAt(model, this.pointer.x, this.pointer.y);
    this.host.style.cursor = joint === null ? "" : "pointer";
    if (joint === this.joint) return;
    this.joint = joint;
    tell(joint);
  }

  private jointAt({ scene, fk }: Model, x: number, y: number): number | null {
    const { axes, size } = this;
    if (!axes || this.map) return null;
    const [u, v] = [(2 * x) / size.width - 1, 1 - (2 * y) / size.height];
    return pickJoint(scene, fk, axes.eye, rayAt(axes, size.width / size.height, u, v));
  }

  private listen(): void {
    const { host } = this;
    const held = new Map<number, { x: number; y: number }>();
    let moved = 0;
    let spread = 0;
    const at = (event: PointerEvent | MouseEvent) => {
      const box = host.getBoundingClientRect();
      return { x: event.clientX - box.left, y: event.clientY - box.top };
    };
    host.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      held.set(event.pointerId, at(event));
      if (held.size === 1) moved = 0;
      spread = 0;
    });
    host.addEventListener("pointermove", (event) => {
      const now = at(event);
      if (event.pointerType !== "touch") this.pointer = now;
      // A menu or another window may have kept the release to itself.
      if (!(event.buttons & 1)) held.delete(event.pointerId);
      const was = held.get(event.pointerId);
      if (!was) return;
      held.set(event.pointerId, now);
      moved += Math.hypot(now.x - was.x, now.y - was.y);
      if (!this.options.orbit || moved < DRAG_PX) return;
      if (!host.hasPointerCapture(event.pointerId)) host.setPointerCapture(event.pointerId);
      const [one, other] = [...held.values()];
      if (one && other) {
        const apart = Math.hypot(one.x - other.x, one.y - other.y);
        if (spread) this.rig.zoom(spread / Math.max(1, apart));
        spread = apart;
      } else this.rig.orbit((was.x - now.x) * 0.006, (now.y - was.y) * 0.005);
    });
    const release = (event: PointerEvent) => {
      held.delete(event.pointerId);
      spread = 0;
    };
    host.addEventListener("pointerup", release);
    host.addEventListener("pointercancel", release);
    host.addEventListener("pointerleave", () => {
      this.pointer = null;
    });
    host.addEventListener("click", (event) => {
      const { onPick } = this.options;
      if (!onPick || moved >= DRAG_PX) return;
      const { x, y } = at(event);
      const hit = this.hitAt(x, y);
      const joint = this.options.onJoint && this.model ? this.jointAt(this.model, x, y) : null;
      if (joint !== null) onPick({ x_m: 0, y_m: 0, ...hit, joint });
      else if (hit) onPick(hit);
    });
    host.addEventListener("dblclick", () => this.options.orbit && this.rig.release());
    host.addEventListener(
      "wheel",
      (event) => {
        if (!this.options.orbit || this.map) return;
        event.preventDefault();
        this.rig.zoom(Math.exp(event.deltaY * 0.001));
      },
      { passive: false },
    );
  }
}

function newCanvas(): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  canvas.className = "view-canvas";
  return canvas;
}
