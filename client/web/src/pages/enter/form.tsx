/** The form with which a team enters, and the card of a team that has entered. */

import { type Signal, useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { type EventInfo, type OwnEntry, TEAM_NAME_MAX } from "../../core/desk";
import { pictureUrl } from "../../core/picture";
import { said, t } from "../../i18n";
import { dayTime } from "../../i18n/words";
import { Mistakes } from "../../ui/mistakes";
import type { Entrant } from "./entrant";
import { Files } from "./files";

interface Props {
  entrant: Entrant;
}

export function Form({ entrant }: Props) {
  const code = useSignal("");
  const team = useSignal("");
  const contact = useSignal("");
  const club = useSignal("");
  const event = entrant.event.value;
  const wrongCode = entrant.why.value?.code === "desk.wrong-code";
  const wrongName = ["desk.name-taken", "contest.team-name"].includes(
    entrant.why.value?.code ?? "",
  );
  return (
    <form
      aria-labelledby="enter-title"
      onSubmit={(submit) => {
        submit.preventDefault();
        void entrant.apply(code.peek(), team.peek(), contact.peek(), club.peek());
      }}
    >
      {event && <p class="muted">{event.name}</p>}
      <h1 id="enter-title">{t("enter.title")}</h1>
      {event && <Until event={event} />}
      <label class="field">
        <span>{t("enter.code")}</span>
        <input
          class="code"
          value={code.value}
          autocomplete="off"
          autocapitalize="characters"
          autocorrect="off"
          spellcheck={false}
          maxLength={40}
          required
          aria-invalid={wrongCode}
          aria-describedby="enter-why"
          onInput={(change) => {
            code.value = change.currentTarget.value;
          }}
        />
      </label>
      <label class="field">
        <span>{t("enter.team")}</span>
        <input
          value={team.value}
          autocomplete="off"
          spellcheck={false}
          maxLength={TEAM_NAME_MAX}
          required
          aria-invalid={wrongName}
          aria-describedby="enter-why"
          onInput={(change) => {
            team.value = change.currentTarget.value;
          }}
        />
      </label>
      <Told label={t("enter.contact")} text={contact} most={200} />
      <Told label={t("enter.club")} text={club} most={64} />
      <Files />
      {event && <p class="muted">{t(`enter.replays.${event.replays}`)}</p>}
      <Refusal entrant={entrant} />
      <button class="button strong large" type="submit" aria-busy={entrant.isWeighing.value}>
        {t(entrant.isWeighing.value ? "enter.weighing" : "enter.go")}
      </button>
    </form>
  );
}

interface ToldProps {
  label: string;
  text: Signal<string>;
  most: number;
}

/** A field that may stay empty. */
function Told({ label, text, most }: ToldProps) {
  return (
    <label class="field">
      <span>{label}</span>
      <input
        value={text.value}
        maxLength={most}
        onInput={(change) => {
          text.value = change.currentTarget.value;
        }}
      />
    </label>
  );
}

interface CardProps extends Props {
  entry: OwnEntry;
}

/** How a team stands: its state, its link, and the way to replace its files. */
export function EntryCard({ entrant, entry }: CardProps) {
  const { event, team, state, files } = entry;
  const link = entrant.link.value;
  const answer = useAnswer(entrant, "taken");
  return (
    <section aria-labelledby="entry-title" data-state={state}>
      <p class="muted">{event.name}</p>
      <h1 id="entry-title">{team}</h1>
      <p ref={answer} role="status" class="state" tabIndex={-1}>
        {t(`enter.state.${state}`)}
      </p>
      {files && (
        <p class="muted">
          {t("office.hash")} <code>{files}</code>
        </p>
      )}
      {link && state !== "left" && (
        <div class="qr">
          <img src={pictureUrl(link.qr)} alt={t("office.qrOf", { team })} />
          <div>
            <p>{t("enter.link")}</p>
            <a class="button strong" href={link.link}>
              {t("enter.play")}
            </a>
            <p class="address">{link.link}</p>
          </div>
        </div>
      )}
      {state !== "left" && (
        <details open={state === "none" || entrant.why.value !== null}>
          <summary>{t("enter.replace")}</summary>
          <form
            onSubmit={(submit) => {
              submit.preventDefault();
              void entrant.change();
            }}
          >
            <Until event={event} />
            <Files />
            <Refusal entrant={entrant} />
            <button class="button" type="submit" aria-busy={entrant.isWeighing.value}>
              {t(entrant.isWeighing.value ? "enter.weighing" : "enter.change")}
            </button>
          </form>
        </details>
      )}
      <button class="button quiet small" type="button" onClick={() => entrant.makeRoom()}>
        {t("enter.other")}
      </button>
    </section>
  );
}

/** Until when files can be replaced. */
function Until({ event }: { event: EventInfo }) {
  if (!event.open) return <p class="warning">{t("enter.closed")}</p>;
  if (!event.closes_ms) return <p class="muted">{t("enter.untilClosed")}</p>;
  return <p class="muted">{t("enter.until", { time: dayTime(event.closes_ms) })}</p>;
}

/** Why nothing was entered: one reason, or every mistake of every file. */
function Refusal({ entrant }: Props) {
  const mistakes = entrant.mistakes.value;
  const why = entrant.why.value;
  const answer = useAnswer(entrant, "refused");
  return (
    <div id="enter-why" class="why" role="alert">
      {why && (
        <p ref={answer} tabIndex={-1}>
          {said(why)} {mistakes.length > 0 && t("enter.nothing")}
        </p>
      )}
      {mistakes.length > 0 && <Mistakes mistakes={mistakes} />}
    </div>
  );
}

/** Give the focus to the element with an answer when it comes, which also brings it into view. */
function useAnswer(entrant: Entrant, which: "taken" | "refused") {
  const element = useRef<HTMLParagraphElement>(null);
  const answered = entrant.answered.value;
  useEffect(() => {
    if (answered !== which) return;
    entrant.answered.value = null;
    element.current?.focus();
  }, [entrant, answered, which]);
  return element;
}
