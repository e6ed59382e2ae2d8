/** The runs of a page: one, or two beside each other or one over the other; which of them is looked at more closely. */

import type { Playback } from "./playback";
import type { View } from "./view";

export class Stage {
  shown: View;
  overlaid = false;

  constructor(
    readonly views: View[],
    readonly playback: Playback,
  ) {
    this.shown = views[0];
    for (const view of views) view.attended = () => this.show(view);
    this.link(true);
  }

  /** Look at a run: its panel, and in an overlay its traffic. */
  show(view: View): void {
    if (view === this.shown) return;
    this.shown = view;
    this.arrange();
  }

  overlay(on: boolean): void {
    this.overlaid = on;
    this.arrange();
  }

  /** Move the cameras together, or each for itself. */
  link(on: boolean): void {
    const [one, other] = this.views;
    if (!other) return;
    one.camera.twin = on ? other.camera : null;
    other.camera.twin = on ? one.camera : null;
    if (on) this.shown.camera.moved();
    this.playback.changed();
  }

  get linked(): boolean {
    return this.shown.camera.twin !== null;
  }

  private arrange(): void {
    for (const view of this.views) view.ghost = this.overlaid ? (this.views.find((other) => other !== view) ?? null) : null;
    this.playback.changed();
  }
}
