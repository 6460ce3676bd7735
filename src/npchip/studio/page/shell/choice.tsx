/**
 * A select box that is safe to look through by keyboard.
 *
 * Browsers tell of every option that an arrow key passes in a closed box. Opening each would run
 * programs and ask for the camera on the way: what keys choose counts with Enter, or once the box
 * is left. Escape takes it back.
 */

import type { ComponentChildren, JSX } from "preact";
import { useRef, useState } from "preact/hooks";
import { heard, putAway, say } from "../say";

export function Choice(props: {
  value: string;
  onChoose: (value: string) => Promise<unknown>;
  children: ComponentChildren;
}): JSX.Element {
  const box = useRef<HTMLSelectElement>(null);
  const byKey = useRef(false);
  const [held, setHeld] = useState<string | null>(null);
  const present = useRef(props.value);
  present.current = props.value;
  const choose = (value: string): void => {
    setHeld(null);
    putAway();
    // A choice that failed is not shown as if it was made.
    const chosen = props.onChoose(value).finally(() => {
      if (box.current) box.current.value = present.current;
    });
    heard(chosen);
  };
  const take = (value: string): void => {
    if (value === present.current) setHeld(null);
    else choose(value);
  };
  return (
    <select
      ref={box}
      value={held ?? props.value}
      onPointerDown={() => {
        byKey.current = false;
      }}
      onKeyDown={(event) => {
        // Space and Alt open the list, which is one choice however it is made.
        byKey.current = !event.altKey && ![" ", "Enter", "Escape", "F4"].includes(event.key);
        if (held === null) return;
        if (event.key === "Enter") take(held);
        else if (event.key === "Escape") setHeld(null);
        else return;
        event.preventDefault();
      }}
      onChange={(event) => {
        const { value, selectedOptions } = event.currentTarget;
        if (!byKey.current) return choose(value);
        setHeld(value);
        say(`Press Enter to choose ${selectedOptions[0]?.label ?? value}, Escape to leave it`);
      }}
      onBlur={() => {
        if (held !== null) take(held);
      }}
    >
      {props.children}
    </select>
  );
}
