/** The robot's own numbers (workshop 4-3), each with what the contest allows. */

import type { RobotReply } from "../../../core/wire";
import { type MessageName, t } from "../../../i18n";
import { hasKeyboard } from "../../../ui/screen";
import type { Can } from "../can";
import type { Files } from "../files/files";
import { Field } from "./field";
import type { Numbers } from "./numbers";
import type { RobotInUse } from "./robot";
import { limitText, NUMBERS, OF_A_LEG, pairOf, textOf, unitOf } from "./units";

interface Props {
  robot: RobotInUse;
  numbers: Numbers;
  files: Files;
  can: Can;
}

export function Robot({ robot, numbers, files, can }: Props) {
  const used = robot.used.value;
  if (!used) return null;
  const { reply, name } = used;
  return (
    <section class="robot" aria-label={t("design.robot")}>
      <p>
        <b>{reply.name}</b> <span class="muted">{name || t("design.workshopRobot")}</span>
      </p>
      {used.text !== null && (
        <p class="robot-file">
          <button
            class="button small"
            type="button"
            disabled={can.save && robot.isSaved.value}
            onClick={() => void files.keepRobot()}
          >
            {t(can.save ? "design.saveRobot" : "design.downloadRobot")}
          </button>
          {can.save && (
            <small class={robot.isSaved.value ? "muted" : "unsaved"}>
              {t(robot.isSaved.value ? "design.isSaved" : "design.unsaved")}
            </small>
          )}
        </p>
      )}
      <p class="muted">
        {t("design.robotHint")} {hasKeyboard.value && t("design.robotKeys")}
      </p>
      <table class="facts">
        <thead>
          <tr>
            <th scope="col">{t("design.number")}</th>
            <th scope="col">{t("design.value")}</th>
            <th scope="col">{t("design.limits")}</th>
          </tr>
        </thead>
        <tbody>
          {NUMBERS.filter(([fact]) => fact in reply.facts).map(([fact, isFree]) => (
            <Fact key={fact} robot={reply} name={fact} numbers={isFree ? numbers : null} />
          ))}
        </tbody>
      </table>
      <LegPlaces robot={reply} numbers={numbers} />
    </section>
  );
}

/** Where each leg is fixed to the body, and where it points. */
function LegPlaces({ robot, numbers }: { robot: RobotReply; numbers: Numbers }) {
  return (
    <>
      <h3>{t("design.legPlaces")}</h3>
      <p class="muted">{t("design.legPlacesHint")}</p>
      <table class="facts leg-places">
        <thead>
          <tr>
            <th scope="col">{t("design.legPlaces.leg")}</th>
            {OF_A_LEG.map((entry) => (
              <th key={entry} scope="col">
                {t(`design.fact.${entry}`)} <small>{unitOf(entry).shown}</small>
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {robot.shapes.map(({ label }, leg) => (
            <tr key={label}>
              <th scope="row">{label}</th>
              {OF_A_LEG.map((entry) => (
                <td key={entry}>
                  <Field
                    numbers={numbers}
                    number={{ entry, leg }}
                    label={`${label}, ${t(`design.fact.${entry}`)}`}
                    shown={textOf(pairOf(robot, { entry, leg })[0], unitOf(entry))}
                    robot={robot}
                  />
                </td>
              ))}
            </tr>
          ))}
        </tbody>
      </table>
    </>
  );
}

interface FactProps {
  robot: RobotReply;
  name: string;
  /** null: the number follows from others. */
  numbers: Numbers | null;
}

function Fact({ robot, name, numbers }: FactProps) {
  const unit = unitOf(name);
  const number = { entry: name, leg: null };
  const [low, high] = pairOf(robot, number);
  const limits = robot.limits[name] as [number | null, number | null] | undefined;
  const isOut =
    limits &&
    ((limits[0] !== null && low < limits[0] - 1e-9) ||
      (limits[1] !== null && high > limits[1] + 1e-9));
  const label = t(`design.fact.${name}` as MessageName);
  const shown = low === high ? textOf(low, unit) : `${textOf(low, unit)} – ${textOf(high, unit)}`;
  return (
    <tr class={isOut ? "out" : ""} data-fact={name} data-unit={unit.of}>
      <th scope="row">
        {label} {unit.shown && <small>{unit.shown}</small>}
      </th>
      <td>
        {numbers ? (
          <Field numbers={numbers} number={number} label={label} shown={shown} robot={robot} />
        ) : (
          shown
        )}
      </td>
      <td>{limitText(limits, unit)}</td>
    </tr>
  );
}
