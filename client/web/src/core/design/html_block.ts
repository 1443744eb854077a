/** Reads the table in HTML that a spreadsheet put on the clipboard, without making a document. */

const TOKEN =
  /<!--[\s\S]*?(?:-->|$)|<(style|script|title)\b[\s\S]*?(?:<\/\1\s*>|$)|<[^<>]*>|[^<]+|</gi;
const SPAN = (name: string) => new RegExp(`\\b${name}\\s*=\\s*["']?(\\d+)`, "i");
const ENTITIES: Readonly<Record<string, string>> = {
  amp: "&",
  lt: "<",
  gt: ">",
  quot: '"',
  apos: "'",
  nbsp: " ",
  minus: "\u2212",
};
/** Most rows or columns of a merged cell that are read; no gait's table has so many. */
const MOST_SPAN = 200;

/** The cells of the first table; a merged cell's text is in its first place. [] without a table. */
export function htmlCells(html: string): string[][] {
  const rows: string[][] = [];
  /** For each column, how many of the next rows a merged cell above still covers. */
  const covered: number[] = [];
  let row: string[] | null = null;
  let cell: string | null = null;
  const close = () => {
    if (row && cell !== null) row[row.lastIndexOf(OPEN)] = tidy(cell);
    cell = null;
  };
  for (const [token] of html.matchAll(TOKEN)) {
    const tag = /^<(\/?)([a-z]+)/i.exec(token);
    if (!tag) {
      if (cell !== null && !/^<[!?]/.test(token)) cell += decoded(token.replace(/\s+/g, " "));
      continue;
    }
    const [isEnd, name] = [tag[1] === "/", tag[2]!.toLowerCase()];
    if (name === "br" && cell !== null) cell += "\n";
    if (name === "td" || name === "th" || name === "tr" || name === "table") close();
    if (name === "table" && isEnd && rows.length) break;
    if (name === "tr" && !isEnd) {
      row = [];
      // Excel ends a table with a hidden row that has its widths.
      if (!/display:\s*none/i.test(token)) rows.push(row);
    } else if ((name === "td" || name === "th") && !isEnd) {
      if (!row) {
        row = [];
        rows.push(row);
      }
      open(row, covered, spanOf(token, "colspan"), spanOf(token, "rowspan"));
      cell = "";
    }
  }
  close();
  return rows.filter((cells) => cells.length);
}

/** Marks the place of the cell whose text is being read. */
const OPEN = "\0";

function open(row: string[], covered: number[], columns: number, height: number): void {
  while ((covered[row.length] ?? 0) > 0) {
    covered[row.length]!--;
    row.push("");
  }
  for (let column = 0; column < columns; column++) {
    covered[row.length] = height - 1;
    row.push(column ? "" : OPEN);
  }
}

function spanOf(tag: string, name: string): number {
  const span = Number(SPAN(name).exec(tag)?.[1] ?? 1);
  return Math.min(MOST_SPAN, Math.max(1, span));
}

function tidy(text: string): string {
  return text.replace(/ *\n */g, "\n").trim();
}

function decoded(text: string): string {
  return text.replace(/&(?:#(\d+)|#x([0-9a-f]+)|([a-z]+));/gi, (whole, decimal, hex, name) => {
    if (name) return ENTITIES[name.toLowerCase()] ?? whole;
    const code = decimal ? Number(decimal) : Number.parseInt(hex, 16);
    return code <= 0x10ffff ? String.fromCodePoint(code) : whole;
  });
}
