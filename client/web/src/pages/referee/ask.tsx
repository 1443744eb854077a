/** The dialog before a decision: what it does, its number, its reason, and the confirmation. */

import { type Signal, useComputed, useSignal } from "@preact/signals";
import { useLayoutEffect } from "preact/hooks";
import type { Phrase } from "../../core/phrase";
import { type DecisionName, type DecisionReply, NEED_A_REASON } from "../../core/wire";
import { said, sentence, t } from "../../i18n";
import { Dialog } from "../../ui/dialog";
import { Standings } from "./day";
import { COMMON_REASONS, type Desk, reasonOf } from "./desk";
import type { Draft } from "./drafts";
import { Outlook } from "./outlook";

const OTHER = "other";
/** Codes of the table; with "other" the words alone are the reason. */
const REASONS = [...COMMON_REASONS, OTHER] as const;
type Reason = (typeof REASONS)[number];

/** Decisions after which play can go on. */
const GOES_ON = new Set<DecisionName>(["take-back", "restart", "freeze", "adjust", "set", "clock"]);

const WORDS_MOST = 200;

export function AskDialog({ desk }: { desk: Desk }) {
  const draft = desk.draft.value;
  return draft ? <Ask key={draft.title} desk={desk} draft={draft} /> : null;
}

function Ask({ desk, draft }: { desk: Desk; draft: Draft }) {
  // As it is typed: a number that is put back while one types would lose its "10.", "0.0" or "-".
  const typed = useSignal(String(draft.amount?.value ?? ""));
  const amount = Number(typed.value);
  const chip = useSignal<Reason | null>(null);
  const words = useSignal("");
  const busy = useSignal(false);
  const refused = useSignal<Phrase | string>("");
  const match = useSignal(desk.court.frame.peek()?.match);
  const close = () => {
    if (desk.draft.peek() === draft) desk.draft.value = null; // it may be another one's by now
  };
  // What is foreseen holds only until the next event.
  const newest = desk.court.events.value.at(-1)?.number;
  const isOpen = desk.court.connection.state.value.open;
  const unforeseen = useSignal<Phrase | string>("");
  const needsReason = NEED_A_REASON.has(draft.name);
  const reason = needsReason ? reasonOfBoth(chip.value, words.value) : "";
  const isOther = match.value !== desk.court.frame.value?.match;
  const why =
    (isOther && t("ask.otherMatch")) ||
    desk.whyNot(draft.name) ||
    (draft.amount && wrongAmount(draft.amount, amount)) ||
    (needsReason && !reason ? t(chip.value ? "ask.needWords" : "ask.needReason") : "") ||
    said(unforeseen.value);
  const confirm = async () => {
    if (why || busy.value) return;
    busy.value = true;
    refused.value = await desk.decide(draft.build(amount), reason);
    busy.value = false;
    if (!refused.value) close();
  };
  return (
    <Dialog title={draft.title} onClose={close}>
      <form
        class="ask"
        onSubmit={(event) => {
          event.preventDefault();
          confirm();
        }}
      >
        <p>{draft.text}</p>
        {draft.event !== undefined && (
          <Preview
            key={`${newest} ${isOpen}`}
            desk={desk}
            event={draft.event}
            unforeseen={unforeseen}
          />
        )}
        {draft.winner !== undefined && <Standings desk={desk} winner={draft.winner} />}
        {draft.amount && <AmountField amount={draft.amount} typed={typed} />}
        {GOES_ON.has(draft.name) && !(draft.amount && wrongAmount(draft.amount, amount)) && (
          <Outlook desk={desk} decision={draft.build(amount)} />
        )}
        {needsReason && (
          <fieldset class="reasons">
            <legend>{t("ask.reason")}</legend>
            <div class="chips">
              {REASONS.map((one) => (
                <label key={one} class="chip">
                  <input
                    type="radio"
                    name="reason"
                    checked={chip.value === one}
                    onChange={() => {
                      chip.value = one;
                    }}
                  />
                  {one === OTHER ? t("reason.other") : said({ code: one })}
                </label>
              ))}
            </div>
            <label class="field">
              <span>{t("ask.words")}</span>
              <input
                name="words"
                maxLength={WORDS_MOST}
                value={words.value}
                onInput={(event) => {
                  words.value = event.currentTarget.value;
                }}
              />
            </label>
          </fieldset>
        )}
        {refused.value && (
          <p class="refused" role="alert">
            {sentence(refused.value)}
          </p>
        )}
        <div class="dialog-end">
          <span id="why-not-confirm" class="why">
            {why}
          </span>
          <button class="button" type="button" onClick={close}>
            {t("common.cancel")}
          </button>
          <button
            class={`button ${draft.final ? "danger solid" : "strong"}`}
            type="submit"
            disabled={Boolean(why) || busy.value}
            aria-describedby="why-not-confirm"
          >
            {draft.confirm}
          </button>
        </div>
      </form>
    </Dialog>
  );
}

interface AmountProps {
  amount: NonNullable<Draft["amount"]>;
  typed: Signal<string>;
}

function AmountField({ amount, typed }: AmountProps) {
  const value = Number(typed.value);
  const shows = wrongAmount(amount, value) ? "" : amount.shows(value);
  return (
    <div class="amount">
      <label class="field">
        <span>{amount.label}</span>
        <input
          name="amount"
          type="number"
          step={amount.whole ? 1 : "any"}
          min={amount.least}
          max={amount.most}
          value={typed.value}
          onInput={(event) => {
            typed.value = event.currentTarget.value;
          }}
        />
      </label>
      <div class="chips">
        {amount.usual.map((usual) => (
          <button
            key={usual}
            class="button small"
            type="button"
            onClick={() => {
              typed.value = String(usual);
            }}
          >
            {amount.least < 0 && usual > 0 ? `+${usual}` : String(usual).replace("-", "−")}
          </button>
        ))}
      </div>
      {shows && <output class="shows">{shows}</output>}
    </div>
  );
}

interface PreviewProps {
  desk: Desk;
  event: number;
  /** Why nobody shall confirm yet: the court's answer is not there, or it refuses; "" if it is. */
  unforeseen: Signal<Phrase | string>;
}

/** What a take-back would do, from the court itself. */
function Preview({ desk, event, unforeseen }: PreviewProps) {
  const reply = useSignal<DecisionReply | null>(null);
  useLayoutEffect(() => {
    let isWanted = true;
    unforeseen.value = { code: "ask.trying" };
    const tell = (found: DecisionReply | null, why: Phrase | string) => {
      if (!isWanted) return;
      reply.value = found;
      unforeseen.value = why;
    };
    desk.tryTakeBack(event).then(
      (found) => tell(found, ""),
      (error) => tell(null, reasonOf(error)),
    );
    return () => {
      isWanted = false;
      unforeseen.value = "";
    };
  }, [desk, event, unforeseen, reply]);
  const entry = desk.court.events.value.find(({ number }) => number === event);
  const now = useComputed(
    () => desk.court.frame.value?.seats.map((seat) => seat.score).join(" : ") ?? "",
  ).value;
  return (
    <div class="preview" aria-live="polite">
      {entry && <blockquote>{said(entry.said)}</blockquote>}
      {reply.value && (
        <>
          <dl class="scores">
            <dt>{t("ask.scoreNow")}</dt>
            <dd>{now}</dd>
            <dt>{t("ask.scoreThen")}</dt>
            <dd class="then">{reply.value.scores.join(" : ")}</dd>
          </dl>
          {reply.value.changes.length ? (
            <ul>
              {reply.value.changes.map(said).map((change) => (
                <li key={change}>{change}</li>
              ))}
            </ul>
          ) : (
            <p class="muted">{t("ask.noChanges")}</p>
          )}
        </>
      )}
    </div>
  );
}

/** The reason for the record; "" while something is missing. */
function reasonOfBoth(chip: Reason | null, words: string): Phrase | string {
  const note = words.trim();
  if (!chip || chip === OTHER) return note;
  return { code: chip, values: { note: note || null } };
}

function wrongAmount(amount: NonNullable<Draft["amount"]>, value: number): string {
  const fits = value >= amount.least && value <= amount.most && value !== 0;
  if (fits && (!amount.whole || Number.isInteger(value))) return "";
  const { least, most } = amount;
  return t(amount.whole ? "ask.whole" : "ask.between", { least, most });
}
