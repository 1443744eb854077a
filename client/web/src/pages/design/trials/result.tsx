/** What a trial showed: figures, and at most three sentences that say why. */

import { jointsOfLeg } from "../../../core/design/parts";
import { legOf } from "../../../core/design/trial";
import type { Sentence } from "../../../core/wire";
import { said, t } from "../../../i18n";
import { guessName } from "../head/foretell";
import { classes } from "../names";
import type { Sheet } from "../table/sheet";
import type { Showing } from "../walk/showing";
import { difference, FIGURES, TILES, titleOf, written } from "./figures";
import type { Trials } from "./trials";
import { type Tried, triedName } from "./tried";
import "./result.css";

interface ResultProps {
  sheet: Sheet;
  trials: Trials;
  showing: Showing;
  onShare: () => void;
}

export function Result({ sheet, trials, showing, onShare }: ResultProps) {
  const tried = showing.shown.value;
  const other = showing.other.value;
  const before = other ?? (tried && trials.before(tried));
  if (!tried) return <First onTry={() => void trials.tryIt()} />;
  const { figures, notes = [], fault } = tried.trial.reply;
  const isOld = !tried.name && tried.version !== sheet.version.value;
  return (
    <section class="trial-result" aria-label={t("design.result")}>
      <header>
        <h2>{tried.name || t("design.trialOf", { number: tried.number, key: tried.key })}</h2>
        {isOld && <span class="badge old">{t("design.oldTable")}</span>}
        <button class="button quiet small" type="button" onClick={onShare}>
          {t("design.share")}
        </button>
      </header>
      <Verdicts tried={tried} />
      <dl class="tiles">
        {TILES.map((one) => {
          const by = before && difference(one, before.trial.reply.figures, figures);
          return (
            <div key={one.name} data-figure={one.name}>
              <dt>{t(titleOf(one))}</dt>
              <dd>
                {written(one, figures)}
                <small>{one.unit}</small>
                {by && by.is !== "same" && <i data-is={by.is}>{by.text}</i>}
              </dd>
            </div>
          );
        })}
      </dl>
      {fault && <p class="fault">{said(fault)}</p>}
      <ol class="sentences" aria-label={t("design.explained")}>
        {tried.trial.reply.explained.map((sentence, index) => (
          <li key={index}>
            <Explained sheet={sheet} tried={tried} sentence={sentence} />
          </li>
        ))}
      </ol>
      {notes.map((note, index) => (
        <p key={index} class="muted note">
          {said(note)}
        </p>
      ))}
      {other && <Differences tried={tried} other={other} />}
    </section>
  );
}

/** How it is done, until something was tried. */
function First({ onTry }: { onTry: () => void }) {
  return (
    <section class="trial-result first" aria-label={t("design.result")}>
      <h2>{t("design.first")}</h2>
      <ol>
        <li>{t("design.first.1")}</li>
        <li>{t("design.first.2")}</li>
        <li>{t("design.first.3")}</li>
      </ol>
      <button class="button strong" type="button" onClick={onTry}>
        {t("design.try")}
      </button>
    </section>
  );
}

interface ExplainedProps {
  sheet: Sheet;
  tried: Tried;
  sentence: Sentence;
}

function Explained({ sheet, tried, sentence }: ExplainedProps) {
  const leg = legOf(sentence);
  const legs = tried.robot.legs.length;
  const joints = sentence.cell ? [sentence.cell.joint] : leg === null ? [] : jointsOfLeg(leg, legs);
  const row = tried.rows[sentence.cell?.posture ?? 0];
  const text = said(sentence.said);
  if (!joints.length || row === undefined) return <p>{text}</p>;
  return (
    <button
      type="button"
      title={t("design.showCell")}
      onPointerEnter={() => sheet.point(joints)}
      onPointerLeave={() => sheet.point([])}
      onFocus={() => sheet.point(joints)}
      onBlur={() => sheet.point([])}
      onClick={() => sheet.select({ row, col: joints[0]! })}
    >
      {text}
    </button>
  );
}

function Verdicts({ tried }: { tried: Tried }) {
  return (
    <>
      {tried.verdicts.map(({ guess, verdict }) => (
        <p key={guess.about} class={classes("verdict", verdict.right ? "right" : "wrong")}>
          {t(verdict.right ? "design.verdict.right" : "design.verdict.wrong", {
            guess: guessName(guess.is),
            was: guessName(verdict.was),
          })}
        </p>
      ))}
    </>
  );
}

/** All figures of two trials side by side. */
function Differences({ tried, other }: { tried: Tried; other: Tried }) {
  const [now, was] = [tried.trial.reply.figures, other.trial.reply.figures];
  return (
    <table class="differences">
      <caption>{t("design.compared", { one: triedName(tried), other: triedName(other) })}</caption>
      <thead>
        <tr>
          <th scope="col">{t("design.figure")}</th>
          <th scope="col">{triedName(tried)}</th>
          <th scope="col">{triedName(other)}</th>
          <th scope="col">{t("design.difference")}</th>
        </tr>
      </thead>
      <tbody>
        {FIGURES.map((one) => {
          const by = difference(one, was, now);
          return (
            <tr key={one.name}>
              <th scope="row">
                {t(titleOf(one))} {one.unit && <small>{one.unit}</small>}
              </th>
              <td>{written(one, now)}</td>
              <td>{written(one, was)}</td>
              <td data-is={by?.is}>{by?.text ?? "–"}</td>
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}
