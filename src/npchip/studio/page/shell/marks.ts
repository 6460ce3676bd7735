/** Times that are measured: `performance.getEntriesByName("npchip:…")` shows them. */

let firstPicture = false;
/** The time at which the program in the chip was edited; null once its first frame was drawn. */
let editedAt: number | null = null;

/** A program that runs was exchanged for one whose text was edited at a time. */
export function exchanged(at: number): void {
  editedAt = at;
}

/** Frames of the program in the chip have come. */
export function pictureCame(): void {
  if (!firstPicture) {
    firstPicture = true;
    performance.mark("npchip:first-picture");
  }
  if (editedAt === null) return;
  const start = editedAt;
  editedAt = null;
  // The first callback draws, the second comes when that is on the screen.
  requestAnimationFrame(() =>
    requestAnimationFrame(() => performance.measure("npchip:edit-to-result", { start })),
  );
}
