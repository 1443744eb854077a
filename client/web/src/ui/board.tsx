/** The field from above as a drawing: crisp at any size, and a way to point at things. */

import { useSignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import { borderOf, markerLabel, ownLabel } from "../core/border";
import { type Match, markerStates } from "../core/match";
import { floorOf, type Place, places } from "../core/poses";
import { MARKER_STATES, type MarkerInfo, type Scene, type Sheet } from "../core/wire";
import { said, t } from "../i18n";
import { markerName, seatName, team } from "../i18n/words";

interface Props {
  match: Match;
  /** Something was clicked: a marker's or a seat's index. */
  onPick?: (what: { marker?: number; seat?: number }) => void;
  /** Points that markers would bring now, by name: they are marked. */
  worth?: Readonly<Record<string, number>> | null;
  /** Index of the marker or seat that is chosen. */
  picked?: { marker?: number; seat?: number } | null;
}

const LOOK_MS = 80;
const ROBOT_M = 0.1;
/** Smallest radius that is drawn: the letter of a flag must be readable. */
const LEAST_MARKER_M = 0.05;
/** Height of a marker's name, by which log and referee call it. */
const NAME_M = 0.055;
/** In a smaller marker the name stands below it. */
const NAME_FITS_M = 0.1;
/** Width of the border that names columns and rows, and height of its letters. */
const EDGE_M = 0.11;
const BORDER_M = 0.085;
const SHADE = "rgb(0 0 0 / 30%)";
const NEUTRAL = "#5d6674";
const DOWN = "#3b424d";

export function Board({ match, onPick, picked, worth }: Props) {
  const states = useMemo(() => markerStates(match), [match]).value;
  const robots = useRobots(match);
  const stop = useSignal(0);
  const sheet = match.sheet.value;
  if (!sheet) return null;
  const floor = floorOf(match.scene.value, sheet);
  const border = borderOf(sheet.markers);
  const edge = border.rows.length ? EDGE_M : 0;
  const left = floor.xM - floor.halfXM;
  const top = -floor.yM - floor.halfYM;
  const size = { width: 2 * floor.halfXM, height: 2 * floor.halfYM };
  const box = [left - edge, top, size.width + edge, size.height + edge];
  const pickable = onPick ? "button" : undefined;
  return (
    <div class="board">
      <svg
        viewBox={box.join(" ")}
        role="group"
        aria-label={t("board.title")}
        onKeyDown={onPick && moveFocus}
      >
        <defs>
          {sheet.seats.map(({ pattern }, index) => (
            <pattern
              key={index}
              id={lookOf(index)}
              width="0.05"
              height="0.05"
              patternUnits="userSpaceOnUse"
              patternTransform="rotate(45)"
            >
              <rect width="0.05" height="0.05" fill={`var(--seat-${index})`} />
              {pattern === "stripes" && <rect width="0.02" height="0.05" fill={SHADE} />}
              {pattern === "dots" && <circle cx="0.025" cy="0.025" r="0.012" fill={SHADE} />}
            </pattern>
          ))}
        </defs>
        <rect x={left} y={top} {...size} fill="#1b2533" />
        {border.columns.map(([text, x]) => (
          <BorderLabel key={text} text={text} x={x} y={top + size.height + EDGE_M / 2} />
        ))}
        {border.rows.map(([text, y]) => (
          <BorderLabel key={text} text={text} x={left - EDGE_M / 2} y={-y} />
        ))}
        {sheet.markers.map((marker, index) => (
          <g
            key={marker.name}
            transform={`translate(${marker.x_m} ${-marker.y_m})`}
            // In SVG the attribute is all lower case. One stop for the tab key, arrows go on.
            {...(onPick && { role: pickable, tabindex: index === stop.value ? 0 : -1 })}
            data-marker={marker.name}
            aria-label={`${markerName(marker.name)}: ${stateWord(states[index] ?? 0)}`}
            onFocus={() => {
              stop.value = index;
            }}
            onClick={() => onPick?.({ marker: index })}
            onKeyDown={(event) => isPress(event) && onPick?.({ marker: index })}
            style={onPick ? "cursor: pointer" : ""}
          >
            <Marker
              marker={marker}
              state={states[index] ?? 0}
              sheet={sheet}
              cloth={clothOf(match.scene.value, index)}
              picked={picked?.marker === index}
              named={onPick !== undefined}
              isOpen={worth?.[marker.name] !== undefined}
            />
          </g>
        ))}
        {robots.map((place, seat) => (
          <Robot
            key={seat}
            place={place}
            seat={seat}
            sheet={sheet}
            picked={picked?.seat === seat}
            {...(onPick && { onPick: () => onPick({ seat }) })}
          />
        ))}
      </svg>
    </div>
  );
}

function BorderLabel({ text, x, y }: { text: string; x: number; y: number }) {
  return (
    <text
      x={x}
      y={y + 0.35 * BORDER_M}
      text-anchor="middle"
      font-size={BORDER_M}
      fill="var(--muted)"
    >
      {text}
    </text>
  );
}

/** A marker's state in a word. */
function stateWord(state: number): string {
  return said({ code: `state.${MARKER_STATES[state] ?? "neutral"}` });
}

/** Whether a key presses a button. It then does nothing else, such as in a dialog that opens. */
function isPress(event: KeyboardEvent): boolean {
  const press = (event.key === "Enter" || event.key === " ") && !event.ctrlKey;
  if (press) event.preventDefault();
  return press;
}

const ARROWS: Record<string, readonly [x: number, y: number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};

/** An arrow goes to the nearest thing in its direction. */
function moveFocus(event: KeyboardEvent & { currentTarget: SVGSVGElement }): void {
  const way = ARROWS[event.key];
  if (!way || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  const here = centre(event.target as Element);
  let nearest: SVGElement | null = null;
  let least = Number.POSITIVE_INFINITY;
  for (const one of event.currentTarget.querySelectorAll<SVGElement>("[role=button]")) {
    const [x, y] = centre(one);
    const along = (x - here[0]) * way[0] + (y - here[1]) * way[1];
    const across = Math.abs((x - here[0]) * way[1]) + Math.abs((y - here[1]) * way[0]);
    if (along > 1 && along + 2 * across < least) {
      nearest = one;
      least = along + 2 * across;
    }
  }
  nearest?.focus();
}

function centre(element: Element): [number, number] {
  const box = element.getBoundingClientRect();
  return [box.x + box.width / 2, box.y + box.height / 2];
}

/** Names a seat's colour with its pattern. */
function lookOf(seat: number): string {
  return `seat-look-${seat}`;
}

/** The colour of a flag, which shows its points; null for other markers. */
function clothOf(scene: Scene | null, marker: number): string | null {
  const cloth = scene?.geoms.find(
    (geom) => geom.marker === marker && geom.state === 0 && geom.type === "box",
  );
  if (!cloth) return null;
  const [red, green, blue] = cloth.rgba.map((part) => Math.round(255 * part));
  return `rgb(${red} ${green} ${blue})`;
}

/** True if dark letters are easier to read on a colour "rgb(r g b)". */
function isLight(colour: string): boolean {
  const [red = 0, green = 0, blue = 0] = colour.match(/\d+/g)?.map(Number) ?? [];
  return 0.299 * red + 0.587 * green + 0.114 * blue > 140;
}

interface MarkerProps {
  /** The colour of a standing flag. */
  cloth: string | null;
  marker: MarkerInfo;
  state: number;
  sheet: Sheet;
  picked: boolean;
  /** Whether its name is shown. */
  named: boolean;
  /** Whether it would bring points now. */
  isOpen: boolean;
}

function Marker({ marker, state, sheet, cloth, picked, named, isOpen }: MarkerProps) {
  const radius = Math.max(LEAST_MARKER_M, marker.radius_m);
  const fits = radius >= NAME_FITS_M;
  const label = named ? markerLabel(marker.name) || marker.name : ownLabel(marker);
  const seat = state > 0 && state <= sheet.seats.length ? state - 1 : null;
  const fill =
    seat === null
      ? MARKER_STATES[state] === "down"
        ? DOWN
        : (cloth ?? NEUTRAL)
      : `url(#${lookOf(seat)})`;
  const ink =
    seat === 1 ? "var(--ink-1)" : seat === null && cloth && isLight(cloth) ? "#10141b" : "#fff";
  const text =
    seat !== null
      ? sheet.seats[seat]!.id.slice(0, 1).toUpperCase()
      : MARKER_STATES[state] === "down"
        ? "×"
        : marker.points > 1 || cloth
          ? String(marker.points)
          : "";
  return (
    <>
      <title>{`${markerName(marker.name)}${marker.points > 1 ? `, ${marker.points}` : ""}`}</title>
      <circle
        r={radius}
        fill={fill}
        stroke={picked || isOpen ? "#fff" : "rgb(255 255 255 / 25%)"}
        stroke-width={picked || (isOpen && fits) ? 0.025 : isOpen ? 0.013 : 0.008}
        stroke-dasharray={isOpen ? "0.05 0.03" : undefined}
      />
      <text
        y={radius * (label && fits ? 0.2 : 0.36)}
        text-anchor="middle"
        font-size={radius}
        font-weight="700"
        fill={ink}
      >
        {text}
      </text>
      {label && (
        <text
          y={fits ? radius * 0.72 : radius + NAME_M}
          text-anchor="middle"
          font-size={NAME_M}
          fill={fits ? ink : "var(--muted)"}
        >
          {label}
        </text>
      )}
    </>
  );
}

interface RobotProps {
  place: Place;
  seat: number;
  sheet: Sheet;
  picked: boolean;
  onPick?: () => void;
}

function Robot({ place, seat, sheet, picked, onPick }: RobotProps) {
  const degrees = (-place.headingRad * 180) / Math.PI;
  const name = `${team(sheet, seat)} (${seatName(sheet.seats[seat]?.id ?? "")})`;
  return (
    <g
      transform={`translate(${place.xM} ${-place.yM}) rotate(${degrees})`}
      {...(onPick && { role: "button", tabindex: 0, onClick: onPick })}
      aria-label={name}
      onKeyDown={(event) => isPress(event) && onPick?.()}
      style={onPick ? "cursor: pointer" : ""}
    >
      <title>{name}</title>
      <circle
        r={ROBOT_M}
        fill={`var(--seat-${seat})`}
        stroke={picked ? "var(--warn)" : "#fff"}
        stroke-width={0.02}
      />
      <path d="M 0.055 0 L -0.03 0.045 L -0.012 0 L -0.03 -0.045 Z" fill={`var(--ink-${seat})`} />
    </g>
  );
}

/** The robots' places, some times a second. */
function useRobots(match: Match): Place[] {
  const found = useSignal<Place[]>([]);
  useEffect(() => {
    const timer = setInterval(() => {
      const frame = match.frame.peek();
      const sheet = match.sheet.peek();
      if (!frame || !sheet) return;
      const now = places(frame, sheet);
      if (JSON.stringify(now) !== JSON.stringify(found.peek())) found.value = now;
    }, LOOK_MS);
    return () => clearInterval(timer);
  }, [match, found]);
  return found.value;
}
