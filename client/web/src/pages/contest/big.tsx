/** The contest on a projector: the match that is played; between matches tables, turned over by itself. */

import { effect, type Signal, signal, useSignal } from "@preact/signals";
import type { ComponentType } from "preact";
import { useEffect, useMemo } from "preact/hooks";
import { ownPage, short } from "../../core/address";
import type { NextGame } from "../../core/contest/games";
import { podium } from "../../core/contest/places";
import { type ContestSheet, type Team, teamsOf } from "../../core/contest/sheet";
import { type Slide, slides } from "../../core/contest/slides";
import { pagesForAll } from "../../core/served";
import { said, t } from "../../i18n";
import { dayTime } from "../../i18n/words";
import { KeyHelp, type KeyRow } from "../../ui/key_help";
import { toggleFullscreen } from "../../ui/screen";
import { useShortcuts } from "../../ui/shortcuts";
import { languageOf } from "../../ui/team_name";
import { TeamPicture } from "../../ui/team_picture";
import { BracketView } from "./bracket";
import { Standing } from "./head";
import { LiveScore, live } from "./now";
import { big } from "./parts";
import { PauseLine } from "./pause";
import { Standings } from "./standings";
import { Ratings, ranked } from "./teams";
import { expected, gameTitle, stageHeading, stageTitle, winnersTitle } from "./words";

const SLIDE_MS = 12_000;
const RATINGS_MOST = 9;
/** So few teams before the draw can be larger. */
const FEW_TEAMS = 6;
/** Tables with so few rows can be larger. */
const FEW = 5;

/** The live picture, once its program is here; a published folder has none. */
const picture = signal<ComponentType<{ shown: Signal<boolean> }> | null>(null);
if (big && !ownPage) {
  void import("./picture").then(({ Picture }) => {
    picture.value = Picture;
  });
}
/** Whether the live picture fills the screen. */
const isPicture = signal(false);
effect(() => {
  document.documentElement.classList.toggle("projector", big);
});

export function Big({ sheet }: { sheet: ContestSheet }) {
  const Picture = picture.value;
  return (
    <>
      {Picture && <Picture shown={isPicture} />}
      {!isPicture.value && <Slides sheet={sheet} />}
    </>
  );
}

function Slides({ sheet }: { sheet: ContestSheet }) {
  const at = useSignal(0);
  const still = useSignal(false);
  const all = slides(sheet);
  const number = at.value % all.length;
  useEffect(() => {
    if (still.value) return;
    const timer = setTimeout(() => {
      at.value++;
    }, SLIDE_MS);
    return () => clearTimeout(timer);
  }, [at.value, still.value]);
  useShortcuts(
    useMemo(() => {
      const turn = (steps: number) => {
        at.value = (number + steps + all.length) % all.length;
      };
      return {
        ArrowLeft: () => turn(-1),
        ArrowRight: () => turn(1),
        Space: () => {
          still.value = !still.value;
        },
        KeyF: toggleFullscreen,
      };
    }, [number, all.length]),
  );
  const slide = all[number]!;
  return (
    <main class="contest big">
      <header class="head">
        <h1>{sheet.name}</h1>
        <p class="state">
          <Standing sheet={sheet} />
        </p>
      </header>
      <div class="slide" data-slide={slide.is}>
        <Shown sheet={sheet} slide={slide} />
      </div>
      <KeyHelp rows={keyRows} />
    </main>
  );
}

function Shown({ sheet, slide }: { sheet: ContestSheet; slide: Slide }) {
  switch (slide.is) {
    case "entered":
      return <Entered sheet={sheet} teams={slide.teams} />;
    case "now":
      return <Next sheet={sheet} games={slide.games} />;
    case "podium":
      return <Podium sheet={sheet} />;
    case "ratings":
      return (
        <>
          <h2>{t("contest.teams")}</h2>
          <Ratings sheet={sheet} teams={ranked(sheet).slice(0, RATINGS_MOST)} />
        </>
      );
  }
  const { stage, plan } = slide.view;
  return (
    <>
      <h2>
        {stageTitle(sheet, stage.name)} <small>{stageHeading(sheet, plan)}</small>
      </h2>
      {slide.is === "bracket" ? (
        <BracketView sheet={sheet} view={slide.view} cut={slide.cut} />
      ) : (
        <div
          class="tables"
          data-small={slide.parts.every(({ rows }) => rows.length <= FEW) || undefined}
        >
          {slide.parts.map(({ table, rows }) => (
            <Standings
              key={table.section + rows[0]!.team}
              view={slide.view}
              table={table}
              rows={rows}
              brief={slide.parts.length > 1}
            />
          ))}
        </div>
      )}
    </>
  );
}

/** Before the draw: who is in, how others enter, and when it begins. */
function Entered({ sheet, teams }: { sheet: ContestSheet; teams: readonly Team[] }) {
  const { open, closes_ms } = sheet;
  const pages = useSignal("");
  useEffect(() => {
    if (open) {
      void pagesForAll().then((found) => {
        pages.value = found;
      });
    }
  }, [open, pages]);
  const begins = !open ? "closed" : closes_ms ? "at" : "open";
  return (
    <>
      <PauseLine sheet={sheet} />
      <h2>{t("contest.hasEntered", { count: teamsOf(sheet).here })}</h2>
      <ul class="entered" data-few={teams.length <= FEW_TEAMS || undefined}>
        {teams.map(({ name }) => (
          <li key={name}>
            <TeamPicture sheet={sheet} team={name} />
            <b class="team">{name}</b>
          </li>
        ))}
      </ul>
      {open && pages.value && (
        <p>{t("contest.enterAt", { address: `${short(pages.value)}/enter` })}</p>
      )}
      <p class="muted">
        {t(`contest.begins.${begins}`, { time: closes_ms ? dayTime(closes_ms) : "" })}
      </p>
    </>
  );
}

/** The games on courts and those that come next: who, what, where and about when. */
function Next({ sheet, games }: { sheet: ContestSheet; games: readonly NextGame[] }) {
  useEffect(() => (ownPage ? undefined : live.start()), []);
  return (
    <>
      <PauseLine sheet={sheet} />
      <h2>
        {t("contest.coming")}{" "}
        {games.some((one) => !one.call && expected(sheet, one)) && (
          <small>{t("contest.estimates")}</small>
        )}
      </h2>
      {!games.length && <p class="muted">{t("contest.noneComing")}</p>}
      <ol class="next-games" data-few={games.length <= 2 || undefined}>
        {games.map((one) => (
          <li key={`${one.pairing}/${one.game}`}>
            <p class="sides">
              <b class="team">{one.teams[0]}</b>
              <span class="between">–</span>
              <b class="team">{one.teams[1]}</b>
            </p>
            <p>
              <span class="muted">{gameTitle(sheet, one.pairing, one.game)}</span>{" "}
              <span class="expected">
                {one.call ? <OnCourt game={one} /> : expected(sheet, one)}
              </span>
            </p>
          </li>
        ))}
      </ol>
    </>
  );
}

/** How a game stands that a court has. */
function OnCourt({ game: { court, call, swapped } }: { game: NextGame }) {
  const score = live.of(call);
  return (
    <>
      {t("contest.court", { court })} ·{" "}
      <LiveScore score={score} swapped={swapped} otherwise={said({ code: "when.moment" })} />
    </>
  );
}

/** Who has won, and the places after that: the first in the middle, the second to its left. */
function Podium({ sheet }: { sheet: ContestSheet }) {
  const { steps, more } = podium(sheet);
  const winners = steps.find(({ rank }) => rank === 1)?.teams ?? [];
  const pictured = sheet.teams.filter(({ picture }) => picture).map(({ name }) => name);
  const withLetter = steps.some(({ teams }) => teams.some((team) => pictured.includes(team)));
  return (
    <div class="podium">
      <h2>{winnersTitle(winners)}</h2>
      <ol class="steps">
        {steps.map(({ rank, teams }) => (
          <li key={rank} data-rank={rank}>
            {teams.map((team) => (
              <p key={team} class="who">
                <TeamPicture sheet={sheet} team={team} withLetter={withLetter} />
                <b lang={languageOf(team)}>{team}</b>
              </p>
            ))}
            <span>{rank}</span>
          </li>
        ))}
      </ol>
      {more.length > 0 && (
        <ol class="more">
          {more.map(({ rank, team }) => (
            <li key={team}>
              <span>{rank}</span> {team}
            </li>
          ))}
        </ol>
      )}
    </div>
  );
}

function keyRows(): readonly KeyRow[] {
  return [
    [["←", "→"], t("contest.keyTurn")],
    [["Space"], t("contest.keyStill")],
    [["F"], t("keys.fullscreen")],
  ];
}
