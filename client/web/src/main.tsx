/** The page's own file or its path says which page it is; each loads only what it needs. */

import { effect } from "@preact/signals";
import { type ComponentType, render } from "preact";
import { ownPage } from "./core/address";
import { palette } from "./core/colours";
import { reloadWhenServed } from "./core/reload";
import { language } from "./i18n";
import "./style.css";

const PAGES: Record<string, () => Promise<{ default: ComponentType }>> = {
  "/": () => import("./pages/home"),
  "/play": () => import("./pages/play"),
  "/practice": () => import("./pages/practice"),
  "/referee": () => import("./pages/referee"),
  "/watch": () => import("./pages/watch"),
  "/overlay": () => import("./pages/overlay"),
  "/design": () => import("./pages/design"),
  "/class": () => import("./pages/class"),
  "/contest": () => import("./pages/contest"),
  "/office": () => import("./pages/office"),
  "/enter": () => import("./pages/enter"),
  "/replay": () => import("./pages/replay"),
  "/film": () => import("./pages/film"),
};

effect(() => {
  document.documentElement.lang = language.value;
  document.documentElement.dataset.palette = palette.value;
});

addEventListener("vite:preloadError", () => void reloadWhenServed());

const path = `/${ownPage ?? location.pathname.split("/").at(-1)}`;
const { default: Page } = await (PAGES[path] ?? PAGES["/"]!)();
document.body.dataset.page = path.slice(1) || "home";
render(<Page />, document.getElementById("page")!);
