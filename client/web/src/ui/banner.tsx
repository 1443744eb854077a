/** Says across the top what the page waits for; nothing while all is well. */

import { signal, useComputed } from "@preact/signals";
import type { ComponentChildren } from "preact";
import type { SocketState } from "../core/connection";
import type { Court } from "../core/court";
import { type Notice, Phase } from "../core/wire";
import { said, t } from "../i18n";
import { endOf } from "../i18n/words";
import { useIsBefore } from "./moment";
import { tellHeight } from "./screen";

/** A sentence that says why the gateway is not there for this page; "" if it is. */
export function waitsForGateway({ open, attempt, refused }: SocketState): string {
  if (refused) return said(refused);
  if (open) return "";
  return attempt > 1 ? t("link.page", { attempt }) : t("link.connecting");
}

/** A sentence that says when the director begins; "" without one, and once it has begun. */
export function directorBegins(court: Court): string {
  const seconds = court.programme.value?.begins_s ?? 0;
  return seconds > 0 ? t("director.begins", { seconds }) : "";
}

/** A sentence that says what the page waits for; "" if it waits for nothing. */
export function waitsFor(court: Court): string {
  return waitsForGateway(court.reached.value) || directorBegins(court) || troubleOf(court);
}

/** A sentence that says what is wrong with the court that is shown; "" if nothing is. */
function troubleOf(court: Court): string {
  const link = court.link.value;
  if (!link && court.delayMs > 0) return t("link.late", { seconds: court.delayMs / 1000 });
  if (link && !link.connected) {
    const seconds = Math.round(link.silent_s);
    const waits =
      seconds > 0 && court.begun.value
        ? t("link.court", { court: link.court, seconds })
        : t("link.noCourt", { court: link.court });
    return link.why ? `${waits} ${said(link.why)}` : waits;
  }
  return court.begun.value && !court.live.value ? t("link.stale") : "";
}

/** True if the last thing shown is the end of a match: then nothing is missing. */
export function isOver(court: Court): boolean {
  const phase = court.frame.value?.phase;
  return phase === Phase.OFFICIAL || phase === Phase.VOID;
}

/** Let the page know how high the banner is: on a phone its text takes several lines. */
const makeRoom = (banner: HTMLElement | null) => tellHeight("--banner", banner);

interface Props {
  role?: "status" | "alert";
  calm?: boolean;
  children: ComponentChildren;
}

/** A line across the top, for which the page below makes room. */
export function Banner({ role = "status", calm = false, children }: Props) {
  return (
    <div class={calm ? "banner calm" : "banner"} role={role} ref={makeRoom}>
      {children}
    </div>
  );
}

/** The parts of the notice that this reader has put away. */
const seen = signal<readonly string[]>([]);

/** What the notice says: the line to all, and whether games are called. */
function noticeParts({ text, paused, until_ms, reason }: Notice, nowMs: number): string[] {
  const held = paused || until_ms > nowMs;
  const why = reason && held ? t("notice.reason", { reason }) : "";
  const day = paused
    ? t("notice.paused")
    : held
      ? t("notice.until", { time: endOf(until_ms) })
      : "";
  return [text, day && day + why].filter(Boolean);
}

/** The notice as one text; "" if there is none. */
export function noticeText(notice: Notice, nowMs: number): string {
  return noticeParts(notice, nowMs).join(" · ");
}

/** The notice across the top; whoever has read it can put it away. */
export function NoticeBanner({ notice }: { notice: Notice | null }) {
  useIsBefore(notice?.until_ms ?? 0);
  const parts = notice ? noticeParts(notice, Date.now()) : [];
  const news = parts.filter((part) => !seen.value.includes(part));
  if (!news.length) return null;
  return (
    <Banner calm>
      {news.join(" · ")}
      <button
        class="button small"
        type="button"
        onClick={() => {
          seen.value = parts;
        }}
      >
        {t("notice.seen")}
      </button>
    </Banner>
  );
}

interface LinkProps {
  court: Court;
  /** Whether the reader's matches are over, so that a court that is away is nobody's trouble. */
  done?: boolean;
}

export function LinkBanner({ court, done = false }: LinkProps) {
  const over = useComputed(() => isOver(court)).value || done;
  if (court.outdated.value) {
    return (
      <Banner role="alert">
        {t("link.outdated")}
        <button class="button" type="button" onClick={() => location.reload()}>
          {t("link.reload")}
        </button>
      </Banner>
    );
  }
  // That the director has not begun yet is no trouble: the page says it more calmly.
  const text = waitsForGateway(court.reached.value) || troubleOf(court);
  if (!text) return <NoticeBanner notice={court.notice.value} />;
  return over ? <Banner calm>{t("link.over")}</Banner> : <Banner>{text}</Banner>;
}
