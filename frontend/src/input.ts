/** Keyboard, mouse and touch. */

import type { Stage } from "./stage";
import { laneAt } from "./streets";
import { button, RATES, STEP } from "./transport";
import type { View } from "./view";

const WHEEL = 0.0015; // zoom for each pixel scrolled

export const KEYS: [string, string][] = [
  ["space", "play, pause"],
  ["← →", "a frame back, on (with shift: a second)"],
  ["Home End", "the start, the end"],
  [", .", "slower, faster"],
  ["n p", "next, previous change of plan"],
  ["+ −", "zoom (or wheel, or two fingers)"],
  ["f", "follow the car"],
  ["w", "the whole town"],
];

export function wholeTown(view: View): void {
  const { ground, camera } = view;
  camera.follow = false;
  if (ground.box) camera.fit(...ground.box);
  view.changed();
}

export function follow(view: View): void {
  view.camera.track(5);
  view.changed();
}

function zoom(view: View, factor: number): void {
  view.camera.zoom(factor);
  view.changed();
}

function change(view: View, by: number): void {
  const count = view.run.doc.changes.length;
  if (count) view.explain(view.change === null ? (by > 0 ? 0 : count - 1) : (view.change + by + count) % count);
}

function faster({ playback }: Stage, by: number): void {
  const next = RATES.indexOf(playback.rate) + by;
  playback.rate = RATES[Math.min(Math.max(next, 0), RATES.length - 1)];
  playback.changed();
}

export function tools(stage: Stage, dark: () => void): HTMLElement[] {
  return [
    button("+", "Zoom in (+)", () => zoom(stage.shown, 1.4)),
    button("−", "Zoom out (−)", () => zoom(stage.shown, 1 / 1.4)),
    button("Follow", "Follow the car (f)", () => follow(stage.shown)),
    button("Town", "The whole town (w)", () => wholeTown(stage.shown)),
    button("Theme", "Light or dark", dark),
  ];
}

export function keyboard(stage: Stage): void {
  const { playback } = stage;
  const acts: Record<string, (event: KeyboardEvent) => void> = {
    " ": () => playback.play(!playback.playing),
    ArrowLeft: (event) => playback.nudge(event.shiftKey ? -1000 : -STEP),
    ArrowRight: (event) => playback.nudge(event.shiftKey ? 1000 : STEP),
    Home: () => playback.seek(0),
    End: () => playback.seek(playback.end),
    ",": () => faster(stage, -1),
    ".": () => faster(stage, 1),
    n: () => change(stage.shown, 1),
    p: () => change(stage.shown, -1),
    "+": () => zoom(stage.shown, 1.4),
    "=": () => zoom(stage.shown, 1.4),
    "-": () => zoom(stage.shown, 1 / 1.4),
    f: () => follow(stage.shown),
    w: () => wholeTown(stage.shown),
  };
  window.addEventListener("keydown", (event) => {
    const on = event.target as HTMLElement;
    const own = on.tagName === "SELECT" || (on.id === "instant" && event.key.length > 1) || (on.tagName === "BUTTON" && event.key === " ");
    const act = acts[event.key];
    if (!act || own || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    act(event);
  });
  // A button that was clicked with a pointer does not keep the space bar to itself.
  window.addEventListener("click", (event) => {
    const clicked = event.target instanceof Element ? event.target.closest("button") : null;
    if (event.detail > 0) clicked?.blur();
  });
}

/** Name the lane under the mouse. */
export function hovering(canvas: HTMLCanvasElement, view: View, tip: HTMLElement): void {
  canvas.addEventListener("pointermove", ({ offsetX: px, offsetY: py, buttons, pointerType }) => {
    const words = buttons || pointerType !== "mouse" ? null : laneAt(view.ground, ...view.camera.ground(px, py));
    tip.hidden = words === null;
    tip.textContent = words;
    tip.style.transform = `translate(${Math.min(px + 14, view.camera.width - 200)}px, ${py + 18}px)`;
  });
  canvas.addEventListener("pointerleave", () => (tip.hidden = true));
}

/** One pointer pans, two zoom. */
export function pointers(canvas: HTMLCanvasElement, view: View): void {
  const down = new Map<number, PointerEvent>();
  const spread = () => {
    const [a, b] = [...down.values()];
    return Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, event);
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = down.get(event.pointerId);
    if (!before) return;
    const apart = down.size === 2 ? spread() : 0;
    down.set(event.pointerId, event);
    if (down.size === 2 && apart > 0) view.camera.zoom(spread() / apart);
    else view.camera.pan(event.clientX - before.clientX, event.clientY - before.clientY);
    view.changed();
  });
  for (const name of ["pointerup", "pointercancel"] as const) {
    canvas.addEventListener(name, (event) => down.delete(event.pointerId));
  }
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const box = canvas.getBoundingClientRect();
      view.camera.zoom(Math.exp(-event.deltaY * WHEEL), event.clientX - box.left, event.clientY - box.top);
      view.changed();
    },
    { passive: false },
  );
}
