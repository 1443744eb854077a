/** The page's own file or its path says which page it is; each loads only what it needs. */

import { effect } from "@preact/signals";
import { type ComponentType, render } from "preact";
import { ownPage } from "./core/address";
import { palette } from "./core/colours";
import { reloadWhenServed } from "./core/reload";
import { GROUPS, type Group, language, loadWords } from "./i18n";
import "./style.css";

type Load = () => Promise<{ default: ComponentType }>;

/** The module of each page, and which words it says beside those of every page. */
const PAGES: Record<string, [Load, ...Group[]]> = {
  "/": [() => import("./pages/home")],
  "/play": [() => import("./pages/play"), "play"],
  "/practice": [
    () => import("./pages/play").then(({ Practice }) => ({ default: Practice })),
    "play",
  ],
  "/referee": [() => import("./pages/referee"), "referee"],
  "/watch": [() => import("./pages/watch"), "contest"],
  "/overlay": [() => import("./pages/overlay"), "contest"],
  "/design": [() => import("./pages/design"), "design", "leg", "play", "seldom"],
  "/class": [() => import("./pages/class"), "class", "design", "seldom"],
  "/contest": [() => import("./pages/contest"), "contest"],
  "/office": [() => import("./pages/office"), "office", "contest"],
  "/enter": [() => import("./pages/enter"), "office", "contest", "seldom"],
  "/replay": [() => import("./pages/replay"), "replay"],
  "/leg": [() => import("./pages/leg"), "leg"],
  // A picture of a film cannot wait for words, so it has all from the beginning.
  "/film": [() => import("./pages/film"), ...GROUPS],
};

effect(() => {
  document.documentElement.lang = language.value;
  document.documentElement.dataset.palette = palette.value;
});

addEventListener("vite:preloadError", () => void reloadWhenServed());

const path = `/${ownPage ?? location.pathname.split("/").at(-1)}`;
const [load, ...groups] = PAGES[path] ?? PAGES["/"]!;
const [{ default: Page }] = await Promise.all([load(), loadWords("every", ...groups)]);
document.body.dataset.page = path.slice(1) || "home";
render(<Page />, document.getElementById("page")!);
