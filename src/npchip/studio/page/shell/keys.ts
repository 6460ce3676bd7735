/** Keys that work everywhere in the page. Those of the panels stand beside them. */

import { act } from "../actions";

export function listen(): void {
  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
    if (event.key === "F5") {
      event.preventDefault();
      act().run();
    } else if (event.key === "F6") {
      event.preventDefault();
      act().pause();
    }
  });
}
