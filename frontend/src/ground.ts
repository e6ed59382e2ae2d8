/** The town as paths in metres, made once. */

import type { Document, Stop } from "./document";
import { points } from "./run";
import { type Sign, signs } from "./streets";

export interface Ground {
  roads: Path2D;
  junctions: Path2D;
  edges: Path2D;
  dashes: Path2D;
  stops: { light: string; links: number[]; from: [number, number]; to: [number, number] }[];
  box: [left: number, bottom: number, right: number, top: number] | null;
  lanes: { id: string; edge: string; half: number; line: Line }[]; // half the width [m], the middle
  streets: Map<string, string>; // what the street of a road or a lane is called
  names: Sign[];
  ids: Sign[];
}

export type Line = [number, number][];

export function build(doc: Document): Ground {
  const made: Ground = {
    roads: new Path2D(),
    junctions: new Path2D(),
    edges: new Path2D(),
    dashes: new Path2D(),
    stops: (doc.ground?.stops ?? []).map(stop),
    box: null,
    lanes: [],
    streets: new Map(),
    names: [],
    ids: [],
  };
  const seen: Line = [];
  for (const shape of doc.ground?.junctions ?? []) trace(made.junctions, points(shape), true);
  for (const [id, edge, width, left, right, line] of doc.ground?.lanes ?? []) {
    const centre = points(line);
    const leftSide = beside(centre, width / 200);
    const rightSide = beside(centre, -width / 200);
    trace(made.roads, [...leftSide, ...rightSide.slice().reverse()], true);
    trace(left ? made.dashes : made.edges, leftSide, false);
    if (!right) trace(made.edges, rightSide, false);
    seen.push(...leftSide, ...rightSide);
    const [road, street] = doc.ground?.edges[edge] ?? ["", ""];
    made.lanes.push({ id, edge: road, half: width / 200, line: centre });
    if (!left && street) made.names.push(...signs(street, leftSide));
    if (!right) made.ids.push(...signs(road, rightSide));
    if (street) made.streets.set(road, street).set(id, street);
  }
  made.box = box(seen);
  return made;
}

/** The smallest rectangle around some points, null where there are none. */
export function box(of: Line): Ground["box"] {
  if (!of.length) return null;
  const found: [number, number, number, number] = [Infinity, Infinity, -Infinity, -Infinity];
  for (const [x, y] of of) {
    found[0] = Math.min(found[0], x);
    found[1] = Math.min(found[1], y);
    found[2] = Math.max(found[2], x);
    found[3] = Math.max(found[3], y);
  }
  return found;
}

export function trace(path: Path2D, line: Line, closed: boolean): void {
  line.forEach(([x, y], i) => (i ? path.lineTo(x, y) : path.moveTo(x, y)));
  if (closed) path.closePath();
}

function stop([light, links, x0, y0, x1, y1]: Stop): Ground["stops"][number] {
  return { light, links, from: [x0 / 100, y0 / 100], to: [x1 / 100, y1 / 100] };
}

/** A line to the left of another one (to the right where the offset is negative) [m]. */
function beside(line: Line, offset: number): Line {
  return line.map(([x, y], i) => {
    const [ax, ay] = line[Math.max(i - 1, 0)];
    const [bx, by] = line[Math.min(i + 1, line.length - 1)];
    const length = Math.hypot(bx - ax, by - ay) || 1;
    return [x - (offset * (by - ay)) / length, y + (offset * (bx - ax)) / length];
  });
}
