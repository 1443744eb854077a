/** The keys as buttons: which do something, what, and which one stands. */

import { useComputed } from "@preact/signals";
import { useMemo } from "preact/hooks";
import type { Court } from "../../core/court";
import { ARROWS } from "../../core/keys";
import type { Player } from "../../core/player";
import type { TryOut } from "../../core/try_out";
import { Level, Phase, RESTART_KEY, SeatFlag } from "../../core/wire";
import { said, t } from "../../i18n";
import { BEATS_PER_S } from "../../i18n/words";
import { Kbd } from "../../ui/kbd";

export const LEVEL_LETTERS = ["A", "B"] as const;

const DIGITS = [1, 2, 3, 4, 5, 6, 7, 8, 9] as const;
const GLYPHS: Record<string, string> = {
  ArrowUp: "↑",
  ArrowLeft: "←",
  ArrowRight: "→",
  ArrowDown: "↓",
};
/** The arrow that stands for a digit of level B. */
export const ARROW_OF = new Map(
  Object.entries(ARROWS).map(([code, digit]) => [digit, GLYPHS[code]]),
);

interface Props {
  court: Court;
  player: Player;
  tryOut: TryOut | null;
  /** A key that is shown as the next one. */
  hinted: number | null;
  onKey: (key: number, atMs: number) => void;
  onLevel: (level: number) => void;
  onView: () => void;
  onLeave: () => void;
}

export function Pad(props: Props) {
  const { court, player, tryOut, onView, onLeave } = props;
  const played = useStanding(player);
  const standing = tryOut?.standing.value ?? played;
  const isOn = useComputed(
    () => court.frame.value?.phase === Phase.PLAYING || tryOut?.isOpen.value,
  ).value;
  const canSteer = player.canSteer.value;
  return (
    <section
      class={`pad${canSteer ? "" : " off"}${isOn ? "" : " rests"}`}
      aria-label={t("pad.title")}
    >
      <LevelSwitch {...props} />
      <div class="keys">
        {DIGITS.map((digit) => (
          <Digit key={digit} {...props} digit={digit} standing={standing} />
        ))}
        <Restart {...props} />
        <Digit {...props} digit={0} standing={standing} />
        <button class="key other" type="button" {...pressing(onView)}>
          <Kbd>Space</Kbd>
          <small>{t("pad.view")}</small>
        </button>
      </div>
      <div class="under">
        <StandingLine standing={standing} />
        <button class="button quiet leave" type="button" onClick={onLeave}>
          <Kbd>z</Kbd> {t("pad.leave")}
        </button>
      </div>
    </section>
  );
}

/** The command that stands. */
interface Standing {
  level: number;
  key: number;
  posture: number;
  /** Postures of the key; 0: not known. */
  count: number;
  begun: boolean;
}

function useStanding(player: Player): Standing {
  const text = useMemo(
    () =>
      player.part(
        (seat) => [seat.level, seat.key, seat.posture, seat.applied_seq ? 1 : 0].join(" "),
        "",
      ),
    [player],
  ).value;
  const [level = 0, key = 0, posture = 0, begun = 0] = text.split(" ").map(Number);
  const counts = player.court.sheet.value?.seats[player.index.value]?.postures ?? [];
  const count = level === Level.LOCOMOTION ? (counts[key] ?? 1) : 1;
  return { level, key, posture, count, begun: begun > 0 };
}

function StandingLine({ standing }: { standing: Standing }) {
  const { level, key, posture, count, begun } = standing;
  const letter = LEVEL_LETTERS[level] ?? "";
  const text = !begun
    ? t("pad.none")
    : count > 1
      ? t("pad.stands", { level: letter, key, posture: posture + 1, count })
      : count
        ? t("pad.standsOne", { level: letter, key })
        : `${letter} ${key}`;
  return <p class="stands">{text}</p>;
}

function LevelSwitch({ court, player, onLevel }: Props) {
  const levels = court.sheet.value?.levels ?? [];
  const now = player.level.value;
  if (levels.length < 2) {
    return <p class="one-level">{t(levels[0] === Level.POSTURE ? "pad.onlyA" : "pad.onlyB")}</p>;
  }
  return (
    <fieldset class="levels" title={t("pad.tab")}>
      <legend class="hidden-text">{t("pad.level")}</legend>
      {levels.map((level) => (
        <button
          key={level}
          type="button"
          class={level === now ? "on" : ""}
          aria-pressed={level === now}
          {...pressing(() => onLevel(level))}
        >
          {t(level === Level.POSTURE ? "pad.levelA" : "pad.levelB")}
        </button>
      ))}
      <Kbd>Tab</Kbd>
    </fieldset>
  );
}

interface DigitProps extends Props {
  digit: number;
  standing: Standing;
}

function Digit({ court, player, digit, standing, hinted, onKey }: DigitProps) {
  const seat = court.sheet.value?.seats[player.index.value];
  const level = player.level.value;
  const does = Boolean(seat?.keys[level as 0 | 1]?.includes(digit));
  const count = seat?.postures[digit] ?? 0;
  const isB = level === Level.LOCOMOTION;
  const move = useMove(player, digit).value;
  const what = !does
    ? t("pad.nothing")
    : !isB
      ? t("pad.posture")
      : move
        ? said({ code: `move.${move}` })
        : count === 1
          ? t("pad.one")
          : t("pad.many", { count });
  const stands = standing.begun && standing.level === level && standing.key === digit;
  const part = stands && standing.count > 1 ? (standing.posture + 1) / standing.count : 0;
  const classes = ["key", does ? "does" : "none", stands && "on", hinted === digit && "hinted"];
  const arrow = isB && does ? ARROW_OF.get(digit) : undefined;
  return (
    <button
      type="button"
      class={classes.filter(Boolean).join(" ")}
      data-key={digit}
      aria-pressed={stands}
      aria-disabled={!does}
      aria-label={t("pad.key", { digit, what })}
      {...pressing((atMs) => onKey(digit, atMs))}
    >
      <b>{digit}</b>
      {arrow && <i aria-hidden="true">{arrow}</i>}
      <small>{does ? what : "–"}</small>
      {part > 0 && <span class="part" style={{ width: `${part * 100}%` }} />}
    </button>
  );
}

/** What a key of level B does, as the court tried it; "" while that is not known. */
function useMove({ moves }: Player, digit: number) {
  return useComputed(() => moves.value[digit] ?? "");
}

function Restart({ player, onKey }: Props) {
  const seconds = useMemo(
    () =>
      player.part(
        (seat) => (seat.flags & SeatFlag.FROZEN ? 0 : Math.ceil(seat.locked_ticks / BEATS_PER_S)),
        0,
      ),
    [player],
  ).value;
  return (
    <button
      class="key other restart"
      type="button"
      aria-disabled={seconds > 0}
      {...pressing((atMs) => onKey(RESTART_KEY, atMs))}
    >
      <Kbd>x</Kbd>
      <small>{seconds ? t("pad.restartIn", { seconds }) : t("pad.restart")}</small>
    </button>
  );
}

/**
 * A button that acts when it is touched, not when it is let go, and leaves the focus on the field:
 * a key of the pad must not take the next keystroke. `click` without a pointer comes from the
 * keyboard or from a screen reader.
 */
export function pressing(act: (atMs: number) => void) {
  return {
    onPointerDown: (event: PointerEvent) => {
      if (event.button !== 0) return;
      event.preventDefault();
      act(event.timeStamp);
    },
    onMouseDown: (event: MouseEvent) => event.preventDefault(),
    onClick: (event: MouseEvent) => {
      if (event.detail === 0) act(event.timeStamp);
    },
  };
}
