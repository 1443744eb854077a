/** A picture of the robot's legs and joints, to point at. */

import { jointsOfLeg } from "../../../core/design/parts";
import { joint, LEVELS } from "../../../core/design/table";
import { mirrorLeg } from "../../../core/design/tools";
import type { RobotReply } from "../../../core/wire";
import { t } from "../../../i18n";
import { classes, jointName } from "../names";
import type { Sheet } from "../table/sheet";
import "./robot.css";

const PITCH = 52;
const HALF_BODY = 24;
const FIRST_OUT = 40;
const STEP_OUT = 27;
const RADIUS = 11;
const WIDTH = 236;

/** Legs and joints, numbered clockwise from the right front (workshop 3-1), seen from above. */
interface Props {
  robot: RobotReply | null;
  sheet: Sheet;
}

export function LegPicture({ robot, sheet }: Props) {
  if (!robot) return null;
  const legs = robot.legs.length;
  const pairs = Math.ceil(legs / 2);
  const height = pairs * PITCH + 30;
  const lit = new Set(sheet.lit.value);
  return (
    <figure class="leg-picture">
      <svg
        viewBox={`${-WIDTH / 2} 0 ${WIDTH} ${height}`}
        role="img"
        aria-label={t("design.legPicture")}
        onPointerLeave={() => sheet.point([])}
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
              sheet={sheet}
              labels={robot.legs}
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
  sheet: Sheet;
  labels: readonly string[];
  leg: number;
  legs: number;
  /** 1: right, -1: left. */
  side: number;
  y: number;
  lit: ReadonlySet<number>;
}

function Leg({ sheet, labels, leg, legs, side, y, lit }: LegProps) {
  const select = (level: number) =>
    sheet.select({ row: sheet.active.peek().row, col: joint(leg, level, legs) });
  const outward = (level: number) => side * (FIRST_OUT + level * STEP_OUT);
  return (
    <g class={classes("leg", jointsOfLeg(leg, legs).some((one) => lit.has(one)) && "lit")}>
      <line x1={side * HALF_BODY} x2={outward(2)} y1={y} y2={y} />
      {/* biome-ignore lint/a11y/noStaticElementInteractions: the table does the same by keyboard */}
      <g
        class="leg-number"
        onPointerEnter={() => sheet.point(jointsOfLeg(leg, legs))}
        onClick={() => select(0)}
      >
        <title>{labels[leg]}</title>
        <rect x={side * 12 - 11} y={y - 9} width={22} height={18} rx={5} />
        <text x={side * 12} y={y + 4}>
          {labels[leg]}
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
            onPointerEnter={() => sheet.point([id])}
            onClick={() => select(level)}
          >
            <title>{jointName(labels, id)}</title>
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
