// Reads cases as JSON lines, [phrase, language], and answers with one rendered text a line.
import { createInterface } from "node:readline";
import { render } from "../../client/web/src/i18n/render.ts";

for await (const line of createInterface({ input: process.stdin })) {
  const [phrase, language] = JSON.parse(line);
  console.log(JSON.stringify(render(phrase, language)));
}
