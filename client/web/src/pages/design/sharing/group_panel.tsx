/** The tab in which a student makes or joins a group, takes a role, and votes for a word. */

import { useSignal } from "@preact/signals";
import { ROLES } from "../../../core/design/roles";
import type { GroupNews } from "../../../core/wire";
import { t } from "../../../i18n";
import { COLOURS } from "./colours";
import type { Group } from "./group";
import "./group.css";

export function GroupPanel({ group }: { group: Group }) {
  const news = group.news.value;
  if (!news) return null;
  return (
    <section class="group" aria-label={t("design.tab.group")}>
      {news.group ? <Own group={group} own={news.group} /> : <Joining group={group} news={news} />}
    </section>
  );
}

function Joining({ group, news }: { group: Group; news: GroupNews }) {
  const name = useSignal("");
  return (
    <>
      <h3>{t("design.group.join")}</h3>
      <p>{t("design.group.text")}</p>
      <form
        class="row"
        onSubmit={(event) => {
          event.preventDefault();
          if (name.peek().trim()) void group.ask("join", name.peek());
        }}
      >
        <input
          value={name.value}
          maxLength={20}
          autocomplete="off"
          aria-label={t("design.group.name")}
          placeholder={t("design.group.name")}
          onInput={(event) => {
            name.value = event.currentTarget.value;
          }}
        />
        <button class="button strong" type="submit" disabled={!name.value.trim()}>
          {t("design.group.make")}
        </button>
      </form>
      <ul class="group-list">
        {news.groups.map((one) => (
          <li key={one.name}>
            <button class="button" type="button" onClick={() => void group.ask("join", one.name)}>
              {t("design.group.joinThis", { name: one.name, count: one.members })}
            </button>
          </li>
        ))}
      </ul>
    </>
  );
}

function Own({ group, own }: { group: Group; own: NonNullable<GroupNews["group"]> }) {
  const me = group.me();
  const role = own.members.find(({ name }) => name === me)?.role ?? "";
  return (
    <>
      <h3>{t("design.group.title", { name: own.name })}</h3>
      <ul class="group-members">
        {own.members.map((member) => (
          <li key={member.name} data-online={member.online}>
            <i data-colour={group.colour(member.name) % COLOURS} aria-hidden="true" />
            <b>{member.name}</b>
            {member.role && <span>{t(`design.group.${member.role}`)}</span>}
            {!member.online && <small class="muted">{t("design.group.away")}</small>}
          </li>
        ))}
      </ul>
      <fieldset class="group-roles">
        <legend>{t("design.group.role")}</legend>
        {ROLES.map((one) => (
          <button
            key={one}
            class="button"
            type="button"
            aria-pressed={role === one}
            onClick={() => void group.ask("role", role === one ? "" : one)}
          >
            {t(`design.group.${one}`)}
          </button>
        ))}
        <p class="muted">{t("design.group.roleHint")}</p>
      </fieldset>
      <Words group={group} own={own} />
      <button class="button quiet" type="button" onClick={() => void group.ask("leave")}>
        {t("design.group.leave")}
      </button>
    </>
  );
}

/** The words for how the robot should walk, and the vote. */
function Words({ group, own }: { group: Group; own: NonNullable<GroupNews["group"]> }) {
  const draft = useSignal("");
  return (
    <fieldset class="group-words">
      <legend>{t("design.group.words")}</legend>
      {own.words.map(({ word, by, votes }) => (
        <button
          key={word}
          class="button"
          type="button"
          aria-pressed={own.voted === word}
          title={by && t("design.group.wordBy", { name: by })}
          onClick={() => void group.ask("word", word)}
        >
          {t("design.group.votes", { word, count: votes })}
        </button>
      ))}
      <form
        class="row"
        onSubmit={(event) => {
          event.preventDefault();
          const word = draft.peek().trim();
          if (word) void group.ask("word", word);
          draft.value = "";
        }}
      >
        <input
          value={draft.value}
          maxLength={40}
          autocomplete="off"
          aria-label={t("design.group.newWord")}
          placeholder={t("design.group.newWord")}
          onInput={(event) => {
            draft.value = event.currentTarget.value;
          }}
        />
        <button class="button" type="submit" disabled={!draft.value.trim()}>
          {t("design.group.propose")}
        </button>
      </form>
      {own.word && <p role="status">{t("design.group.word", { word: own.word })}</p>}
    </fieldset>
  );
}
