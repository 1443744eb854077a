/** The contestant's page; practice is the same page with a court of one's own. */

import { effect, useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useMemo, useRef } from "preact/hooks";
import { followColours } from "../../core/colours";
import { Court } from "../../core/court";
import { applyChange, beginChange, cancelChange, download } from "../../core/files";
import type { Pressed } from "../../core/keys";
import { phaseOf } from "../../core/match";
import type { Phrase } from "../../core/phrase";
import { Player, type Word } from "../../core/player";
import { PosData } from "../../core/posdata";
import { Team } from "../../core/team";
import { TryOut } from "../../core/try_out";
import {
  Level,
  MOST_HZ,
  Phase,
  RESTART_KEY,
  readFrame,
  SeatFlag,
  type Sheet,
  WHY_NO,
} from "../../core/wire";
import { said, sentence, t } from "../../i18n";
import { clockTicks, logClock, played, ruleOf } from "../../i18n/words";
import { LinkBanner } from "../../ui/banner";
import { Dialog } from "../../ui/dialog";
import { useDrop } from "../../ui/drop";
import { hideKeys, KeyHelp, showKeys } from "../../ui/key_help";
import { later } from "../../ui/later";
import { RulesLink } from "../../ui/rules_link";
import { Settings } from "../../ui/settings";
import { Toasts, toast } from "../../ui/toasts";
import { Entrance } from "./card";
import { Field, VIEWS, type ViewName } from "./field";
import { canChange, dragging, FilePicker, take } from "./files";
import { Footer } from "./footer";
import { Heard } from "./heard";
import { keyRows } from "./key_rows";
import { useKeyboard, useWindowFocus } from "./keyboard";
import { KeyTest } from "./keytest";
import { Leaving, LeavingBar } from "./leaving";
import { LEVEL_LETTERS } from "./pad";
import { Rail } from "./rail";
import "./player.css";

const LinkTestDialog = later(() => import("./link_test").then((it) => it.LinkTestDialog));

const POS_DATA = "Pos-data.txt";

type Open = "" | "leave" | "files" | "settings" | "linktest";

export function Cockpit({ alone }: { alone: boolean }) {
  const { court, player, team, tryOut } = useMemo(() => begin(alone), [alone]);
  const view = useSignal<ViewName>("arena");
  const open = useSignal<Open>("");
  const hasFocus = useSignal(true);
  const hasInputMethod = useSignal(false);
  const field = useRef<HTMLDivElement>(null);

  // Once a dialog is gone: nothing beneath it takes the focus before.
  const focusField = () =>
    requestAnimationFrame(() => field.current?.focus({ preventScroll: true }));
  const close = () => {
    open.value = "";
    focusField();
  };
  /** A match is on: nothing may take the keyboard from who plays it. */
  const isMatchOn = () => {
    const phase = court.frame.peek()?.phase ?? Phase.CREATED;
    return !alone && phase >= Phase.COUNTDOWN && phase <= Phase.HALTED;
  };
  const leaving = useMemo(
    () =>
      new Leaving(() => {
        saveData(player);
        player.leave();
      }),
    [player],
  );
  const sayReady = () => {
    const frame = court.frame.peek();
    const isEarly = frame && (frame.phase === Phase.LOBBY || frame.phase === Phase.READY);
    const isReady = (player.seatNow()?.flags ?? 0) & SeatFlag.READY;
    if (isEarly && !alone && !isReady) void player.ready(true);
  };
  const nextView = () => {
    view.value = VIEWS[(VIEWS.indexOf(view.peek()) + 1) % VIEWS.length]!;
  };
  const openSettings = () => {
    open.value = "settings";
  };
  const openLinkTest = () => {
    open.value = "linktest";
  };
  const press = (key: number, atMs: number) => {
    if (tryOut?.isOpen.peek()) tryOut.press(player.level.peek(), key);
    else void player.press(key, atMs);
  };
  const changeLevel = (to?: number) => {
    player.changeLevel(to);
    toast(t("toast.level", { level: LEVEL_LETTERS[player.level.peek()] ?? "" }));
  };
  const act = (pressed: Pressed, atMs: number) => {
    switch (pressed.does) {
      case "digit":
        return press(pressed.digit, atMs);
      case "arrow":
        if (player.level.peek() === Level.LOCOMOTION) return press(pressed.digit, atMs);
        return toast(t("toast.arrows"), "no");
      case "restart":
        return press(RESTART_KEY, atMs);
      case "level":
        return changeLevel();
      case "view":
        return nextView();
      case "ready":
        return sayReady();
      default:
        if (isMatchOn()) leaving.hold();
        else open.value = "leave";
    }
  };
  useWindowFocus(hasFocus);
  useEffect(() => {
    // The back button, or a closed tab, leaves the robot standing: the browser asks first.
    const ask = (event: BeforeUnloadEvent) => {
      if (player.standing.peek() === "seated" && isMatchOn()) event.preventDefault();
    };
    addEventListener("beforeunload", ask);
    return () => removeEventListener("beforeunload", ask);
  }, []);
  useKeyboard(
    field,
    {
      isOn: () => player.standing.peek() === "seated",
      hasLevels: () => (court.sheet.peek()?.levels.length ?? 0) > 1,
      act,
      leaveReleased: () => leaving.release(),
      leaveField: () =>
        document.querySelector<HTMLElement>(".rail button:not(:disabled), .foot button")?.focus(),
    },
    hasInputMethod,
  );
  // At once, before a dropped file is taken: an effect of the component would come too late.
  useEffect(
    () =>
      effect(() => {
        if (open.value !== "files") return;
        beginChange();
        return cancelChange;
      }),
    [],
  );
  useDrop(dragging, (files) => {
    const standing = player.standing.peek();
    const isSeated = standing === "seated";
    if (standing !== "outside" && !(isSeated && canChange(court))) {
      toast(t("files.notNow"), "no");
      return;
    }
    if (isSeated) open.value = "files";
    void take(files);
  });
  useAutoJoin(court, player, alone);
  useFieldFocus(court, player, field);
  const phase = useMemo(() => phaseOf(court), [court]);
  useSignalEffect(() => {
    const isBegun =
      phase.value === Phase.COUNTDOWN && !alone && player.standing.peek() === "seated";
    if (isBegun) {
      hideKeys();
      if (open.peek()) close();
    }
    if (phase.value < Phase.COUNTDOWN || phase.value > Phase.HALTED) leaving.end();
  });

  const standing = player.standing.value;
  const isIn = standing === "seated" || standing === "joining";
  const controls = {
    onKey: press,
    onLevel: (level: number) => level !== player.level.peek() && changeLevel(level),
    onView: nextView,
    onLeave: () => {
      if (isMatchOn()) leaving.show();
      else open.value = "leave";
    },
    onSave: () => saveData(player),
  };
  return (
    <main class={`player${isIn ? "" : " outside"}`} data-standing={standing}>
      <LinkBanner court={court} done={Boolean(team?.isOver.value)} />
      <Field
        {...{ court, player, alone, tryOut, view, hasFocus, hasInputMethod, field }}
        urgent={
          <>
            <LeavingBar leaving={leaving} onStay={close} />
            <Toasts inPlace />
          </>
        }
        onView={nextView}
        onSave={controls.onSave}
      />
      {isIn ? (
        <>
          {court.sheet.value && <h1 class="hidden-text">{played(court.sheet.value)}</h1>}
          <Rail {...{ court, player, alone, tryOut }} {...controls} onLinkTest={openLinkTest} />
          <Footer
            court={court}
            player={player}
            onKeys={showKeys}
            onFiles={() => {
              open.value = "files";
            }}
            onSettings={openSettings}
          />
        </>
      ) : (
        <div class="entrance-place">
          <Entrance court={court} player={player} alone={alone} team={team} />
          <div class="corner">
            {!alone && (
              <button class="button quiet small" type="button" onClick={openLinkTest}>
                {t("linktest.test")}
              </button>
            )}
            <button class="button quiet small" type="button" onClick={openSettings}>
              {t("foot.settings")}
            </button>
          </div>
        </div>
      )}
      {open.value === "leave" && <Leave {...{ court, player, alone }} onClose={close} />}
      {open.value === "files" && <Files {...{ court, player, alone }} onClose={close} />}
      {open.value === "settings" && (
        <Settings onClose={close}>
          <KeyTest />
        </Settings>
      )}
      {open.value === "linktest" && <LinkTestDialog court={court} onClose={close} />}
      <KeyHelp rows={() => keyRows(court.sheet.value, alone)} onClose={focusField}>
        <p>
          {ruleOf(court.sheet.value)} <RulesLink />
        </p>
      </KeyHelp>
      {isIn ? <Heard {...{ court, player, alone, tryOut }} /> : <Toasts />}
    </main>
  );
}

function begin(alone: boolean) {
  const court = new Court(MOST_HZ);
  followColours(court);
  const player = new Player(court, speak, alone);
  window.__lacoc = Object.assign(window.__lacoc ?? {}, { posData });
  const say = (why: Phrase) => toast(() => sentence(why), "no");
  return alone
    ? { court, player, team: null, tryOut: null }
    : { court, player, team: new Team(court, player), tryOut: new TryOut(court, player, say) };
}

/** For tests: Pos-data.txt of any frames, and what the page says of it. */
function posData(seat: number, joints: number[], frames: Uint8Array[], most: number) {
  const data = new PosData(seat, joints, most);
  for (const frame of frames) data.add(readFrame(frame));
  const [says, saysInPractice] = [false, true].map((alone) => aboutData(data, alone, null));
  return { text: data.parts().join(""), says, saysInPractice };
}

function speak(word: Word): void {
  if ("said" in word) {
    toast(() => said(word.said), word.tone);
    return;
  }
  const why = sentence({ code: WHY_NO[word.refused] ?? "key.refused" });
  const key = word.key === RESTART_KEY ? "x" : String(word.key);
  toast(t("toast.refused", { key, why }), "no");
}

/** True if there was something to save. */
function saveData(player: Player): boolean {
  const { data } = player;
  if (!data?.length) return false;
  download(POS_DATA, data.parts());
  toast(t("leave.saved"), "yes");
  return true;
}

/** `lacoc practice` has said everything already: the first thing to see is the robot. */
function useAutoJoin(court: Court, player: Player, alone: boolean): void {
  const tried = useRef(false);
  useSignalEffect(() => {
    const welcome = court.welcome.value;
    const prefill = welcome?.prefill;
    if (!alone || tried.current || !welcome?.court || !prefill?.has_token) return;
    if (player.standing.value !== "outside" || player.isWaiting.value) return;
    tried.current = true;
    const { seat, name } = prefill;
    player.join({ court: welcome.court, seat, token: null, name: name || t("join.practice") });
  });
}

/** The field takes the focus when a seat is taken and when play begins, unless somebody types. */
function useFieldFocus(
  court: Court,
  player: Player,
  field: { current: HTMLDivElement | null },
): void {
  const moment = useSignal("");
  useSignalEffect(() => {
    const phase = court.frame.value?.phase ?? 0;
    const isOn = phase >= Phase.COUNTDOWN && phase <= Phase.PLAYING;
    moment.value = `${player.standing.value} ${isOn}`;
  });
  useEffect(
    () =>
      moment.subscribe(() => {
        requestAnimationFrame(() => {
          const isBusy = document.querySelector("dialog[open]");
          if (player.standing.peek() === "seated" && !isBusy) {
            field.current?.focus({ preventScroll: true });
          }
        });
      }),
    [moment, player, field],
  );
}

interface DialogProps {
  court: Court;
  player: Player;
  alone: boolean;
  onClose: () => void;
}

function Leave({ court, player, alone, onClose }: DialogProps) {
  const phase = court.frame.peek()?.phase ?? Phase.LOBBY;
  const hasData = Boolean(player.data?.length);
  const inMatch = phase > Phase.READY && phase < Phase.OFFICIAL;
  const leave = () => {
    saveData(player);
    onClose();
    player.leave();
  };
  return (
    <Dialog title={t("leave.title")} onClose={onClose}>
      <p>{t(alone ? "leave.practice" : inMatch ? "leave.match" : "leave.lobby")}</p>
      <p class="muted">{aboutData(player.data, alone, court.sheet.value)}</p>
      <div class="row end">
        <button class="button" type="button" onClick={onClose}>
          {t("common.cancel")}
        </button>
        {hasData && (
          <button
            class="button"
            type="button"
            onClick={() => {
              saveData(player);
              onClose();
            }}
          >
            {t("leave.save")}
          </button>
        )}
        <button class="button strong" type="button" autofocus onClick={leave}>
          {t(hasData ? "leave.go" : "leave.goNoData")}
        </button>
      </div>
    </Dialog>
  );
}

/** What Pos-data.txt has: all, or from when on and why. */
function aboutData(data: PosData | null, alone: boolean, sheet: Sheet | null): string {
  if (!data?.length) return t("leave.noData");
  const since = { clock_ticks: data.sinceTicks };
  const time = logClock(sheet ? clockTicks(since, sheet) : data.sinceTicks);
  if (data.isCut) return t("leave.dataNewest", { time });
  if (!data.sinceTicks) return t("leave.data");
  const text = t("leave.dataSince", { time });
  // Practice keeps a record only where that was asked for.
  return alone ? text : `${text} ${t("leave.dataRecord")}`;
}

function Files({ court, player, alone, onClose }: DialogProps) {
  return (
    <Dialog title={t("files.title")} onClose={onClose}>
      <div class="files-dialog">
        {!alone && <p class="muted">{t("files.changeText")}</p>}
        <FilePicker court={court} alone={alone} />
        <div class="row end">
          <button class="button" type="button" onClick={onClose}>
            {t("common.cancel")}
          </button>
          <button
            class="button strong"
            type="button"
            onClick={() => {
              applyChange();
              onClose();
              player.rejoin();
            }}
          >
            {t("files.use")}
          </button>
        </div>
      </div>
    </Dialog>
  );
}
