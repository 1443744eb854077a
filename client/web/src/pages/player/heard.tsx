/** What a screen reader says of a match: the time, the score, what happens. Nobody sees it. */

import { signal, useSignalEffect } from "@preact/signals";
import { useMemo, useRef } from "preact/hooks";
import type { Court } from "../../core/court";
import { part, scoresOf } from "../../core/match";
import type { Player } from "../../core/player";
import type { TryOut } from "../../core/try_out";
import { BEATS_PER_S, Phase } from "../../core/wire";
import { said, t } from "../../i18n";
import { clockTicks, team } from "../../i18n/words";
import { isTold } from "./rail";
import { nextStep } from "./steps";

/** The time is told when so many seconds are left. */
const TOLD_S = [60, 30, 10];
/** The newest lines stay in the page, so that each is read to its end. */
const MOST = 4;

interface Props {
  court: Court;
  player: Player;
  alone: boolean;
  tryOut: TryOut | null;
}

export function Heard(props: Props) {
  const { court } = props;
  const lines = useMemo(() => new Lines(), []);
  useStep(props, lines);
  useEvents(court, lines);
  useScore(court, lines);
  useTime(court, lines);
  return (
    <div class="hidden-text heard" role="log" aria-live="polite" aria-label={t("heard.label")}>
      {lines.shown.value.map(({ id, text }) => (
        <p key={id}>{text}</p>
      ))}
    </div>
  );
}

class Lines {
  readonly shown = signal<readonly { id: number; text: string }[]>([]);
  private last = 0;

  tell(text: string): void {
    const before = this.shown.peek().slice(1 - MOST);
    this.shown.value = [...before, { id: ++this.last, text }];
  }
}

/** What to do next, but not where one could score: that changes with each step of the robot. */
function useStep({ court, player, alone, tryOut }: Props, lines: Lines): void {
  const before = useRef("");
  useSignalEffect(() => {
    const isPlaying = court.frame.value?.phase === Phase.PLAYING;
    const { text, tone } = nextStep(court, player, alone, tryOut?.isOpen.value);
    const now = isPlaying && tone === "do" ? "" : text;
    if (now && now !== before.current) lines.tell(now);
    before.current = now;
  });
}

function useEvents(court: Court, lines: Lines): void {
  const heard = useRef(court.events.peek().at(-1)?.number ?? 0);
  useSignalEffect(() => {
    const events = court.events.value;
    const fresh = events.filter((event) => event.number > heard.current && isTold(event));
    heard.current = events.at(-1)?.number ?? 0;
    for (const event of fresh) lines.tell(said(event.said));
  });
}

function useScore(court: Court, lines: Lines): void {
  const scores = useMemo(() => scoresOf(court), [court]);
  const before = useRef(scores.peek());
  useSignalEffect(() => {
    const now = scores.value;
    const sheet = court.sheet.peek();
    if (now !== before.current && before.current && sheet && sheet.seats.length > 1) {
      const points = now.split(" ");
      lines.tell(
        t("heard.score", {
          left: team(sheet, 0),
          right: team(sheet, 1),
          leftPoints: points[0] ?? "",
          rightPoints: points[1] ?? "",
        }),
      );
    }
    before.current = now;
  });
}

function useTime(court: Court, lines: Lines): void {
  const seconds = useMemo(
    () =>
      part(
        court,
        (frame) => {
          const sheet = court.sheet.value;
          const isOn = frame.phase === Phase.PLAYING && sheet && sheet.duration_s > 0;
          return isOn ? Math.ceil(clockTicks(frame, sheet) / BEATS_PER_S) : 0;
        },
        0,
      ),
    [court],
  );
  const before = useRef(0);
  useSignalEffect(() => {
    const now = seconds.value;
    const isPassed = TOLD_S.some((at) => now > 0 && now <= at && at < before.current);
    if (isPassed) lines.tell(t("heard.left", { seconds: now }));
    before.current = now;
  });
}
