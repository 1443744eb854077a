// Tests of the clipboard (client/web/src/core/design/clipboard.ts, html_block.ts).

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  isWholeSheet,
  paste,
  readBlock,
  writeBlock,
} from "../../../client/web/src/core/design/clipboard.ts";
import * as t from "../../../client/web/src/core/design/table.ts";
import { chanceOf, sample, walking } from "./design_sample.mjs";

const area = (top, left, bottom = top, right = left) => ({ top, left, bottom, right });

/** How each spreadsheet program puts a block of cells on the clipboard. */
const WAYS = {
  "this page": (cells) => [writeBlock(cells)],
  "CR LF at the end of rows": (cells) => [
    cells.map((row) => `${row.map(quoted).join("\t")}\r\n`).join(""),
  ],
  "LF at the end of rows": (cells) => [
    cells.map((row) => `${row.map(quoted).join("\t")}\n`).join(""),
  ],
  "LF between rows": (cells) => [`${cells.map((row) => row.map(quoted).join("\t")).join("\n")}`],
  "CR at the end of rows": (cells) => [
    cells.map((row) => `${row.map(quoted).join("\t")}\r`).join(""),
  ],
  "text beside LibreOffice's HTML": (cells) => [writeBlock(cells), libreOffice([["wrong"]])],
  "LibreOffice's HTML": (cells) => ["", libreOffice(cells)],
  "Excel's HTML": (cells) => ["", excel(cells)],
};

const quoted = (cell) => (/[\t\r\n"]/.test(cell) ? `"${cell.replaceAll('"', '""')}"` : cell);
const escaped = (cell) =>
  cell
    .replaceAll("&", "&amp;")
    .replaceAll("<", "&lt;")
    .replaceAll(">", "&gt;")
    .replaceAll("\n", "<br>");

function libreOffice(cells) {
  const rows = cells.map((row) => {
    const tds = row.map((cell) => {
      const value = t.numberOf(cell);
      const attributes =
        value === null ? 'align="left"' : `align="right" sdval="${value}" sdnum="1031;"`;
      return `<td height="17" ${attributes}><font face="Liberation Sans">${escaped(cell) || "<br>"}</font></td>\n\t\t`;
    });
    return `\t<tr>\n\t\t${tds.join("")}</tr>\n`;
  });
  return `<!DOCTYPE html>\n<html>\n<head>\n<meta http-equiv="content-type" content="text/html; charset=utf-8"/>
<style type="text/css">\n\t\tbody,td { font-family:"Liberation Sans"; font-size:x-small }\n</style>\n</head>
<body>\n<table cellspacing="0" border="0">\n\t<colgroup span="3" width="85"></colgroup>\n${rows.join("")}</table>\n</body>\n</html>`;
}

function excel(cells) {
  const rows = cells.map((row, index) => {
    const tds = row.map((cell) => {
      const inside = /^[\w.,+-]*$/.test(cell)
        ? escaped(cell)
        : `<span style='mso-spacerun:yes'>${escaped(cell)}</span>`;
      return `<td height=20 class=xl65 align=right style='height:15.0pt;width:48pt'>${inside || "&nbsp;"}</td>\r\n  `;
    });
    return ` <tr height=20 style='mso-height-source:userset'>\r\n  ${index ? "" : "<!--StartFragment-->"}${tds.join("")}</tr>\r\n`;
  });
  return `<html xmlns:v="urn:schemas-microsoft-com:vml" xmlns:x="urn:schemas-microsoft-com:office:excel">
<head><style>\r\n<!--table\r\n\t{mso-displayed-decimal-separator:"\\,";}\r\ntd {padding:0px;}\r\n-->\r\n</style></head>
<body link=blue vlink=purple>\r\n<table border=0 cellpadding=0 style='border-collapse:\r\n collapse'>\r\n <col width=64 span=2>
${rows.join("")}<!--EndFragment--><![if supportMisalignedColumns]><tr height=0 style='display:none'><td width=64 style='width:48pt'></td></tr><![endif]></table></body></html>`;
}

/** The forms in which spreadsheets show an angle. */
const SHOWN = [
  (angle) => String(angle),
  (angle) => String(angle).replace(".", ","),
  (angle) => String(angle).replace("-", "\u2212"),
  (angle) => String(angle).replace(/./g, (c) => String.fromCodePoint(c.codePointAt(0) + 0xfee0)),
  (angle) => (angle > 0 ? `+${angle}` : String(angle)),
];
const REMARKS = [
  "",
  "1 Key",
  'a "quoted" word',
  "two\nlines",
  "a < b & c",
  "姿勢",
  '"',
  "L,F",
  "=A1",
];

test("10,000 blocks in the forms of all spreadsheets are read without loss", () => {
  const chance = chanceOf(7);
  const below = (count) => Math.floor(chance() * count);
  const ways = Object.entries(WAYS);
  for (let count = 0; count < 10000; count++) {
    const [height, width] = [1 + below(4), 1 + below(5)];
    const angles = Array.from({ length: height }, () =>
      Array.from({ length: width }, () => (below(3001) - 1500) / 10),
    );
    const [name, way] = ways[count % ways.length];
    const shown = SHOWN[below(SHOWN.length)];
    const cells = angles.map((row) => row.map(shown));
    const at = area(below(9 - height), below(18 - width));
    const pasted = paste(sample, at, readBlock(...way(cells)));
    assert.ok(pasted.table, `${name}: ${JSON.stringify(cells)} ${JSON.stringify(pasted.bad)}`);
    assert.deepEqual(t.cellsOf(pasted.table, pasted.area), angles, name);
    // Remarks between the numbers are also read unchanged. They have no spaces at their ends,
    // because HTML removes such spaces.
    const mixed = cells.map((row) => row.map((cell) => (below(3) ? cell : REMARKS[below(9)])));
    if (name === "LF between rows") mixed.at(-1)[0] ||= "x";
    assert.deepEqual(readBlock(...way(mixed)), mixed, name);
  }
});

test("text and HTML of a clipboard are read as cells", () => {
  const cases = [
    ["", "", []],
    ["", "<p>no table</p>", []],
    ["5", "", [["5"]]],
    ["\r\n", "", [[""]]],
    [
      "1\t2\r\n3\r\n",
      "",
      [
        ["1", "2"],
        ["3", ""],
      ],
    ],
    ["1\t\r\n", "", [["1", ""]]],
    ["1\t", "", [["1", ""]]],
    ["\uFEFF1\t2", "", [["1", "2"]]],
    ['5" long\tb', "", [['5" long', "b"]]],
    ['"open\tb', "", [['"open', "b"]]],
    ['"a" b\tc', "", [['"a" b', "c"]]],
    [
      "",
      "<table><tr><td>1<td>2<tr><td>3</table>",
      [
        ["1", "2"],
        ["3", ""],
      ],
    ],
    ["", "<TABLE><TR><TH colspan=2>a<TH>b</TR></TABLE>", [["a", "", "b"]]],
    [
      "",
      "<table><tr><td rowspan=2>a<td>b<tr><td>c</table>",
      [
        ["a", "b"],
        ["", "c"],
      ],
    ],
    ["", "<table><tr><td>two\n  words</table>", [["two words"]]],
    ["", "<table><tr></tr><tr><td>1</table>", [["1"]]],
    ["", "<table><tr><td>&#45;&#x34;5&nbsp;&lt;</table>", [["-45 <"]]],
    ["", "<table><tr><td>1</table><table><tr><td>2</table>", [["1"]]],
  ];
  for (const [plain, html, expected] of cases) {
    assert.deepEqual(readBlock(plain, html), expected, JSON.stringify([plain, html]));
  }
});

test("if one cell of a block is bad, nothing is pasted", () => {
  const pasted = paste(sample, area(1, 16), [
    ["1", "x"],
    ["200", ""],
    ["3", "4"],
  ]);
  assert.deepEqual(pasted, {
    bad: [
      { row: 1, col: 17, text: "x", why: "number" },
      { row: 2, col: 16, text: "200", why: "range" },
      { row: 2, col: 17, text: "", why: "empty" },
    ],
  });
  const beyond = paste(sample, area(8, 17), [
    ["1", "2"],
    ["3", "4"],
  ]);
  assert.deepEqual(
    beyond.bad.map(({ row, col, why }) => [row, col, why]),
    [
      [8, 18, "outside"],
      [9, 17, "outside"],
      [9, 18, "outside"],
    ],
  );
});

test("one number fills the selection, and empty edges do not count", () => {
  const filled = paste(sample, area(1, 6, 2, 8), [["33"]]);
  assert.deepEqual(t.cellsOf(filled.table, area(1, 6, 2, 8)), [
    [33, 33, 33],
    [33, 33, 33],
  ]);
  const edged = paste(sample, area(1, 6), [
    ["1", "2", ""],
    ["", "", ""],
  ]);
  assert.deepEqual(edged.area, area(1, 6, 1, 7));
  assert.equal(paste(sample, area(1, 6), [["", ""]]).table, sample);
});

test("numbers with spaces between them are read as cells of a row", () => {
  const pasted = paste(sample, area(1, 0), readBlock("1 2  -3,5\n4 5 6\n"));
  assert.deepEqual(t.cellsOf(pasted.table, pasted.area), [
    [1, 2, -3.5],
    [4, 5, 6],
  ]);
});

test("rows that begin with the name of a key are pasted into this key", () => {
  const angles = Array.from({ length: 18 }, (_, id) => String(id));
  const legend = ["ID of Joint", ...angles];
  const block = [["9 Key", ...angles], ["２ key", ...angles], legend];
  const { table, area: where } = paste(sample, area(0, 5), block);
  assert.deepEqual([table.rows.length, where], [10, area(2, 0, 9, 17)]);
  for (const row of [2, 9]) assert.deepEqual(table.rows[row].cells, angles.map(Number));
  assert.equal(table.rows[0], sample.rows[0]);
  const short = paste(sample, area(0, 0), [["1 Key", "5"]]);
  assert.deepEqual([short.bad.length, short.bad[0].col], [17, 1]);
  const long = paste(sample, area(0, 0), [["1 Key", ...angles, "5"]]);
  assert.deepEqual(
    long.bad.map(({ col, why }) => [col, why]),
    [[18, "outside"]],
  );
});

test("no number of a row without a name is left out", () => {
  const line = (name, angle) => [name, ...Array(18).fill(String(angle))];
  const block = [line("1 Key", 11), line("", 22), line("3 Key", 33)];
  assert.ok("bad" in paste(sample, area(0, 0), block));
  const legend = ["", "Root", ...Array(17).fill("")];
  assert.ok("table" in paste(sample, area(0, 0), [line("1 Key", 11), legend]));
});

test("if a key comes twice, its name is pasted as a bad cell", () => {
  const angles = Array(18).fill("1");
  const pasted = paste(sample, area(1, 0), [
    ["1 Key", ...angles],
    ["1 Key", ...angles],
  ]);
  assert.deepEqual([pasted.bad[0].text, pasted.bad[0].why], ["1 Key", "number"]);
});

test("a whole gait file is distinguished from a block of cells", () => {
  const whole = [
    "Num of Posture\t9\r\n0 Key\t45\t0\r\n",
    "num of postures\t2\n0 Key\t1",
    "\t\nNum of Posture\t1\n0 Key\t1",
    "4\t\t\n1\t\t\n45\t0\t0",
    "４\t\n１\t\n45\t0",
  ];
  const parts = ["4\n1\n1", "4", "1\t2\n3\t4", "1 Key\t5", "", "4.5\t\n1\t\n3\t3"];
  for (const text of whole) assert.ok(isWholeSheet(readBlock(text)), text);
  for (const text of parts) assert.ok(!isWholeSheet(readBlock(text)), text);
  assert.ok(!isWholeSheet(readBlock(writeBlock(walking.rows.map(({ cells }) => cells)))));
});

test("a paste that is much too large lists a thousand bad cells", () => {
  for (const piece of ["1\n", "x\t", "1 2\n", "\n"]) {
    const pasted = paste(sample, area(0, 0), readBlock(piece.repeat(20_000)));
    if (piece === "\n") assert.equal(pasted.table, sample);
    else assert.equal(pasted.bad.length, 1000, JSON.stringify(piece));
  }
});

test("megabytes are read quickly, also if quotes and tags never end", () => {
  const count = 100_000;
  const cases = { '"a\t': count + 1, '""\t': count + 1, "1\t": count + 1, '"': 1, "\r\n": 1 };
  for (const [piece, width] of Object.entries(cases)) {
    assert.equal(readBlock(piece.repeat(count))[0].length, width, JSON.stringify(piece));
  }
  assert.equal(readBlock("", "<td>".repeat(count))[0].length, count);
  for (const piece of ["<!--", "<style>", "<", "&", "&#"]) {
    assert.deepEqual(readBlock("", piece.repeat(count)), [], piece);
  }
});
