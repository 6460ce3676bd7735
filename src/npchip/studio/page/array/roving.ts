/** One tab stop for many values; the arrow keys go from one to the next. */

import type { RefObject } from "preact";
import { useRef, useState } from "preact/hooks";
import { moved } from "./keys";

export interface Roving<E extends HTMLElement> {
  ref: RefObject<E | null>;
  onKeyDown: (event: KeyboardEvent) => void;
  /** Attributes of an item's element, in the order of the rows. */
  item: (index: number) => { tabIndex: number; "data-item": number; onFocus: () => void };
}

/** Return what makes `rows` × `cols` elements one tab stop. */
export function useRoving<E extends HTMLElement = HTMLTableSectionElement>(rows: number, cols: number): Roving<E> {
  const ref = useRef<E>(null);
  const [wanted, want] = useState(0);
  const at = Math.min(wanted, rows * cols - 1);
  return {
    ref,
    onKeyDown(event) {
      if (event.altKey || event.metaKey) return;
      const to = moved(event.key, event.ctrlKey, Math.floor(at / cols), at % cols, rows, cols);
      if (!to) return;
      event.preventDefault();
      ref.current?.querySelector<HTMLElement>(`[data-item="${to.row * cols + to.column}"]`)?.focus();
    },
    item: (index) => ({
      tabIndex: index === at ? 0 : -1,
      "data-item": index,
      onFocus: () => want(index),
    }),
  };
}
