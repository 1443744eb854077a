/** A student at a glance: one small card. */

import type { ComponentChildren } from "preact";
import { barsPath, elapsed, LESSON_STEPS, PHASES } from "../../core/class";
import type { Card } from "../../core/wire";
import { said, t } from "../../i18n";
import { Icon } from "../../ui/icons";
import type { Teacher } from "./teacher";

/** A mark for each state of a phase, so that nobody has to tell colours apart. */
const MARKS = { met: "✓", open: "", skipped: "–" } as const;

interface Props {
  teacher: Teacher;
  card: Card;
  /** Whether Tab leads to it. */
  isStop: boolean;
}

export function StudentCard({ teacher, card, isStop }: Props) {
  const what = news(teacher, card);
  return (
    <li>
      <StudentButton teacher={teacher} card={card} isStop={isStop}>
        <span class="walk">
          <Feet card={card} />
          <span class="speeds">
            <b>{speed(card.best_mm_s)}</b>
            <small>{speed(card.last_mm_s)}</small>
          </span>
        </span>
        {what && <span class="news">{what}</span>}
      </StudentButton>
    </li>
  );
}

interface ButtonProps extends Props {
  /** The line of the student's group in which it stands; without it, the student works alone. */
  member?: { role: string };
  children?: ComponentChildren;
}

/** Opens a student: the name, what the teacher should see at once, and the phases. */
export function StudentButton({ teacher, card, isStop, member, children }: ButtonProps) {
  const name = teacher.name(card.name);
  const text = summary(teacher, card);
  return (
    <button
      type="button"
      class={member ? "student member" : "student"}
      tabIndex={isStop ? 0 : -1}
      data-student={card.name}
      data-need={card.need}
      data-online={card.online}
      aria-label={`${name}: ${text}`}
      title={(member && news(teacher, card)) || text}
      onClick={() => {
        teacher.opened.value = card.name;
      }}
    >
      <span class="who">
        {card.hand_up_s !== null && <Icon name="hand" />}
        <b>{name}</b>
        {member?.role && <small>{member.role}</small>}
        {card.coached && <i class="coached">C</i>}
      </span>
      <Dots card={card} />
      {children}
    </button>
  );
}

/** The phases as dots: how far, what was left out, and where the student is. */
export function Dots({ card }: { card: Card }) {
  return (
    <span class="dots">
      {PHASES.map((phase) => {
        const state = card.states[phase] ?? "open";
        return (
          <i key={phase} data-state={state} data-now={phase === card.phase}>
            {phase === card.phase && state !== "met" ? phase : MARKS[state]}
          </i>
        );
      })}
    </span>
  );
}

/** When each foot was down in the last trial, a row for each leg. */
export function Feet({ card }: { card: Card }) {
  const { feet } = card;
  if (!feet?.length) {
    // After a restart of the class the figures are there, but no trial to draw.
    const why = card.best_mm_s === null ? "class.noTrial" : "class.noTrialSince";
    return <span class="feet empty">{t(why)}</span>;
  }
  return (
    <svg
      class="feet"
      viewBox={`0 0 100 ${feet.length}`}
      preserveAspectRatio="none"
      role="img"
      aria-label={t("class.feet")}
    >
      <path d={barsPath(feet)} />
    </svg>
  );
}

/** A speed as a card writes it [mm/s]; "–" where there is none. */
export function speed(mmS: number | null): string {
  return mmS === null ? "–" : String(Math.round(mmS)).replace("-", "−");
}

/** "3 min" */
export function since(teacher: Teacher, thenS: number): string {
  const { unit, count } = elapsed(teacher.nowS.value, thenS);
  return t(`class.${unit}`, { count });
}

/** The one thing that a teacher should know now; "" if there is none. */
export function news(teacher: Teacher, card: Card): string {
  if (!card.online) return t("class.offline", { since: since(teacher, card.seen_s) });
  if (card.hand_up_s !== null) {
    return t("class.hand", { since: since(teacher, card.hand_up_s) });
  }
  if (card.stuck) return said(card.stuck);
  if (card.in_lesson) return lessonStep(card);
  if (card.need === "quiet") return t("class.quiet", { since: since(teacher, card.seen_s) });
  return "";
}

/** Where in the lesson of one leg the student is. */
export function lessonStep({ lesson_step: step }: Card): string {
  return t("class.lesson", { step: Math.max(1, step), of: LESSON_STEPS });
}

/** A card in words. */
export function summary(teacher: Teacher, card: Card): string {
  const parts = [
    news(teacher, card),
    card.hand_up_s !== null && card.stuck && said(card.stuck),
    card.lesson_step > 0 && !card.in_lesson && lessonStep(card),
    t("class.atPhase", { number: card.phase, percent: Math.round(100 * card.share) }),
    ...PHASES.filter((phase) => card.states[phase] !== "open").map((number) =>
      t("class.state", { number, state: t(`class.legend.${card.states[number]!}`) }),
    ),
    card.best_mm_s === null
      ? t("class.noTrial")
      : t("class.bestText", { speed: speed(card.best_mm_s) }),
    card.last_mm_s !== null && t("class.lastText", { speed: speed(card.last_mm_s) }),
    card.coached && t("class.coached"),
  ];
  return parts.filter(Boolean).join(", ");
}
