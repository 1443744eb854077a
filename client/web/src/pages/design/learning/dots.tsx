/** The phases as dots, each of which opens its task (workshop 4-2). */

import type { PhaseState } from "../../../core/wire";
import { type MessageName, said, t } from "../../../i18n";
import type { Learning } from "./learning";

export function PhaseDots({ learning, onOpen }: { learning: Learning; onOpen: () => void }) {
  const now = learning.phases.value;
  if (!now) return null;
  return (
    <nav class="phase-dots" aria-label={t("design.phases")}>
      {now.phases.map((phase) => (
        <button
          key={phase.number}
          type="button"
          data-state={phase.state}
          aria-current={phase.number === now.phase ? "step" : undefined}
          aria-label={phaseName(phase)}
          title={phaseName(phase)}
          onClick={() => {
            if (phase.number !== now.phase) void learning.goTo(phase.number);
            onOpen();
          }}
        >
          {phase.state === "met" ? "✓" : phase.number}
        </button>
      ))}
    </nav>
  );
}

/** "2 Three legs, done" */
function phaseName({ number, title, state }: PhaseState): string {
  return t("design.phase.name", { number, title: said(title), state: stateName(state) });
}

export function stateName(state: string): string {
  return t(`design.phase.${state}` as MessageName);
}
