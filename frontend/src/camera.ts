/** What part of the town is seen. */

const NEAREST = 60; // [px/m]
const FURTHEST = 0.05;

export class Camera {
  x = 0; // [m] the middle of the view
  y = 0;
  scale = 1; // [px/m]
  follow = true;
  width = 1; // [px]
  height = 1;
  twin: Camera | null = null; // moved with this one

  /** Show a rectangle [m] whole. */
  fit(left: number, bottom: number, right: number, top: number): void {
    this.x = (left + right) / 2;
    this.y = (bottom + top) / 2;
    this.scale = this.bounded(0.94 * Math.min(this.width / (right - left), this.height / (top - bottom)));
    this.moved();
  }

  /** Zoom such that the point under (px, py) stays where it is. */
  zoom(factor: number, px = this.width / 2, py = this.height / 2): void {
    const [x, y] = this.ground(px, py);
    this.scale = this.bounded(this.scale * factor);
    const [x1, y1] = this.ground(px, py);
    if (!this.follow) [this.x, this.y] = [this.x + x - x1, this.y + y - y1];
    this.moved();
  }

  /** Follow the car, at least so close [px/m]. */
  track(least: number): void {
    this.follow = true;
    this.scale = Math.max(this.scale, least);
    this.moved();
  }

  pan(dx: number, dy: number): void {
    this.follow = false;
    this.x -= dx / this.scale;
    this.y += dy / this.scale;
    this.moved();
  }

  ground(px: number, py: number): [number, number] {
    return [this.x + (px - this.width / 2) / this.scale, this.y - (py - this.height / 2) / this.scale];
  }

  screen(x: number, y: number): [number, number] {
    return [(x - this.x) * this.scale + this.width / 2, (this.y - y) * this.scale + this.height / 2];
  }

  /** Draw in metres from now on, y upwards. */
  apply(ctx: CanvasRenderingContext2D, ratio: number): void {
    const k = this.scale * ratio;
    ctx.setTransform(k, 0, 0, -k, ratio * (this.width / 2 - this.x * this.scale), ratio * (this.height / 2 + this.y * this.scale));
  }

  /** Let the twin see the same, or follow its own car just as near. */
  moved(): void {
    const { x, y, scale, follow } = this;
    if (this.twin) Object.assign(this.twin, { x, y, scale, follow });
  }

  private bounded(scale: number): number {
    return Math.min(Math.max(Number.isFinite(scale) ? scale : 1, FURTHEST), NEAREST);
  }
}
