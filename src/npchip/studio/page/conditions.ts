/** The debugger's language as trees: conditions, and the quantities that they ask for. */

/**
 * A condition of the debugger's language, parsed by the project's own parser.
 * `places`: addresses at which it is asked; null for everywhere.
 */
export interface ConditionTree {
  text: string;
  places: number[] | null;
  test: Test | null;
  event:
    | { kind: "changes"; value: Quantity }
    | { kind: "sent"; port: number; op: Op | null; number: number | null }
    | null;
  /** Addresses of the instructions that can make it true; null for all. */
  triggers: number[] | null;
}

export type Op = "==" | "!=" | "<" | "<=" | ">" | ">=";
export type Test =
  | { kind: "compare"; value: Quantity; op: Op; number: number; quantifier: "any" | "all" | null }
  | { kind: "mask-empty" };

export interface Cell {
  kind: "register" | "flag" | "memory" | "active";
  /** Register number, `Z` or `C`, memory address; empty for the activity. */
  index: number | string;
}
export type Quantity =
  | { kind: "cell"; cell: Cell }
  | { kind: "one"; cell: Cell; row: number; column: number }
  | { kind: "pixel"; row: number; column: number }
  | { kind: "counter"; name: string };
