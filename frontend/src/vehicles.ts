/** Draws vehicles to scale, the way the car drove, and the car of another run as a ghost. */

import type { Camera } from "./camera";
import { type Theme } from "./palette";
import type { Pose, Run } from "./run";
import type { View } from "./view";

type Context = CanvasRenderingContext2D;
type Size = [length: number, width: number]; // [m]

/** Draw the vehicles of a run at its moment, ``risky`` in the colour of risk, and its car. */
export function traffic(ctx: Context, view: View, colours: Theme, risky: string | null): void {
  const { run, time, camera } = view;
  const { ego: own, car } = run.doc.sizes;
  run.eachCar(time, (id, pose) => body(ctx, camera, pose, car, id === risky ? colours.risk : colours.car, colours.glass, 3));
  const ego = run.egoAt(time);
  if (!ego) return;
  body(ctx, camera, ego, rimmed(camera, own), colours.egoEdge, colours.glass, 12);
  body(ctx, camera, ego, own, colours.ego, colours.glass, 10);
}

/** Draw only the car of a run and the way it drove: hollow, dashed. */
export function ghost(ctx: Context, view: View, camera: Camera, colours: Theme): void {
  const { run, time } = view;
  const ego = run.egoAt(time);
  if (!ego) return;
  ctx.setLineDash([6 / camera.scale, 4 / camera.scale]);
  driven(ctx, run, time, colours.ghost, Math.max(0.35, 2.5 / camera.scale));
  ctx.setLineDash([]);
  const { ego: own } = run.doc.sizes;
  body(ctx, camera, ego, rimmed(camera, rimmed(camera, own)), colours.ghost, colours.ghost, 14);
  body(ctx, camera, ego, own, colours.egoEdge, colours.ghost, 10);
}

export function driven(ctx: Context, run: Run, time: number, colour: string, width: number): void {
  if (!run.times.length) return;
  const { frame } = run.between(time);
  ctx.strokeStyle = colour;
  ctx.lineWidth = width;
  ctx.beginPath();
  for (let i = 0; i <= frame; i += 3) ctx.lineTo(run.ego.x[i], run.ego.y[i]);
  ctx.lineTo(run.ego.x[frame], run.ego.y[frame]);
  ctx.stroke();
}

function rimmed({ scale }: Camera, [length, width]: Size): Size {
  return [length + 4 / scale, width + 4 / scale];
}

/** A vehicle to scale, but never shorter than some pixels; the window tells where its front is. */
function body(ctx: Context, { scale }: Camera, pose: Pose, [length, width]: Size, colour: string, glass: string, least: number): void {
  const k = Math.max(1, least / scale / length);
  ctx.save();
  ctx.translate(pose.x, pose.y);
  ctx.rotate(pose.heading);
  ctx.scale(k, k);
  ctx.fillStyle = colour;
  ctx.fillRect(-length / 2, -width / 2, length, width);
  if (scale * k > 3) {
    ctx.fillStyle = glass;
    ctx.fillRect(length * 0.12, -width * 0.38, length * 0.16, width * 0.76);
  }
  ctx.restore();
}
