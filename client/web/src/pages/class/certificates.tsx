/** Certificates for who finished the workshop; a name that is typed here leaves this page never. */

import { useSignal } from "@preact/signals";
import { PHASES } from "../../core/class";
import type { Card } from "../../core/wire";
import { t } from "../../i18n";
import { Certificate, Papers } from "../../ui/papers";
import { phaseTitle } from "./controls";
import type { Teacher } from "./teacher";

/** Whether a student has finished all phases of the workshop; the lesson before them is extra. */
function isDone({ states }: Card): boolean {
  return PHASES.every((phase) => phase === 0 || states[phase] === "met");
}

export function Certificates({ teacher }: { teacher: Teacher }) {
  const done = teacher.cards.value.filter(isDone);
  return (
    <Papers
      paper="certificates"
      hint={t("class.certificates.hint")}
      onBack={() => {
        teacher.screen.value = null;
      }}
    >
      {!done.length && <p class="muted">{t("class.certificates.none")}</p>}
      {done.map((card) => (
        <Certificate
          key={card.name}
          of={t("class.certificates.of")}
          title={t("class.certificates.title")}
          who={<Name card={card} />}
        >
          {t("class.certificates.for")}
          <small>
            {PHASES.filter((phase) => phase > 0)
              .map(phaseTitle)
              .join(" · ")}
          </small>
          {card.best_mm_s !== null && (
            <small>{t("class.certificates.best", { speed: Math.round(card.best_mm_s) })}</small>
          )}
        </Certificate>
      ))}
    </Papers>
  );
}

/** The nickname, until the teacher types the name that shall stand there. */
function Name({ card }: { card: Card }) {
  const name = useSignal(card.name);
  return (
    <input
      class="name"
      aria-label={t("class.certificates.name", { name: card.name })}
      value={name.value}
      onInput={({ currentTarget }) => {
        name.value = currentTarget.value;
      }}
    />
  );
}
