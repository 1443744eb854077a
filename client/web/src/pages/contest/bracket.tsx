/** A bracket as a drawing: boxes of matches, and lines to where their winners go. */

import type { ComponentChildren } from "preact";
import { type Box, type Bracket, bracket, type Cut, type Line } from "../../core/contest/bracket";
import { fit } from "../../core/contest/fit";
import {
  byId,
  type ContestMatch,
  type ContestSheet,
  howEnded,
  isDecided,
  origin,
  type StageView,
  score,
  seating,
  written,
} from "../../core/contest/sheet";
import { replayAddress } from "../../core/record_files";
import { t } from "../../i18n";
import { big, chosenTeam, matchId, teamAddress } from "./parts";
import { courtOf, matchTitle, numberTitle, roundTitle, shortOrigin } from "./words";

const BOX = { width: 216, height: 56 };
const HEAD = 34;
const PAD = 4;
/** Height of a note below a box: its line, with the parts of letters below that. */
const NOTE = big ? 22 : 17;
/** From a box to the line of its note: letters are larger on a projector. */
const NOTE_LINE = big ? 17 : 13;
/** From box to box: lines go between columns, notes between rows. */
const STEP = { x: BOX.width + 44, y: BOX.height + NOTE + 6 };
const NAME_EM = 11;
/** A bold name has room for so much less text. */
const BOLD = 0.82;
const FROM_EM = 14.5;
const POINTS_WIDTH = 34;

interface Props {
  sheet: ContestSheet;
  view: StageView;
  /** What is shown of it. */
  cut?: Cut;
}

/** The bracket of a stage. */
export function BracketView({ sheet, view, cut }: Props) {
  const made = bracket(view, cut);
  const width = made.columns * STEP.x - (STEP.x - BOX.width) + 2 * PAD;
  const height = HEAD + made.rows * STEP.y - (STEP.y - BOX.height) / 2 + NOTE;
  return (
    <svg
      class="bracket"
      width={width}
      height={height}
      viewBox={`0 0 ${width} ${height}`}
      aria-label={t("contest.bracket")}
    >
      <Headings view={view} made={made} />
      {made.lines.map((line) => (
        <Way key={line.to.match.pairing.id + line.place} line={line} />
      ))}
      {made.boxes.map((box) => (
        <MatchBox key={box.match.pairing.id} sheet={sheet} view={view} box={box} />
      ))}
    </svg>
  );
}

function Headings({ view, made }: { view: StageView; made: Bracket }) {
  return made.headings.map((heading) => (
    <text
      key={heading.section + heading.round}
      class="heading"
      x={PAD + heading.column * STEP.x}
      y={HEAD + heading.row * STEP.y - 4}
    >
      {fit(roundTitle(view, heading), 15)}
    </text>
  ));
}

function Way({ line: { from, to, place } }: { line: Line }) {
  const x1 = PAD + from.column * STEP.x + BOX.width;
  const y1 = HEAD + from.row * STEP.y;
  const x2 = PAD + to.column * STEP.x;
  const isLower = seating(to.match)[1] === place;
  const y2 = HEAD + to.row * STEP.y + (isLower ? 1 : -1) * (BOX.height / 4);
  const winner = from.match.winner;
  const chosen = winner && winner === chosenTeam.value;
  const middle = x2 - (STEP.x - BOX.width) / 2;
  return (
    <path class="way" data-chosen={chosen || undefined} d={`M${x1} ${y1}H${middle}V${y2}H${x2}`} />
  );
}

interface BoxProps {
  sheet: ContestSheet;
  view: StageView;
  box: Box;
}

function MatchBox({ sheet, view, box }: BoxProps) {
  const { match } = box;
  const x = PAD + box.column * STEP.x;
  const y = HEAD + box.row * STEP.y - BOX.height / 2;
  const points = score(match, view);
  const games = match.games ?? [];
  const record = games.length === 1 && isDecided(match) ? games[0]!.record : "";
  const court = courtOf(sheet.running, match);
  const how = howEnded(match);
  const title = matchTitle(sheet, match.pairing.id);
  const note = court
    ? t("contest.on", { court })
    : how
      ? t(how === "walkover" ? "contest.how.walkover.short" : `contest.how.${how}`)
      : match.pairing.only_if_second_won && !games.length
        ? t("contest.ifNeeded")
        : "";
  const scores = points && (
    <>
      <rect
        class="points-back"
        x={BOX.width - POINTS_WIDTH}
        width={POINTS_WIDTH}
        height={BOX.height}
      />
      {seating(match).map((place, line) => (
        <text
          key={place}
          class="points"
          data-won={won(match, place) || undefined}
          x={BOX.width - POINTS_WIDTH / 2}
          y={lineY(line)}
        >
          {written(points[place])}
        </text>
      ))}
    </>
  );
  const [one, other] = seating(match).map((place) => match.teams[place] ?? t("contest.open"));
  const versus = { left: one!, right: other! };
  return (
    <g class="box" data-state={court ? "running" : match.state} transform={`translate(${x} ${y})`}>
      <title>{note ? `${title}, ${note}` : title}</title>
      <rect class="frame" width={BOX.width} height={BOX.height} rx="8" />
      <line class="half" x1="22" x2={BOX.width} y1={BOX.height / 2} y2={BOX.height / 2} />
      <text class="number" x="11" y={BOX.height / 2 + 4}>
        {numberTitle(view, match)}
      </text>
      {seating(match).map((place, line) => (
        <PlaceLine
          key={place}
          sheet={sheet}
          view={view}
          match={match}
          place={place}
          y={lineY(line)}
        />
      ))}
      {scores && (
        <Link
          href={record ? replayAddress(record) : `#${matchId(match)}`}
          label={
            record ? t("contest.replayOf", { ...versus, number: 1 }) : t("contest.gamesOf", versus)
          }
        >
          {scores}
        </Link>
      )}
      {note && (
        <text class="note" x={BOX.width} y={BOX.height + NOTE_LINE}>
          {fit(note, 20)}
        </text>
      )}
    </g>
  );
}

interface LineProps {
  sheet: ContestSheet;
  view: StageView;
  match: ContestMatch;
  place: 0 | 1;
  /** Where its line stands in the box. */
  y: number;
}

/** The team of a place, or where it will come from. */
function PlaceLine({ sheet, view, match, place, y }: LineProps) {
  const team = match.teams[place];
  if (team === null) {
    const source = origin(match.pairing.sources[place], byId(view));
    return (
      <text class="from" x="24" y={y}>
        {fit(shortOrigin(sheet, source, match), FROM_EM)}
      </text>
    );
  }
  const decided = isDecided(match);
  return (
    <Link href={teamAddress(team)} label={team}>
      <text
        class="name"
        data-won={won(match, place) || undefined}
        data-lost={(decided && !won(match, place)) || undefined}
        data-chosen={chosenTeam.value === team || undefined}
        x="24"
        y={y}
      >
        {fit(team, won(match, place) ? NAME_EM * BOLD : NAME_EM)}
      </text>
    </Link>
  );
}

interface LinkProps {
  href: string;
  label: string;
  children: ComponentChildren;
}

/** A link within the drawing; on a projector nobody can press it. */
function Link({ href, label, children }: LinkProps) {
  if (big) return <>{children}</>;
  return (
    <a href={href} aria-label={label}>
      {children}
    </a>
  );
}

function won(match: ContestMatch, place: 0 | 1): boolean {
  return isDecided(match) && !!match.winner && match.winner === match.teams[place];
}

/** Where the first or the second line of a box stands. */
function lineY(line: number): number {
  return BOX.height * (line ? 0.75 : 0.25) + 5;
}
