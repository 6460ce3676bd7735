/** The rows of a long table that are drawn. */

export const ROW_HEIGHT = 28;

/** Tables up to so many rows are drawn whole, unless they grow. */
const WHOLE = 300;
const SPARE = 10; // rows beyond the visible ones, for fast scrolling

/** Return the rows to draw, from `start` to `end` - 1, and the space above them in pixels. */
export function visibleRows(
  count: number,
  scrollTop: number,
  height: number,
  grows = false,
): { start: number; end: number; above: number } {
  if (count <= WHOLE && !grows) return { start: 0, end: count, above: 0 };
  const first = Math.floor(scrollTop / ROW_HEIGHT) - SPARE;
  const drawn = Math.ceil(height / ROW_HEIGHT) + 2 * SPARE;
  const start = Math.max(0, Math.min(first, count - drawn));
  return { start, end: Math.min(count, start + drawn), above: start * ROW_HEIGHT };
}

/** Return the row to go to from `row` with a key; null if the key does not move. */
export function rowAfterKey(
  key: string,
  row: number,
  count: number,
  height: number,
): number | null {
  const page = Math.max(1, Math.floor(height / ROW_HEIGHT) - 2);
  const moves: Record<string, number> = {
    ArrowUp: row - 1,
    ArrowDown: row + 1,
    PageUp: row - page,
    PageDown: row + page,
    Home: 0,
    End: count - 1,
  };
  const to = moves[key];
  return to === undefined ? null : Math.max(0, Math.min(count - 1, to));
}
