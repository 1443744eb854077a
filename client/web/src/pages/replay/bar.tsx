/** The bar of a recording: where one is, what happened where, and who was ahead. */

import { useSignal } from "@preact/signals";
import { useMemo } from "preact/hooks";
import type { Recording } from "../../core/recording";
import { type Event, Phase } from "../../core/wire";
import { t } from "../../i18n";
import { BEATS_PER_S, eventClock } from "../../i18n/words";
import { OddsCurve } from "../../ui/odds";
import { sentence } from "../../ui/thirds";
import type { Player } from "./player";

const HEIGHT = 100;

export function SeekBar({ player }: { player: Player }) {
  const { recording } = player;
  const { firstBeat, lastBeat } = recording;
  // What does not move is made once, not with each picture.
  const happened = useMemo(() => <Happened player={player} />, [player]);
  const span = lastBeat - firstBeat;
  const beat = Math.floor(recording.beat.value);
  const position = t("replay.position", {
    time: seconds(beat - firstBeat),
    total: seconds(span),
  });
  return (
    <div class="seek" style={`--at: ${partOf(recording, recording.beat.value)}`}>
      {happened}
      <input
        type="range"
        min={firstBeat}
        max={lastBeat}
        step={1}
        value={beat}
        aria-label={t("replay.seek")}
        aria-valuetext={position}
        onInput={(event) => player.seek(Number(event.currentTarget.value))}
        onKeyDown={(event) => {
          // By seconds, not by beats: comma and full stop do those.
          const by = { ArrowLeft: -5, ArrowDown: -5, ArrowRight: 5, ArrowUp: 5 }[event.code];
          if (!by) return;
          event.preventDefault();
          player.skip(by);
        }}
      />
    </div>
  );
}

/** The parts of the bar that do not move: lead, odds, and a mark for each event. */
function Happened({ player }: { player: Player }) {
  const { recording } = player;
  const hovered = useSignal<Event | null>(null);
  return (
    <>
      <Lead recording={recording} />
      {player.odds.value && (
        <div class="odds">
          <OddsCurve
            odds={player.odds.value}
            first={recording.firstBeat}
            last={recording.lastBeat}
          />
        </div>
      )}
      <div class="done" />
      <div class="marks" aria-hidden="true">
        {player.marks.map((event) => (
          <button
            key={event.number}
            type="button"
            tabIndex={-1}
            class="mark"
            data-kind={event.kind}
            data-beat={event.beat}
            {...(event.seat >= 0 && { "data-seat": event.seat })}
            style={`left: ${100 * partOf(recording, event.beat)}%`}
            onMouseEnter={() => {
              hovered.value = event;
            }}
            onMouseLeave={() => {
              hovered.value = null;
            }}
            onClick={() => player.show(event)}
          />
        ))}
      </div>
      {hovered.value && <Label recording={recording} event={hovered.value} />}
    </>
  );
}

function Label({ recording, event }: { recording: Recording; event: Event }) {
  const place = partOf(recording, event.beat);
  const side = place < 0.15 ? "start" : place > 0.85 ? "end" : "middle";
  return (
    <span class={`mark-label ${side}`} style={`left: ${100 * place}%`}>
      <b>{eventClock(event, recording.sheet.value)}</b> {sentence(recording, event)}
    </span>
  );
}

/** Who was ahead by how much, over the whole match: left above the line, right below it. */
function Lead({ recording }: { recording: Recording }) {
  const { firstBeat, lastBeat, record } = recording;
  const { areas, halts } = useMemo(() => {
    const steps = record.scores.map(({ beat, value }) => ({
      beat: Math.max(firstBeat, beat),
      lead: value.length === 2 ? value[0]! - value[1]! : 0,
    }));
    const most = Math.max(1, ...steps.map(({ lead }) => Math.abs(lead)));
    const area = (sign: 1 | -1) => {
      const points = [`M ${firstBeat} 0`];
      let last = 0;
      for (const { beat, lead } of steps) {
        points.push(`L ${beat} ${last}`);
        last = (-sign * Math.max(0, sign * lead) * HEIGHT) / most;
        points.push(`L ${beat} ${last}`);
      }
      return [...points, `L ${lastBeat} ${last}`, `L ${lastBeat} 0 Z`].join(" ");
    };
    const halts = record.phases.flatMap(({ beat, value }, index) =>
      value === Phase.HALTED ? [{ beat, end: record.phases[index + 1]?.beat ?? lastBeat }] : [],
    );
    return { areas: [area(1), area(-1)], halts };
  }, [record, firstBeat, lastBeat]);
  return (
    <svg
      class="lead"
      viewBox={`${firstBeat} ${-HEIGHT} ${lastBeat - firstBeat} ${2 * HEIGHT}`}
      preserveAspectRatio="none"
      aria-hidden="true"
    >
      {areas.map((path, seat) => (
        <path key={seat} d={path} style={`fill: var(--seat-${seat})`} />
      ))}
      {halts.map(({ beat, end }) => (
        <rect key={beat} x={beat} y={-HEIGHT} width={end - beat} height={2 * HEIGHT} class="halt" />
      ))}
    </svg>
  );
}

/** Where in the recording a beat is, from 0 to 1. */
function partOf({ firstBeat, lastBeat }: Recording, beat: number): number {
  return Math.min(1, Math.max(0, (beat - firstBeat) / (lastBeat - firstBeat)));
}

/** A number of beats as minutes and seconds, "1:05". */
export function seconds(beats: number): string {
  const whole = Math.floor(Math.max(0, beats) / BEATS_PER_S);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
}
