/** What the page shows at the moment; everything that draws reads it, and only controls change it. */

import { Camera } from "./camera";
import { build, type Ground } from "./ground";
import type { Run } from "./run";

export class View {
  readonly camera = new Camera();
  readonly ground: Ground;
  time: number; // [ms]
  playing = false;
  rate = 4; // simulated seconds in a second
  change: number | null = null; // which change of plan is being explained
  hovered: number[] | null = null; // the actions of a plan that is pointed at
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

  /** Stop a second before something happened, close to the car. */
  goTo(time: number): void {
    this.playing = false;
    this.camera.follow = true;
    this.camera.scale = Math.max(this.camera.scale, 9);
    this.seek(time - 1000);
  }

  /** Open the explanation of a change of plan, and go there. */
  explain(change: number): void {
    this.change = change;
    this.hovered = null;
    this.goTo(this.run.doc.plans[this.run.doc.changes[change].plan].time);
  }
}
