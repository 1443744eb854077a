/** The picture of a match as a part of a page; fills its parent. */

import "@preact/signals"; // redraws a component when a signal that it read changes
import type { ReadonlySignal } from "@preact/signals";
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";
import type { Quality } from "../core/settings";
import type { Annotations } from "./annotations";
import type { CameraName } from "./cameras";
import type { FloorMarks } from "./marks";
import type { Hit } from "./picking";
import type { Shutter } from "./shutter";
import type { OwnSeat } from "./tags";
import { type Inset, type Options, type Source, Viewer, type ViewHook } from "./viewer";
import type { Worth } from "./worths";
import "./view.css";

export type { Annotations, Placed, Reaching } from "./annotations";
export type { CameraName } from "./cameras";
export { CAMERAS } from "./cameras";
export type { FloorMarks } from "./marks";
export type { Hit } from "./picking";
export { Shutter } from "./shutter";
export type { Placing } from "./tags";
export type { Inset, Source } from "./viewer";

interface Props {
  /** Must stay the same object for as long as the same match is meant. */
  source: Source;
  camera?: CameraName | ReadonlySignal<CameraName>;
  /** Whose robot the camera `chase` follows. */
  seat?: number;
  quality?: Quality | ReadonlySignal<Quality>;
  /** Nothing behind the arena: for a broadcast that puts its own picture there. */
  transparent?: boolean;
  /** Turn by dragging, come nearer by the wheel; a double click undoes it. */
  orbit?: boolean;
  /** The teams' names above their robots. */
  labels?: boolean;
  /** Edges that something else covers [px]: the arena is fitted between them. */
  inset?: Inset;
  /** A click on the field; with it, what can be clicked is marked under the pointer. */
  onPick?: (hit: Hit) => void;
  /** The pointer came to the link of a joint, or left them all. With it, `onPick` tells joints. */
  onJoint?: (joint: number | null) => void;
  /** Bodies of robots that glow, and how strongly, from 0 to 1. */
  lit?: ReadonlyMap<number, number>;
  /** The same robots in another trial, drawn translucent. */
  ghost?: Source["sample"] | null;
  /** Marks on the floor, asked for with each picture. */
  marks?: () => FloorMarks | null;
  /** What the page writes over the picture. */
  annotations?: Annotations | null;
  /** Called with the canvas after each picture: later the browser has taken it away. */
  onDrawn?: (canvas: HTMLCanvasElement) => void;
  /** The reader's own robot. */
  own?: OwnSeat | null;
  /** What markers would bring the reader's robot now. */
  worth?: Worth | null;
  /** Says when to draw, for a film. Must not change. */
  shutter?: Shutter;
  /** The label for screen readers. */
  label?: string;
}

const NONE: ReadonlyMap<number, number> = new Map();

/** All views of the page, the oldest first; `view` is the first of them. */
interface Hooks {
  view?: ViewHook;
  views?: ViewHook[];
}

declare global {
  interface Window {
    __lacoc?: Hooks;
  }
}

export function View(props: Props) {
  const host = useRef<HTMLDivElement>(null);
  const viewer = useRef<Viewer | null>(null);
  const options = optionsOf(props);

  useEffect(() => {
    const made = new Viewer(host.current!, options);
    viewer.current = made;
    register(made.hook);
    return () => {
      viewer.current = null;
      unregister(made.hook);
      made.end();
    };
  }, []);
  // With the change that it belongs to, not at some later picture: a film must not depend on when.
  useLayoutEffect(() => viewer.current?.update(options));

  return (
    <div
      ref={host}
      class="view"
      data-transparent={options.transparent}
      role="img"
      aria-label={props.label ?? "3D"}
    />
  );
}

function optionsOf(props: Props): Options {
  return {
    source: props.source,
    camera: chosen(props.camera, "arena"),
    seat: props.seat ?? 0,
    quality: chosen(props.quality, "auto"),
    transparent: props.transparent ?? false,
    orbit: props.orbit ?? false,
    labels: props.labels ?? false,
    inset: props.inset ?? {},
    onPick: props.onPick ?? null,
    onJoint: props.onJoint ?? null,
    lit: props.lit ?? NONE,
    ghost: props.ghost ?? null,
    marks: props.marks ?? null,
    annotations: props.annotations ?? null,
    onDrawn: props.onDrawn ?? null,
    own: props.own ?? null,
    worth: props.worth ?? null,
    shutter: props.shutter ?? null,
  };
}

function chosen<T extends string>(given: T | ReadonlySignal<T> | undefined, otherwise: T): T {
  if (given === undefined) return otherwise;
  return typeof given === "string" ? given : given.value;
}

function register(hook: ViewHook): void {
  window.__lacoc ??= {};
  const hooks = window.__lacoc;
  hooks.views = [...(hooks.views ?? []), hook];
  hooks.view = hooks.views[0]!;
}

function unregister(hook: ViewHook): void {
  const hooks = window.__lacoc;
  if (!hooks?.views) return;
  hooks.views = hooks.views.filter((one) => one !== hook);
  if (hooks.views[0]) hooks.view = hooks.views[0];
  else delete hooks.view;
}
