/** Messages of this part: English, Japanese. */
export const replay = {
  "replay.title": ["replay", "replay"],
} as const satisfies Record<string, readonly [string, string]>;
