/** What streets and roads are called: names along the middle of the street, the map's own ids beside the road close by. */

import type { Theme } from "./palette";
import type { Ground, Line } from "./ground";
import type { View } from "./view";

const APART = 130; // [px] between two signs of the same words
const CLOSE = 6; // [px/m] from which on ids are shown
const EVERY = 50; // [m] along a road

export interface Sign {
  text: string;
  x: number; // [m]
  y: number;
  angle: number; // [rad] along the road, such that it can be read
  room: number; // [m] of road
}

/** Signs along a line, one at least; ``outwards``: beside it, as far as letters are high. */
export function signs(text: string, line: Line): Sign[] {
  const lengths = line.slice(1).map(([x, y], i) => Math.hypot(x - line[i][0], y - line[i][1]));
  const room = lengths.reduce((sum, length) => sum + length, 0);
  const count = Math.max(1, Math.round(room / EVERY));
  return Array.from({ length: count }, (_, i) => ({ text, room, ...along(line, lengths, ((i + 0.5) / count) * room) }));
}

function along(line: Line, lengths: number[], at: number): { x: number; y: number; angle: number } {
  let i = 0;
  while (i < lengths.length - 1 && at > lengths[i]) at -= lengths[i++];
  const [[x0, y0], [x1, y1]] = [line[i], line[i + 1] ?? line[i]];
  const share = lengths[i] ? at / lengths[i] : 0;
  return { x: x0 + share * (x1 - x0), y: y0 + share * (y1 - y0), angle: Math.atan2(y1 - y0, x1 - x0) };
}

/** Write the signs that have room, in CSS pixels. */
export function names(ctx: CanvasRenderingContext2D, view: View, colours: Theme): void {
  const { ground, camera } = view;
  write(ctx, view, ground.names, "600 11px system-ui, sans-serif", colours.soft, colours.road, 4, true);
  if (camera.scale >= CLOSE) write(ctx, view, ground.ids, "11px system-ui, sans-serif", colours.soft, colours.land, 13, false);
}

function write(ctx: CanvasRenderingContext2D, view: View, all: Sign[], font: string, ink: string, halo: string, below: number, sparse: boolean): void {
  const { camera } = view;
  const put: [string, number, number][] = [];
  ctx.font = font;
  for (const { text, x, y, angle, room } of all) {
    const [px, py] = camera.screen(x, y);
    if (px < 0 || py < 0 || px > camera.width || py > camera.height) continue;
    const wide = ctx.measureText(text).width;
    if (wide > room * camera.scale) continue;
    if (sparse && put.some(([same, qx, qy]) => same === text && Math.hypot(px - qx, py - qy) < APART + wide)) continue;
    put.push([text, px, py]);
    const turned = Math.abs(angle) > Math.PI / 2;
    ctx.save();
    ctx.translate(px, py);
    ctx.rotate(turned ? Math.PI - angle : -angle);
    ctx.lineWidth = 4;
    ctx.lineJoin = "round";
    ctx.strokeStyle = halo;
    ctx.fillStyle = ink;
    const down = !sparse && turned ? -5 : below;
    ctx.strokeText(text, -wide / 2, down);
    ctx.fillText(text, -wide / 2, down);
    ctx.restore();
  }
}

/** The lane under a place [m], in words; null where there is none. */
export function laneAt(ground: Ground, x: number, y: number): string | null {
  for (const { id, edge, half, line } of ground.lanes) {
    if (line.some((from, i) => i + 1 < line.length && distance(from, line[i + 1], x, y) <= half)) {
      const name = ground.streets.get(edge);
      return name ? `${name}, lane ${id}` : `lane ${id}`;
    }
  }
  return null;
}

/** How far a place is from a piece of a line. */
function distance([x0, y0]: [number, number], [x1, y1]: [number, number], x: number, y: number): number {
  const [dx, dy] = [x1 - x0, y1 - y0];
  const squared = dx * dx + dy * dy || 1;
  const share = Math.min(Math.max(((x - x0) * dx + (y - y0) * dy) / squared, 0), 1);
  return Math.hypot(x - x0 - share * dx, y - y0 - share * dy);
}
