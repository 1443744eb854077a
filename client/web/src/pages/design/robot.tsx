/** The robot: a picture of its legs and joints to point at, and its numbers beside their limits. */

import { jointsOfLeg } from "../../core/design/parts";
import { joint, LEVELS } from "../../core/design/table";
import { mirrorLeg } from "../../core/design/tools";
import type { RobotReply } from "../../core/wire";
import { type MessageName, t } from "../../i18n";
import { classes } from "./rows";
import { jointName, type Studio } from "./studio";

const PITCH = 52;
const HALF_BODY = 24;
const FIRST_OUT = 40;
const STEP_OUT = 27;
const RADIUS = 11;
const WIDTH = 236;

/** Legs and joints, numbered clockwise from the right front (workshop 3-1), seen from above. */
export function LegPicture({ studio }: { studio: Studio }) {
  const robot = studio.robot.value;
  if (!robot) return null;
  const legs = robot.legs.length;
  const pairs = Math.ceil(legs / 2);
  const height = pairs * PITCH + 30;
  const lit = new Set(studio.lit.value);
  return (
    <figure class="leg-picture">
      <svg
        viewBox={`${-WIDTH / 2} 0 ${WIDTH} ${height}`}
        role="img"
        aria-label={t("design.legPicture")}
        onPointerLeave={() => studio.point([])}
      >
        <text class="front" x={0} y={12}>
          {t("design.front")}
        </text>
        <rect
          class="body"
          x={-HALF_BODY}
          y={18}
          width={2 * HALF_BODY}
          height={height - 24}
          rx={10}
        />
        <path class="eyes" d={`M -12 25 h 6 M 6 25 h 6`} />
        {robot.legs.map((label, leg) => {
          const isRight = leg < mirrorLeg(leg, legs);
          const place = isRight ? leg : mirrorLeg(leg, legs);
          const y = 18 + (place + 0.5) * ((height - 24) / pairs);
          return (
            <Leg
              key={label}
              studio={studio}
              label={label}
              leg={leg}
              legs={legs}
              side={isRight ? 1 : -1}
              y={y}
              lit={lit}
            />
          );
        })}
      </svg>
      <figcaption class="muted">{t("design.legHint")}</figcaption>
    </figure>
  );
}

interface LegProps {
  studio: Studio;
  label: string;
  leg: number;
  legs: number;
  /** 1: right, -1: left. */
  side: number;
  y: number;
  lit: ReadonlySet<number>;
}

function Leg({ studio, label, leg, legs, side, y, lit }: LegProps) {
  const select = (level: number) =>
    studio.select({ row: studio.active.peek().row, col: joint(leg, level, legs) });
  const outward = (level: number) => side * (FIRST_OUT + level * STEP_OUT);
  return (
    <g class={classes("leg", jointsOfLeg(leg, legs).some((one) => lit.has(one)) && "lit")}>
      <line x1={side * HALF_BODY} x2={outward(2)} y1={y} y2={y} />
      {/* biome-ignore lint/a11y/noStaticElementInteractions: the table does the same by keyboard */}
      <g
        class="leg-number"
        onPointerEnter={() => studio.point(jointsOfLeg(leg, legs))}
        onClick={() => select(0)}
      >
        <title>{label}</title>
        <rect x={side * 12 - 11} y={y - 9} width={22} height={18} rx={5} />
        <text x={side * 12} y={y + 4}>
          {label}
        </text>
      </g>
      {LEVELS.map((_, level) => {
        const id = joint(leg, level, legs);
        return (
          // biome-ignore lint/a11y/noStaticElementInteractions: the table does the same by keyboard
          <g
            key={id}
            class={classes("joint", lit.has(id) && "lit")}
            data-joint={id}
            onPointerEnter={() => studio.point([id])}
            onClick={() => select(level)}
          >
            <title>{jointName([...studio.robot.peek()!.legs], id)}</title>
            <circle cx={outward(level)} cy={y} r={RADIUS} />
            <text x={outward(level)} y={y + 4}>
              {id}
            </text>
          </g>
        );
      })}
    </g>
  );
}

const FACTS = [
  "legs",
  "width_m",
  "length_m",
  "height_m",
  "mass_kg",
  "body_mass_kg",
  "link_mass_kg",
  "root_link_m",
  "first_link_m",
  "second_link_m",
  "link_radius_m",
  "range_deg",
  "drop_m",
  "ang_min_deg_s",
  "hold_s",
  "torque_n_m",
  "kp",
  "kv",
  "damping",
  "armature",
  "friction",
] as const;

/** The robot's own numbers (workshop 4-3), each with what the contest allows. */
export function Robot({ studio }: { studio: Studio }) {
  const robot = studio.robot.value;
  if (!robot) return null;
  return (
    <section class="robot" aria-label={t("design.robot")}>
      <p>
        <b>{robot.name}</b>{" "}
        <span class="muted">{studio.robotName.value || t("design.workshopRobot")}</span>
      </p>
      <p class="muted">{t("design.robotHint")}</p>
      <table class="facts">
        <thead>
          <tr>
            <th scope="col">{t("design.number")}</th>
            <th scope="col">{t("design.value")}</th>
            <th scope="col">{t("design.limits")}</th>
          </tr>
        </thead>
        <tbody>
          {FACTS.filter((name) => name in robot.facts).map((name) => (
            <Fact key={name} robot={robot} name={name} />
          ))}
        </tbody>
      </table>
    </section>
  );
}

function Fact({ robot, name }: { robot: RobotReply; name: (typeof FACTS)[number] }) {
  const [of, shown] = UNITS.find(([end]) => name.endsWith(end)) ?? ["", { unit: "", times: 1 }];
  const text = (value: unknown) =>
    typeof value === "number" ? String(Number((value * shown.times).toPrecision(4))) : "–";
  const value = robot.facts[name];
  const [low, high] = Array.isArray(value) ? value : [value, value];
  const limit = robot.limits[name] as [number | null, number | null] | undefined;
  const isOut =
    limit &&
    ((typeof low === "number" && limit[0] !== null && low < limit[0] - 1e-9) ||
      (typeof high === "number" && limit[1] !== null && high > limit[1] + 1e-9));
  return (
    <tr class={isOut ? "out" : ""} data-fact={name} data-unit={of}>
      <th scope="row">
        {t(`design.fact.${name}` as MessageName)} {shown.unit && <small>{shown.unit}</small>}
      </th>
      <td>{low === high ? text(low) : `${text(low)} – ${text(high)}`}</td>
      <td>{limit ? limitText(limit.map((one) => (one === null ? null : text(one)))) : "–"}</td>
    </tr>
  );
}

function limitText([low, high]: (string | null)[]): string {
  if (low == null && high == null) return "–";
  if (low == null) return `≤ ${high}`;
  return high == null ? `≥ ${low}` : `${low} – ${high}`;
}

/** How numbers are shown, by the end of their names. */
const UNITS: readonly [string, { unit: string; times: number }][] = [
  ["_n_m", { unit: "N m", times: 1 }],
  ["_deg_s", { unit: "°/s", times: 1 }],
  ["_m", { unit: "mm", times: 1000 }],
  ["_kg", { unit: "g", times: 1000 }],
  ["_deg", { unit: "°", times: 1 }],
  ["_s", { unit: "s", times: 1 }],
];
