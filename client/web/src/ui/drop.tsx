/** Files dropped anywhere on the page: where nothing takes them, a browser would leave the page. */

import type { ReadonlySignal, Signal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useEffect } from "preact/hooks";

/**
 * Take what is dropped while this component is there.
 *
 * @param dragging Set to whether files are over the page.
 */
export function useDrop(dragging: Signal<boolean>, take: (files: readonly File[]) => void): void {
  useEffect(() => {
    const over = (event: DragEvent) => {
      if (!bringsFiles(event)) return;
      event.preventDefault();
      dragging.value = true;
    };
    const leave = (event: DragEvent) => {
      if (event.relatedTarget === null) dragging.value = false;
    };
    const drop = (event: DragEvent) => {
      if (!bringsFiles(event)) return;
      event.preventDefault();
      dragging.value = false;
      take([...(event.dataTransfer?.files ?? [])]);
    };
    addEventListener("dragover", over);
    addEventListener("dragleave", leave);
    addEventListener("drop", drop);
    return () => {
      removeEventListener("dragover", over);
      removeEventListener("dragleave", leave);
      removeEventListener("drop", drop);
    };
  }, []);
}

interface Props {
  dragging: ReadonlySignal<boolean>;
  children: ComponentChildren;
}

/** What is shown over the whole page while files are dragged over it. */
export function Dropping({ dragging, children }: Props) {
  return dragging.value ? <div class="dropping">{children}</div> : null;
}

/** False for a word that is dragged into a field. */
function bringsFiles(event: DragEvent): boolean {
  return event.dataTransfer?.types.includes("Files") ?? false;
}
