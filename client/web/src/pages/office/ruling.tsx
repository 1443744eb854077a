/** Decisions about a match: its result, another game, a void match, a team that did not come. */

import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { bySeat, gamesOf, pointsOf } from "../../core/contest/games";
import {
  type ContestMatch,
  type ContestSheet,
  found,
  howEnded,
  isMatch,
  type StageView,
  score,
  seating,
  written,
} from "../../core/contest/sheet";
import type { Effect, OfficeView, Rule } from "../../core/desk";
import { said, t } from "../../i18n";
import { Dialog } from "../../ui/dialog";
import { matchTitle } from "../contest/words";
import { Effects, Reason } from "./dialogs";
import { matches } from "./entries";
import type { Organiser } from "./organiser";

const KINDS = ["result", "replay", "no-show", "void"] as const;
/** Most matches that are listed. */
const LISTED = 30;

interface Props {
  organiser: Organiser;
}

/** The matches whose teams are known: decided ones first, those of the last rounds on top. */
export function Rulings({ organiser }: Props) {
  const wanted = useSignal("");
  const sheet = organiser.feed.sheet.value;
  if (!sheet) return null;
  const all = sheet.stages
    .flatMap((view) => view.matches.map((match) => ({ view, match })))
    .filter(({ match }) => isMatch(match) && match.teams.every(Boolean))
    .filter(({ match }) =>
      [...match.teams, matchTitle(sheet, match.pairing.id)].some((text) =>
        matches(text ?? "", wanted.value),
      ),
    );
  const played = all.filter(({ match }) => match.state === "decided").toReversed();
  const shown = [...played, ...all.filter(({ match }) => match.state !== "decided")];
  return (
    <section class="rulings" aria-labelledby="rulings-title">
      <div class="bar">
        <h2 id="rulings-title">{t("office.rulings")}</h2>
        <input
          type="search"
          aria-label={t("office.findMatch")}
          placeholder={t("office.findMatch")}
          value={wanted.value}
          onInput={(event) => {
            wanted.value = event.currentTarget.value;
          }}
        />
      </div>
      <ul>
        {shown.slice(0, LISTED).map(({ view, match }) => (
          <li key={match.pairing.id} data-state={match.state}>
            <Line sheet={sheet} view={view} match={match} />
            <button
              class="button quiet small"
              type="button"
              aria-label={t("office.decideOf", { versus: versus(match) })}
              onClick={() => {
                organiser.over.value = { is: "rule", pairing: match.pairing.id };
              }}
            >
              {t("office.decide")}
            </button>
          </li>
        ))}
      </ul>
      {shown.length > LISTED && (
        <p class="muted">{t("contest.more", { count: shown.length - LISTED })}</p>
      )}
    </section>
  );
}

/** The teams of a match in its order. */
function versus(match: ContestMatch): string {
  return seating(match)
    .map((place) => match.teams[place])
    .join(" – ");
}

interface LineProps {
  sheet: ContestSheet;
  view: StageView;
  match: ContestMatch;
}

function Line({ sheet, view, match }: LineProps) {
  const points = score(match, view);
  const how = howEnded(match);
  const [one, other] = seating(match);
  return (
    <span class="line">
      <Side match={match} place={one} />{" "}
      <span class="score">
        {points ? `${written(points[one])} : ${written(points[other])}` : "–"}
      </span>{" "}
      <Side match={match} place={other} />{" "}
      <span class="muted">
        {matchTitle(sheet, match.pairing.id)}
        {how && ` · ${t(`contest.how.${how}`)}`}
      </span>
      {match.games?.map(
        ({ number, advice: reasons }) =>
          reasons && (
            <small key={number} class="warning">
              {said({ code: "event.advised", values: { reasons } })}
            </small>
          ),
      )}
    </span>
  );
}

interface DialogProps extends Props {
  pairing: string;
  view: OfficeView;
}

/** The dialog for a decision; it shows what the decision would change. */
export function RuleDialog({ organiser, pairing, view }: DialogProps) {
  const sheet = organiser.feed.sheet.value;
  const there = sheet && found(sheet, pairing);
  const late = view.slots.find((slot) => slot.running && slot.pairing === pairing)?.absent ?? [];
  const points = there && pointsOf(there.match, 1);
  const kind = useSignal<Rule["kind"]>(late.length ? "no-show" : "result");
  const game = useSignal(1);
  const team = useSignal(late.length === 1 ? late[0]! : "");
  // In the order of the match's teams: they change seats from game to game.
  const first = useSignal(points ? `${points[0]}` : "");
  const second = useSignal(points ? `${points[1]}` : "");
  const reason = useSignal("");
  const effect = useSignal<Effect | null>(null);
  const isScore = kind.value === "result";
  const scores: [number, number] = [Number(first.value), Number(second.value)];
  const isWhole =
    (!isScore || (first.value !== "" && second.value !== "" && scores.every(isPoints))) &&
    (kind.value !== "no-show" || team.value !== "");
  const wish = {
    do: "rule",
    kind: kind.value,
    pairing,
    game: game.value,
    team: kind.value === "no-show" ? team.value : "",
    scores: isScore && there ? bySeat(there.match, game.value, scores) : null,
  } as const;
  useEffect(() => {
    effect.value = null;
    if (!isWhole) return;
    let newest = true;
    // The reason does not change the effect, but a decision must have one.
    void organiser.preview({ ...wish, reason: "–" }).then((seen) => {
      if (newest) effect.value = seen;
    });
    return () => {
      newest = false;
    };
  }, [organiser, isWhole, kind.value, game.value, team.value, first.value, second.value]);
  if (!sheet || !there) return null;
  const { match } = there;
  const order = seating(match);
  const fields = [first, second];
  const teams = order.map((place) => match.teams[place] ?? "");
  const numbers = gamesOf(match);
  const present = pointsOf(match, game.value);
  return (
    <Dialog title={matchTitle(sheet, pairing)} onClose={() => organiser.close()}>
      <form
        class="asks"
        onSubmit={async (event) => {
          event.preventDefault();
          const done = await organiser.act({ ...wish, reason: reason.value.trim(), really: true });
          if (done) organiser.close();
        }}
      >
        <Line sheet={sheet} view={there.view} match={match} />
        <fieldset>
          <legend>{t("office.decision")}</legend>
          {KINDS.map((one) => (
            <label key={one} class="check">
              <input
                type="radio"
                name="kind"
                checked={kind.value === one}
                onChange={() => {
                  kind.value = one;
                }}
              />
              {t(`office.decision.${one}`)}
            </label>
          ))}
        </fieldset>
        {(isScore || kind.value === "replay") && numbers.length > 1 && (
          <label class="field">
            <span>{t("office.game")}</span>
            <select
              value={game.value}
              onChange={(event) => {
                game.value = Number(event.currentTarget.value);
                const now = pointsOf(match, game.value);
                first.value = now ? `${now[0]}` : "";
                second.value = now ? `${now[1]}` : "";
              }}
            >
              {numbers.map((number) => (
                <option key={number} value={number}>
                  {number}
                </option>
              ))}
            </select>
          </label>
        )}
        {isScore && (
          <div class="points">
            {order.map((place, at) => (
              <label key={place} class="field">
                <span>{t("office.pointsOf", { team: teams[at]! })}</span>
                <input
                  inputMode="numeric"
                  value={fields[place]!.value}
                  onInput={(event) => {
                    fields[place]!.value = event.currentTarget.value.trim();
                  }}
                />
              </label>
            ))}
            {present && (
              <p class="muted">
                {t("office.pointsNow", {
                  first: teams[0]!,
                  second: teams[1]!,
                  points: order.map((place) => present[place]).join(" : "),
                })}
              </p>
            )}
          </div>
        )}
        {kind.value === "no-show" && (
          <fieldset class="absent">
            <legend>{t("office.absent")}</legend>
            {teams.map((one) => (
              <label key={one} class="check">
                <input
                  type="radio"
                  name="absent"
                  checked={team.value === one}
                  onChange={() => {
                    team.value = one;
                  }}
                />
                {one}
              </label>
            ))}
          </fieldset>
        )}
        <Reason reason={reason} />
        <Effects effect={effect.value} />
        <button
          class="button strong"
          type="submit"
          disabled={!isWhole || !effect.value || !reason.value.trim()}
        >
          {t("office.decide.go")}
        </button>
      </form>
    </Dialog>
  );
}

function isPoints(value: number): boolean {
  return Number.isInteger(value) && value >= 0;
}

/** A team of a match; bold if it has won. */
function Side({ match, place }: { match: ContestMatch; place: 0 | 1 }) {
  const team = match.teams[place];
  return team && match.winner === team ? <b class="won">{team}</b> : <span>{team}</span>;
}
