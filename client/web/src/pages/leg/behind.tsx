/** The first leg from behind: its links, a right triangle at each, and its foot to drag. */

import { useRef } from "preact/hooks";
import { bent, cos, type Leg, type SampleRobot, type Spot, sin, spots } from "../../core/leg/leg";
import { t } from "../../i18n";
import { Arc, Label, type LabelProps, Line, mm, RightAngle, textSize } from "./svg";

/** A square of the area that the foot reaches [mm]. */
const SQUARE_MM = 2;
const EDGE_MM = 16;
/** A side shorter than this has no number [mm]. */
const SHORT_MM = 4;
/** From the middle of a link to that of its name [mm]. */
const BESIDE_MM = 11;
/** From here on a text has room in an angle [deg]. */
const ROOMY_DEG = 25;

interface Props {
  robot: SampleRobot;
  first: number;
  second: number;
  /** The triangles that are drawn: 1 at the first link, 2 at both. */
  triangles?: 0 | 1 | 2;
  /** Whether there is a shank. */
  hasShank?: boolean;
  /** Whether there is a leg at all. */
  hasLinks?: boolean;
  /** Other postures, pale: 1st and 2nd. */
  others?: readonly (readonly [number, number])[];
  /** Where the foot shall be. */
  target?: Spot | null;
  isReached?: boolean;
  /** Whether the area that the foot reaches is drawn, and there is room for it. */
  hasArea?: boolean;
  isWide?: boolean;
  /** On paper half as large as the robot, for a compass. */
  isHalfSize?: boolean;
  /** Brings the foot to a spot: it can be dragged. */
  onDrag?: ((spot: Spot) => void) | undefined;
}

export function Behind(props: Props) {
  const { robot, first, second, triangles = 0, target, onDrag } = props;
  const { hasShank = true, hasLinks = true, isHalfSize } = props;
  const svg = useRef<SVGSVGElement>(null);
  const leg = robot.legs[0]!;
  const [hip, knee, foot] = spots(leg, first, second);
  const [width, , tall] = robot.size_mm;
  const box = boxOf(leg, props.isWide ?? false);
  const wide = box.right - box.left;
  const middle = -leg.position_mm[2];
  const spotOf = (event: PointerEvent): Spot => {
    const inverse = svg.current!.getScreenCTM()!.inverse();
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(inverse);
    return { r: Math.round(x), z: Math.round(-y) };
  };
  const bring = (spot: Spot) => onDrag?.(inside(box, spot));
  const drag = onDrag && {
    onPointerDown: (event: PointerEvent) => {
      svg.current!.setPointerCapture(event.pointerId);
      bring(spotOf(event));
    },
    onPointerMove: (event: PointerEvent) => {
      if (svg.current!.hasPointerCapture(event.pointerId)) bring(spotOf(event));
    },
  };
  const place = ({ r, z }: Spot) => `translate(${r} ${-z})`;
  return (
    <svg
      ref={svg}
      class={`leg-drawing ${onDrag ? "to-drag" : ""} ${isHalfSize ? "half-size" : ""}`}
      viewBox={`${box.left} ${-box.top} ${wide} ${box.top - box.bottom}`}
      role={onDrag ? "group" : "img"}
      style={textSize(wide) + (isHalfSize ? `; width: ${wide / 2}mm` : "")}
      aria-label={t("leg.fromBehind")}
      {...drag}
    >
      {props.hasArea && <path class="area" d={areaPath(leg)} />}
      <rect
        class="body"
        x={-width / 2}
        y={-(middle + tall / 2)}
        width={width / 2}
        height={tall}
        rx={4}
      />
      <Label x={Math.max(-width / 4, (box.left - 2) / 2)} y={middle + tall / 2 - 10} kind="muted">
        {t("leg.body")}
      </Label>
      {props.others?.map(([one, other]) => (
        <Links key={`${one} ${other}`} leg={leg} first={one} second={other} isPale />
      ))}
      {hasLinks && <Links leg={leg} first={first} second={second} hasShank={hasShank} />}
      {triangles > 0 && <First leg={leg} first={first} />}
      {triangles > 1 && <Second leg={leg} first={first} second={second} />}
      <circle class="joint" cx={0} cy={0} r={5} />
      <circle class="joint" cx={hip.r} cy={0} r={5} />
      {hasLinks && <circle class="joint" cx={knee.r} cy={-knee.z} r={5} />}
      {hasLinks && hasShank && <circle class="foot" cx={foot.r} cy={-foot.z} r={6} />}
      {target && (
        <path
          class={props.isReached === false ? "target missed" : "target"}
          transform={place(target)}
          d="M -9 0 H 9 M 0 -9 V 9"
        />
      )}
      {onDrag && target && (
        <circle
          class="handle"
          transform={place(target)}
          r={13}
          tabindex={0}
          role="slider"
          aria-label={t("leg.foot")}
          aria-valuenow={target.r}
          aria-valuetext={t("leg.spot", { r: target.r, z: target.z })}
          onKeyDown={(event) => {
            const way = WAYS[event.key];
            if (!way) return;
            event.preventDefault();
            const step = event.shiftKey ? 10 : 1;
            bring({ r: target.r + step * way[0], z: target.z + step * way[1] });
          }}
        />
      )}
    </svg>
  );
}

const WAYS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

function boxOf({ lengths_mm: [l0, l1, l2] }: Leg, isWide: boolean) {
  const far = l1 + l2;
  if (isWide) {
    const size = far + EDGE_MM;
    return { left: l0 - size, right: l0 + size, top: size, bottom: -size };
  }
  const right = l0 + far + EDGE_MM;
  return { left: -52, right, top: l1 + EDGE_MM, bottom: -(l2 + 2 * EDGE_MM) };
}

/** The spot itself, or the nearest one in the picture. */
function inside(box: ReturnType<typeof boxOf>, { r, z }: Spot): Spot {
  return {
    r: Math.min(box.right, Math.max(box.left, r)),
    z: Math.min(box.top, Math.max(box.bottom, z)),
  };
}

interface LinksProps {
  leg: Leg;
  first: number;
  second: number;
  hasShank?: boolean;
  isPale?: boolean;
}

function Links({ leg, first, second, hasShank = true, isPale = false }: LinksProps) {
  const [hip, knee, foot] = spots(leg, first, second);
  return (
    <g class={isPale ? "links pale" : "links"}>
      <Line kind="link l0" from={[0, 0]} to={[hip.r, 0]} />
      <Line kind="link l1" from={[hip.r, 0]} to={[knee.r, knee.z]} />
      {hasShank && <Line kind="link l2" from={[knee.r, knee.z]} to={[foot.r, foot.z]} />}
      {!isPale && (
        <>
          <LinkName name="L₁" from={hip} to={knee} />
          {hasShank && <LinkName name="L₂" from={knee} to={foot} />}
        </>
      )}
    </g>
  );
}

/** The name of a link, beside its middle: above L₁, outside of L₂. */
function LinkName({ name, from, to }: { name: string; from: Spot; to: Spot }) {
  const [along, up] = [to.r - from.r, to.z - from.z];
  const share = BESIDE_MM / Math.hypot(along, up);
  const [x, y] = [(from.r + to.r) / 2 - share * up, (from.z + to.z) / 2 + share * along];
  return (
    <Label x={x} y={y} kind="link-name">
      {name}
    </Label>
  );
}

/** The triangle of the first link: beside the angle, and opposite it. */
function First({ leg, first }: { leg: Leg; first: number }) {
  const [hip, knee] = spots(leg, first, 0);
  const along = knee.r - hip.r;
  const side = Math.sign(along) || 1;
  const below = first >= 0 ? -1 : 1;
  return (
    <g class="triangle">
      <Line kind="side" from={[hip.r, 0]} to={[knee.r, 0]} />
      <Line kind="side" from={[knee.r, 0]} to={[knee.r, knee.z]} />
      <RightAngle x={knee.r} y={0} u={-along} v={knee.z} />
      {first !== 0 && <Arc x={hip.r} y={0} radius={26} from={0} to={first} />}
      {Math.abs(along) > SHORT_MM && (
        <Label x={hip.r + along / 2} y={10 * below}>
          {mm(Math.abs(along))}
        </Label>
      )}
      {Math.abs(knee.z) > SHORT_MM && (
        <Label x={knee.r + 8 * side} y={knee.z / 2} anchor={side > 0 ? "start" : "end"}>
          {mm(Math.abs(knee.z))}
        </Label>
      )}
      {first !== 0 && (
        <Label {...firstNameAt(hip, first)} kind="angle">
          θ₁ {mm(first, 0)}°
        </Label>
      )}
    </g>
  );
}

/** Where the size of the first angle stands: in the angle, if there is room, or else beside it. */
function firstNameAt(hip: Spot, first: number): Pick<LabelProps, "x" | "y" | "anchor"> {
  if (Math.abs(first) < ROOMY_DEG) {
    return { x: hip.r - 7, y: first >= 0 ? -13 : 13, anchor: "end" };
  }
  const half = first / 2;
  return { x: hip.r + 32 * cos(half), y: 32 * sin(half), anchor: "start" };
}

/** The triangle that hangs from the knee: below it, and outward. */
function Second({ leg, first, second }: { leg: Leg; first: number; second: number }) {
  const [, knee, foot] = spots(leg, first, second);
  const out = foot.r - knee.r;
  const down = foot.z - knee.z;
  const lean = first + second;
  const side = Math.sign(out) || 1;
  return (
    <g class="triangle">
      <Line kind="side" from={[knee.r, knee.z]} to={[knee.r, foot.z]} />
      <Line kind="side" from={[knee.r, foot.z]} to={[foot.r, foot.z]} />
      <RightAngle x={knee.r} y={foot.z} u={out} v={-down} />
      {Math.abs(lean) > 1 && <Arc x={knee.r} y={knee.z} radius={30} from={-90} to={-90 + lean} />}
      {Math.abs(out) > SHORT_MM && (
        <Label x={knee.r + out / 2} y={foot.z + Math.sign(down || -1) * 10}>
          {mm(Math.abs(out))}
        </Label>
      )}
      {Math.abs(down) > SHORT_MM && (
        <Label x={knee.r - 6 * side} y={knee.z + 0.75 * down} anchor={side > 0 ? "end" : "start"}>
          {mm(Math.abs(down))}
        </Label>
      )}
      <Label x={knee.r} y={knee.z - Math.sign(down || -1) * 12} kind="angle">
        θ₁ + θ₂ {mm(lean, 0)}°
      </Label>
    </g>
  );
}

const areas = new Map<Leg, string>();

/** The squares whose middle the foot reaches, row by row. */
function areaPath(leg: Leg): string {
  const known = areas.get(leg);
  if (known !== undefined) return known;
  const [l0, l1, l2] = leg.lengths_mm;
  const far = Math.ceil((l1 + l2) / SQUARE_MM) * SQUARE_MM;
  let path = "";
  for (let z = -far; z <= far; z += SQUARE_MM) {
    let begun: number | null = null;
    for (let x = -far; x <= far + SQUARE_MM; x += SQUARE_MM) {
      const isIn = bent(leg, { r: l0 + x, z }).postures.length > 0;
      if (isIn && begun === null) begun = x;
      if (isIn || begun === null) continue;
      const left = l0 + begun - SQUARE_MM / 2;
      path += `M${left} ${-z - SQUARE_MM / 2}h${x - begun}v${SQUARE_MM}h${begun - x}z`;
      begun = null;
    }
  }
  areas.set(leg, path);
  return path;
}
