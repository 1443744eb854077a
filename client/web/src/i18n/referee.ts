/** Messages of this part: English, Japanese. */
export const referee = {
  "referee.title": ["referee", "referee"],
} as const satisfies Record<string, readonly [string, string]>;
