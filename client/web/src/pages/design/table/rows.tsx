/** The cells of the grid: head, rows, and what their colours say. */

import { type ReadonlySignal, useComputed } from "@preact/signals";
import {
  type Cell,
  LEVELS,
  type Range,
  type Row,
  type Table,
  wrongOf,
} from "../../../core/design/table";
import { seam } from "../../../core/design/tools";
import type { Person } from "../../../core/wire";
import { type MessageName, t } from "../../../i18n";
import type { Marked } from "../coach/coach";
import { cellId, classes, jointName, rowName } from "../names";
import { COLOURS } from "../sharing/colours";
import type { Group, Proposal } from "../sharing/group";
import type { Place, Sheet } from "./sheet";

/** What others show in the table. */
export interface Overlay {
  /** What the coach says of cells, by row and column; null: nothing. */
  marks: ReadonlySignal<ReadonlyMap<number, ReadonlyMap<number, Marked>> | null>;
  /** The other pages of the table, by the cell where they are: "row col". */
  people: ReadonlySignal<ReadonlyMap<string, Person>>;
  /** Who owns rows, and what is proposed for them. */
  group: Group;
  /** The row whose posture is the target at the moment shown; -1: none. */
  target: ReadonlySignal<number>;
}

interface TableProps {
  sheet: Sheet;
  overlay: Overlay;
  table: Table;
  /** Give the input the focus. */
  focus: () => void;
  /** Keep what is being typed. */
  commit: () => void;
  /** Begin to type into the active cell. */
  edit: () => void;
}

export function GridTable({ sheet, overlay, table, focus, commit, edit }: TableProps) {
  const area = sheet.area.value;
  const active = sheet.active.value;
  const lit = new Set(sheet.lit.value);
  const sequence = sheet.sequence.value ?? [];
  const target = overlay.target.value;
  const weights = overlay.marks.value;
  const people = overlay.people.value;
  const proposed = new Map<number, Proposal[]>();
  for (const one of overlay.group.proposals.value) {
    proposed.set(one.row, [...(proposed.get(one.row) ?? []), one]);
  }
  const unpasted = byRow(sheet.unpasted.value);
  const last = table.rows.length - 1;
  const isSequence = table.kind === "locomotion";

  const onPointerDown = (event: PointerEvent) => {
    const place = placeOf(event);
    if (!place || event.button !== 0 || event.pointerType === "touch") return;
    event.preventDefault(); // the input keeps the focus
    commit();
    sheet.select(place, event.shiftKey ? sheet.anchor.peek() : place);
    focus();
  };
  const onPointerMove = (event: PointerEvent) => {
    const place = placeOf(event);
    if (place) sheet.point([place.col]);
    const isDragging = event.buttons & 1 && event.pointerType !== "touch";
    const now = sheet.active.peek();
    if (!place || !isDragging || (place.row === now.row && place.col === now.col)) return;
    sheet.select(place, sheet.anchor.peek());
  };
  const onClick = (event: MouseEvent) => {
    const place = placeOf(event);
    if (!place || (event as PointerEvent).pointerType !== "touch") return;
    const now = sheet.active.peek();
    const isAgain = now.row === place.row && now.col === place.col;
    commit();
    sheet.select(place);
    // Only a second tap types: the first one must not bring up a keyboard.
    if (isAgain) edit();
  };
  const selectColumns = (left: number, right: number) => {
    sheet.select({ row: 0, col: left }, { row: last, col: right });
    focus();
  };
  return (
    <table
      id="gait-grid"
      role="grid"
      aria-label={t("design.grid")}
      aria-multiselectable="true"
      onPointerDown={onPointerDown}
      onPointerMove={onPointerMove}
      onPointerLeave={() => sheet.point([])}
      onClick={onClick}
      onDblClick={(event) => placeOf(event) && edit()}
    >
      <Head sheet={sheet} table={table} lit={lit} onSelect={selectColumns} />
      <tbody>
        {table.rows.map((row, index) => (
          <GridRow
            key={index}
            row={row}
            index={index}
            legs={table.legs.length}
            ranges={table.ranges}
            isSequence={isSequence}
            isNewKey={index > 0 && table.rows[index - 1]!.key !== row.key}
            step={sequence.indexOf(index)}
            isTarget={target === index}
            activeCol={active.row === index ? active.col : -1}
            left={index >= area.top && index <= area.bottom ? area.left : 0}
            right={index >= area.top && index <= area.bottom ? area.right : -1}
            lit={lit}
            weights={weights?.get(index) ?? null}
            unpasted={unpasted.get(index) ?? null}
            people={people}
            group={overlay.group}
            owners={overlay.group.owners(table, row).map(({ name }) => name)}
            proposed={proposed.get(index) ?? null}
            onSelect={() => {
              sheet.select({ row: index, col: 0 }, { row: index, col: row.cells.length - 1 });
              focus();
            }}
          />
        ))}
      </tbody>
    </table>
  );
}

interface HeadProps {
  sheet: Sheet;
  table: Table;
  lit: ReadonlySet<number>;
  onSelect: (left: number, right: number) => void;
}

function Head({ sheet, table, lit, onSelect }: HeadProps) {
  const legs = table.legs.length;
  const jumps = useComputed(() => {
    const now = sheet.table.value;
    return now ? seam(now, sheet.sequence.value ?? []).map((one) => one.jumps) : [];
  }).value;
  const headOf = (col: number) => ({
    class: classes(col % legs === 0 && "first", lit.has(col) && "lit", jumps[col] && "jumps"),
    title: jumps[col] ? t("design.seamJump") : jointName(table.legs, col),
    onClick: () => onSelect(col, col),
    onPointerEnter: () => sheet.point([col]),
  });
  const columns = table.ranges.map((_, col) => col);
  return (
    <thead>
      <tr class="levels">
        <th scope="col" rowSpan={3} class="corner">
          {t("design.row")}
        </th>
        {LEVELS.map((name, level) => (
          <th
            key={name}
            scope="colgroup"
            colSpan={legs}
            class="first"
            onClick={() => onSelect(level * legs, level * legs + legs - 1)}
          >
            {name}
          </th>
        ))}
      </tr>
      <tr class="legs">
        {columns.map((col) => (
          <th key={col} scope="col" {...headOf(col)}>
            {table.legs[col % legs]}
          </th>
        ))}
      </tr>
      <tr class="ids">
        {columns.map((col) => (
          <th key={col} scope="col" {...headOf(col)}>
            {col}
          </th>
        ))}
      </tr>
    </thead>
  );
}

interface RowProps {
  row: Row;
  index: number;
  legs: number;
  ranges: readonly Range[];
  isSequence: boolean;
  isNewKey: boolean;
  /** Place in the chosen key's sequence; -1: not in it. */
  step: number;
  /** Whether its posture is the target at the moment shown. */
  isTarget: boolean;
  activeCol: number;
  left: number;
  right: number;
  lit: ReadonlySet<number>;
  weights: ReadonlyMap<number, Marked> | null;
  people: ReadonlyMap<string, Person>;
  group: Group;
  /** Nicknames of those who own the row. */
  owners: readonly string[];
  proposed: readonly Proposal[] | null;
  /** Why what was pasted can't stand, by column. */
  unpasted: ReadonlyMap<number, string> | null;
  onSelect: () => void;
}

function GridRow(props: RowProps) {
  const { row, index, legs, step, weights, activeCol } = props;
  return (
    <tr
      class={classes(
        props.isNewKey && props.isSequence && "new-key",
        step >= 0 && "in-sequence",
        props.isTarget && "target",
        activeCol >= 0 && "active",
      )}
    >
      <th
        scope="row"
        onClick={props.onSelect}
        title={
          props.owners.length
            ? t("design.group.owner", { name: props.owners.join(", ") })
            : t("design.selectRow")
        }
        {...(props.owners[0] && { "data-colour": props.group.colour(props.owners[0]) % COLOURS })}
      >
        <span class="row-name">{rowName(row, props.isSequence)}</span>
        {step >= 0 && !props.isSequence && (
          <span class="step" title={t("design.step.of", { step: step + 1 })}>
            {step + 1}
          </span>
        )}
      </th>
      {row.cells.map((cell, col) => {
        const marked = weights?.get(col);
        const proposal = props.proposed?.find((one) => one.col === col);
        const person = props.people.get(`${index} ${col}`);
        return (
          <td
            key={col}
            id={cellId({ row: index, col })}
            data-row={index}
            data-col={col}
            aria-selected={col >= props.left && col <= props.right}
            class={classes(
              col % legs === 0 && "first",
              props.lit.has(col) && "lit",
              col === activeCol && "at",
              marked && "weighted",
            )}
            {...wrongProps(cell, props.ranges[col]!)}
            {...(props.unpasted?.has(col) && {
              "data-unpasted": true,
              title: props.unpasted.get(col)!,
            })}
            {...(person && {
              "data-colour": (props.group.colour(person.name) || person.id) % COLOURS,
            })}
            {...(marked && { style: `--weight: ${marked.share}`, title: marked.text })}
          >
            {cell}
            {proposal && (
              <span class="proposed" data-colour={props.group.colour(proposal.by) % COLOURS}>
                {proposal.text}
              </span>
            )}
            {person?.typing != null && (
              <span class="typing" aria-hidden="true">
                {person.typing}
              </span>
            )}
            {marked && (
              <span class="marks" aria-hidden="true">
                <i data-effect={marked.up} />
                <i data-effect={marked.down} />
              </span>
            )}
          </td>
        );
      })}
    </tr>
  );
}

function byRow(cells: Sheet["unpasted"]["value"]): Map<number, Map<number, string>> {
  const found = new Map<number, Map<number, string>>();
  for (const { row, col, why } of cells) {
    found.set(row, (found.get(row) ?? new Map()).set(col, why));
  }
  return found;
}

function wrongProps(cell: Cell, [low, high]: Range) {
  const why = wrongOf(cell);
  if (!why) return {};
  const title = t(`design.bad.${why}` as MessageName, { low, high });
  return { "aria-invalid": true, title };
}

function placeOf({ target }: Event): Place | null {
  const cell = (target as HTMLElement | null)?.closest<HTMLElement>("td[data-row]");
  return cell ? { row: Number(cell.dataset.row), col: Number(cell.dataset.col) } : null;
}
