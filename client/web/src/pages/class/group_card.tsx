/** A group at a glance: one card with a line for each member. */

import type { Card, ClassGroup } from "../../core/wire";
import { t } from "../../i18n";
import { Icon } from "../../ui/icons";
import { Dots, Feet, news, speed, summary } from "./card";
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
      {cards.map((card) => (
        <Member
          key={card.name}
          teacher={teacher}
          card={card}
          role={group.roles[card.name] ?? ""}
          isStop={card.name === stop}
        />
      ))}
    </li>
  );
}

interface MemberProps {
  teacher: Teacher;
  card: Card;
  role: ClassGroup["roles"][string];
  isStop: boolean;
}

function Member({ teacher, card, role, isStop }: MemberProps) {
  const name = teacher.name(card.name);
  const said = summary(teacher, card);
  return (
    <button
      type="button"
      class="student member"
      tabIndex={isStop ? 0 : -1}
      data-student={card.name}
      data-need={card.need}
      data-online={card.online}
      aria-label={`${name}: ${said}`}
      title={news(teacher, card) || said}
      onClick={() => {
        teacher.opened.value = card.name;
      }}
    >
      <span class="who">
        {card.hand_up_s !== null && <Icon name="hand" />}
        <b>{name}</b>
        {role && <small>{t(`class.group.${role}`)}</small>}
        {card.coached && <i class="coached">C</i>}
      </span>
      <Dots card={card} />
    </button>
  );
}
