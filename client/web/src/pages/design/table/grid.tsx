/**
 * The table that is edited: an ARIA grid with one input.
 *
 * The input keeps the focus, lies over the active cell, and has its text, selected. So the first key
 * of an input method begins a composition like any other, and copy and paste are the browser's own.
 */

import { useSignal } from "@preact/signals";
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";
import { writeBlock } from "../../../core/design/clipboard";
import { cellsOf, type Table, wrongOf } from "../../../core/design/table";
import { type MessageName, t } from "../../../i18n";
import { cellId, jointName, rowName } from "../names";
import { type Parse, pasteInto, rangeOf } from "./paste";
import { GridTable, type Overlay } from "./rows";
import type { Place, Sheet } from "./sheet";
import { clearCells, type Typing, Typist } from "./typist";
import "./table.css";

interface Props {
  sheet: Sheet;
  overlay: Overlay;
  /** Reads a sheet that was pasted whole. */
  parse: Parse;
}

export function Grid({ sheet, overlay, parse }: Props) {
  const table = sheet.table.value;
  const typing = useSignal<Typing>("");
  const input = useRef<HTMLInputElement>(null);
  const box = useRef<HTMLDivElement>(null);
  const typist = useRef<Typist>(null);
  typist.current ??= new Typist(sheet, typing, input);
  const { current: keys } = typist;
  const active = sheet.active.value;
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
    const cells = cellsOf(table, sheet.area.peek());
    event.clipboardData?.setData("text/plain", writeBlock(cells));
    if (event.type === "cut") clearCells(sheet, t("design.step.cut"));
  };
  const takePaste = (event: ClipboardEvent) => {
    if (typing.peek()) return;
    event.preventDefault();
    const of = (kind: string) => event.clipboardData?.getData(kind) ?? "";
    pasteInto(sheet, of("text/plain"), of("text/html"), parse);
  };
  return (
    <div class="grid-box" ref={box} style={`--legs: ${table.legs.length}`}>
      <GridTable
        sheet={sheet}
        overlay={overlay}
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

function cellLabel(table: Table, { row, col }: Place): string {
  const found = table.rows[row];
  if (!found) return "";
  const angle = found.cells[col] ?? "";
  const name = rowName(found, table.kind === "locomotion");
  const label = t("design.cell", { row: name, joint: jointName(table.legs, col), angle });
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
