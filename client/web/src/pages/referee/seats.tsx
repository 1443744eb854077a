/** Each contestant: link, key, ready state, and the decisions about their robot. */

import { useMemo } from "preact/hooks";
import { part } from "../../core/match";
import {
  type Frame,
  Phase,
  SeatFlag,
  type SeatHealth,
  type Sheet,
  SILENT_AFTER_S,
} from "../../core/wire";
import { said, t } from "../../i18n";
import { seatName, seatState, team } from "../../i18n/words";
import { SeatMark } from "../../ui/score";
import { TeamName } from "../../ui/team_name";
import { Act } from "./act";
import type { Desk } from "./desk";
import * as drafts from "./drafts";
import { Verdict, type VerdictName } from "./health";

const GOOD_MS = 350;
/** From here on the court lets the robot stand. */
const SILENT_MS = 1000 * SILENT_AFTER_S;

export function Seats({ desk }: { desk: Desk }) {
  const sheet = desk.court.sheet.value;
  return (
    <div class="seats">
      {sheet?.seats.map((seat, index) => (
        <SeatCard key={seat.id} desk={desk} sheet={sheet} index={index} />
      ))}
    </div>
  );
}

interface Props {
  desk: Desk;
  sheet: Sheet;
  index: number;
}

function SeatCard({ desk, sheet, index }: Props) {
  const { court } = desk;
  const state = useMemo(() => {
    return part(court, (frame) => seatState(frame, index), "");
  }, [court, index]).value;
  const side = seatName(sheet.seats[index]?.id ?? "");
  return (
    <section class="card seat" data-seat={index} aria-label={t("referee.seat", { seat: side })}>
      <header>
        <SeatMark sheet={sheet} index={index} />
        <h2>
          <TeamName name={team(sheet, index)} />
        </h2>
        {state && <span class="seat-state">{state}</span>}
      </header>
      <LinkFacts desk={desk} sheet={sheet} index={index} />
      <RobotActs desk={desk} seat={index} />
    </section>
  );
}

/** The decisions about one robot, also in the popover of the field. */
export function RobotActs({ desk, seat, then }: { desk: Desk; seat: number; then?: () => void }) {
  const { court } = desk;
  const id = court.sheet.value?.seats[seat]?.id ?? "";
  const ask = (draft: drafts.Draft) => {
    then?.();
    desk.draft.value = draft;
  };
  return (
    <div class="acts">
      <Act
        why={desk.whyNotFor("ready", seat)}
        onAct={() => {
          then?.();
          desk.decide({ type: "ready", seat: id }, "");
        }}
      >
        {t("decide.ready")}
      </Act>
      <Act why={desk.whyNotFor("restart", seat)} onAct={() => ask(drafts.restart(court, seat))}>
        {t("decide.restart")}
      </Act>
      <Act why={desk.whyNotFor("freeze", seat)} onAct={() => ask(drafts.freeze(court, seat))}>
        {t("decide.freeze")}
      </Act>
      <Act
        why={desk.whyNotFor("unfreeze", seat)}
        onAct={() => {
          then?.();
          desk.decide({ type: "unfreeze", seat: id }, "");
        }}
      >
        {t("decide.unfreeze")}
      </Act>
      <Act why={desk.whyNotFor("adjust", seat)} onAct={() => ask(drafts.adjust(court, seat, 1))}>
        {t("decide.adjust")}
      </Act>
    </div>
  );
}

function LinkFacts({ desk, sheet, index }: Props) {
  const { court } = desk;
  const key = useMemo(
    () => part(court, (frame) => keyText(frame, sheet, index), ""),
    [court, sheet, index],
  ).value;
  const flags = desk.flags(index).value;
  const health = court.live.value ? court.health.value : null;
  const link = health?.seats[index];
  const isOver = useMemo(() => part(court, ({ phase }) => phase >= Phase.FINISHED, false), [court]);
  const verdict = linkVerdict(link, isOver.value);
  const refused = Object.entries(link?.refused ?? {});
  return (
    <dl class="facts">
      <dt>{t("seatLink.title")}</dt>
      <dd>
        <Verdict name={verdict} text={t(`seatLink.${linkWord(verdict, link)}`)} />
        {link?.joined && verdict !== "unknown" && (
          <span class="muted">
            {link.heard_ms === null
              ? t("seatLink.notHeard")
              : t("seatLink.heard", { ms: Math.round(link.heard_ms) })}
            {" · "}
            {t("seatLink.rate", { hz: Math.round(link.commands_hz) })}
          </span>
        )}
      </dd>
      <dt>{t("seatLink.trip")}</dt>
      <dd data-trip>{link?.joined ? tripText(link) : "–"}</dd>
      {!!health?.input_delay_ms && (
        <>
          <dt>{t("seatLink.equal")}</dt>
          <dd data-equal>
            {t("seatLink.ms", { ms: health.input_delay_ms })}
            <span class="muted">{t("seatLink.late", { count: link?.late ?? 0 })}</span>
          </dd>
        </>
      )}
      <dt>{t("seatLink.key")}</dt>
      <dd>{key || "–"}</dd>
      <dt>{t("seatLink.ready")}</dt>
      <dd>{flags & SeatFlag.READY ? `✓ ${t("seatLink.yes")}` : t("seatLink.no")}</dd>
      <dt>{t("seatLink.refused")}</dt>
      <dd>
        {refused.length
          ? refused
              .map(([why, count]) => `${count} × ${said({ code: `count.${why}` })}`)
              .join(said({ code: "join.comma" }))
          : t("seatLink.nothingRefused")}
      </dd>
    </dl>
  );
}

function linkVerdict(link: SeatHealth | undefined, isOver: boolean): VerdictName {
  if (!link?.joined) return "unknown";
  if (isOver && (link.heard_ms ?? SILENT_MS) >= SILENT_MS) return "unknown"; // it has gone: no news
  if (link.heard_ms === null || link.heard_ms >= SILENT_MS) return "bad";
  return link.heard_ms < GOOD_MS ? "good" : "watch";
}

function linkWord(
  verdict: VerdictName,
  link: SeatHealth | undefined,
): "good" | "watch" | "bad" | "none" | "unknown" {
  if (verdict !== "unknown") return verdict;
  return link ? "none" : "unknown";
}

function tripText(link: SeatHealth): string {
  const { round_trip_p50_ms: p50, round_trip_p95_ms: p95 } = link;
  if (p50 === null || p95 === null) return "–";
  return t("seatLink.tripMs", { p50: Math.round(p50), p95: Math.round(p95) });
}

/** What a robot does: "B 2 · posture 1/4"; "" before it is on the field. */
function keyText(frame: Frame, sheet: Sheet, index: number): string {
  const seat = frame.seats[index];
  if (!seat || !frame.poses.length) return "";
  const key = `${"AB"[seat.level]} ${seat.key}`;
  const of = sheet.seats[index]?.postures[seat.key] ?? 0;
  if (seat.level !== 1 || of < 2) return key;
  return `${key} · ${t("seatLink.posture", { at: seat.posture + 1, of })}`;
}
