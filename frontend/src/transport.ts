/** Playing, stepping, speed and time. */

import { el } from "./elements";
import { Timeline } from "./timeline";
import type { View } from "./view";

export const RATES = [0.25, 0.5, 1, 2, 4, 8, 16];
export const STEP = 100; // [ms] one frame

export function transport(view: View): HTMLElement[] {
  const { run } = view;
  const play = button("▶", "Play or pause (space)", () => view.play(!view.playing));
  play.id = "play";
  const clock = el("output", { class: "clock", id: "clock" });
  const speed = el("span", { class: "speed" });
  const rates = el(
    "select",
    { id: "rate", "aria-label": "Speed", onchange: () => ((view.rate = Number(rates.value)), view.changed()) },
    ...RATES.map((rate) => el("option", { value: rate }, `${rate}×`)),
  );
  view.onChange(() => {
    const face = view.playing ? "❚❚" : "▶";
    if (play.textContent !== face) play.textContent = face;
    clock.textContent = `${run.clock(view.time)} / ${run.clock(run.end)}`;
    speed.textContent = run.times.length ? `${(run.speedAt(view.time) * 3.6).toFixed(0)} km/h` : "";
    if (rates.value !== String(view.rate)) rates.value = String(view.rate);
  });
  const row = el(
    "div",
    { class: "buttons" },
    button("Start", "Back to the start (Home)", () => view.seek(run.begin)),
    button("◂", "A frame back (left arrow)", () => nudge(view, -STEP)),
    play,
    button("▸", "A frame on (right arrow)", () => nudge(view, STEP)),
    rates,
    clock,
    speed,
    el("span", { class: "axis" }, "Safe of each estimate, from 0 (bottom) to 1"),
  );
  return [row, new Timeline(view).element];
}

export function nudge(view: View, by: number): void {
  view.playing = false;
  view.seek(view.time + by);
}

export function button(face: string, title: string, act: () => void): HTMLButtonElement {
  return el("button", { type: "button", title, "aria-label": title, onclick: act }, face);
}
