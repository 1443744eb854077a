/** The link to the recording of a match that is over, and its odds, when the gateway has them. */

import { useSignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import { type Match, phaseOf } from "../core/match";
import type { Odds } from "../core/odds";
import { listed, oddsOf, replayAddress } from "../core/record_files";
import { BEATS_PER_S, Phase } from "../core/wire";
import { t } from "../i18n";
import { OddsCurve } from "./odds";

const FIRST_MS = 700;
const MOST_MS = 30_000;

/** How long before a moment the replay of it begins [s]. */
const BEFORE_S = 4;

interface Props {
  match: Match;
  /** The moment to which it leads; without it, it leads to the whole match and its odds. */
  beat?: number;
}

export function ReplayLink({ match, beat }: Props) {
  const phase = useMemo(() => phaseOf(match), [match]).value;
  const isOver = phase === Phase.OFFICIAL || phase === Phase.VOID;
  const id = match.sheet.value?.match_id ?? "";
  const file = useSignal("");
  const odds = useSignal<Odds | null>(null);
  useEffect(() => {
    file.value = "";
    odds.value = null;
    if (!isOver || !id) return;
    let timer = 0;
    let waitMs = FIRST_MS;
    const look = async () => {
      const name = `${id}.mcap`;
      if (!file.value) {
        const list = await listed().catch(() => []);
        if (timer < 0) return;
        file.value = list.find((one) => one.name === name)?.name ?? "";
      }
      if (file.value) {
        const found = await oddsOf(name, id).catch(() => null);
        if (timer < 0) return;
        odds.value = found;
        if (found) return;
      }
      // Hundreds of pages may wait for one file. Odds are computed later, if at all.
      waitMs = file.value ? MOST_MS : Math.min(MOST_MS, 2 * waitMs);
      timer = window.setTimeout(look, waitMs);
    };
    timer = window.setTimeout(look, FIRST_MS * (1 + Math.random()));
    return () => {
      clearTimeout(timer);
      timer = -1;
    };
  }, [file, odds, isOver, id]);
  if (!file.value) return null;
  if (beat !== undefined) {
    const from_s = Math.max(0, beat / BEATS_PER_S - BEFORE_S).toFixed(1);
    return <a href={`${replayAddress(file.value)}&t=${from_s}`}>{t("result.seeIt")}</a>;
  }
  const moments = odds.value?.moments;
  return (
    <>
      {odds.value && moments && (
        <span class="odds-after">
          <OddsCurve odds={odds.value} first={moments[0]!.beat} last={moments.at(-1)!.beat} />
        </span>
      )}
      <a class="button strong" href={replayAddress(file.value)}>
        {t("result.replay")}
      </a>
    </>
  );
}
