/** A group at a glance: one card with a line for each member. */

import type { Card, ClassGroup } from "../../core/wire";
import { t } from "../../i18n";
import { Feet, StudentButton, speed } from "./card";
import type { Teacher } from "./teacher";

interface Props {
  teacher: Teacher;
  group: ClassGroup;
  /** Those of its members, whoever needs help first first. */
  cards: readonly Card[];
  /** The student to whom Tab leads. */
  stop: string | undefined;
}

export function GroupCard({ teacher, group, cards, stop }: Props) {
  const name = teacher.hide(group.name);
  const walked = cards.find(({ feet }) => feet?.length) ?? cards[0]!;
  const best = Math.max(...cards.map((card) => card.best_mm_s ?? Number.NEGATIVE_INFINITY));
  return (
    <li class="class-group" aria-label={t("class.group.card", { name })}>
      <span class="who">
        <b>{name}</b>
        {group.word && <i>{group.word}</i>}
        {Number.isFinite(best) && <small>{speed(best)} mm/s</small>}
      </span>
      <Feet card={walked} />
      {cards.map((card) => {
        const role = group.roles[card.name];
        return (
          <StudentButton
            key={card.name}
            teacher={teacher}
            card={card}
            isStop={card.name === stop}
            member={{ role: role ? t(`class.group.${role}`) : "" }}
          />
        );
      })}
    </li>
  );
}
