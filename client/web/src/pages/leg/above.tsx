/** Pictures from above: one foot that swings, and the whole robot with its joints and feet. */

import { joint, LEVELS } from "../../core/design/table";
import { hull } from "../../core/hull";
import { bodyWay, cos, points, type SampleRobot, sin, type Three } from "../../core/leg/leg";
import { feetOf } from "../../core/leg/lesson";
import { t } from "../../i18n";
import { Arc, Label, Line, mm, RightAngle, textSize } from "./svg";

const EDGE_MM = 18;

interface SwingProps {
  r: number;
  swing: number;
  /** Whether the way is shown, or only where the swing begins. */
  isShown: boolean;
}

/** The right half of the body, whose middle edge has the Root joint. */
function Body() {
  return (
    <>
      <rect class="body" x={-50} y={-45} width={50} height={90} rx={6} />
      <Label x={-25} y={53} kind="muted">
        ▲ {t("leg.front")}
      </Label>
    </>
  );
}

/** A leg from above, which swings from forward to backward around its Root joint. */
export function Swing({ r, swing, isShown }: SwingProps) {
  const half = swing / 2;
  const [out, ahead] = [r * cos(half), r * sin(half)];
  const tall = Math.max(62, r * sin(Math.min(90, half)) + 26);
  return (
    <svg
      class="leg-drawing"
      viewBox={`-62 ${-tall} ${r + 62 + 52} ${2 * tall}`}
      role="img"
      style={textSize(r + 114)}
      aria-label={t("leg.fromAbove")}
    >
      <Body />
      <Line kind="side" from={[0, 0]} to={[r, 0]} />
      <Line kind="link l1" from={[0, 0]} to={[out, ahead]} />
      {isShown && (
        <>
          <g class="links pale">
            <Line kind="link l1" from={[0, 0]} to={[out, -ahead]} />
          </g>
          <Arc kind="arc way" x={0} y={0} radius={r} from={half} to={-half} />
          <Arc x={0} y={0} radius={36} from={0} to={half} />
          <Line kind="chord" from={[out, ahead]} to={[out, -ahead]} />
          <RightAngle x={out} y={0} u={-out} v={ahead} />
          <Label x={out + 8} y={ahead / 2} anchor="start">
            {mm(ahead)}
          </Label>
          <Label x={out / 2} y={-8}>
            {mm(out)}
          </Label>
          <Label x={40} y={7} kind="angle" anchor="start">
            Δ/2 {mm(half)}°
          </Label>
          <path class="arrow" d={arrow(bodyWay(r, swing))} />
        </>
      )}
      <Label x={0.62 * out - 6} y={0.62 * ahead + 10} anchor="end">
        r {mm(r)}
      </Label>
      <circle class="joint" cx={0} cy={0} r={5} />
      <circle class="foot" cx={out} cy={-ahead} r={6} />
    </svg>
  );
}

/** A leg from above, turned by Root: how far forward and how far outward its foot is. */
export function Turned({ r, root }: { r: number; root: number }) {
  const [out, ahead] = [r * cos(root), r * sin(root)];
  const size = Math.max(62, Math.abs(r) + 30);
  return (
    <svg
      class="leg-drawing"
      viewBox={`${-size} ${-size} ${2 * size} ${2 * size}`}
      role="img"
      style={textSize(2 * size)}
      aria-label={t("leg.fromAbove")}
    >
      <Body />
      <g class="triangle">
        <Line kind="side" from={[0, 0]} to={[out, 0]} />
        <Line kind="side" from={[out, 0]} to={[out, ahead]} />
        <RightAngle x={out} y={0} u={-out} v={ahead} />
      </g>
      <Line kind="link l1" from={[0, 0]} to={[out, ahead]} />
      {root !== 0 && <Arc x={0} y={0} radius={30} from={0} to={root} />}
      <Label x={out / 2} y={ahead < 0 ? 9 : -9}>
        {mm(Math.abs(out))}
      </Label>
      {Math.abs(ahead) > 4 && (
        <Label x={out + (out < 0 ? -8 : 8)} y={ahead / 2} anchor={out < 0 ? "end" : "start"}>
          {mm(Math.abs(ahead))}
        </Label>
      )}
      <Label x={38 * cos(root / 2)} y={38 * sin(root / 2)} kind="angle" anchor="start">
        θ₀ {mm(root, 0)}°
      </Label>
      <circle class="joint" cx={0} cy={0} r={5} />
      <circle class="foot" cx={out} cy={-ahead} r={6} />
    </svg>
  );
}

/** How far the body goes: an arrow in the body. */
function arrow(way: number): string {
  const half = way / 2;
  return `M -14 ${half} V ${-half} m -6 9 l 6 -9 l 6 9`;
}

interface RobotProps {
  robot: SampleRobot;
  /** Numbers of joints that are written; null: of all. */
  numbers?: readonly number[] | null;
  /** A joint that glows. */
  lit?: number | null;
  /** The legs that stand, with the feet of the start posture; left out: the joints are shown. */
  down?: ReadonlySet<number>;
  hasArea?: boolean;
}

export function RobotAbove({ robot, numbers = null, lit = null, down, hasArea }: RobotProps) {
  const { legs, size_mm } = robot;
  const [width, length] = size_mm;
  const feet = feetOf(robot);
  const joints = legs.map((leg) => points(leg, [0, 0, 0]));
  const all = [...feet, ...joints.flat()];
  const right = Math.max(...all.map(([x]) => x)) + EDGE_MM;
  const front = Math.max(length / 2, ...all.map(([, y]) => y)) + EDGE_MM;
  const corners = down && hasArea ? hull([...down].map((leg) => feet[leg]!)) : [];
  return (
    <svg
      class="leg-drawing"
      viewBox={`${-right} ${-front - 8} ${2 * right} ${2 * front + 8}`}
      role="img"
      style={textSize(2 * right)}
      aria-label={t("leg.allFromAbove")}
    >
      {corners.length > 0 && (
        <polygon class="area" points={corners.map(([x, y]) => `${x},${-y}`).join(" ")} />
      )}
      <rect class="body" x={-width / 2} y={-length / 2} width={width} height={length} rx={8} />
      <Label x={0} y={length / 2 + 10} kind="muted">
        ▲ {t("leg.front")}
      </Label>
      {legs.map((leg, index) => {
        const side = leg.position_mm[0] > 0 ? 1 : -1;
        return (
          <g key={leg.label}>
            {down ? (
              <Foot
                from={leg.position_mm}
                to={feet[index]!}
                label={leg.label}
                isDown={down.has(index)}
              />
            ) : (
              <Joints robot={robot} leg={index} at={joints[index]!} numbers={numbers} lit={lit} />
            )}
            {!down && (
              <Label x={side * (width / 2 - 17)} y={leg.position_mm[1]} kind="name">
                {leg.label}
              </Label>
            )}
          </g>
        );
      })}
      {down && <path class="middle" d="M -7 0 H 7 M 0 -7 V 7" />}
    </svg>
  );
}

interface FootProps {
  from: Three;
  to: readonly [number, number];
  label: string;
  isDown: boolean;
}

function Foot({ from: [x, y], to, label, isDown }: FootProps) {
  const side = to[0] > 0 ? 1 : -1;
  return (
    <g class={isDown ? "stands" : "lifted"}>
      <Line kind="link l1" from={[x, y]} to={to} />
      <circle class="foot" cx={to[0]} cy={-to[1]} r={7} />
      <Label x={x - side * 17} y={y} kind="name">
        {label}
      </Label>
    </g>
  );
}

interface JointsProps {
  robot: SampleRobot;
  leg: number;
  /** Its hinges and its foot. */
  at: readonly Three[];
  numbers: readonly number[] | null;
  lit: number | null;
}

function Joints({ robot, leg, at, numbers, lit }: JointsProps) {
  const count = robot.legs.length;
  const [from, , to] = at as [Three, Three, Three];
  return (
    <g class="joints">
      <Line kind="link l1" from={[from[0], from[1]]} to={[to[0], to[1]]} />
      {LEVELS.map((level, index) => {
        const id = joint(leg, index, count);
        const [x, y] = at[index]!;
        return (
          <g key={level} class={lit === id ? "lit" : ""} data-joint={id}>
            <circle class="joint" cx={x} cy={-y} r={7.2} />
            {(numbers === null || numbers.includes(id)) && (
              <Label x={x} y={y} kind="number">
                {id}
              </Label>
            )}
          </g>
        );
      })}
    </g>
  );
}
