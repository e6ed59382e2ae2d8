/** The document a page is given (src/tmpud/viewer/document.py tells its units), and how it is unpacked. */

export type Stop = [light: string, links: number[], x0: number, y0: number, x1: number, y1: number];
export type StepRow = [action: string, from: string, path: number[]];
export type LaneRow = [id: string, edge: number, width: number, left: number, right: number, line: number[]];

/** A control is safe where c_a acceleration + c_x turning <= limit; null: every control is. */
export type Plane = [limit: number, byAcceleration: number, byTurning: number] | null;

export interface Controls {
  acceleration: [number, number]; // Delta [m/s^2]
  turning: [number, number]; // Theta [rad] or [rad/s]
  steering: boolean; // whether Theta holds steering angles, else yaw rates
  aggregate: string; // over the instants
}

export interface Plan {
  name: string;
  time: number;
  steps: number[];
  cost: (number | null)[];
  penalty: (number | null)[];
}

export interface Estimate {
  time: number;
  step: number;
  safe: number;
  worst: string | null;
  ids: string[];
  o: number[][];
  instants: number[];
  path: number[];
  planes: Plane[][]; // of each vehicle at each instant; none in logs of schema 1
  others: number[][]; // where each vehicle was predicted to be; none in logs of schema 1
}

export interface Candidate {
  steps: number[];
  role: string;
  length: number | null;
  turns: number;
  before: number | null;
  after: number | null;
  total: number | null;
}

export interface Change {
  plan: number;
  step: number | null;
  headline: string;
  words: string[];
  keep: string[];
  rows: Candidate[];
}

export interface Judged {
  time: number;
  kind: string;
  vehicle: string | null;
  rule: string;
  blame: string;
  detail: string;
}

export interface Finished {
  time: number;
  status: string;
  message: string;
  distance: number;
}

export interface Document {
  mission: Record<string, unknown>;
  versions: Record<string, string>;
  sizes: { ego: [number, number]; car: [number, number] };
  ground: { edges: [id: string, street: string][]; lanes: LaneRow[]; junctions: number[][]; stops: Stop[] } | null;
  seen: {
    times: number[];
    ego: number[][];
    cars: [string, ...[number, number[], number[], number[]][]][];
    lights: Record<string, [number, string][]>;
  };
  controls: Controls | null;
  steps: StepRow[];
  plans: Plan[];
  estimates: Estimate[];
  executed: { time: number; outcome: string }[];
  judged: Judged[];
  changes: Change[];
  finished: Finished | null;
  missing: string[];
}

/** What one of two runs did where they parted. */
export interface Side {
  time: number;
  action: string;
  from: string;
  plan: string;
  number: number; // of the plan
  road: number | null; // [m] of what is left of the plan
  penalty: number | null;
  safe: ([safe: number, adds: number | null] | null)[]; // of the first run's action and of the second's; null: not estimated
}

/** Two runs (src/tmpud/viewer/comparison.py). */
export interface Comparison {
  runs: [Document, Document];
  names: [string, string];
  notices: string[];
  parted: { alike: number; sides: [Side | null, Side | null] } | null;
}

const SCHEMA = 3;

/** Read the document out of the page: that of a run, or of two. */
export async function unpack(): Promise<Document | Comparison> {
  const text = document.getElementById("run")?.textContent ?? "";
  const bytes = Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  const found = (await new Response(stream).json()) as (Document | Comparison) & { schema: number };
  if (found.schema !== SCHEMA) throw new Error(`this page shows schema ${SCHEMA}, the run is of schema ${found.schema}`);
  return found;
}
