/** A part of a page that is loaded when it is shown first. */

import { signal } from "@preact/signals";
import type { ComponentType } from "preact";
import { useEffect } from "preact/hooks";

/** The part as a component; nothing is shown until it is here. */
export function later<P extends object>(load: () => Promise<ComponentType<P>>): ComponentType<P> {
  const loaded = signal<ComponentType<P> | null>(null);
  return (props: P) => {
    useEffect(() => {
      void load().then((part) => {
        loaded.value = part;
      });
    }, []);
    const Part = loaded.value;
    return Part ? <Part {...props} /> : null;
  };
}
