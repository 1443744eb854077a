/** The end of the lesson: the three numbers go into posture 1 of the table. */

import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { joint, LEVELS } from "../../core/design/table";
import { GIVEN_LEG, written } from "../../core/leg/given";
import { points, spots, type Three } from "../../core/leg/leg";
import { hasPage } from "../../core/served";
import { t } from "../../i18n";
import { Joints } from "./controls";
import { RootFormula } from "./formulas";
import type { Lesson } from "./lesson";

const DESIGN = "design";

const placeOf = ([x, y, z]: Three) => ({ x, y, z });

export function Table({ lesson }: { lesson: Lesson }) {
  const canOpen = useSignal(false);
  useEffect(() => {
    void hasPage(`/${DESIGN}`).then((found) => {
      canOpen.value = found;
    });
  }, [canOpen]);
  const leg = lesson.leg.value;
  const legs = lesson.robot.value.legs.length;
  const whole = lesson.angles.value.map((angle) => Math.round(angle) + 0);
  const angles = whole as unknown as Three;
  const foot = spots(leg, angles[1], angles[2])[2];
  const query = new URLSearchParams({ [GIVEN_LEG]: written({ label: leg.label, angles }) });
  return (
    <>
      <table class="posture">
        <thead>
          <tr>
            {LEVELS.map((level, index) => (
              <th key={level} scope="col">
                {leg.label} {level}
                <small>{t("leg.table.joint", { joint: joint(0, index, legs) })}</small>
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          <tr>
            {angles.map((angle, index) => (
              <td key={index}>{angle}</td>
            ))}
          </tr>
        </tbody>
      </table>
      <p class="muted">{t("leg.table.round", { ...foot })}</p>
      <Joints lesson={lesson} levels={[0, 1, 2]} />
      <p>{t("leg.table.root", placeOf(leg.position_mm))}</p>
      <RootFormula r={foot.r} root={angles[0]} />
      <p>{t("leg.table.foot", placeOf(points(leg, angles)[3]))}</p>
      {canOpen.value ? (
        <a class="button strong" href={`${DESIGN}?${query}`}>
          {t("leg.table.open")}
        </a>
      ) : (
        <p>{t("leg.table.none")}</p>
      )}
      <p>{t("leg.table.then")}</p>
    </>
  );
}
