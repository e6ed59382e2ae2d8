/** The safe control sets of an estimate, from their half-planes (src/tmpud/safety/control_set.py). */

import type { Controls, Plane } from "./document";

export type Control = [turn: number, acceleration: number];

const PIECES = 24; // of an edge, since a straight cut of tangents is a curve over angles

/** What a control turns by: the yaw rate, or the tangent of the steering angle. */
const effect = (controls: Controls, turn: number): number => (controls.steering ? Math.tan(turn) : turn);

export function isSafe(plane: Plane, controls: Controls, [turn, acceleration]: Control): boolean {
  return plane === null || plane[1] * acceleration + plane[2] * effect(controls, turn) <= plane[0];
}

/** The safe part of Delta x Theta, and the line that cuts it off; both empty where there is none. */
export function safePart(plane: Plane, controls: Controls): { part: Control[]; cut: Control[] } {
  const [low, high] = controls.turning.map((turn) => effect(controls, turn));
  const [least, most] = controls.acceleration;
  const corners: Control[] = [[low, least], [high, least], [high, most], [low, most]];
  const { part, cut } = plane === null ? { part: corners, cut: [] } : clip(corners, plane);
  return { part: over(controls, part, true), cut: over(controls, cut, false) };
}

/** Clip a polygon (Sutherland and Hodgman); the cut runs between the points where its edges cross the line. */
function clip(corners: Control[], [limit, byAcceleration, byTurning]: NonNullable<Plane>): { part: Control[]; cut: Control[] } {
  const room = ([x, a]: Control) => limit - byAcceleration * a - byTurning * x;
  const part: Control[] = [];
  const cut: Control[] = [];
  corners.forEach((from, i) => {
    const to = corners[(i + 1) % corners.length];
    const [here, there] = [room(from), room(to)];
    if (here >= 0) part.push(from);
    if (here >= 0 === there >= 0) return;
    const share = here / (here - there);
    const crossing: Control = [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])];
    part.push(crossing);
    cut.push(crossing);
  });
  return { part, cut };
}

/** Points of a line in terms of what controls do, as the controls themselves. */
function over(controls: Controls, line: Control[], closed: boolean): Control[] {
  const turn = (x: number) => (controls.steering ? Math.atan(x) : x);
  const found: Control[] = [];
  line.forEach(([x, a], i) => {
    const next = line[i + 1] ?? (closed ? line[0] : null);
    for (let k = 0; k < (next ? PIECES : 1); k++) {
      const share = k / PIECES;
      found.push(next ? [turn(x + share * (next[0] - x)), a + share * (next[1] - a)] : [turn(x), a]);
    }
  });
  return found;
}

/** At how many instants a control is safe. */
export function timesSafe(planes: Plane[], controls: Controls, control: Control): number {
  return planes.reduce((count, plane) => count + (isSafe(plane, controls, control) ? 1 : 0), 0);
}
