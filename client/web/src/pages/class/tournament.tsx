/** A friendly tournament of the class's gaits: start it, follow it, read the standings. */

import { useSignal } from "@preact/signals";
import { replayAddress } from "../../core/record_files";
import type { ClassMatch, LeftOut, TournamentState } from "../../core/wire";
import { said, t } from "../../i18n";
import { Icon } from "../../ui/icons";
import type { Teacher } from "./teacher";

const GAMES = ["othello", "flag-strike"] as const;
const COLUMNS = ["won", "drawn", "lost", "points"] as const;
/** How many others each student meets. */
const ROUNDS = { least: 1, most: 20, usual: 3 };
const SECONDS = { least: 10, most: 180, usual: 60 };

export function Tournament({ teacher }: { teacher: Teacher }) {
  const state = teacher.tournament.value;
  return (
    <div class="tournament">
      {state.state === "running" ? (
        <Running teacher={teacher} state={state} />
      ) : (
        <Start teacher={teacher} />
      )}
      {state.trouble && (
        <p class="refused" role="alert">
          {teacher.hide(said(state.trouble))}
        </p>
      )}
      {state.state !== "none" && state.state !== "running" && (
        <p role="status">{t(`class.play.${state.state}`, { done: state.done, of: state.of })}</p>
      )}
      {state.standings.length > 0 && (
        <section aria-label={t("class.play.standings")}>
          <button
            class="button"
            type="button"
            onClick={() => {
              teacher.screen.value = { shows: "standings" };
            }}
          >
            <Icon name="full" /> {t("class.play.big")}
          </button>
          <Standings teacher={teacher} />
        </section>
      )}
      {state.left_out.length > 0 && <Left teacher={teacher} out={state.left_out} />}
      {state.matches.length > 0 && <Matches teacher={teacher} matches={state.matches} />}
    </div>
  );
}

function Start({ teacher }: { teacher: Teacher }) {
  const arena = useSignal<string>(GAMES[0]);
  const rounds = useSignal(ROUNDS.usual);
  const seconds = useSignal(SECONDS.usual);
  const number = (label: string, value: typeof rounds, { least, most }: typeof ROUNDS) => (
    <label class="field">
      <span>{label}</span>
      <input
        type="number"
        required
        min={least}
        max={most}
        value={value.value}
        onInput={(event) => {
          value.value = event.currentTarget.valueAsNumber;
        }}
      />
    </label>
  );
  return (
    <form
      class="start"
      onSubmit={(event) => {
        event.preventDefault();
        const fields = { arena: arena.value, rounds: rounds.value, seconds: seconds.value };
        void teacher.act("play", fields);
      }}
    >
      <p class="muted">{t("class.play.text")}</p>
      <label class="field">
        <span>{t("class.play.game")}</span>
        <select
          name="arena"
          value={arena.value}
          onChange={(event) => {
            arena.value = event.currentTarget.value;
          }}
        >
          {GAMES.map((game) => (
            <option key={game} value={game}>
              {t(`class.play.${game}`)}
            </option>
          ))}
        </select>
      </label>
      <div class="row">
        {number(t("class.play.rounds"), rounds, ROUNDS)}
        {number(t("class.play.seconds"), seconds, SECONDS)}
      </div>
      <button class="button strong" type="submit" disabled={teacher.cards.value.length < 2}>
        {t("class.play.start")}
      </button>
    </form>
  );
}

function Running({ teacher, state }: { teacher: Teacher; state: TournamentState }) {
  const text = t("class.play.running", { done: state.done, of: state.of });
  return (
    <div class="running">
      <p role="status">{text}</p>
      <progress max={Math.max(1, state.of)} value={state.done} aria-label={text} />
      <button class="button" type="button" onClick={() => void teacher.act("stop_play")}>
        {t("class.play.stop")}
      </button>
    </div>
  );
}

interface StandingsProps {
  teacher: Teacher;
  /** Whether there is room for whole words. */
  big?: boolean;
}

/** The standings, the best first. */
export function Standings({ teacher, big = false }: StandingsProps) {
  const { standings } = teacher.tournament.value;
  return (
    <table class="standings">
      <thead>
        <tr>
          <th scope="col">
            <span class="hidden-text">{t("class.play.place")}</span>
          </th>
          <th scope="col">{t("class.play.name")}</th>
          {COLUMNS.map((column) => {
            const word = t(`class.play.${column}`);
            return (
              <th key={column} scope="col">
                {big ? word : <abbr title={word}>{t(`class.play.${column}.short`)}</abbr>}
              </th>
            );
          })}
        </tr>
      </thead>
      <tbody>
        {standings.map((one) => (
          <tr key={one.name}>
            <td>{one.rank}</td>
            <th scope="row">{teacher.player(one.name)}</th>
            {COLUMNS.map((column) => (
              <td key={column}>{one[column]}</td>
            ))}
          </tr>
        ))}
      </tbody>
    </table>
  );
}

/** Who does not play, and why. */
function Left({ teacher, out }: { teacher: Teacher; out: readonly LeftOut[] }) {
  return (
    <details class="left-out">
      <summary>{t("class.play.leftOut", { count: out.length })}</summary>
      <ul>
        {out.map(({ name, mistakes, why }) => {
          const reason = why ?? mistakes[0]?.found;
          return (
            <li key={name}>
              <b>{teacher.player(name)}</b> {reason && said(reason)}
            </li>
          );
        })}
      </ul>
    </details>
  );
}

interface MatchesProps {
  teacher: Teacher;
  matches: readonly ClassMatch[];
}

/** All matches, the newest first; each leads to its replay. */
function Matches({ teacher, matches }: MatchesProps) {
  const hidden = teacher.projector.value;
  return (
    <section class="matches" aria-label={t("class.play.matches")}>
      <h2>{t("class.play.matches")}</h2>
      {hidden && <p class="muted">{t("class.play.noReplay")}</p>}
      <ol reversed>
        {matches.toReversed().map(({ left, right, scores, winner, record, ...match }, index) => {
          const [one, other] = [left, right].map((name) => teacher.player(name)) as [
            string,
            string,
          ];
          return (
            <li key={matches.length - index}>
              <span class="sides">
                {winner === 0 ? <b>{one}</b> : one}
                {" – "}
                {winner === 1 ? <b>{other}</b> : other}
              </span>
              <span>{match.void ? t("class.play.void") : `${scores[0]} : ${scores[1]}`}</span>
              {record && !hidden && (
                <a
                  href={replayAddress(record)}
                  target="_blank"
                  rel="noreferrer"
                  aria-label={t("class.play.replay", { left: one, right: other })}
                >
                  <Icon name="play" />
                </a>
              )}
            </li>
          );
        })}
      </ol>
    </section>
  );
}
