/** What is written over the scene, in pixels. */

import { blamed, kindOf } from "./judged";
import type { Look } from "./look";
import type { Theme } from "./palette";
import type { Pose } from "./run";
import type { View } from "./view";

export const SHOWN_FOR = 4000; // [ms] around an event in which the scene points at it

const LINE = 16; // [px] between two texts, at least

/** A plan's letter on its way. */
export interface Letter {
  place: [number, number]; // [px]
  name: string;
  colour: string;
}

export class Labels {
  private readonly taken: { x: number; y: number; width: number }[] = []; // by texts

  constructor(
    private readonly ctx: CanvasRenderingContext2D,
    private readonly view: View,
    private readonly colours: Theme,
  ) {}

  draw(ego: Pose | null, look: Look | null, paths: [number, number][][], letters: Letter[]): void {
    const { run, time } = this.view;
    this.ctx.lineWidth = 2;
    this.scaleBar();
    this.ends(paths, ego);
    for (const { place, name, colour } of letters) this.disc(place, name, colour);
    if (ego) {
      const [px, py] = this.view.camera.screen(ego.x, ego.y);
      const below = Math.max(20, 2.5 * this.view.camera.scale + 6);
      const name = this.view.name ?? "our car";
      this.words(name, px - 3.2 * name.length, py + below, this.colours.ego, this.colours.egoEdge);
    }
    this.ghost();
    if (look) this.judged(look);
    for (const judged of run.doc.judged) {
      const where = Math.abs(judged.time - time) < SHOWN_FOR ? run.carAt(judged.vehicle, time) ?? ego : null;
      if (where) {
        this.ring(where, this.colours.risk);
        const ahead = judged.time - time;
        const when = ahead > 50 ? `in ${(ahead / 1000).toFixed(1)} s: ` : "";
        this.tag(where, `${when}${kindOf(judged)} (${blamed(judged)})`, this.colours.risk, this.colours.paper);
      }
    }
  }

  /** Above the other run's car, since our own one's name is below it. */
  private ghost(): void {
    const { ghost, camera } = this.view;
    const where = ghost?.run.egoAt(ghost.time);
    if (!ghost || !where) return;
    const [px, py] = camera.screen(where.x, where.y);
    const name = `${ghost.name} (ghost)`;
    this.words(name, px - 3.2 * name.length, py - Math.max(14, 2.5 * camera.scale), this.colours.ghost, this.colours.egoEdge);
  }

  /** The vehicle that sets Safe, and the one that is looked at. */
  private judged({ estimate, vehicle }: Look): void {
    const { run, time } = this.view;
    const { colours } = this;
    const worst = run.carAt(estimate.worst, time);
    if (worst) {
      this.ring(worst, colours.risk);
      this.tag(worst, `${estimate.worst}: limits Safe to ${estimate.safe.toFixed(2)}`, colours.risk, colours.paper);
    }
    const id = estimate.ids[vehicle];
    const other = id === estimate.worst ? null : run.carAt(id, time);
    if (other) {
      this.ring(other, colours.ink);
      this.tag(other, `${id}: looked at`, colours.ink, colours.paper);
    }
  }

  private ends(paths: [number, number][][], ego: Pose | null): void {
    const first = this.view.run.doc.plans.find((plan) => plan.steps.length);
    if (!first) return;
    const start = paths[first.steps[0]]?.[0];
    const last = paths[first.steps[first.steps.length - 1]];
    const left = start && !(ego && Math.hypot(ego.x - start[0], ego.y - start[1]) < 20);
    if (left) this.flag(start, "start");
    if (last?.length) this.flag(last[last.length - 1], "goal");
  }

  private flag([x, y]: [number, number], text: string): void {
    const { ctx, colours } = this;
    const [px, py] = this.view.camera.screen(x, y);
    ctx.fillStyle = colours.ink;
    ctx.strokeStyle = colours.paper;
    ctx.beginPath();
    ctx.arc(px, py, 5, 0, 2 * Math.PI);
    ctx.fill();
    ctx.stroke();
    this.words(text, px + 9, py + 4, colours.ink, colours.paper);
  }

  private disc([px, py]: [number, number], name: string, colour: string): void {
    const { ctx } = this;
    ctx.fillStyle = colour;
    ctx.strokeStyle = "#fff";
    ctx.beginPath();
    ctx.arc(px, py, 10, 0, 2 * Math.PI);
    ctx.fill();
    ctx.stroke();
    ctx.font = "700 12px system-ui, sans-serif";
    ctx.fillStyle = "#fff";
    ctx.fillText(name, px - ctx.measureText(name).width / 2, py + 4);
  }

  private ring(where: Pose, colour: string): void {
    const [px, py] = this.view.camera.screen(where.x, where.y);
    this.ctx.strokeStyle = colour;
    this.ctx.beginPath();
    this.ctx.arc(px, py, Math.max(12, 4 * this.view.camera.scale), 0, 2 * Math.PI);
    this.ctx.stroke();
  }

  private tag(where: Pose, text: string, ink: string, paper: string): void {
    const [px, py] = this.view.camera.screen(where.x, where.y);
    const above = Math.max(14, 3 * this.view.camera.scale);
    this.words(text, px + above * 0.7, py - above, ink, paper);
  }

  /** Above what is written there already, and wholly inside the scene if a part of it is. */
  private words(text: string, px: number, py: number, ink: string, paper: string): void {
    const { ctx } = this;
    ctx.font = "600 12px system-ui, sans-serif";
    [px, py] = this.room(px, py, ctx.measureText(text).width);
    ctx.strokeStyle = paper;
    ctx.lineWidth = 4;
    ctx.lineJoin = "round";
    ctx.strokeText(text, px, py);
    ctx.lineWidth = 2;
    ctx.fillStyle = ink;
    ctx.fillText(text, px, py);
  }

  private room(px: number, py: number, width: number): [number, number] {
    const edge = this.view.camera.width;
    const x = px > -width && px < edge ? Math.max(4, Math.min(px, edge - width - 4)) : px;
    const hit = (y: number) => this.taken.find((box) => Math.abs(box.y - y) < LINE - 1 && x < box.x + box.width && box.x < x + width);
    let y = py;
    for (let box = hit(y); box; box = hit(y)) y = box.y - LINE;
    this.taken.push({ x, y, width });
    return [x, y];
  }

  private scaleBar(): void {
    const { ctx, colours } = this;
    const { scale, height } = this.view.camera;
    const length = [5, 10, 20, 50, 100, 200, 500, 1000].find((metres) => metres * scale > 60) ?? 2000;
    ctx.fillStyle = colours.ink;
    ctx.fillRect(14, height - 16, length * scale, 3);
    this.words(`${length} m`, 14, height - 22, colours.ink, colours.land);
  }
}
