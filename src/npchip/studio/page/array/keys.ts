/** The keys that move through a grid, the same in each of these panels. */

/** Return where a key leads from a cell, or null if it moves nothing. */
export function moved(
  key: string,
  control: boolean,
  row: number,
  column: number,
  rows: number,
  cols: number,
): { row: number; column: number } | null {
  const jump = Math.max(1, Math.floor(rows / 2));
  const places: Record<string, [number, number]> = {
    ArrowUp: [row - 1, column],
    ArrowDown: [row + 1, column],
    ArrowLeft: [row, column - 1],
    ArrowRight: [row, column + 1],
    PageUp: [row - jump, column],
    PageDown: [row + jump, column],
    Home: [control ? 0 : row, 0],
    End: [control ? rows - 1 : row, cols - 1],
  };
  const place = places[key];
  return place ? { row: within(place[0], rows), column: within(place[1], cols) } : null;
}

function within(place: number, count: number): number {
  return Math.min(Math.max(place, 0), count - 1);
}
