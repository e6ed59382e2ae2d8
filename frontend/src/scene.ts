/** Draws the scene: the town, its lights, the traffic, the car, and its plan. */

import { trace } from "./ground";
import { Labels, type Letter, SHOWN_FOR } from "./labels";
import type { Look } from "./look";
import { type Theme, planColour, theme } from "./palette";
import { type Pose, points } from "./run";
import { names } from "./streets";
import { lights, town } from "./townscape";
import { driven, ghost, traffic } from "./vehicles";
import type { View } from "./view";

export class Scene {
  private readonly ctx: CanvasRenderingContext2D;
  private readonly paths: [number, number][][]; // of each action
  private colours: Theme = theme();
  private ratio = 1;
  private letters: Letter[] = [];

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly view: View,
  ) {
    const ctx = canvas.getContext("2d", { alpha: false });
    if (!ctx) throw new Error("this browser has no canvas");
    this.ctx = ctx;
    this.paths = view.run.doc.steps.map(([, , path]) => points(path));
  }

  /** Take over the size of the canvas on the page. */
  resize(): void {
    const { camera } = this.view;
    const box = this.canvas.getBoundingClientRect();
    this.ratio = Math.min(window.devicePixelRatio || 1, 2);
    camera.width = Math.max(box.width, 1);
    camera.height = Math.max(box.height, 1);
    this.canvas.width = Math.round(camera.width * this.ratio);
    this.canvas.height = Math.round(camera.height * this.ratio);
  }

  draw(): void {
    const { view, ctx } = this;
    const { camera, run, time } = view;
    this.colours = theme();
    const ego = run.egoAt(time);
    if (camera.follow && ego) [camera.x, camera.y] = [ego.x, ego.y];
    ctx.setTransform(1, 0, 0, 1, 0, 0);
    ctx.fillStyle = this.colours.land;
    ctx.fillRect(0, 0, this.canvas.width, this.canvas.height);
    camera.apply(ctx, this.ratio);
    town(ctx, view, this.colours);
    ctx.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    names(ctx, view, this.colours);
    camera.apply(ctx, this.ratio);
    this.plans(ego);
    driven(ctx, run, time, this.colours.driven, Math.max(0.25, 1.5 / camera.scale));
    lights(ctx, view);
    const look = this.pointedAt();
    if (look) this.motion(look);
    traffic(ctx, view, this.colours, look?.estimate.worst ?? null);
    if (view.ghost) ghost(ctx, view.ghost, camera, this.colours);
    ctx.setTransform(this.ratio, 0, 0, this.ratio, 0, 0); // CSS pixels from here on
    new Labels(ctx, view, this.colours).draw(ego, look, this.paths, this.letters);
  }

  /** The estimate to point at: one that was asked for, or of this moment where it found a risk. */
  private pointedAt(): Look | null {
    const { view } = this;
    const look = view.look();
    if (!look) return null;
    const { time, instants, safe } = look.estimate;
    const asked = view.isChosen(look) && Math.abs(time - view.time) < SHOWN_FOR;
    const risk = safe < 1 && view.time <= time + instants[instants.length - 1];
    return asked || risk ? look : null;
  }

  /** The plan in force ahead of the car; the one given up, dashed, while the change is explained. */
  private plans(ego: Pose | null): void {
    this.letters = [];
    const { run, time, change, hovered } = this.view;
    const number = run.planAt(time);
    const plan = run.doc.plans[number];
    const opened = change === null ? null : run.doc.changes[change];
    const near = opened && Math.abs(run.doc.plans[opened.plan].time - time) < SHOWN_FOR;
    if (opened && near) {
      for (const row of opened.rows.filter((one) => one.role)) {
        const chosen = row.role === "chosen";
        const one = chosen ? opened.plan : opened.plan - 1;
        const line = this.way(row.steps, planColour(one), chosen ? 1.0 : 0.7, !chosen, null);
        this.letter(line, one, chosen ? 0.7 : 0.35);
      }
    } else if (plan) {
      const rest = plan.steps.slice(run.drivenOf(plan, time));
      this.letter(this.way(rest, planColour(number), 1.0, false, ego), number, 0.6);
    }
    if (hovered) this.way(hovered, this.colours.ink, 0.5, true, null);
  }

  private way(steps: number[], colour: string, width: number, dashed: boolean, from: Pose | null): [number, number][] {
    const { ctx, view } = this;
    const line = this.ahead(steps.flatMap((step) => this.paths[step] ?? []), from);
    const path = new Path2D();
    trace(path, line, false);
    ctx.globalAlpha = 0.8;
    ctx.strokeStyle = colour;
    ctx.lineWidth = Math.max(width, (4 * width) / view.camera.scale);
    ctx.lineJoin = "round";
    ctx.setLineDash(dashed ? [ctx.lineWidth * 2.5, ctx.lineWidth * 2] : []);
    ctx.stroke(path);
    ctx.setLineDash([]);
    ctx.globalAlpha = 1;
    return line;
  }

  /** Note where on its line a plan's letter goes: some share of the way along what of it is in view. */
  private letter(line: [number, number][], plan: number, share: number): void {
    const { camera, run } = this.view;
    const seen = evenly(line, 20 / camera.scale)
      .map(([x, y]) => camera.screen(x, y))
      .filter(([px, py]) => px > 20 && py > 50 && px < camera.width - 20 && py < camera.height - 20);
    const place = seen[Math.floor(share * seen.length)];
    if (place) this.letters.push({ place, name: run.doc.plans[plan].name, colour: planColour(plan) });
  }

  /** What of a line lies ahead of a pose, near its beginning. */
  private ahead(line: [number, number][], from: Pose | null): [number, number][] {
    if (!from || !line.length) return line;
    let best = 0;
    let travelled = 0;
    let least = Infinity;
    for (let i = 0; i < line.length && travelled < 200; i++) {
      const away = Math.hypot(line[i][0] - from.x, line[i][1] - from.y);
      if (away < least) [least, best] = [away, i];
      if (i + 1 < line.length) travelled += Math.hypot(line[i + 1][0] - line[i][0], line[i + 1][1] - line[i][1]);
    }
    return [[from.x, from.y], ...line.slice(best + 1)];
  }

  /** The motion that an estimate judged and that it predicted of a vehicle, a dot for each instant. */
  private motion({ estimate, vehicle, instant }: Look): void {
    const { ctx } = this;
    const least = Math.max(0.3, 1.5 / this.view.camera.scale);
    const [ours, theirs] = [points(estimate.path), points(estimate.others[vehicle] ?? [])];
    ctx.fillStyle = ctx.strokeStyle = this.colours.risk;
    for (const path of [ours, theirs]) {
      path.forEach(([x, y], t) => {
        ctx.beginPath();
        ctx.arc(x, y, t === instant ? 2.5 * least : least, 0, 2 * Math.PI);
        ctx.fill();
      });
    }
    const [from, to] = [ours[instant], theirs[instant]];
    if (!from || !to) return;
    ctx.lineWidth = 0.7 * least;
    ctx.beginPath();
    ctx.moveTo(...from);
    ctx.lineTo(...to);
    ctx.stroke();
  }
}

/** Points along a line, some metres apart. */
function evenly(line: [number, number][], spacing: number): [number, number][] {
  const found: [number, number][] = [];
  for (let i = 0; i + 1 < line.length; i++) {
    const [[x0, y0], [x1, y1]] = [line[i], line[i + 1]];
    const pieces = Math.max(1, Math.round(Math.hypot(x1 - x0, y1 - y0) / spacing));
    for (let k = 0; k < pieces; k++) found.push([x0 + ((x1 - x0) * k) / pieces, y0 + ((y1 - y0) * k) / pieces]);
  }
  return found;
}
