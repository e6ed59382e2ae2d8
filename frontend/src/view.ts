/** What the page shows of a run at the moment; everything that draws reads it, and only controls change it. */

import { Camera } from "./camera";
import type { Estimate } from "./document";
import type { Ground } from "./ground";
import { type Look, lookAt, worstOf } from "./look";
import type { Playback } from "./playback";
import type { Run } from "./run";

export class View {
  readonly camera = new Camera();
  change: number | null = null; // which change of plan is being explained
  hovered: number[] | null = null; // the actions of a plan that is pointed at
  ghost: View | null = null; // another run whose car is drawn, too
  attended: () => void = () => undefined; // called when something of this run is asked for
  private chosen: Look | null = null; // what of an estimate was asked for

  constructor(
    readonly run: Run,
    readonly playback: Playback,
    readonly ground: Ground,
    readonly name: string | null = null, // what the run is called beside another
  ) {}

  /** The moment of the run [ms]; its end where the page's clock is further. */
  get time(): number {
    return Math.min(this.run.begin + this.playback.elapsed, this.run.end);
  }

  onChange(listener: () => void): void {
    this.playback.onChange(listener);
  }

  changed(): void {
    this.playback.changed();
  }

  seek(time: number): void {
    this.playback.seek(time - this.run.begin);
  }

  /** Stop at a moment, close to the car; a second before it where something happened. */
  goTo(time: number, before = 1000): void {
    this.attended();
    this.playback.playing = false;
    this.camera.track(9);
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
