/** The worksheet of the lesson, to print; the teacher's has the answers. */

import type { ComponentChildren } from "preact";
import { joint, LEVELS } from "../../core/design/table";
import { bent, bodyWay, type SampleRobot, spots } from "../../core/leg/leg";
import { farSpot, feetOf, KNEE_DEG, SWING_DEG, standing, startOf } from "../../core/leg/lesson";
import { margin } from "../../core/leg/stance";
import { t } from "../../i18n";
import { RobotAbove } from "./above";
import { Behind } from "./behind";
import { mm } from "./svg";

interface Props {
  robot: SampleRobot;
  hasAnswers: boolean;
}

export function Sheet({ robot, hasAnswers }: Props) {
  const leg = robot.legs[0]!;
  const [l0, l1, l2] = leg.lengths_mm;
  const [, first, second] = startOf(robot);
  const foot = spots(leg, first, second)[2];
  const far = farSpot(robot);
  const found = bent(leg, far).postures;
  const set = standing(robot)[0]!;
  const feet = feetOf(robot);
  const inside = margin(set.map((one) => feet[one]!)) ?? 0;
  const count = robot.legs.length;
  const asked = [count, 2 * count + 1, 3 * count - 1];
  const line = (name: string, answer: number) => (
    <Line key={name} name={name} answer={answer} hasAnswers={hasAnswers} />
  );
  const blank = (answer: string) => <Blank answer={hasAnswers ? answer : null} />;
  return (
    <article class={hasAnswers ? "worksheet answered" : "worksheet"}>
      <header>
        <h1>{t("leg.title")}</h1>
        {hasAnswers ? (
          <p class="teacher">{t("leg.sheet.teacher")}</p>
        ) : (
          <p class="who">
            {t("leg.sheet.name")} <Blank answer={null} isLong /> {t("leg.sheet.date")}{" "}
            <Blank answer={null} />
          </p>
        )}
        <p>{t("leg.sheet.given", { robot: robot.name, l0, l1, l2 })}</p>
      </header>
      <ol>
        <Task
          picture={
            <RobotAbove robot={robot} numbers={hasAnswers ? null : [0, joint(0, 1, count) - 1]} />
          }
        >
          <p>{t("leg.sheet.joints")}</p>
          {asked.map((id) => (
            <p key={id} class="line">
              {id}: {blank(`${robot.legs[id % count]!.label} ${LEVELS[Math.floor(id / count)]}`)}
            </p>
          ))}
        </Task>
        <Task
          picture={
            <Behind
              robot={robot}
              first={KNEE_DEG}
              second={0}
              hasShank={false}
              triangles={hasAnswers ? 1 : 0}
            />
          }
        >
          <p>{t("leg.sheet.knee")}</p>
          {[KNEE_DEG, 2 * KNEE_DEG].map((angle) => line(`${angle}°`, spots(leg, angle, 0)[1].z))}
        </Task>
        <Task
          picture={
            <Behind robot={robot} first={first} second={second} triangles={hasAnswers ? 2 : 0} />
          }
        >
          <p>
            {t("leg.sheet.foot")} θ₁ = {first}°, θ₂ = {second}°
          </p>
          <p class="line">r = L₀ + L₁ cos θ₁ + L₂ sin(θ₁ + θ₂)</p>
          <p class="line">z = L₁ sin θ₁ − L₂ cos(θ₁ + θ₂)</p>
          {line("r", foot.r)}
          {line("z", foot.z)}
        </Task>
        <Task>
          <p>{t("leg.sheet.swing", { r: foot.r })}</p>
          {[SWING_DEG, 2 * SWING_DEG].map((swing) => line(`Δ = ${swing}°`, bodyWay(foot.r, swing)))}
        </Task>
        <Task
          picture={
            <Behind
              robot={robot}
              first={found[0]?.[0] ?? 0}
              second={found[0]?.[1] ?? 0}
              others={hasAnswers ? found.slice(1) : []}
              hasLinks={hasAnswers}
              target={far}
              isHalfSize
            />
          }
        >
          <p>{t("leg.sheet.back", { ...far })}</p>
          {found.map(([one, other], index) => (
            <p key={index} class="line">
              1st {blank(`${mm(one)}°`)} 2nd {blank(`${mm(other)}°`)}
            </p>
          ))}
        </Task>
        <Task picture={<RobotAbove robot={robot} down={new Set(set)} hasArea={hasAnswers} />}>
          <p>
            {t("leg.sheet.stand", { legs: set.map((one) => robot.legs[one]!.label).join(" ") })}
          </p>
          <p class="line">
            {blank(inside > 0 ? `${t("leg.stand.yes")}, ${mm(inside, 0)} mm` : t("leg.stand.no"))}
          </p>
        </Task>
      </ol>
    </article>
  );
}

/** A task with its picture beside it. */
function Task({ children, picture }: { children: ComponentChildren; picture?: ComponentChildren }) {
  return (
    <li>
      <div>
        <div>{children}</div>
        {picture}
      </div>
    </li>
  );
}

/** A length to guess and to compute. */
function Line({ name, answer, hasAnswers }: { name: string; answer: number; hasAnswers: boolean }) {
  return (
    <p class="line">
      {name}: {t("leg.sheet.guess")} <Blank answer={null} /> {t("leg.sheet.computed")}{" "}
      <Blank answer={hasAnswers ? mm(answer) : null} /> mm
    </p>
  );
}

/** A line to write on; in the teacher's version the answer stands there. */
function Blank({ answer, isLong = false }: { answer: string | null; isLong?: boolean }) {
  return <span class={isLong ? "blank long" : "blank"}>{answer ?? "\u00a0"}</span>;
}
