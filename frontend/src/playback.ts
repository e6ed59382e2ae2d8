/** The clock of a page: how far its drives are, each counted from its own start, and who wants to know. */

export class Playback {
  elapsed = 0; // [ms]
  playing = false;
  rate = 4; // simulated seconds in a second
  private readonly listeners: (() => void)[] = [];

  /** The longest of the drives lasts until ``end`` [ms]. */
  constructor(readonly end: number) {}

  /** Call back after each change of what the page shows. */
  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }

  changed(): void {
    for (const listener of this.listeners) listener();
  }

  seek(elapsed: number): void {
    this.elapsed = Math.min(Math.max(elapsed, 0), this.end);
    this.changed();
  }

  play(on: boolean): void {
    if (on && this.elapsed >= this.end) this.elapsed = 0;
    this.playing = on;
    this.changed();
  }

  nudge(by: number): void {
    this.playing = false;
    this.seek(this.elapsed + by);
  }
}

/** Time as m:ss.s. */
export function clock(elapsed: number): string {
  const tenths = Math.round(Math.max(elapsed, 0) / 100);
  const seconds = (tenths % 600) / 10;
  return `${Math.floor(tenths / 600)}:${seconds < 10 ? "0" : ""}${seconds.toFixed(1)}`;
}
