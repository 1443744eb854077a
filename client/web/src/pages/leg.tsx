/** The first lesson of the workshop: one leg, by triangles (workshop 3-1). Anybody may open it. */

import { signal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import { flag } from "../core/address";
import type { Leg } from "../core/leg/leg";
import { SAMPLES } from "../core/leg/samples.gen";
import { t } from "../i18n";
import { Settings } from "../ui/settings";
import { Attendance } from "./leg/attendance";
import { Lesson } from "./leg/lesson";
import { Ask } from "./leg/question";
import { Sheet } from "./leg/sheet";
import { SHOWN } from "./leg/steps";
import "./leg/leg.css";

const isPrinted = flag("print", false);
const hasAnswers = signal(flag("answers", false));
const hasSettings = signal(false);

export default function LegPage() {
  const lesson = useMemo(() => new Lesson(), []);
  const attendance = useMemo(() => new Attendance(lesson), [lesson]);
  const title = t("leg.title");
  useEffect(() => {
    document.title = `${title} – LACOC`;
  }, [title]);
  useEffect(() => {
    if (!isPrinted) void attendance.begin();
  }, [attendance]);
  useEffect(() => {
    const follow = () => lesson.follow();
    addEventListener("hashchange", follow);
    return () => removeEventListener("hashchange", follow);
  }, [lesson]);
  return (
    <main class={isPrinted ? "leg printed" : "leg"}>
      <Head lesson={lesson} attendance={attendance} />
      {isPrinted ? (
        <Sheet robot={lesson.robot.value} hasAnswers={hasAnswers.value} />
      ) : (
        <Screen lesson={lesson} />
      )}
      {hasSettings.value && (
        <Settings
          onClose={() => {
            hasSettings.value = false;
          }}
        />
      )}
    </main>
  );
}

function Head({ lesson, attendance }: { lesson: Lesson; attendance: Attendance }) {
  return (
    <header class="bar">
      {!isPrinted && <h1>{t("leg.title")}</h1>}
      <label>
        <span>{t("leg.robot")}</span>
        <select
          value={lesson.robotName.value}
          onChange={(event) => lesson.choose(event.currentTarget.value)}
        >
          {Object.entries(SAMPLES).map(([key, { name }]) => (
            <option key={key} value={key}>
              {name}
            </option>
          ))}
        </select>
      </label>
      {isPrinted ? (
        <>
          <a href="leg">{t("leg.lesson")}</a>
          <button
            class="button"
            type="button"
            onClick={() => {
              hasAnswers.value = !hasAnswers.value;
            }}
          >
            {t(hasAnswers.value ? "leg.noAnswers" : "leg.answers")}
          </button>
          <button class="button strong" type="button" onClick={() => print()}>
            {t("leg.print")}
          </button>
        </>
      ) : (
        <>
          <a href="leg?print">{t("leg.sheet")}</a>
          {attendance.keeps.value && (
            <a class="button" href="design">
              {t("leg.back")}
            </a>
          )}
        </>
      )}
      <button
        class="button"
        type="button"
        onClick={() => {
          hasSettings.value = true;
        }}
      >
        {t("settings.title")}
      </button>
    </header>
  );
}

/** What the first sentences of the steps name. */
function introOf({ label, lengths_mm: [l0, l1, l2] }: Leg) {
  return { leg: label, l0, l1, l2 };
}

function Screen({ lesson }: { lesson: Lesson }) {
  const { name, questions } = lesson.step.value;
  const { Picture, More } = SHOWN[name];
  const at = lesson.at.value;
  const last = lesson.steps.value.length - 1;
  const isShown = lesson.isShown();
  // One question after the other.
  const asked = questions.filter((_, index) => index === 0 || lesson.answerOf(index - 1) !== null);
  return (
    <>
      <Dots lesson={lesson} />
      <figure>
        <Picture lesson={lesson} />
      </figure>
      <section class="told" aria-labelledby="step-title">
        <h2 id="step-title">
          {at + 1}. {t(`leg.step.${name}`)}
        </h2>
        <p>{t(`leg.intro.${name}`, introOf(lesson.leg.value))}</p>
        {asked.map((question, index) => (
          <Ask key={`${name} ${index}`} lesson={lesson} question={question} at={index} />
        ))}
        {isShown && More && <More lesson={lesson} />}
        <div class="ways">
          <button
            class="button"
            type="button"
            disabled={at === 0}
            onClick={() => lesson.goTo(at - 1)}
          >
            {t("leg.previous")}
          </button>
          {isShown && questions.length > 0 && (
            <button class="button" type="button" onClick={() => lesson.askAgain()}>
              {t("leg.again")}
            </button>
          )}
          <button
            class={isShown ? "button strong" : "button"}
            type="button"
            disabled={at === last}
            onClick={() => lesson.goTo(at + 1)}
          >
            {t("leg.next")}
          </button>
        </div>
      </section>
    </>
  );
}

function Dots({ lesson }: { lesson: Lesson }) {
  return (
    <nav class="dots" aria-label={t("leg.steps")}>
      {lesson.steps.value.map(({ name, questions }, index) => {
        const isDone = questions.length > 0 && lesson.isShown(index);
        const title = t(`leg.step.${name}`);
        const label = t(isDone ? "leg.stepDone" : "leg.stepOf", { number: index + 1, title });
        return (
          <button
            key={name}
            type="button"
            data-done={isDone}
            aria-current={index === lesson.at.value ? "step" : undefined}
            aria-label={label}
            title={label}
            onClick={() => lesson.goTo(index)}
          >
            {isDone ? "✓" : index + 1}
          </button>
        );
      })}
    </nav>
  );
}
