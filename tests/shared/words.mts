// Reads cases as JSON lines, [phrase, language], and answers with one rendered text a line.
import { readdirSync, readFileSync } from "node:fs";
import { createInterface } from "node:readline";
import { render, type Words } from "../../client/web/src/i18n/render.ts";

const TEXTS = new URL("../../client/web/src/i18n/texts/", import.meta.url);

function wordsOf(language: string): Words {
  const folder = new URL(`${language}/`, TEXTS);
  const files = readdirSync(folder).map((name) => readFileSync(new URL(name, folder), "utf-8"));
  // What pages write otherwise than programs.
  const programs = { "number.minus": "-" };
  return Object.assign({}, ...files.map((text) => JSON.parse(text)), programs);
}

const words: Record<string, Words> = { en: wordsOf("en"), ja: wordsOf("ja") };
for await (const line of createInterface({ input: process.stdin })) {
  const [phrase, language] = JSON.parse(line);
  console.log(JSON.stringify(render(phrase, words[language])));
}
