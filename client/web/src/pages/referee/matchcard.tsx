/** The state of the match, the next sensible step as one big button, and all other decisions. */

import { useSignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import { part } from "../../core/match";
import { whyHalted } from "../../core/rulings";
import { type DecisionName, Phase, SeatFlag } from "../../core/wire";
import { type MessageName, said, sentence, t } from "../../i18n";
import { seatName, team } from "../../i18n/words";
import { Kbd } from "../../ui/kbd";
import { Hint, PhaseWord, SeatMark } from "../../ui/score";
import { TeamName } from "../../ui/team_name";
import { Act } from "./act";
import { nextTeams } from "./day";
import { type Answer, COMMON_REASONS, type Desk, type Step } from "./desk";
import * as drafts from "./drafts";
import { Advice, adviceOf } from "./health";
import { Outlook } from "./outlook";

const CLOCK_S = 10;
const OVER = new Set<number>([Phase.FINISHED, Phase.OFFICIAL]);

/** Take the step that the big button and Ctrl+Enter stand for, unless they only just began to. */
export function takeNext(desk: Desk): void {
  if (!desk.fresh.value) takeStep(desk, desk.next.value);
}

/** Take a step of the match: at once, or asked about where it is final. */
function takeStep(desk: Desk, name: DecisionName): void {
  if (desk.whyNot(name) || desk.draft.value) return;
  if (name === "official") desk.draft.value = drafts.official(desk.court);
  else if (name === "next") desk.draft.value = drafts.next();
  else desk.step(name as Step);
}

export function MatchCard({ desk }: { desk: Desk }) {
  return (
    <section class="card match" aria-labelledby="match-title">
      <h2 id="match-title" class="hidden-text">
        {t("referee.flow")}
      </h2>
      <div class="match-state" role="status">
        <PhaseWord match={desk.court} />
        {desk.court.live.value ? (
          <Hint match={desk.court} />
        ) : (
          <span class="hint">{t("referee.stale")}</span>
        )}
      </div>
      <WhyHalted desk={desk} />
      <BigButton desk={desk} />
      <Outlook desk={desk} decision={null} />
      <Missing desk={desk} />
      <ReplayAdvice desk={desk} />
      <LastAnswer desk={desk} />
      <Groups desk={desk} />
    </section>
  );
}

function BigButton({ desk }: { desk: Desk }) {
  const name = desk.next.value;
  const does = t(`decide.${name}` as MessageName);
  const teams = name === "next" ? nextTeams() : "";
  return (
    <div class={desk.fresh.value ? "big fresh" : "big"}>
      <Act
        why={desk.whyNot(name)}
        tone={`strong ${name}`}
        label={teams ? t("referee.nextOf", { does, teams }) : does}
        onAct={() => takeNext(desk)}
      >
        <span>{does}</span>
        {teams && <TeamName name={teams} />}
        <Kbd>Ctrl+Enter</Kbd>
      </Act>
    </div>
  );
}

/** All that is missing for the start, at once. */
function Missing({ desk }: { desk: Desk }) {
  const { court } = desk;
  const flags = useMemo(
    () => part(court, ({ seats }) => seats.map((seat) => seat.flags & 3).join(), ""),
    [court],
  ).value;
  const sheet = court.sheet.value;
  if (desk.phase.value !== Phase.LOBBY || !sheet || !flags) return null;
  const missing = flags.split(",").flatMap((text, index) => {
    const seat = seatName(sheet.seats[index]?.id ?? "");
    if (!(Number(text) & SeatFlag.JOINED)) return [t("referee.missingJoin", { seat })];
    if (Number(text) & SeatFlag.READY) return [];
    return [t("referee.missingReady", { team: team(sheet, index) })];
  });
  if (!missing.length) return null;
  return (
    <div class="missing">
      <h3>{t("referee.missing")}</h3>
      <ul>
        {missing.map((text) => (
          <li key={text}>{text}</li>
        ))}
      </ul>
    </div>
  );
}

/** Beside the result, before it becomes official. */
function ReplayAdvice({ desk }: { desk: Desk }) {
  const over = OVER.has(desk.phase.value);
  return over ? <Advice advice={adviceOf(desk.court.health.value)} /> : null;
}

/** Why the match is halted, large: a court that was started again, a fault, a referee's reason. */
function WhyHalted({ desk }: { desk: Desk }) {
  const cause = desk.phase.value === Phase.HALTED ? whyHalted(desk.court.events.value) : null;
  return cause ? <p class="why-halted">{said(cause.said)}</p> : null;
}

/** The label before the court's answer. */
const ANSWERED = {
  yes: ["✓", "referee.done"],
  no: ["✕", "referee.no"],
  plain: ["?", "referee.noAnswer"],
} as const satisfies Record<Answer["tone"], readonly [mark: string, word: MessageName]>;

function LastAnswer({ desk }: { desk: Desk }) {
  const answer = desk.answer.value;
  const nowMs = useSignal(performance.now());
  useEffect(() => {
    const timer = setInterval(() => {
      nowMs.value = performance.now();
    }, 1000);
    return () => clearInterval(timer);
  }, [nowMs]);
  if (!answer) return null;
  const seconds = Math.max(0, Math.round((nowMs.value - answer.atMs) / 1000));
  const [mark, word] = ANSWERED[answer.tone];
  return (
    <p class={`answer ${answer.tone}`} title={t("referee.lastAnswer")}>
      <strong>
        {mark} {t(word)}
      </strong>{" "}
      {sentence(answer.what)} <small class="muted">{t("referee.ago", { seconds })}</small>
    </p>
  );
}

function Groups({ desk }: { desk: Desk }) {
  const { court } = desk;
  const sheet = court.sheet.value;
  const ask = (draft: drafts.Draft) => {
    desk.draft.value = draft;
  };
  const step = (name: DecisionName) => (
    <Act why={desk.whyNot(name)} onAct={() => takeStep(desk, name)}>
      {t(`decide.${name}` as MessageName)}
    </Act>
  );
  return (
    <div class="groups">
      <Group title={t("referee.flow")}>
        {step("start")}
        {step("halt")}
        {step("resume")}
        {step("official")}
        {step("next")}
        <Act why={desk.whyNot("abort")} tone="danger" onAct={() => ask(drafts.abort())}>
          {t("decide.abort")}
        </Act>
      </Group>
      <Group title={t("referee.haltFor")}>
        {COMMON_REASONS.map((code) => (
          <Act
            key={code}
            why={desk.whyNot("halt")}
            label={t("referee.haltForOf", { reason: said({ code }) })}
            onAct={() => void desk.step("halt", { code, values: { note: null } })}
          >
            {said({ code })}
          </Act>
        ))}
      </Group>
      <Group title={t("referee.time")}>
        <Act why={desk.whyNot("clock")} onAct={() => ask(drafts.moveClock(court, -CLOCK_S))}>
          {t("decide.clockTake", { seconds: CLOCK_S })}
        </Act>
        <Act why={desk.whyNot("clock")} onAct={() => ask(drafts.moveClock(court, CLOCK_S))}>
          {t("decide.clockGive", { seconds: CLOCK_S })}
        </Act>
        <Act why={desk.whyNot("clock")} onAct={() => ask(drafts.moveClock(court, 1))}>
          {t("decide.clockOther")}
        </Act>
      </Group>
      <Group title={t("referee.result")}>
        {sheet?.seats.map((seat, index) => (
          <Act
            key={seat.id}
            why={desk.whyNot("declare")}
            label={t("decide.declareTeam", { team: team(sheet, index) })}
            onAct={() => ask(drafts.declare(court, index))}
          >
            <SeatMark sheet={sheet} index={index} />
            <TeamName name={team(sheet, index)} />
          </Act>
        ))}
        <Act why={desk.whyNot("declare")} onAct={() => ask(drafts.declare(court, null))}>
          {t("decide.declareDraw")}
        </Act>
      </Group>
    </div>
  );
}

function Group({ title, children }: { title: string; children: preact.ComponentChildren }) {
  return (
    <fieldset class="group">
      <legend>{title}</legend>
      {children}
    </fieldset>
  );
}
