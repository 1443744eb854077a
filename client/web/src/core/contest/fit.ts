/** Texts in drawings, which do not break lines by themselves. Pure. */

/** Characters of full width, as in Chinese, Japanese and Korean. */
const WIDE = /[\u1100-\u115f\u2e80-\ua4cf\uac00-\ud7a3\uf900-\ufaff\ufe30-\ufe6f\uff00-\uff60]/u;
const WIDE_EM = 1;
const NARROW_EM = 0.56;

/** Cut a text that would be wider than so many em, and mark the cut. */
export function fit(text: string, mostEm: number): string {
  const points = Array.from(text);
  let width = 0;
  for (const [index, point] of points.entries()) {
    width += WIDE.test(point) ? WIDE_EM : NARROW_EM;
    if (width > mostEm) return `${points.slice(0, Math.max(1, index - 1)).join("")}…`;
  }
  return text;
}
