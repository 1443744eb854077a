/** Messages of this part: English, Japanese. */
export const watch = {
  "watch.title": ["watch", "watch"],
} as const satisfies Record<string, readonly [string, string]>;
