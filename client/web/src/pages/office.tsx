/** The office: entries, timetable, decisions and papers, for whoever organises a contest. */

import { useSignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import { said, t } from "../i18n";
import { Banner, waitsForGateway } from "../ui/banner";
import { useIsBefore } from "../ui/moment";
import { Settings } from "../ui/settings";
import { Toasts } from "../ui/toasts";
import { Reasons } from "./contest/reasons";
import { stageTitle } from "./contest/words";
import { CloseDialog, DrawDialog } from "./office/closing";
import {
  DayBar,
  LaterDialog,
  LineDialog,
  PauseDialog,
  SubstituteDialog,
  UndrawDialog,
} from "./office/day";
import {
  ApproveDialog,
  CodeDialog,
  DeclineDialog,
  LeaveDialog,
  TeamDialog,
} from "./office/dialogs";
import { Entries } from "./office/entries";
import { Head } from "./office/head";
import { MoveDialog } from "./office/moving";
import { Organiser } from "./office/organiser";
import { OfficePapers } from "./office/papers";
import { RuleDialog, Rulings } from "./office/ruling";
import { StaffDialog } from "./office/staff";
import { Timetable } from "./office/timetable";
import "./contest/contest.css";
import "./office/office.css";

/** Who has gone on into the newest stage that follows another one, and why. */
function GoesOn({ organiser }: { organiser: Organiser }) {
  const sheet = organiser.feed.sheet.value;
  const view = sheet?.stages.findLast(({ stage }) => sheet.reasons[stage.name]);
  return sheet && view ? (
    <section aria-label={t("contest.reasons")}>
      <h2>{stageTitle(sheet, view.stage.name)}</h2>
      <Reasons sheet={sheet} view={view} />
    </section>
  ) : null;
}

export default function Office() {
  const organiser = useMemo(() => new Organiser(), []);
  const settings = useSignal(false);
  const view = organiser.view.value;
  const over = organiser.over.value;
  const name = view?.event.name;
  useEffect(() => {
    document.title = `${t("office.title")} – ${name ?? "LACOC"}`;
  });
  useIsBefore(view?.day.until_ms ?? 0); // then nothing is held any more
  const trouble = organiser.trouble.value;
  const waits = trouble ? said(trouble) : waitsForGateway(organiser.desk.connection.state.value);
  if (over?.is === "paper") return <OfficePapers organiser={organiser} paper={over.paper} />;
  return (
    <>
      {waits && <Banner role="alert">{waits}</Banner>}
      <main class="office">
        {!view && <h1>{t("office.title")}</h1>}
        {view && (
          <>
            <Head
              organiser={organiser}
              view={view}
              onSettings={() => {
                settings.value = true;
              }}
            />
            {view.drawn && organiser.waiting.value.length > 0 && (
              <Entries organiser={organiser} view={view} waiting />
            )}
            <DayBar organiser={organiser} view={view} />
            {!view.drawn && <Entries organiser={organiser} view={view} />}
            {(view.drawn || view.slots.length > 0) && (
              <Timetable organiser={organiser} view={view} />
            )}
            {view.drawn && <GoesOn organiser={organiser} />}
            {view.drawn && <Rulings organiser={organiser} />}
            {view.drawn && <Entries organiser={organiser} view={view} />}
          </>
        )}
      </main>
      {over?.is === "close" && view && <CloseDialog organiser={organiser} view={view} />}
      {over?.is === "draw" && view && <DrawDialog organiser={organiser} view={view} />}
      {over?.is === "pause" && <PauseDialog organiser={organiser} />}
      {over?.is === "later" && <LaterDialog organiser={organiser} />}
      {over?.is === "line" && view && <LineDialog organiser={organiser} view={view} />}
      {over?.is === "undraw" && view && <UndrawDialog organiser={organiser} view={view} />}
      {over?.is === "staff" && view && <StaffDialog organiser={organiser} view={view} />}
      {over?.is === "substitute" && view && (
        <SubstituteDialog organiser={organiser} view={view} team={over.team} />
      )}
      {over?.is === "team" && <TeamDialog organiser={organiser} team={over.team} />}
      {over?.is === "leave" && <LeaveDialog organiser={organiser} team={over.team} />}
      {over?.is === "approve" && <ApproveDialog organiser={organiser} team={over.team} />}
      {over?.is === "decline" && <DeclineDialog organiser={organiser} teams={over.teams} />}
      {over?.is === "code" && <CodeDialog organiser={organiser} />}
      {over?.is === "move" && view && (
        <MoveDialog organiser={organiser} view={view} pairing={over.pairing} />
      )}
      {over?.is === "rule" && view && (
        <RuleDialog organiser={organiser} pairing={over.pairing} view={view} />
      )}
      {settings.value && (
        <Settings
          onClose={() => {
            settings.value = false;
          }}
        />
      )}
      <Toasts />
    </>
  );
}
