/** The tables of a stage: its groups, a Swiss stage, or the places in a bracket. */

import {
  isKnockout,
  isStillIn,
  levelPlaces,
  type StageView,
  type Table,
  tieColumns,
} from "../../core/contest/sheet";
import { isMessage, said, t } from "../../i18n";
import { chosenTeam, TeamLink } from "./parts";
import { groupTitle, signed } from "./words";

const COUNTS = ["played", "won", "drawn", "lost"] as const;
const BRACKET_COUNTS = ["played", "won", "lost"] as const;
const BRIEF_COUNTS = ["played"] as const;

export function Tables({ view }: { view: StageView }) {
  const ranked = view.tables.filter(({ rows }) => rows.length);
  return (
    <div class="tables" data-many={ranked.length > 1 || undefined}>
      {ranked.map((table) => (
        <div key={table.section} class="scrolls">
          <Standings view={view} table={table} rows={table.rows} />
        </div>
      ))}
    </div>
  );
}

interface Props {
  view: StageView;
  table: Table;
  /** Those of its rows that are shown. */
  rows: Table["rows"];
  /** Whether there is no room for all columns. */
  brief?: boolean;
}

export function Standings({ view, table, rows, brief = false }: Props) {
  const bracket = isKnockout(view);
  const counts = bracket ? BRACKET_COUNTS : brief ? BRIEF_COUNTS : COUNTS;
  const ties = bracket || brief ? [] : tieColumns(table);
  const title = groupTitle(view, table.section);
  const notes = [
    ...(rows.some(({ shares }) => shares) ? [`= ${t("contest.shares")}`] : []),
    ...(bracket ? levelPlaces(table) : []).map((values) =>
      said({ code: "standing.level", values }),
    ),
  ];
  return (
    <table class="standings">
      <caption>{title || t("contest.table")}</caption>
      <thead>
        <tr>
          <th scope="col">
            <span class="hidden-text">{t("contest.rank")}</span>
          </th>
          <th scope="col" class="who">
            {t("contest.team")}
          </th>
          {!bracket && <Column name="points" />}
          {counts.map((name) => (
            <Column key={name} name={name} />
          ))}
          <Column name="difference" />
          {ties.map(({ code }) => (
            <TieColumn key={code} id={`${view.stage.name}-${table.section}-${code}`} code={code} />
          ))}
        </tr>
      </thead>
      <tbody>
        {rows.map((row) => {
          const { team, rank, won, drawn, lost, points, scored, conceded, out, shares } = row;
          const all = { played: won + drawn + lost, won, drawn, lost };
          return (
            <tr key={team} data-chosen={chosenTeam.value === team || undefined}>
              <td>
                {bracket && isStillIn(view, team) ? "" : rank}
                {shares && (
                  <abbr class="shares" title={t("contest.shares")}>
                    {" ="}
                  </abbr>
                )}
              </td>
              <th scope="row" class="who">
                <TeamLink name={team} />
                {out && <small class="out"> {t("contest.out")}</small>}
              </th>
              {!bracket && <td class="points">{points}</td>}
              {counts.map((name) => (
                <td key={name}>{all[name]}</td>
              ))}
              <td title={`${scored} : ${conceded}`}>{signed(scored - conceded)}</td>
              {ties.map(({ code, index }) => (
                <td key={code}>{row.tie_breaks[index]}</td>
              ))}
            </tr>
          );
        })}
      </tbody>
      {!brief && notes.length > 0 && (
        <tfoot>
          {notes.map((note) => (
            <tr key={note}>
              <td colSpan={4 + counts.length + ties.length} class="muted">
                {note}
              </td>
            </tr>
          ))}
        </tfoot>
      )}
    </table>
  );
}

/** A column whose heading is a short word; the whole word is its explanation. */
function Column({ name }: { name: "points" | "difference" | (typeof COUNTS)[number] }) {
  return (
    <th scope="col">
      <abbr title={t(`contest.${name}`)}>{t(`contest.${name}.short`)}</abbr>
    </th>
  );
}

/** A column of a tie-break: its heading explains it. */
function TieColumn({ id, code }: { id: string; code: string }) {
  const short = `contest.tie.${code}.short`;
  return (
    <th scope="col">
      <button type="button" class="explains" popovertarget={id} title={tieText(code)}>
        {isMessage(short) ? t(short) : code}
      </button>
      <p id={id} popover="auto">
        {tieText(code)}
      </p>
    </th>
  );
}

/** Explains in which order ties are broken. */
export function Ties({ view }: { view: StageView }) {
  const codes = view.tables[0]?.tie_breaks ?? [];
  if (isKnockout(view) || !codes.length) return null;
  return (
    <details class="ties">
      <summary>{t("contest.ties")}</summary>
      <p class="muted">{t("contest.tiesHow")}</p>
      <ol>
        {codes.map((code) => (
          <li key={code}>{tieText(code)}</li>
        ))}
      </ol>
    </details>
  );
}

function tieText(code: string): string {
  const name = `contest.tie.${code}`;
  return isMessage(name) ? t(name) : t("contest.tie.other", { code });
}
