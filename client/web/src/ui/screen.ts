/** Facts about the screen that a page is on. */

import { signal, useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";

const upright = matchMedia("(max-width: 760px)");

/** A phone held upright: parts stand below one another. */
export const isNarrow = signal(upright.matches);
upright.addEventListener("change", () => {
  isNarrow.value = upright.matches;
});

const fine = matchMedia("(hover: hover) and (pointer: fine)");

/** Where a mouse is, a keyboard is likely; fingers alone have none. */
export const hasKeyboard = signal(fine.matches);
fine.addEventListener("change", () => {
  hasKeyboard.value = fine.matches;
});

/**
 * Keep a CSS property of the page as high as an element: others make room for it.
 *
 * @param tell Is told the height too [px].
 */
export function tellHeight(
  property: `--${string}`,
  element: HTMLElement | null,
  tell?: (px: number) => void,
): void {
  keepHeight(element, (px) => {
    document.documentElement.style.setProperty(property, `${px}px`);
    tell?.(px);
  });
}

/** Tell how high an element is [px], now and whenever that changes. */
export function keepHeight(element: HTMLElement | null, tell: (px: number) => void): void {
  if (!element) return;
  new ResizeObserver(([seen], observer) => {
    if (!element.isConnected) observer.disconnect();
    tell(Math.ceil(seen?.borderBoxSize[0]?.blockSize ?? element.offsetHeight));
  }).observe(element);
}

/** Whether a media query holds; the component is drawn again when that changes. */
export function useMedia(query: MediaQueryList): boolean {
  const holds = useSignal(query.matches);
  useEffect(() => {
    const look = () => {
      holds.value = query.matches;
    };
    query.addEventListener("change", look);
    return () => query.removeEventListener("change", look);
  }, [query, holds]);
  return holds.value;
}

/** Fill the screen, or come back from it; a browser may refuse. */
export function toggleFullscreen(): void {
  const change = document.fullscreenElement
    ? document.exitFullscreen()
    : document.documentElement.requestFullscreen();
  change.catch(() => undefined);
}
