/** Keys that work everywhere in the page. Those of the panels stand beside them. */

import { act } from "../actions";
import { running } from "../store";

export function listen(): void {
  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
    if (event.key === "F5") {
      event.preventDefault();
      act().run();
    } else if (event.key === "F6" && running.peek()) {
      // Else it is the browser's: with it the keyboard reaches the browser's own bars.
      event.preventDefault();
      act().pause();
    }
  });
}
