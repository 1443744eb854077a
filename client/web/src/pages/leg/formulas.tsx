/** The formulas beside the pictures, with the numbers of the moment in them. */

import { bodyWay, cos, type Leg, sin, spots } from "../../core/leg/leg";
import { t } from "../../i18n";
import { mm } from "./svg";

/** Each line: a formula, its numbers, and what comes out. */
function Lines({ lines }: { lines: readonly (readonly [string, string, string])[] }) {
  return (
    <section class="formulas" aria-label={t("leg.formula")}>
      {lines.map(([letters, numbers, result]) => (
        <p key={letters}>
          <span>{letters}</span> <span>= {numbers}</span> <strong>= {result} mm</strong>
        </p>
      ))}
    </section>
  );
}

/** An angle in a formula. */
function deg(angle: number): string {
  return `${mm(angle, Number.isInteger(angle) ? 0 : 1)}°`;
}

export function KneeFormula({ leg, first }: { leg: Leg; first: number }) {
  const l1 = leg.lengths_mm[1];
  const [, knee] = spots(leg, first, 0);
  return <Lines lines={[["z = L₁ sin θ₁", `${l1} · sin ${deg(first)}`, mm(knee.z)]]} />;
}

interface FootProps {
  leg: Leg;
  first: number;
  second: number;
}

export function FootFormula({ leg, first, second }: FootProps) {
  const [l0, l1, l2] = leg.lengths_mm;
  const [, , foot] = spots(leg, first, second);
  const lean = deg(first + second);
  return (
    <Lines
      lines={[
        [
          "r = L₀ + L₁ cos θ₁ + L₂ sin(θ₁ + θ₂)",
          `${l0} + ${l1} · cos ${deg(first)} + ${l2} · sin ${lean}`,
          mm(foot.r),
        ],
        [
          "z = L₁ sin θ₁ − L₂ cos(θ₁ + θ₂)",
          `${l1} · sin ${deg(first)} − ${l2} · cos ${lean}`,
          mm(foot.z),
        ],
      ]}
    />
  );
}

/** Where the foot is, seen from above: Root turns the whole leg. */
export function RootFormula({ r, root }: { r: number; root: number }) {
  return (
    <Lines
      lines={[
        [`${t("leg.forward")}: r sin θ₀`, `${mm(r)} · sin ${deg(root)}`, mm(r * sin(root))],
        [`${t("leg.outward")}: r cos θ₀`, `${mm(r)} · cos ${deg(root)}`, mm(r * cos(root))],
      ]}
    />
  );
}

export function SwingFormula({ r, swing }: { r: number; swing: number }) {
  return (
    <Lines
      lines={[["2 r sin(Δ/2)", `2 · ${mm(r)} · sin ${deg(swing / 2)}`, mm(bodyWay(r, swing))]]}
    />
  );
}
