/** The note on a fork, and the names of fork and origin when both are shown. */

import type { ReadonlySignal } from "@preact/signals";
import { useMemo } from "preact/hooks";
import { ownPage } from "../../core/address";
import { how } from "../../core/forks";
import { type Match, scoresOf } from "../../core/match";
import type { Recording } from "../../core/recording";
import { said, t } from "../../i18n";
import { logClock } from "../../i18n/words";

interface Props {
  recording: Recording;
  /** The origin, while it is shown. */
  beside: ReadonlySignal<Recording | null>;
  /** Name of the recording at the gateway; null: it is from this machine. */
  server: string | null;
  /** Shows the origin, or puts it away; absent where it can't be got. */
  onBeside?: () => void;
}

/** A note that the recording is a fork; nothing for other recordings. */
export function ForkNote({ recording, beside, server, onBeside }: Props) {
  const { origin } = recording.record.header.setup;
  if (!origin) return null;
  return (
    <div class="notes fork-note" role="note">
      <p>
        {t("replay.fork", {
          match: origin.match_id,
          time: logClock(origin.beat - recording.firstBeat),
        })}
        {how(origin.changes)?.map((change) => (
          <span class="change" key={change.code + change.values?.seat}>
            {said(change)}
          </span>
        ))}
      </p>
      {onBeside && (
        <button
          class="button quiet"
          type="button"
          aria-pressed={beside.value !== null}
          onClick={onBeside}
        >
          {t(beside.value ? "replay.alone" : "replay.beside")}
        </button>
      )}
      {server !== null && !ownPage && (
        <a class="button quiet" href={`recordings/${encodeURIComponent(server)}`} download={server}>
          {t("replay.save")}
        </a>
      )}
    </div>
  );
}

/** Says whether a picture shows the fork or its origin, and the score there. */
export function LineScore({ name, match }: { name: string; match: Match }) {
  const scores = useMemo(() => scoresOf(match), [match]).value;
  return (
    <p class="line-score">
      {name} <b>{scores?.split(" ").join(" : ")}</b>
    </p>
  );
}
