/** The page where a gait is designed, and tried (workshop 3-2, 4-1, 4-2). */

import { type Signal, signal, useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useMemo, useRef } from "preact/hooks";
import { hasGiven } from "../core/given";
import { said, t } from "../i18n";
import { Banner, waitsForGateway } from "../ui/banner";
import { Dropping, useDrop } from "../ui/drop";
import { KeyHelp, type KeyRow } from "../ui/key_help";
import { isNarrow } from "../ui/screen";
import { Settings } from "../ui/settings";
import { Toasts, toast } from "../ui/toasts";
import "./design/design.css";
import { Forgotten } from "./design/class/forgotten";
import { Join } from "./design/class/join";
import { Offer } from "./design/class/offer";
import { ConflictDialog, TroubleDialog } from "./design/files/conflict";
import { FilesDialog, takeFiles } from "./design/files/dialog";
import { Head } from "./design/head/head";
import { LegPicture } from "./design/robot/legs";
import { ShareDialog } from "./design/share/dialog";
import { PeopleHere } from "./design/sharing/people_here";
import { Proposals } from "./design/sharing/proposals";
import { Side, type Tab } from "./design/side";
import { Studio } from "./design/studio";
import { Grid } from "./design/table/grid";
import { Strip } from "./design/table/strip";
import { Keys } from "./design/trials/keys";
import { Bars } from "./design/walk/bars";
import { Stage } from "./design/walk/stage";

declare global {
  interface Window {
    /** What tests look at. */
    __studio?: Studio;
  }
}

const dragging = signal(false);

export default function Design() {
  const studio = useMemo(() => new Studio(), []);
  const { sheet, trials, showing, coach, files, robot, gateway, membership, people, group } =
    studio;
  const open = useSignal<"" | "files" | "settings" | "share">("");
  const tab = useSignal<Tab>("phase");
  window.__studio = studio;
  const close = () => {
    open.value = "";
  };
  const overlay = useMemo(
    () => ({ marks: coach.marks, target: trials.target, people: people.places, group }),
    [coach, trials, people, group],
  );
  useQuestion(studio, tab);
  useKeys(studio);
  useDrop(dragging, (taken) => void takeFiles(files, taken));
  useLinks(studio);
  useLeaving(studio);
  const name = membership.name.value || files.file.value.name || t("design.unnamed");
  useEffect(() => {
    document.title = `${name} – LACOC`;
  }, [name]);
  const door = membership.door.value;
  const settings = open.value === "settings" && <Settings onClose={close} />;
  if (door) {
    return (
      <>
        <Join
          door={door}
          membership={membership}
          gateway={gateway}
          onSettings={() => {
            open.value = "settings";
          }}
        />
        {settings}
      </>
    );
  }
  return (
    <main class="design">
      <Waiting studio={studio} />
      <Head
        studio={studio}
        onFiles={() => {
          open.value = "files";
        }}
        onPhase={() => {
          tab.value = "phase";
          // Where all stands below one another, the task would be out of sight.
          const show = () => document.getElementById("panel-phase")?.scrollIntoView();
          if (isNarrow.peek()) requestAnimationFrame(() => requestAnimationFrame(show));
        }}
        onSettings={() => {
          open.value = "settings";
        }}
      />
      <div class="left">
        <Keys sheet={sheet} onChoose={(key) => trials.press(key)} />
        <LegPicture robot={robot.robot.value} sheet={sheet} />
      </div>
      <Stage
        picture={studio.picture}
        robot={robot.robot}
        sheet={sheet}
        showing={showing}
        onDrawn={studio.shots.drawn}
      />
      <section class="sheet" aria-label={t("design.grid")}>
        <PeopleHere people={people} group={studio.group} sheet={sheet} />
        <Proposals group={studio.group} sheet={sheet} />
        <Grid
          sheet={sheet}
          overlay={overlay}
          parse={(name, data) => void files.parse(name, data)}
        />
        <Strip sheet={sheet} />
      </section>
      <Bars sheet={sheet} showing={showing} />
      <Side
        studio={studio}
        tab={tab}
        onShare={() => {
          open.value = "share";
        }}
      />
      {open.value === "files" && (
        <FilesDialog
          files={files}
          robot={robot}
          sheet={sheet}
          can={studio.can.value}
          membership={membership}
          handed={studio.handed}
          court={studio.court}
          onClose={close}
        />
      )}
      {open.value === "share" && <ShareDialog studio={studio} onClose={close} />}
      {settings}
      <Forgotten membership={membership} />
      <ConflictDialog files={files} />
      <TroubleDialog gateway={gateway} robot={robot} sheet={sheet} />
      <Dropping dragging={dragging}>{t("design.drop")}</Dropping>
      <KeyHelp rows={keyRows} />
      <Toasts />
    </main>
  );
}

/** What the page waits for, or else what the teacher has handed out. */
function Waiting({ studio }: { studio: Studio }) {
  const why = studio.why.value;
  const noStudio = why ? said(why) : t("design.noStudio");
  const waitsFor = studio.opening.waitsFor.value;
  const text =
    waitsForGateway(studio.gateway.state.value) ||
    (studio.present.value === false && noStudio) ||
    (waitsFor && said(waitsFor));
  if (text) return <Banner>{text}</Banner>;
  return studio.sheet.table.value && <Offered studio={studio} />;
}

/** A gait that the teacher or a friend offers. */
function Offered({ studio: { handed, friend } }: { studio: Studio }) {
  const [table, gait] = [handed.offered.value, friend.offered.value];
  if (gait) {
    return (
      <Offer
        text={t("design.friend", { name: gait.gait.name })}
        onTake={() => void friend.take(gait)}
        onLater={() => friend.putOff()}
      />
    );
  }
  if (!table) return null;
  return (
    <Offer
      text={t("design.handed", { title: table.title })}
      onTake={() => handed.take(table)}
      onLater={() => handed.putOff(table)}
    />
  );
}

function keyRows(): readonly KeyRow[] {
  return [
    [["Ctrl+Enter"], t("design.keyTry")],
    [["Ctrl+S"], t("design.keySave")],
    [["Ctrl+Z"], t("design.keyUndo")],
    [["Ctrl+Y", "Ctrl+Shift+Z"], t("design.keyRedo")],
  ];
}

/** Take the number that is being typed, as when its field is left; the focus stays there. */
function settle(): void {
  const field = document.activeElement;
  if (!(field instanceof HTMLInputElement)) return;
  field.blur();
  field.focus({ preventScroll: true });
}

/** Keys that work wherever the focus is. */
function useKeys({ sheet, files, trials, learning, membership }: Studio): void {
  useEffect(() => {
    const press = (event: KeyboardEvent) => {
      if (event.isComposing || !(event.ctrlKey || event.metaKey) || event.altKey) return;
      if (document.querySelector("dialog[open]")) return;
      const key = event.key.toLowerCase();
      // A field other than the grid's has an undo of its own while something is typed there.
      const isField = (event.target as HTMLElement).matches(
        "input:not(.cell-input, [type=range], [type=checkbox], [type=radio], [data-kept])",
      );
      const takesTyped = key === "enter" || key === "s";
      if (takesTyped && event.repeat) return event.preventDefault();
      if (takesTyped) settle();
      if (key === "enter") void trials.tryIt();
      else if (key === "s" && membership.name.peek()) {
        const trouble = learning.phases.peek()?.trouble;
        toast(() => (trouble ? said(trouble) : t("design.class.kept")));
      } else if (key === "s") void files.keep();
      else if (key === "z" && !isField) event.shiftKey ? sheet.redo() : sheet.undo();
      else if (key === "y" && !isField) sheet.redo();
      else return;
      event.preventDefault();
    };
    addEventListener("keydown", press);
    return () => removeEventListener("keydown", press);
  }, [sheet, files, trials, membership]);
}

/** A new question of a phase does not hide behind another tab. */
function useQuestion({ learning, can }: Studio, tab: Signal<Tab>): void {
  const shown = useRef("");
  useSignalEffect(() => {
    const now = learning.phases.value;
    const asked = can.value.learn && now?.phases[now.phase]?.asked;
    const name = asked ? `${now?.phase} ${asked.name}` : "";
    if (name && name !== shown.current) tab.value = "phase";
    shown.current = name;
  });
}

/** A link with a gait is offered when the page opens with it, and when it is pasted anywhere. */
function useLinks({ friend }: Studio): void {
  useEffect(() => {
    const paste = (event: ClipboardEvent) => {
      const text = event.clipboardData?.getData("text/plain") ?? "";
      if (!hasGiven(text)) return;
      event.preventDefault();
      event.stopPropagation();
      void friend.offer(text);
    };
    const look = () => friend.lookAtAddress();
    look();
    addEventListener("paste", paste, { capture: true });
    addEventListener("hashchange", look);
    return () => {
      removeEventListener("paste", paste, { capture: true });
      removeEventListener("hashchange", look);
    };
  }, [friend]);
}

/** Tell the gateway all before the page goes, and ask before a table is lost. */
function useLeaving(studio: Studio): void {
  const { sheet, files, robot, learning, sharing, gateway, membership } = studio;
  useEffect(() => {
    const leave = (event: BeforeUnloadEvent) => {
      if (membership.isForgotten.peek()) return;
      const isKept = membership.name.peek()
        ? gateway.state.peek().open || (sharing.isKept.peek() && learning.isTold.peek())
        : files.isSaved.peek() && robot.isSaved.peek();
      if (!isKept || sheet.draft.peek() !== null) event.preventDefault();
    };
    // A tablet ends a page that is out of sight without another word.
    const tell = () => learning.tell();
    addEventListener("beforeunload", leave);
    addEventListener("pagehide", tell);
    document.addEventListener("visibilitychange", tell);
    return () => {
      removeEventListener("beforeunload", leave);
      removeEventListener("pagehide", tell);
      document.removeEventListener("visibilitychange", tell);
    };
  }, [sheet, files, robot, learning, sharing, gateway, membership]);
}
