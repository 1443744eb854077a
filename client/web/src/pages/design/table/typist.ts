/** Takes the keys of the grid, and edits the selected cells. */

import { clear, LEVELS, nudge, readCell, setCell } from "../../../core/design/table";
import { t } from "../../../i18n";
import type { Place, Sheet } from "./sheet";

const NUDGE_DEG = 5;
const FINE_DEG = 1;

/** How a cell is being typed into: "type" began with a new text, "edit" with the old one. */
export type Typing = "" | "type" | "edit";

/** Takes the keys of the grid. */
export class Typist {
  constructor(
    private readonly sheet: Sheet,
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
    const range = this.sheet.table.peek()?.ranges[this.sheet.active.peek().col];
    const text = this.input.current?.value ?? "";
    if (!this.typing.peek()) this.typing.value = "type";
    if (range) this.sheet.draft.value = readCell(text, range);
  }

  commit(): void {
    if (!this.typing.peek()) return;
    this.typing.value = "";
    this.sheet.draft.value = null;
    const { row, col } = this.sheet.active.peek();
    const text = this.input.current?.value ?? "";
    if (text === this.text()) return;
    this.sheet.edit(t("design.step.type"), (now) => setCell(now, row, col, text));
  }

  cancel(): void {
    this.typing.value = "";
    this.sheet.draft.value = null;
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
    const { row, col } = this.sheet.active.peek();
    return String(this.sheet.table.peek()?.rows[row]?.cells[col] ?? "");
  }

  private whileTyping(event: KeyboardEvent): (() => void) | null {
    const wide = event.ctrlKey || event.metaKey;
    const letter = event.key.toLowerCase();
    if (wide && (letter === "z" || letter === "y")) {
      // What is typed is no step yet: no older step must be taken back, or done again.
      const takesBack = letter === "z" && !event.shiftKey;
      return () => takesBack && this.cancel();
    }
    const then = (rows: number, cols: number) => () => {
      this.commit();
      this.move(rows, cols, false);
    };
    switch (event.key) {
      case "Escape":
        return () => this.cancel();
      case "Enter":
        // It stays where it is: the picture must show the posture that was changed.
        return wide ? null : then(0, 0);
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
    const { row, col } = this.sheet.active.peek();
    const table = this.sheet.table.peek()!;
    const [lastRow, lastCol] = [table.rows.length - 1, LEVELS.length * table.legs.length - 1];
    const turn = (sign: number) => () =>
      turnCells(this.sheet, sign * (extend ? FINE_DEG : NUDGE_DEG));
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
        return () => clearCells(this.sheet, t("design.step.clear"));
      case "a":
      case "A":
        return wide
          ? () => this.sheet.select({ row: 0, col: 0 }, { row: lastRow, col: lastCol })
          : null;
      default:
        return null;
    }
  }

  private move(rows: number, cols: number, extend: boolean): void {
    const { row, col } = this.sheet.active.peek();
    this.go({ row: row + rows, col: col + cols }, extend);
  }

  private go(place: Place, extend: boolean): void {
    this.sheet.select(place, extend ? this.sheet.anchor.peek() : place);
  }
}

/** Turn the selected angles; edits in a row with the same gesture are one step. */
export function turnCells(sheet: Sheet, byDeg: number, gesture: string | null = null): void {
  const area = sheet.area.peek();
  sheet.edit(t("design.step.turn"), (now) => nudge(now, area, byDeg), gesture);
}

/** Empty the selected cells, or cut them. */
export function clearCells(sheet: Sheet, name: string): void {
  const area = sheet.area.peek();
  sheet.edit(name, (now) => clear(now, area));
}
