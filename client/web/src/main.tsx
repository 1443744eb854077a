/** The path says which page; each loads only what it needs. */

import { effect } from "@preact/signals";
import { type ComponentType, render } from "preact";
import { language } from "./i18n";
import "./style.css";

const PAGES: Record<string, () => Promise<{ default: ComponentType }>> = {
  "/": () => import("./pages/home"),
  "/play": () => import("./pages/play"),
  "/practice": () => import("./pages/practice"),
  "/referee": () => import("./pages/referee"),
  "/watch": () => import("./pages/watch"),
  "/overlay": () => import("./pages/overlay"),
  "/replay": () => import("./pages/replay"),
};

effect(() => {
  document.documentElement.lang = language.value;
});

// After the server was updated a part of the old page can't be loaded any more: take the new page,
// but wait, or a server that is down would be asked without end.
const RELOAD_MS = 3000;
addEventListener("vite:preloadError", () => setTimeout(() => location.reload(), RELOAD_MS));

const path = location.pathname.replace(/\/+$/, "") || "/";
const { default: Page } = await (PAGES[path] ?? PAGES["/"]!)();
document.body.dataset.page = path.slice(1) || "home";
render(<Page />, document.getElementById("page")!);
