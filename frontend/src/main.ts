/** Puts the page together and keeps it moving. */

import { caption } from "./caption";
import { unpack } from "./document";
import { el } from "./elements";
import { box } from "./ground";
import { keyboard, pointers, tools, wholeTown } from "./input";
import { setDark } from "./palette";
import { panel } from "./panel";
import { points, Run } from "./run";
import { Scene } from "./scene";
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
  const run = new Run(await unpack());
  const view = new View(run);
  const canvas = document.getElementById("scene") as HTMLCanvasElement;
  const scene = new Scene(canvas, view);
  document.title = `${run.doc.mission.start} → ${run.doc.mission.goal}: tmpud replay`;
  document.getElementById("panel")?.append(...panel(view));
  document.getElementById("transport")?.append(...transport(view));
  document.getElementById("tools")?.append(...tools(view, () => dark(view)));
  caption(view, document.getElementById("moment") as HTMLElement);
  keyboard(view);
  pointers(canvas, view);
  new ResizeObserver(() => {
    scene.resize();
    view.changed();
  }).observe(canvas);
  darkness.addEventListener("change", () => dark(view, darkness.matches));
  scene.resize();
  firstLook(view);
  animate(view, scene);
  document.documentElement.dataset.ready = "yes";
}

/** See all plans at first; without any, the whole town. */
function firstLook(view: View): void {
  const way = box(view.run.doc.plans.flatMap((plan) => plan.steps.flatMap((step) => points(view.run.doc.steps[step][4]))));
  wholeTown(view);
  if (way) view.camera.fit(way[0] - 60, way[1] - 60, way[2] + 60, way[3] + 60);
  view.changed();
}

function animate(view: View, scene: Scene): void {
  window.frameTimes = [];
  window.drawTimes = [];
  let stale = true;
  let before = 0;
  view.onChange(() => (stale = true));
  const tick = (now: number) => {
    const passed = now - before;
    before = now;
    if (view.playing) {
      note(window.frameTimes, passed);
      view.seek(view.time + Math.min(passed, 250) * view.rate);
      if (view.time >= view.run.end) view.play(false);
    }
    if (stale) {
      stale = false;
      const began = performance.now();
      scene.draw();
      if (view.playing) note(window.drawTimes, performance.now() - began);
    }
    requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);
}

function note(times: number[], value: number): void {
  times.push(value);
  if (times.length > KEPT) times.shift();
}

/** Change to dark colours or back, or to what the system has changed to. */
function dark(view: View, on?: boolean): void {
  setDark(on);
  view.changed();
}

main().catch((error: unknown) => {
  const words = `This replay cannot be shown: ${error instanceof Error ? error.message : String(error)}`;
  document.getElementById("panel")?.replaceChildren(el("p", { role: "alert" }, words));
  console.error(error);
});
