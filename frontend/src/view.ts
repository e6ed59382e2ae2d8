/** What the page shows at the moment; everything that draws reads it, and only controls change it. */

import { Camera } from "./camera";
import { build, type Ground } from "./ground";
import type { Estimate } from "./document";
import { type Look, lookAt, worstOf } from "./look";
import type { Run } from "./run";

export class View {
  readonly camera = new Camera();
  readonly ground: Ground;
  time: number; // [ms]
  playing = false;
  rate = 4; // simulated seconds in a second
  change: number | null = null; // which change of plan is being explained
  hovered: number[] | null = null; // the actions of a plan that is pointed at
  private chosen: Look | null = null; // what of an estimate was asked for
  private readonly listeners: (() => void)[] = [];

  constructor(readonly run: Run) {
    this.ground = build(run.doc);
    this.time = run.begin;
  }

  /** Call back after each change of the view. */
  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }

  changed(): void {
    for (const listener of this.listeners) listener();
  }

  seek(time: number): void {
    this.time = Math.min(Math.max(time, this.run.begin), this.run.end);
    this.changed();
  }

  play(on: boolean): void {
    if (on && this.time >= this.run.end) this.time = this.run.begin;
    this.playing = on;
    this.changed();
  }

  /** Stop at a moment, close to the car; a second before it where something happened. */
  goTo(time: number, before = 1000): void {
    this.playing = false;
    this.camera.follow = true;
    this.camera.scale = Math.max(this.camera.scale, 9);
    this.seek(time - before);
  }

  look(): Look | null {
    return lookAt(this.run, this.time, this.chosen);
  }

  /** Whether a look was asked for, and is not just the latest estimate. */
  isChosen(look: Look): boolean {
    return look === this.chosen;
  }

  choose(look: Look): void {
    this.chosen = look;
    this.changed();
  }

  /** Look at an estimate at the moment it was made. */
  judge(estimate: Estimate): void {
    this.chosen = worstOf(estimate);
    this.goTo(estimate.time, 0);
  }

  /** Open the explanation of a change of plan, and go there. */
  explain(change: number): void {
    this.change = change;
    this.hovered = null;
    const behind = this.run.estimateBehind(this.run.doc.changes[change]);
    this.chosen = behind?.ids.length ? worstOf(behind) : null;
    this.goTo(this.run.doc.plans[this.run.doc.changes[change].plan].time);
  }
}
