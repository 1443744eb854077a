/** Parts of the hand-drawn pictures. One unit is a millimetre; up on the page is up or forward. */

import type { ComponentChildren } from "preact";
import { cos, sin } from "../../core/leg/leg";

/** How often the height of a text goes into the width of its picture. */
const TEXTS = 32;

/** A number as the lesson writes it: one decimal, with a real minus. */
export function mm(value: number, digits = 1): string {
  const text = Math.abs(value).toFixed(digits);
  return value < 0 && /[1-9]/.test(text) ? `\u2212${text}` : text;
}

/** Texts are as large in each picture, however wide it is in millimetres. */
export function textSize(width: number): string {
  return `font-size: ${(width / TEXTS).toFixed(1)}px`;
}

export interface LabelProps {
  x: number;
  y: number;
  anchor?: "start" | "middle" | "end";
  kind?: string;
  children: ComponentChildren;
}

/** A text in a picture, in millimetres from its origin. */
export function Label({ x, y, anchor = "middle", kind = "", children }: LabelProps) {
  return (
    <text class={kind} x={x} y={-y} text-anchor={anchor} dominant-baseline="middle">
      {children}
    </text>
  );
}

interface LineProps {
  from: readonly [number, number];
  to: readonly [number, number];
  kind: string;
}

export function Line({ from: [x, y], to: [u, v], kind }: LineProps) {
  return <line class={kind} x1={x} y1={-y} x2={u} y2={-v} />;
}

interface ArcProps {
  x: number;
  y: number;
  radius: number;
  /** Directions [deg]: 0 is right, 90 is up. */
  from: number;
  to: number;
  kind?: string;
}

export function Arc({ x, y, radius, from, to, kind = "arc" }: ArcProps) {
  const place = (deg: number) => `${x + radius * cos(deg)} ${-(y + radius * sin(deg))}`;
  const large = Math.abs(to - from) > 180 ? 1 : 0;
  const sweep = to > from ? 0 : 1;
  return (
    <path
      class={kind}
      d={`M ${place(from)} A ${radius} ${radius} 0 ${large} ${sweep} ${place(to)}`}
    />
  );
}

/** The small square in the corner of a right angle; `u` and `v` say where its sides go. */
export function RightAngle({ x, y, u, v }: { x: number; y: number; u: number; v: number }) {
  const size = 5;
  const right = Math.sign(u) * size;
  const up = Math.sign(v) * size;
  if (Math.abs(u) < 2 * size || Math.abs(v) < 2 * size) return null;
  return <path class="square" d={`M ${x + right} ${-y} v ${-up} h ${-right}`} />;
}
