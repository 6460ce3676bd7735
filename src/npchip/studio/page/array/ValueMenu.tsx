/** The menu of a value: who wrote it, stop when it changes, show it in the array. */

import type { JSX } from "preact";
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";
import { act } from "../actions";
import type { Quantity } from "../protocol";
import { heard } from "../say";
import { message } from "../store";
import { show } from "./Chooser";
import { quantityText } from "./names";
import { picture } from "./state";

/** A value that the reader has opened. */
export interface Asked {
  value: Quantity;
  name: string;
  anchor: HTMLElement;
}

/** A menu below a value, where it stays while the page scrolls; Escape, Tab or a click elsewhere closes it. */
export function ValueMenu({ asked, close }: { asked: Asked; close: () => void }): JSX.Element {
  const menu = useRef<HTMLDivElement>(null);
  const items = itemsOf(asked.value);
  useLayoutEffect(() => {
    const box = menu.current;
    if (!box) return;
    place(box, asked.anchor.getBoundingClientRect());
    box.querySelector("button")?.focus({ preventScroll: true });
  }, [asked]);
  useEffect(() => {
    // Keys that chose the value may have scrolled it into view: the event comes when the menu is open.
    const follow = (): void => {
      if (menu.current) place(menu.current, asked.anchor.getBoundingClientRect());
    };
    const outside = (event: Event): void => {
      if (!menu.current?.contains(event.target as Node)) close();
    };
    addEventListener("pointerdown", outside);
    addEventListener("scroll", follow, true);
    addEventListener("resize", follow);
    return () => {
      removeEventListener("pointerdown", outside);
      removeEventListener("scroll", follow, true);
      removeEventListener("resize", follow);
    };
  }, [asked, close]);

  const leave = (): void => {
    close();
    asked.anchor.focus();
  };
  const press = (event: KeyboardEvent): void => {
    const all = [...(menu.current?.querySelectorAll("button") ?? [])];
    const at = all.indexOf(document.activeElement as HTMLButtonElement);
    const steps: Record<string, number> = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: -1 };
    const to = steps[event.key];
    if (to !== undefined) all.at(to % all.length)?.focus();
    else if (event.key === "Escape") leave();
    else if (event.key === "Tab") return leave();
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  return (
    <div ref={menu} class="array-menu" role="menu" aria-label={asked.name} onKeyDown={press}>
      <p aria-hidden="true">{asked.name}</p>
      {items.map(({ text, chosen }) => (
        <button
          key={text}
          type="button"
          role="menuitem"
          tabIndex={-1}
          onClick={() => {
            leave();
            chosen();
          }}
        >
          {text}
        </button>
      ))}
    </div>
  );
}

function itemsOf(value: Quantity): { text: string; chosen: () => void }[] {
  const items: { text: string; chosen: () => void }[] = [
    { text: "Stop when it changes", chosen: () => heard(stopAt(value)) },
  ];
  if (value.kind === "pixel") {
    items.push({
      text: "Show the frame in the array",
      chosen: () => {
        picture.value = { kind: "frame" };
      },
    });
  }
  if (value.kind === "one") {
    const { cell } = value;
    items.push({ text: "Show it in the array", chosen: () => show(cell) });
  }
  // The activity follows from the masks: no single instruction writes it.
  const written = value.kind === "pixel" || (value.kind === "one" && value.cell.kind !== "active");
  if (written) items.unshift({ text: "Who wrote this?", chosen: () => act().whoWrote(value) });
  return items;
}

async function stopAt(value: Quantity): Promise<void> {
  const text = `${quantityText(value)} changes`;
  const wrong = await act().addCondition(text);
  message.value = wrong ? { kind: "error", text: wrong } : { kind: "info", text: `Stops when ${text}` };
}

/** Put the menu below its value, or above it if there is no room. */
function place(box: HTMLElement, anchor: DOMRect): void {
  const { offsetWidth: width, offsetHeight: height } = box;
  const below = anchor.bottom + 2;
  box.style.left = `${Math.max(4, Math.min(anchor.left, innerWidth - width - 4))}px`;
  box.style.top = `${below + height < innerHeight ? below : Math.max(4, anchor.top - height - 2)}px`;
}
