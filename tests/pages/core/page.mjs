// Lets Node load the pages' modules like a browser: "./words" is words.ts, and `location` is set.

import { registerHooks } from "node:module";

registerHooks({
  resolve(name, context, next) {
    const isOurs = name.startsWith(".") && context.parentURL.includes("/client/web/src/");
    return next(isOurs && !name.endsWith(".ts") ? `${name}.ts` : name, context);
  },
});
globalThis.location = new URL("http://127.0.0.1/play?lang=en");
