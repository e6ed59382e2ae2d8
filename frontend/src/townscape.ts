/** The town itself: roads, their markings, and what the lights show. */

import type { Theme } from "./palette";
import type { View } from "./view";

export function town(ctx: CanvasRenderingContext2D, view: View, colours: Theme): void {
  const { ground, camera } = view;
  ctx.fillStyle = colours.junction;
  ctx.fill(ground.junctions);
  ctx.fillStyle = colours.road;
  ctx.fill(ground.roads);
  if (camera.scale < 0.8) return;
  ctx.strokeStyle = colours.marking;
  ctx.lineWidth = Math.max(0.15, 0.8 / camera.scale);
  ctx.stroke(ground.edges);
  ctx.setLineDash([3, 6]);
  ctx.stroke(ground.dashes);
  ctx.setLineDash([]);
}

/** Stop lines: red is thick, yellow dashed, green thin, so that colour is not all that tells them apart. */
export function lights(ctx: CanvasRenderingContext2D, view: View): void {
  const { ground, run, time, camera } = view;
  if (camera.scale < 0.8) return;
  const { frame } = run.between(time);
  for (const { light, links, from, to } of ground.stops) {
    const letters = run.lettersAt(light, frame);
    const shown = links.map((link) => letters[link] ?? "");
    const [colour, width, dash] = look(shown);
    ctx.strokeStyle = colour;
    ctx.lineWidth = Math.max(width, (2.5 * width) / camera.scale);
    ctx.setLineDash(dash);
    ctx.beginPath();
    ctx.moveTo(...from);
    ctx.lineTo(...to);
    ctx.stroke();
  }
  ctx.setLineDash([]);
}

/** Colour, width [m] and dashes [m] of a stop line whose links show some letters. */
function look(letters: string[]): [string, number, number[]] {
  const has = (wanted: string) => letters.some((letter) => wanted.includes(letter) && letter !== "");
  if (has("Gg")) return ["#009e73", 0.35, []];
  if (has("yYu")) return ["#e69f00", 0.8, [0.7, 0.5]];
  if (has("rR")) return ["#d0021b", 0.9, []];
  return ["#808080", 0.3, []];
}
