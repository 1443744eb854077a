/** The head of the page: how students join, who is here, and what is wrong. */

import { pagesUrl, short } from "../../core/address";
import { said, t } from "../../i18n";
import { copy } from "../../ui/copy";
import { Icon, IconButton } from "../../ui/icons";
import type { Teacher } from "./teacher";

interface Props {
  teacher: Teacher;
  /** Whether the controls are open. */
  panel: boolean;
  onPanel: () => void;
  onSettings: () => void;
}

export function Head({ teacher, panel, onPanel, onSettings }: Props) {
  const state = teacher.state.value;
  const hidden = teacher.projector.value;
  return (
    <header class="head" data-hidden={hidden}>
      <h1 class="hidden-text">{t("class.title")}</h1>
      <dl class="entry">
        <div>
          <dt>{t("class.code")}</dt>
          <dd class="code">
            <b>{state?.code ?? "…"}</b>
            <IconButton
              name="copy"
              label={t("class.copyCode")}
              onClick={() => void copy(state?.code ?? "")}
            />
          </dd>
        </div>
        <div>
          <dt>{t("class.address")}</dt>
          <dd class="address">
            <Address teacher={teacher} />
            <IconButton
              name="copy"
              label={t("class.copyAddress")}
              onClick={() => void copy(addressOf(teacher))}
            />
          </dd>
        </div>
      </dl>
      <button
        class="button"
        type="button"
        title={t("class.roomHint")}
        onClick={() => {
          teacher.screen.value = { shows: "room" };
        }}
      >
        <Icon name="full" /> {t("class.room")}
      </button>
      <Counts teacher={teacher} />
      <div class="acts">
        <button
          class="button projector"
          type="button"
          aria-pressed={hidden}
          title={t("class.projectorHint")}
          onClick={() => {
            teacher.projector.value = !hidden;
          }}
        >
          <Icon name="hidden" />
          <span>
            {t("class.projector")}
            {hidden && <small>{t("class.projectorOn")}</small>}
          </span>
        </button>
        <button
          class="button"
          type="button"
          aria-expanded={panel}
          aria-controls="class-panel"
          onClick={onPanel}
        >
          <Icon name="panel" /> {t("class.panel")}
        </button>
        <IconButton name="settings" label={t("settings.title")} onClick={onSettings} />
      </div>
    </header>
  );
}

/** What is wrong, or what the page waits for; nothing while all is well. */
export function Troubles({ teacher }: { teacher: Teacher }) {
  const { open, attempt, refused } = teacher.connection.state.value;
  const state = teacher.state.value;
  const link = refused
    ? said(refused)
    : !open
      ? t(attempt > 1 ? "link.page" : "link.connecting", { attempt })
      : "";
  const studio = state?.studios === 0 ? (state.why ? said(state.why) : t("class.noStudio")) : "";
  const texts = link ? [link] : [state?.trouble ? said(state.trouble) : "", studio].filter(Boolean);
  return (
    <div role="status">
      {texts.map((text) => (
        <p key={text} class="banner">
          {teacher.hide(text)}
        </p>
      ))}
    </div>
  );
}

/** What students type into their browsers. */
export function addressOf(teacher: Teacher): string {
  return teacher.state.value?.addresses[0] ?? pagesUrl();
}

function Address({ teacher }: { teacher: Teacher }) {
  const others = teacher.state.value?.addresses.slice(1) ?? [];
  return (
    <>
      <b>{short(addressOf(teacher))}</b>
      {others.length > 0 && (
        <details>
          <summary aria-label={t("class.addresses")} title={t("class.addresses")}>
            +{others.length}
          </summary>
          <ul>
            {others.map((one) => (
              <li key={one}>{one}</li>
            ))}
          </ul>
        </details>
      )}
    </>
  );
}

function Counts({ teacher }: { teacher: Teacher }) {
  const state = teacher.state.value;
  const hands = teacher.hands.value;
  if (!state) return <p class="counts" />;
  return (
    <p class="counts" role="status">
      <span class="here">
        {t("class.here", { count: teacher.here.value, all: teacher.cards.value.length })}
        {state.studios > 0 && (
          <small class="studio">
            {t(state.studios > 1 ? "class.studiosMany" : "class.studios", { count: state.studios })}
          </small>
        )}
      </span>
      {hands > 0 && (
        <span class="hands">
          <Icon name="hand" />
          <b aria-hidden="true">{t("class.hands", { count: hands })}</b>
          <span class="hidden-text">{t("class.handsText", { count: hands })}</span>
        </span>
      )}
    </p>
  );
}
