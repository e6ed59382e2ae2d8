/** Puts the page together and keeps it moving. */

import { comparison } from "./comparison";
import { type Comparison, type Document, unpack } from "./document";
import { el } from "./elements";
import { box, build } from "./ground";
import { keyboard, tools, wholeTown } from "./input";
import { setDark } from "./palette";
import { type Pane, pane } from "./pane";
import { panel } from "./panel";
import { Playback } from "./playback";
import { points, Run } from "./run";
import { Stage } from "./stage";
import { transport } from "./transport";
import { View } from "./view";

declare global {
  interface Window {
    frameTimes: number[]; // [ms] between the pictures while the run plays, the latest KEPT of them
    drawTimes: number[]; // [ms] that drawing each of them took
  }
}

const KEPT = 2000;

async function main(): Promise<void> {
  const darkness = matchMedia("(prefers-color-scheme: dark)");
  setDark(darkness.matches);
  const found = await unpack();
  const two = "runs" in found ? found : null;
  const stage = staged(two ? two.runs : [found as Document], two);
  const { playback, views } = stage;
  const panes = views.map((view) => pane(stage, view));
  const dark = (on?: boolean) => {
    setDark(on);
    playback.changed();
  };
  document.title = `${two ? two.names.join(" and ") : views[0].run.route()}: tmpud replay`;
  part("scenes").append(...panes.map(({ element }) => element));
  part("panel").append(...(two ? comparison(stage, two) : panel(views[0])));
  part("transport").append(...transport(stage));
  part("tools").append(...tools(stage, () => dark()));
  keyboard(stage);
  const observer = new ResizeObserver(() => {
    for (const { resize } of panes) resize();
    playback.changed();
  });
  for (const { element, resize } of panes) {
    resize();
    observer.observe(element);
  }
  darkness.addEventListener("change", () => dark(darkness.matches));
  firstLook(stage);
  animate(playback, panes);
  document.documentElement.dataset.ready = "yes";
}

function staged(documents: Document[], two: Comparison | null): Stage {
  const runs = documents.map((one) => new Run(one));
  const playback = new Playback(Math.max(...runs.map((run) => run.end - run.begin)));
  const ground = build(documents.find((one) => one.ground) ?? documents[0]);
  return new Stage(
    runs.map((run, i) => new View(run, playback, ground, two ? two.names[i] : null)),
    playback,
  );
}

function part(id: string): HTMLElement {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page lacks its part ${id}`);
  return found;
}

/** See all plans at first; without any, the whole town. */
function firstLook({ views, playback }: Stage): void {
  const steps = (view: View) => view.run.doc.plans.flatMap((plan) => plan.steps.flatMap((step) => points(view.run.doc.steps[step][2])));
  const way = box(views.flatMap(steps));
  wholeTown(views[0]);
  if (way) views[0].camera.fit(way[0] - 60, way[1] - 60, way[2] + 60, way[3] + 60);
  playback.changed();
}

function animate(playback: Playback, panes: Pane[]): void {
  window.frameTimes = [];
  window.drawTimes = [];
  let stale = true;
  let before = 0;
  playback.onChange(() => (stale = true));
  const tick = (now: number) => {
    const passed = now - before;
    before = now;
    if (playback.playing) {
      note(window.frameTimes, passed);
      playback.seek(playback.elapsed + Math.min(passed, 250) * playback.rate);
      if (playback.elapsed >= playback.end) playback.play(false);
    }
    if (stale) {
      stale = false;
      const began = performance.now();
      for (const { draw } of panes) draw();
      if (playback.playing) note(window.drawTimes, performance.now() - began);
    }
    requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);
}

function note(times: number[], value: number): void {
  times.push(value);
  if (times.length > KEPT) times.shift();
}

main().catch((error: unknown) => {
  const words = `This replay cannot be shown: ${error instanceof Error ? error.message : String(error)}`;
  document.getElementById("panel")?.replaceChildren(el("p", { role: "alert" }, words));
  console.error(error);
});
