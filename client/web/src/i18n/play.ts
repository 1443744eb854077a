/** Messages of this part: English, Japanese. */
export const play = {
  "play.title": ["play", "play"],
} as const satisfies Record<string, readonly [string, string]>;
