/** The dialog that goes on with a recording from the beat that is shown. */

import { useSignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import { botsFor, fork } from "../../core/forks";
import type { Recording } from "../../core/recording";
import { canGo, goneEvents } from "../../core/rulings";
import { type Event, RECORDED } from "../../core/wire";
import { language, said, t } from "../../i18n";
import { eventClock, logClock, team } from "../../i18n/words";
import { Dialog } from "../../ui/dialog";

const EVENTS_MOST = 200;

interface Props {
  recording: Recording;
  /** Name of the recording at the gateway. */
  name: string;
  /** First beat that may differ. */
  beat: number;
  onMade: (name: string) => void;
  onClose: () => void;
}

export function ForkHere({ recording, name, beat, onMade, onClose }: Props) {
  const sheet = recording.sheet.value;
  const seats = sheet?.seats ?? [];
  const bots = useSignal<readonly string[]>([]);
  const players = useSignal<readonly string[]>(seats.map(() => RECORDED));
  const restart = useSignal<readonly string[]>([]);
  const event = useSignal<number | null>(null);
  const busy = useSignal(false);
  const refused = useSignal("");
  const waiting = useMemo(() => new AbortController(), []);
  useEffect(() => () => waiting.abort(), [waiting]);
  useEffect(() => {
    botsFor(name, language.peek()).then(
      (found) => {
        bots.value = found;
      },
      (error: Error) => {
        refused.value = error.message;
      },
    );
  }, [name, bots, refused]);
  const isSame =
    event.value === null && !restart.value.length && players.value.every((one) => one === RECORDED);
  const play = async () => {
    if (isSame || busy.value) return;
    busy.value = true;
    refused.value = "";
    const asked = {
      beat,
      take_back: event.value,
      restart: [...restart.value],
      players: [...players.value],
    };
    try {
      onMade(await fork(name, asked, language.peek(), waiting.signal));
    } catch (error) {
      refused.value = error instanceof Error ? error.message : String(error);
    } finally {
      busy.value = false;
    }
  };
  return (
    <Dialog title={t("fork.title")} onClose={onClose}>
      <form
        class="fork-here"
        onSubmit={(submit) => {
          submit.preventDefault();
          void play();
        }}
      >
        <p class="muted">{t("fork.help", { time: logClock(beat - recording.firstBeat) })}</p>
        {seats.map((seat, index) => (
          <div class="seat-choice" key={seat.id}>
            <label class="field">
              <span>{t("fork.player", { team: sheet ? team(sheet, index) : seat.id })}</span>
              <select
                name={`player-${seat.id}`}
                onChange={(change) => {
                  const chosen = change.currentTarget.value;
                  players.value = players.value.map((one, at) => (at === index ? chosen : one));
                }}
              >
                <option value={RECORDED}>{t("fork.recorded")}</option>
                {bots.value.map((bot) => (
                  <option key={bot} value={bot}>
                    {t("fork.bot", { bot })}
                  </option>
                ))}
              </select>
            </label>
            <label class="check">
              <input
                type="checkbox"
                name={`restart-${seat.id}`}
                onChange={(change) => {
                  const others = restart.value.filter((one) => one !== seat.id);
                  restart.value = change.currentTarget.checked ? [...others, seat.id] : others;
                }}
              />
              <span>{t("fork.restart")}</span>
            </label>
          </div>
        ))}
        <label class="field">
          <span>{t("fork.event")}</span>
          <select
            name="event"
            onChange={(change) => {
              event.value = Number(change.currentTarget.value) || null;
            }}
          >
            <option value="">{t("fork.noEvent")}</option>
            {eventsBefore(recording.record.events, beat).map((one) => (
              <option key={one.number} value={one.number}>
                {eventClock(one, sheet)} {said(one.said)}
              </option>
            ))}
          </select>
        </label>
        {refused.value && (
          <p class="refused" role="alert">
            {refused.value}
          </p>
        )}
        <div class="dialog-end">
          <span id="fork-why" class="why" role="status">
            {busy.value ? t("fork.playing") : isSame ? t("fork.same") : ""}
          </span>
          <button class="button" type="button" onClick={onClose}>
            {t("common.cancel")}
          </button>
          <button
            class="button strong"
            type="submit"
            disabled={isSame || busy.value}
            aria-describedby="fork-why"
          >
            {t("fork.go")}
          </button>
        </div>
      </form>
    </Dialog>
  );
}

/** The events before a beat that still stand and can be taken back, the newest first. */
function eventsBefore(events: readonly Event[], beat: number): Event[] {
  const before = events.filter((event) => event.beat < beat);
  const gone = goneEvents(before);
  return before
    .filter((event) => canGo(event) && !gone.has(event.number))
    .slice(-EVENTS_MOST)
    .reverse();
}
