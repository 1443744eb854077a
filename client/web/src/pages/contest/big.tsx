/** The contest on a projector: large, and turned over by itself. */

import { useSignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import type { ContestSheet } from "../../core/contest/sheet";
import { type Slide, slides } from "../../core/contest/slides";
import { t } from "../../i18n";
import { IconButton } from "../../ui/icons";
import { toggleFullscreen } from "../../ui/screen";
import { useShortcuts } from "../../ui/shortcuts";
import { BracketView } from "./bracket";
import { Standing, Winners } from "./head";
import { Now } from "./now";
import { Standings } from "./standings";
import { Ratings, ranked } from "./teams";
import { format, stageTitle } from "./words";

const SLIDE_MS = 12_000;
const COMING_MOST = 6;
const RATINGS_MOST = 12;
const WINNERS_MOST = 8;
/** Tables with so few rows can be larger. */
const FEW = 7;

export function Big({ sheet }: { sheet: ContestSheet }) {
  const at = useSignal(0);
  const still = useSignal(false);
  const all = slides(sheet);
  const number = at.value % all.length;
  const turn = (steps: number) => {
    at.value = (number + steps + all.length) % all.length;
  };
  useEffect(() => {
    if (still.value) return;
    const timer = setTimeout(() => {
      at.value++;
    }, SLIDE_MS);
    return () => clearTimeout(timer);
  }, [at.value, still.value]);
  const toggle = () => {
    still.value = !still.value;
  };
  useShortcuts(
    useMemo(
      () => ({
        ArrowLeft: () => turn(-1),
        ArrowRight: () => turn(1),
        Space: toggle,
        KeyF: toggleFullscreen,
      }),
      [number, all.length],
    ),
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
      <footer>
        <IconButton name="back" label={t("contest.previous")} onClick={() => turn(-1)} />
        <IconButton
          name={still.value ? "play" : "pause"}
          label={t(still.value ? "contest.resume" : "contest.pause")}
          onClick={toggle}
        />
        <IconButton name="ahead" label={t("contest.next")} onClick={() => turn(1)} />
        <span class="muted">{t("contest.slide", { number: number + 1, all: all.length })}</span>
        <a href="?">{t("contest.whole")}</a>
      </footer>
    </main>
  );
}

function Shown({ sheet, slide }: { sheet: ContestSheet; slide: Slide }) {
  switch (slide.is) {
    case "now":
      return <Now sheet={sheet} games={slide.running} most={COMING_MOST} />;
    case "winner":
      return <End sheet={sheet} />;
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
        {stageTitle(sheet, stage.name)} <small>{format(plan.format, stage.settings.games)}</small>
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

/** Who has won, and who follows. */
function End({ sheet }: { sheet: ContestSheet }) {
  const view = sheet.stages.at(-1)!;
  return (
    <>
      <Winners sheet={sheet} />
      {view.tables.slice(0, 1).map((table) => (
        <Standings
          key={table.section}
          view={view}
          table={table}
          rows={table.rows.slice(0, WINNERS_MOST)}
        />
      ))}
    </>
  );
}
