/** What the teacher opens, closes, hands out and takes home. */

import { useSignal } from "@preact/signals";
import { useEffect, useId, useRef } from "preact/hooks";
import { COACHES, PHASES } from "../../core/class";
import type { StudentRules } from "../../core/wire";
import { said, t } from "../../i18n";
import { Dialog } from "../../ui/dialog";
import { Mistakes } from "../../ui/mistakes";
import type { Handout, Teacher } from "./teacher";

/** Codes of the phases' titles, by number. */
const TITLES = ["lesson", "one-leg", "three-legs", "half-cycle", "cycle", "concept", "creative"];

/** The title of a phase. */
export function phaseTitle(phase: number): string {
  return said({ code: `phases.${TITLES[phase]}` });
}

export function Controls({ teacher }: { teacher: Teacher }) {
  return (
    <>
      <Phases teacher={teacher} />
      <Teaching teacher={teacher} />
      <HandOut teacher={teacher} />
      <Home teacher={teacher} />
    </>
  );
}

function Phases({ teacher }: { teacher: Teacher }) {
  const { closed } = teacher.rules.value;
  return (
    <fieldset class="phases">
      <legend>{t("class.phases")}</legend>
      {PHASES.map((phase) => {
        const isOpen = !closed.includes(phase);
        return (
          <label key={phase}>
            <input type="checkbox" checked={isOpen} onChange={() => teacher.toggle(phase)} />
            <span>
              {phase}. {phaseTitle(phase)}
            </span>
            <small>{t(isOpen ? "class.phaseOpen" : "class.phaseClosed")}</small>
          </label>
        );
      })}
    </fieldset>
  );
}

function Teaching({ teacher }: { teacher: Teacher }) {
  const rules = teacher.rules.value;
  const hint = useId();
  return (
    <section class="teaching">
      <label class="field">
        <span>{t("class.coach")}</span>
        <select
          name="coach"
          value={rules.coach}
          onChange={(event) => {
            const coach = event.currentTarget.value as StudentRules["coach"];
            void teacher.change({ ...rules, coach });
          }}
        >
          {COACHES.map((coach) => (
            <option key={coach} value={coach}>
              {t(`class.coach.${coach}`)}
            </option>
          ))}
        </select>
      </label>
      <label class="switch">
        <input
          type="checkbox"
          name="explain-first"
          checked={rules.explain_first}
          aria-describedby={hint}
          onChange={() => void teacher.change({ ...rules, explain_first: !rules.explain_first })}
        />
        <span>{t("class.explain")}</span>
      </label>
      <p id={hint} class="muted">
        {t("class.explainHint")}
      </p>
    </section>
  );
}

function HandOut({ teacher }: { teacher: Teacher }) {
  const input = useId();
  const handed = teacher.state.value?.handed;
  const sample = t("class.handOut.sample");
  return (
    <section aria-label={t("class.handOut")}>
      <h2>{t("class.handOut")}</h2>
      <div class="row">
        <button class="button" type="button" onClick={() => void teacher.handOut(sample)}>
          {sample}
        </button>
        <input
          id={input}
          class="hidden-text"
          type="file"
          accept=".txt,.xlsx,.tsv,.csv"
          onChange={(event) => {
            const [file] = event.currentTarget.files ?? [];
            if (file) void teacher.takeIn(file);
            // The same file can be chosen once more.
            event.currentTarget.value = "";
          }}
        />
        <label class="button" for={input}>
          {t("class.handOut.file")}
        </label>
      </div>
      <Recipient teacher={teacher} />
      <p class="muted">
        {handed
          ? t("class.handOut.last", { title: teacher.hide(handed.title) })
          : t("class.handOut.hint")}
      </p>
    </section>
  );
}

/** To whom a table is handed out. */
function Recipient({ teacher }: { teacher: Teacher }) {
  const groups = teacher.groups.value;
  if (!groups.length) return null;
  return (
    <label class="field">
      <span>{t("class.handOut.to")}</span>
      <select
        name="recipient"
        value={teacher.recipient.value}
        onChange={(event) => {
          teacher.recipient.value = event.currentTarget.value;
        }}
      >
        <option value="">{t("class.handOut.all")}</option>
        {groups.map(({ name }) => (
          <option key={name} value={name}>
            {teacher.hide(name)}
          </option>
        ))}
      </select>
    </label>
  );
}

function Home({ teacher }: { teacher: Teacher }) {
  return (
    <section aria-label={t("class.export")}>
      <h2>{t("class.export")}</h2>
      <div class="row">
        <button class="button" type="button" onClick={() => void teacher.save("evidence")}>
          {t("class.export.evidence")}
        </button>
        <button class="button" type="button" onClick={() => void teacher.save("tables")}>
          {t("class.export.tables")}
        </button>
        <button
          class="button"
          type="button"
          onClick={() => {
            teacher.screen.value = { shows: "certificates" };
          }}
        >
          {t("class.certificates")}
        </button>
        <button
          class="button quiet"
          type="button"
          title={t("class.newCodeHint")}
          onClick={() => void teacher.act("new_code")}
        >
          {t("class.newCode")}
        </button>
      </div>
    </section>
  );
}

/** Asks for the title of a file's table before it goes to all. */
export function HandoutDialog({ teacher }: { teacher: Teacher }) {
  const handout = teacher.handout.value;
  return handout ? <Titled key={handout} teacher={teacher} handout={handout} /> : null;
}

function Titled({ teacher, handout }: { teacher: Teacher; handout: Handout }) {
  const title = useSignal(handout.title);
  const { table } = handout;
  const input = useRef<HTMLInputElement>(null);
  useEffect(() => input.current?.select(), []);
  const close = () => {
    if (teacher.handout.peek() === handout) teacher.handout.value = null;
  };
  return (
    <Dialog title={t("class.handOut")} onClose={close}>
      <form
        class="handout"
        onSubmit={(event) => {
          event.preventDefault();
          const named = title.value.trim() || handout.title;
          close();
          void teacher.handOut(named, { table });
        }}
      >
        <p class="muted">
          {t("class.handOut.rows", { count: table.rows.length, legs: table.legs })}
        </p>
        <label class="field">
          <span>{t("class.handOut.title")}</span>
          <input
            ref={input}
            value={title.value}
            maxLength={60}
            onInput={(event) => {
              title.value = event.currentTarget.value;
            }}
          />
        </label>
        <Recipient teacher={teacher} />
        <button class="button strong" type="submit">
          {t("class.handOut.go")}
        </button>
      </form>
    </Dialog>
  );
}

/** Says what is wrong with a file that could not be read. */
export function FileTrouble({ teacher }: { teacher: Teacher }) {
  const trouble = teacher.trouble.value;
  if (!trouble) return null;
  return (
    <Dialog
      key={trouble}
      title={teacher.reason(trouble.why)}
      onClose={() => {
        if (teacher.trouble.peek() === trouble) teacher.trouble.value = null;
      }}
    >
      <Mistakes mistakes={trouble.mistakes} />
    </Dialog>
  );
}
