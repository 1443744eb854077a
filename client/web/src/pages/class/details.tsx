/** A student's card in full, and what the teacher can do for this student. */

import { useSignal } from "@preact/signals";
import { useId } from "preact/hooks";
import type { Card } from "../../core/wire";
import { type MessageName, said, t } from "../../i18n";
import { Dialog } from "../../ui/dialog";
import { Icon } from "../../ui/icons";
import { toast } from "../../ui/toasts";
import { Dots, Feet, lessonStep, since, speed } from "./card";
import { phaseTitle } from "./controls";
import type { Teacher } from "./teacher";

export function Details({ teacher }: { teacher: Teacher }) {
  const card = teacher.card(teacher.opened.value);
  if (!card) return null;
  const close = () => {
    // A dialog that closes late no longer takes the next one with it.
    if (teacher.opened.peek() === card.name) teacher.opened.value = "";
  };
  const name = teacher.name(card.name);
  return (
    <Dialog key={card.name} title={name} onClose={close}>
      <div class="details">
        <State teacher={teacher} card={card} />
        <section aria-label={t("class.lastTrial")}>
          <h3>{t("class.lastTrial")}</h3>
          <BigFeet card={card} />
          {card.said && <p>{said(card.said)}</p>}
          <dl class="facts">
            <Fact title={t("class.best")} value={`${speed(card.best_mm_s)} mm/s`} />
            <Fact title={t("class.last")} value={`${speed(card.last_mm_s)} mm/s`} />
            <Fact title={t("class.tries")} value={String(card.tries)} />
          </dl>
        </section>
        <Progress card={card} />
        <Grouping teacher={teacher} student={card.name} />
        <Acts teacher={teacher} card={card} onClose={close} />
      </div>
    </Dialog>
  );
}

function State({ teacher, card }: { teacher: Teacher; card: Card }) {
  const isQuiet = card.need === "quiet";
  const seen = since(teacher, card.seen_s);
  return (
    <ul class="states">
      {card.hand_up_s !== null && (
        <li data-need="hand">
          <Icon name="hand" /> {t("class.hand", { since: since(teacher, card.hand_up_s) })}
          <button
            class="button strong"
            type="button"
            onClick={() => void teacher.act("lower", { student: card.name })}
          >
            {t("class.act.lower")}
          </button>
        </li>
      )}
      {card.stuck && <li data-need="stuck">{said(card.stuck)}</li>}
      {card.lesson_step > 0 && <li>{lessonStep(card)}</li>}
      {card.coached && <li>{t("class.coached")}</li>}
      <li>
        {!card.online
          ? t("class.offline", { since: seen })
          : isQuiet
            ? t("class.quiet", { since: seen })
            : t("class.online")}
      </li>
    </ul>
  );
}

function BigFeet({ card }: { card: Card }) {
  return (
    <div class="details-feet">
      {card.feet && (
        <ul aria-hidden="true">
          {card.legs.map((leg) => (
            <li key={leg}>{leg}</li>
          ))}
        </ul>
      )}
      <Feet card={card} />
    </div>
  );
}

function Fact({ title, value }: { title: string; value: string }) {
  return (
    <div>
      <dt>{title}</dt>
      <dd>{value}</dd>
    </div>
  );
}

function Progress({ card }: { card: Card }) {
  const percent = Math.round(100 * card.share);
  const title = t("class.progress", { number: card.phase, title: phaseTitle(card.phase) });
  const state = card.states[card.phase] ?? "open";
  return (
    <section aria-label={title}>
      <h3>
        {title} <small>{t(`design.phase.${state}` as MessageName)}</small>
      </h3>
      <Dots card={card} />
      <progress max={100} value={percent} aria-label={t("design.phase.share")}>
        {percent} %
      </progress>
      {card.missing && <p class="muted">{said(card.missing)}</p>}
    </section>
  );
}

/** The group of a student, and what puts the student into another one. */
function Grouping({ teacher, student }: { teacher: Teacher; student: string }) {
  const own = teacher.groups.value.find(({ members }) => members.includes(student))?.name ?? "";
  const draft = useSignal<string | null>(null);
  const list = useId();
  const name = (draft.value ?? own).trim();
  return (
    <form
      class="row grouping"
      onSubmit={(event) => {
        event.preventDefault();
        void teacher.act("seat", { student, group: name });
        draft.value = null;
      }}
    >
      <label class="field">
        <span>{t("class.group")}</span>
        <input
          name="group"
          value={draft.value ?? own}
          list={list}
          maxLength={20}
          autocomplete="off"
          placeholder={t("class.group.none")}
          onInput={(event) => {
            draft.value = event.currentTarget.value;
          }}
        />
      </label>
      <datalist id={list}>
        {teacher.groups.value.map((group) => (
          <option key={group.name} value={group.name} />
        ))}
      </datalist>
      <button class="button" type="submit" disabled={name === own}>
        {t("class.group.set")}
      </button>
    </form>
  );
}

interface ActsProps {
  teacher: Teacher;
  card: Card;
  onClose: () => void;
}

function Acts({ teacher, card, onClose }: ActsProps) {
  const asks = useSignal(false);
  const { name: student } = card;
  const name = teacher.name(student);
  const forget = async () => {
    onClose();
    if ((await teacher.act("forget", { student })) === null) return;
    toast(t("class.forgotten", { name }), "yes");
  };
  const admit = async () => {
    onClose();
    if ((await teacher.act("admit", { student })) === null) return;
    toast(t("class.admitted", { name }), "yes");
  };
  if (asks.value) {
    return (
      <section class="forget" role="alert">
        <h3>{t("class.forget.title", { name })}</h3>
        <p>{t("class.forget.text", { tries: card.tries })}</p>
        <div class="row">
          <button
            class="button"
            type="button"
            ref={(button) => button?.focus()}
            onClick={() => {
              asks.value = false;
            }}
          >
            {t("common.cancel")}
          </button>
          <button class="button danger" type="button" onClick={() => void forget()}>
            {t("class.forget.yes")}
          </button>
        </div>
      </section>
    );
  }
  const to = teacher.group.value;
  return (
    <div class="row acts">
      <button
        class="button"
        type="button"
        title={t("class.act.showHint")}
        onClick={() => {
          onClose();
          teacher.screen.value = { shows: "robot", name: student };
        }}
      >
        <Icon name="screen" /> {t("class.act.show")}
      </button>
      <button
        class="button"
        type="button"
        title={to ? undefined : t("class.act.handOutHint")}
        onClick={() => {
          onClose();
          void teacher.handOut(t("class.handOut.of", { name }), { student });
        }}
      >
        {to ? t("class.act.handOutTo", { to: teacher.hide(to) }) : t("class.act.handOut")}
      </button>
      <button
        class="button"
        type="button"
        title={t("class.act.admitHint")}
        onClick={() => void admit()}
      >
        {t("class.act.admit")}
      </button>
      <button
        class="button danger"
        type="button"
        onClick={() => {
          asks.value = true;
        }}
      >
        {t("class.act.forget")}
      </button>
    </div>
  );
}
