/** The robot's own numbers (workshop 4-3), each with what the contest allows. */

import type { RobotReply } from "../../../core/wire";
import { type MessageName, t } from "../../../i18n";

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

interface Props {
  robot: RobotReply | null;
  /** Name of its file; "": the workshop's hexapod. */
  file: string;
}

export function Robot({ robot, file }: Props) {
  if (!robot) return null;
  return (
    <section class="robot" aria-label={t("design.robot")}>
      <p>
        <b>{robot.name}</b> <span class="muted">{file || t("design.workshopRobot")}</span>
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
