/** The document a page is given (src/tmpud/viewer/document.py tells its units), and how it is unpacked. */

export type Stop = [light: string, links: number[], x0: number, y0: number, x1: number, y1: number];
export type StepRow = [action: string, from: string, to: string, leg: number, path: number[]];

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
  reason: string;
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
  travel_time: number;
  replans: number;
}

export interface Document {
  schema: number;
  mission: Record<string, unknown>;
  versions: Record<string, string>;
  sizes: { ego: [number, number]; car: [number, number] };
  ground: { lanes: [number, number, number, number[]][]; junctions: number[][]; stops: Stop[] } | null;
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
  executed: { time: number; step: number; outcome: string; distance: number }[];
  judged: Judged[];
  changes: Change[];
  finished: Finished | null;
  missing: string[];
}

const SCHEMA = 2;

/** Read the document out of the page. */
export async function unpack(): Promise<Document> {
  const text = document.getElementById("run")?.textContent ?? "";
  const bytes = Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  const found = (await new Response(stream).json()) as Document;
  if (found.schema !== SCHEMA) throw new Error(`this page shows schema ${SCHEMA}, the run is of schema ${found.schema}`);
  return found;
}
