/** The way to the recording of the match that is over, as soon as the gateway has it. */

import { useSignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import { type Match, phaseOf } from "../core/match";
import { listed, replayAddress } from "../core/record_files";
import { Phase } from "../core/wire";
import { t } from "../i18n";

const FIRST_MS = 700;
const MOST_MS = 30_000;

export function ReplayLink({ match }: { match: Match }) {
  const phase = useMemo(() => phaseOf(match), [match]).value;
  const isOver = phase === Phase.OFFICIAL || phase === Phase.VOID;
  const id = match.sheet.value?.match_id ?? "";
  const file = useSignal("");
  useEffect(() => {
    file.value = "";
    if (!isOver || !id) return;
    let timer = 0;
    let waitMs = FIRST_MS;
    const look = async () => {
      const list = await listed().catch(() => []);
      if (timer < 0) return;
      file.value = list.find(({ name }) => name === `${id}.mcap`)?.name ?? "";
      if (file.value) return;
      // Hundreds of pages may wait for one file.
      waitMs = Math.min(MOST_MS, 2 * waitMs);
      timer = window.setTimeout(look, waitMs);
    };
    timer = window.setTimeout(look, FIRST_MS * (1 + Math.random()));
    return () => {
      clearTimeout(timer);
      timer = -1;
    };
  }, [file, isOver, id]);
  if (!file.value) return null;
  return (
    <a class="button strong" href={replayAddress(file.value)}>
      {t("result.replay")}
    </a>
  );
}
