/**
 * The table that is edited: an ARIA grid with one input.
 *
 * The input keeps the focus, lies over the active cell, and has its text, selected. So the first key
 * of an input method begins a composition like any other, and copy and paste are the browser's own.
 */

import { useSignal } from "@preact/signals";
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";
import {
  type BadPaste,
  isWholeSheet,
  paste,
  readBlock,
  writeBlock,
} from "../../core/design/clipboard";
import {
  cellsOf,
  clear,
  LEVELS,
  nudge,
  readCell,
  setCell,
  type Table,
  wrongOf,
} from "../../core/design/table";
import { type MessageName, t } from "../../i18n";
import { toast } from "../../ui/toasts";
import { cellId, GridTable, rowName } from "./rows";
import { jointName, type Place, type Studio } from "./studio";

const NUDGE_DEG = 5;
const FINE_DEG = 1;
/** The name under which a pasted sheet goes to the reader of files. */
const PASTED = "Loco-data.txt";

/** How a cell is being typed into: "type" began with a new text, "edit" with the old one. */
export type Typing = "" | "type" | "edit";

/** Takes the keys of the grid. */
class Typist {
  constructor(
    private readonly studio: Studio,
    private readonly typing: { value: Typing; peek(): Typing },
    private readonly input: { current: HTMLInputElement | null },
  ) {}

  begin(how: Typing): void {
    const field = this.input.current;
    if (!field) return;
    this.typing.value = how;
    field.focus({ preventScroll: true });
    if (how === "edit") field.setSelectionRange(field.value.length, field.value.length);
  }

  /** The text has changed: the picture shows what it would be. */
  draw(): void {
    const range = this.studio.table.peek()?.ranges[this.studio.active.peek().col];
    const text = this.input.current?.value ?? "";
    if (!this.typing.peek()) this.typing.value = "type";
    if (range) this.studio.draft.value = readCell(text, range);
  }

  commit(): void {
    if (!this.typing.peek()) return;
    this.typing.value = "";
    this.studio.draft.value = null;
    const { row, col } = this.studio.active.peek();
    const text = this.input.current?.value ?? "";
    if (text === this.text()) return;
    this.studio.edit(t("design.step.type"), (now) => setCell(now, row, col, text));
  }

  cancel(): void {
    this.typing.value = "";
    this.studio.draft.value = null;
    const field = this.input.current!;
    field.value = this.text();
    field.select();
  }

  press(event: KeyboardEvent): void {
    if (event.isComposing || event.keyCode === 229) return;
    const act = this.typing.peek() ? this.whileTyping(event) : this.otherwise(event);
    if (!act) return;
    event.preventDefault();
    event.stopPropagation();
    act();
  }

  private text(): string {
    const { row, col } = this.studio.active.peek();
    return String(this.studio.table.peek()?.rows[row]?.cells[col] ?? "");
  }

  private whileTyping(event: KeyboardEvent): (() => void) | null {
    const wide = event.ctrlKey || event.metaKey;
    const then = (rows: number, cols: number) => () => {
      this.commit();
      this.move(rows, cols, false);
    };
    switch (event.key) {
      case "Escape":
        return () => this.cancel();
      case "Enter":
        // It stays where it is: the picture must show the posture that was changed.
        if (!wide) return then(0, 0);
        this.commit(); // and the page lets the robot walk
        return null;
      case "Tab":
        this.commit();
        return null;
      case "ArrowUp":
        return then(-1, 0);
      case "ArrowDown":
        return then(1, 0);
      case "ArrowLeft":
        return this.typing.peek() === "type" ? then(0, -1) : null;
      case "ArrowRight":
        return this.typing.peek() === "type" ? then(0, 1) : null;
      default:
        return null;
    }
  }

  private otherwise(event: KeyboardEvent): (() => void) | null {
    const { altKey, shiftKey: extend } = event;
    const wide = event.ctrlKey || event.metaKey;
    const { row, col } = this.studio.active.peek();
    const table = this.studio.table.peek()!;
    const [lastRow, lastCol] = [table.rows.length - 1, LEVELS.length * table.legs.length - 1];
    const turn = (sign: number) => () =>
      turnCells(this.studio, sign * (extend ? FINE_DEG : NUDGE_DEG));
    if (altKey) {
      if (event.key === "ArrowUp") return turn(1);
      return event.key === "ArrowDown" ? turn(-1) : null;
    }
    const to = (place: Place) => () => this.go(place, extend);
    switch (event.key) {
      case "ArrowUp":
        return to({ row: wide ? 0 : row - 1, col });
      case "ArrowDown":
        return to({ row: wide ? lastRow : row + 1, col });
      case "ArrowLeft":
        return to({ row, col: wide ? 0 : col - 1 });
      case "ArrowRight":
        return to({ row, col: wide ? lastCol : col + 1 });
      case "Home":
        return to({ row: wide ? 0 : row, col: 0 });
      case "End":
        return to({ row: wide ? lastRow : row, col: lastCol });
      case "PageUp":
        return to({ row: 0, col });
      case "PageDown":
        return to({ row: lastRow, col });
      case "F2":
        return () => this.begin("edit");
      case "Enter":
        return wide ? null : () => this.begin("edit");
      case "Escape":
        return () => this.go({ row, col }, false);
      case "Delete":
      case "Backspace":
        return () => clearCells(this.studio, t("design.step.clear"));
      case "a":
      case "A":
        return wide
          ? () => this.studio.select({ row: 0, col: 0 }, { row: lastRow, col: lastCol })
          : null;
      default:
        return null;
    }
  }

  private move(rows: number, cols: number, extend: boolean): void {
    const { row, col } = this.studio.active.peek();
    this.go({ row: row + rows, col: col + cols }, extend);
  }

  private go(place: Place, extend: boolean): void {
    this.studio.select(place, extend ? this.studio.anchor.peek() : place);
  }
}

export function Grid({ studio }: { studio: Studio }) {
  const table = studio.table.value;
  const typing = useSignal<Typing>("");
  const input = useRef<HTMLInputElement>(null);
  const box = useRef<HTMLDivElement>(null);
  const typist = useRef<Typist>(null);
  typist.current ??= new Typist(studio, typing, input);
  const { current: keys } = typist;
  const active = studio.active.value;
  const cell = table?.rows[active.row]?.cells[active.col] ?? "";

  useLayoutEffect(() => {
    const field = input.current;
    const at = box.current?.querySelector<HTMLElement>(`#${cellId(active)}`);
    if (!field || !at || typing.peek()) return;
    Object.assign(field.style, {
      left: `${at.offsetLeft}px`,
      top: `${at.offsetTop}px`,
      width: `${at.offsetWidth}px`,
      height: `${at.offsetHeight}px`,
    });
    field.value = String(cell);
    if (document.activeElement !== field) return;
    field.select();
    showCell(box.current!, at);
  }, [active, cell, table, typing.value]);
  // Whoever comes to the page can type at once.
  useEffect(() => {
    const isFree = document.activeElement === document.body && !matchMedia("(hover: none)").matches;
    if (table && isFree) input.current?.focus({ preventScroll: true });
  }, [Boolean(table)]);

  if (!table) return null;
  const copy = (event: ClipboardEvent) => {
    if (typing.peek()) return;
    event.preventDefault();
    const cells = cellsOf(table, studio.area.peek());
    event.clipboardData?.setData("text/plain", writeBlock(cells));
    if (event.type === "cut") clearCells(studio, t("design.step.cut"));
  };
  const takePaste = (event: ClipboardEvent) => {
    if (typing.peek()) return;
    event.preventDefault();
    const of = (kind: string) => event.clipboardData?.getData(kind) ?? "";
    pasteInto(studio, of("text/plain"), of("text/html"));
  };
  return (
    <div class="grid-box" ref={box} style={`--legs: ${table.legs.length}`}>
      <GridTable
        studio={studio}
        table={table}
        focus={() => input.current?.focus({ preventScroll: true })}
        commit={() => keys.commit()}
        edit={() => keys.begin("edit")}
      />
      <input
        ref={input}
        class={`cell-input${typing.value ? " on" : ""}`}
        aria-label={cellLabel(table, active)}
        aria-activedescendant={typing.value ? undefined : cellId(active)}
        aria-controls="gait-grid"
        autocomplete="off"
        autocapitalize="off"
        spellcheck={false}
        inputMode={typing.value ? "text" : "none"}
        onKeyDown={(event) => keys.press(event)}
        onInput={() => keys.draw()}
        onCompositionStart={() => {
          if (!typing.peek()) typing.value = "type";
        }}
        onCopy={copy}
        onCut={copy}
        onPaste={takePaste}
        onBlur={() => keys.commit()}
        onFocus={(event) => event.currentTarget.select()}
      />
    </div>
  );
}

/** Turn the selected angles; edits in a row with the same gesture are one step. */
export function turnCells(studio: Studio, byDeg: number, gesture: string | null = null): void {
  const area = studio.area.peek();
  studio.edit(t("design.step.turn"), (now) => nudge(now, area, byDeg), gesture);
}

function clearCells(studio: Studio, name: string): void {
  const area = studio.area.peek();
  studio.edit(name, (now) => clear(now, area));
}

/** Put what is on the clipboard into the table: all of it, or nothing. */
export function pasteInto(studio: Studio, plain: string, html: string): void {
  const table = studio.table.peek();
  const block = readBlock(plain, html);
  if (!table || !block.length) return;
  if (isWholeSheet(block)) {
    void studio.parse(PASTED, new TextEncoder().encode(plain || writeBlock(block)));
    return;
  }
  const pasted = paste(table, studio.area.peek(), block);
  if ("bad" in pasted) {
    refusePaste(studio, table, pasted.bad);
    return;
  }
  studio.edit(t("design.step.paste"), () => pasted.table, null, "paste");
  const { top, left, bottom, right } = pasted.area;
  studio.select({ row: top, col: left }, { row: bottom, col: right });
}

/** Say why nothing was pasted; the cells that are in the way turn red. */
function refusePaste(studio: Studio, table: Table, bad: readonly BadPaste[]): void {
  const inside = bad.filter(({ why }) => why !== "outside");
  studio.unpasted.value = inside.map(({ row, col, text, why }) => ({
    row,
    col,
    why: `“${text}” ${t(`design.bad.${why}` as MessageName, rangeOf(table, col))}`,
  }));
  const [first] = inside;
  if (!first) {
    toast(t("design.notPastedOutside"), "no");
    return;
  }
  const { row, col, text, why } = first;
  const reason = t(`design.bad.${why}` as MessageName, rangeOf(table, col));
  const key = table.rows[row]?.key ?? "?";
  toast(t("design.notPasted", { text, key, where: jointName(table.legs, col), reason }), "no");
}

function rangeOf(table: Table, col: number): { low: number; high: number } {
  const [low, high] = table.ranges[col] ?? [0, 0];
  return { low, high };
}

function cellLabel(table: Table, { row, col }: Place): string {
  const found = table.rows[row];
  if (!found) return "";
  const angle = found.cells[col] ?? "";
  const key = rowName(found, table.kind === "locomotion");
  const label = t("design.cell", { key, joint: jointName(table.legs, col), angle });
  const why = wrongOf(angle);
  return why ? `${label}. ${t(`design.bad.${why}` as MessageName, rangeOf(table, col))}` : label;
}

/** Scroll the grid, not the page, until a cell is free of names and head. */
function showCell(box: HTMLElement, cell: HTMLElement): void {
  const names = box.querySelector<HTMLElement>("th.corner")?.offsetWidth ?? 0;
  const head = box.querySelector("thead")?.offsetHeight ?? 0;
  const { offsetLeft: left, offsetTop: top } = cell;
  const right = left + cell.offsetWidth;
  const bottom = top + cell.offsetHeight;
  if (left - names < box.scrollLeft) box.scrollLeft = left - names;
  else if (right > box.scrollLeft + box.clientWidth) box.scrollLeft = right - box.clientWidth;
  if (top - head < box.scrollTop) box.scrollTop = top - head;
  else if (bottom > box.scrollTop + box.clientHeight) box.scrollTop = bottom - box.clientHeight;
}
