/** The phases as dots, each of which opens its task (workshop 4-2). */

import type { PhaseState } from "../../../core/wire";
import { type MessageName, said, t } from "../../../i18n";
import { toast } from "../../../ui/toasts";
import { type Can, isClosed } from "../can";
import type { Learning } from "./learning";

interface Props {
  learning: Learning;
  can: Can;
  onOpen: () => void;
}

export function PhaseDots({ learning, can, onOpen }: Props) {
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
          aria-disabled={isClosed(can, phase.number) || undefined}
          aria-label={phaseName(phase, can)}
          title={phaseName(phase, can)}
          onClick={() => {
            if (phase.number !== now.phase && isClosed(can, phase.number)) {
              toast(closedText(phase.number), "no");
              return;
            }
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
function phaseName({ number, title, state }: PhaseState, can: Can): string {
  const is = isClosed(can, number) ? t("design.class.closed") : stateName(state);
  return t("design.phase.name", { number, title: said(title), state: is });
}

/** Why a phase can't be entered. */
export function closedText(number: number): string {
  return said({ code: "class.phase-closed", values: { number } });
}

export function stateName(state: string): string {
  return t(`design.phase.${state}` as MessageName);
}
