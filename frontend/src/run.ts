/** A run in memory: where everything was at any moment, and what was known then. */

import type { Document, Estimate, Plan } from "./document";
import { clock } from "./playback";

export interface Pose {
  x: number; // [m]
  y: number;
  heading: number; // [rad]
}

interface Track {
  x: Float64Array;
  y: Float64Array;
  heading: Float64Array;
}

interface Stretch extends Track {
  first: number; // the number of its first frame
}

interface Car {
  id: string;
  stretches: Stretch[];
}

/** Where a moment lies between two frames. */
interface Between {
  frame: number;
  share: number; // of the way to the next frame
}

const LONGEST_GAP = 300; // [ms] frames further apart have nothing in between
const LONGEST_MOVE = 6; // [m] within 0.1 s; what moved further was put there

export class Run {
  readonly times: Float64Array; // [ms] of the frames
  readonly begin: number; // [ms]
  readonly end: number;
  readonly speeds: Float64Array; // [m/s] of the ego
  readonly ego: Track;
  readonly cars: Car[];
  private readonly driven: Float64Array; // [m] until each frame
  private readonly lights: Map<string, [number, string][]>;

  constructor(readonly doc: Document) {
    const { seen } = doc;
    this.times = sums(seen.times);
    this.ego = track(seen.ego);
    this.speeds = sums(seen.ego[3] ?? []).map((speed) => speed / 100);
    const moves = this.ego.x.map((x, i) => (i ? Math.hypot(x - this.ego.x[i - 1], this.ego.y[i] - this.ego.y[i - 1]) : 0));
    this.driven = sums(moves);
    this.cars = seen.cars.map(([id, ...rows]) => ({
      id,
      stretches: rows.map(([first, ...columns]) => ({ first, ...track(columns) })),
    }));
    this.lights = new Map(Object.entries(seen.lights));
    const moments = [...doc.plans, ...doc.estimates, ...doc.executed, ...doc.judged].map((event) => event.time);
    if (doc.finished) moments.push(doc.finished.time);
    if (this.times.length) moments.push(this.times[0], this.times[this.times.length - 1]);
    this.begin = moments.reduce((least, time) => Math.min(least, time), moments[0] ?? 0);
    this.end = moments.reduce((most, time) => Math.max(most, time), this.begin + 100);
  }

  /** The frame at or before a moment, and how far it is to the next. */
  between(time: number): Between {
    const { times } = this;
    let low = 0;
    let high = times.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (times[middle] <= time) low = middle;
      else high = middle - 1;
    }
    const gap = (times[low + 1] ?? times[low]) - times[low];
    const share = gap > 0 && gap <= LONGEST_GAP ? Math.min(Math.max((time - times[low]) / gap, 0), 1) : 0;
    return { frame: low, share };
  }

  egoAt(time: number): Pose | null {
    return this.times.length ? pose(this.ego, this.between(time)) : null;
  }

  speedAt(time: number): number {
    return this.speeds[this.between(time).frame] ?? 0;
  }

  /** Visit all other vehicles that were seen at a moment. */
  eachCar(time: number, visit: (id: string, pose: Pose) => void): void {
    const at = this.between(time);
    for (const car of this.cars) {
      for (const stretch of car.stretches) {
        const frame = at.frame - stretch.first;
        if (frame >= 0 && frame < stretch.x.length) visit(car.id, pose(stretch, { frame, share: at.share }));
      }
    }
  }

  carAt(id: string | null, time: number): Pose | null {
    let found: Pose | null = null;
    if (id !== null) this.eachCar(time, (name, where) => (found = name === id ? where : found));
    return found;
  }

  /** What a light shows, one letter for each link. */
  lettersAt(light: string, frame: number): string {
    let letters = "";
    for (const [since, shown] of this.lights.get(light) ?? []) {
      if (since > frame) break;
      letters = shown;
    }
    return letters;
  }

  /** The number of the plan in force; of several made at one moment the last. */
  planAt(time: number): number {
    let number = 0;
    this.doc.plans.forEach((plan, index) => (number = plan.time <= time + 0.5 ? index : number));
    return number;
  }

  /** How many actions of a plan were driven by a moment. */
  drivenOf(plan: Plan, time: number): number {
    const until = this.doc.plans[this.doc.plans.indexOf(plan) + 1]?.time ?? Infinity;
    const driven = (event: { time: number; outcome: string }) =>
      event.outcome === "done" && event.time > plan.time && event.time <= Math.min(time + 0.5, until);
    return Math.min(this.doc.executed.filter(driven).length, plan.steps.length);
  }

  /** The estimate that led to a plan: the one before it whose action was refused. */
  estimateBehind(change: { plan: number; step: number | null }): Estimate | null {
    const time = this.doc.plans[change.plan]?.time;
    const fits = this.doc.estimates.filter((e) => e.time === time && e.step === change.step);
    return fits[fits.length - 1] ?? null;
  }

  /** How far the car has driven [m]. */
  distanceAt(time: number): number {
    const { finished } = this.doc;
    return finished && time >= finished.time - 0.5 ? finished.distance : (this.driven[this.between(time).frame] ?? 0);
  }

  /** Where it was driven from, and to. */
  route(named = (place: string) => place): string {
    const { start, via, goal } = this.doc.mission;
    return [start, ...(Array.isArray(via) ? via : []), goal].map((place) => named(String(place))).join(" → ");
  }

  /** Time since the drive began, as m:ss.s. */
  clock(time: number): string {
    return clock(time - this.begin);
  }
}

/** Points [m] of a line stored as a first point and steps in centimetres. */
export function points(line: number[]): [number, number][] {
  const found: [number, number][] = [];
  let x = 0;
  let y = 0;
  for (let i = 0; i + 1 < line.length; i += 2) {
    x += line[i];
    y += line[i + 1];
    found.push([x / 100, y / 100]);
  }
  return found;
}

function sums(differences: ArrayLike<number>): Float64Array {
  const values = Float64Array.from(differences);
  for (let i = 1; i < values.length; i++) values[i] += values[i - 1];
  return values;
}

function track(columns: number[][]): Track {
  const [x, y, heading] = columns;
  return {
    x: sums(sums(x ?? [])).map((value) => value / 100),
    y: sums(sums(y ?? [])).map((value) => value / 100),
    heading: sums(heading ?? []).map((value) => value / 1000),
  };
}

function pose(of: Track, { frame, share }: Between): Pose {
  const here = { x: of.x[frame], y: of.y[frame], heading: of.heading[frame] };
  if (share === 0 || frame + 1 >= of.x.length) return here;
  const dx = of.x[frame + 1] - here.x;
  const dy = of.y[frame + 1] - here.y;
  if (Math.hypot(dx, dy) > LONGEST_MOVE) return here;
  const turn = of.heading[frame + 1] - here.heading;
  const shortest = Math.atan2(Math.sin(turn), Math.cos(turn));
  return { x: here.x + share * dx, y: here.y + share * dy, heading: here.heading + share * shortest };
}
