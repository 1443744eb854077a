/** The court's English sentences in Japanese: patterns with holes, the first that fits. */

const PATTERNS: readonly (readonly [string, string])[] = [];

const COMPILED = PATTERNS.map(
  ([english, japanese]) =>
    [
      new RegExp(
        `^${english.replace(/[.*+?^$()|[\]\\]/g, "\\$&").replace(/\{\w+\}/g, "(.+?)")}$`,
        "s",
      ),
      japanese,
    ] as const,
);

/** A sentence in Japanese; as it is where none of the patterns fits. */
export function toJapanese(text: string): string {
  for (const [pattern, japanese] of COMPILED) {
    const found = pattern.exec(text);
    if (found) {
      let hole = 0;
      return japanese.replace(/\{\w+\}/g, () => toJapanese(found[++hole] ?? ""));
    }
  }
  return text;
}
