/** Keyboard, mouse and touch. */

import { button, nudge, RATES, STEP } from "./transport";
import type { View } from "./view";

const WHEEL = 0.0015; // zoom for each pixel scrolled

export const KEYS: [string, string][] = [
  ["space", "play, pause"],
  ["← →", "a frame back, on (with shift: a second)"],
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
  view.camera.follow = true;
  view.camera.scale = Math.max(view.camera.scale, 5);
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

function faster(view: View, by: number): void {
  const next = RATES.indexOf(view.rate) + by;
  view.rate = RATES[Math.min(Math.max(next, 0), RATES.length - 1)];
  view.changed();
}

export function tools(view: View, dark: () => void): HTMLElement[] {
  return [
    button("+", "Zoom in (+)", () => zoom(view, 1.4)),
    button("−", "Zoom out (−)", () => zoom(view, 1 / 1.4)),
    button("Follow", "Follow the car (f)", () => follow(view)),
    button("Town", "The whole town (w)", () => wholeTown(view)),
    button("Theme", "Light or dark", dark),
  ];
}

export function keyboard(view: View): void {
  const acts: Record<string, (event: KeyboardEvent) => void> = {
    " ": () => view.play(!view.playing),
    ArrowLeft: (event) => nudge(view, event.shiftKey ? -1000 : -STEP),
    ArrowRight: (event) => nudge(view, event.shiftKey ? 1000 : STEP),
    Home: () => view.seek(view.run.begin),
    End: () => view.seek(view.run.end),
    ",": () => faster(view, -1),
    ".": () => faster(view, 1),
    n: () => change(view, 1),
    p: () => change(view, -1),
    "+": () => zoom(view, 1.4),
    "=": () => zoom(view, 1.4),
    "-": () => zoom(view, 1 / 1.4),
    f: () => follow(view),
    w: () => wholeTown(view),
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
