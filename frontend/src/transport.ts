/** Playing, stepping, speed and time. */

import { el } from "./elements";
import { clock } from "./playback";
import type { Stage } from "./stage";
import { strip, Timeline } from "./timeline";

export const RATES = [0.25, 0.5, 1, 2, 4, 8, 16];
export const STEP = 100; // [ms] one frame

export function transport({ views, playback }: Stage): HTMLElement[] {
  const play = button("▶", "Play or pause (space)", () => playback.play(!playback.playing));
  play.id = "play";
  const time = el("output", { class: "clock", id: "clock" });
  const speed = el("span", { class: "speed" });
  const rates = el(
    "select",
    { id: "rate", "aria-label": "Speed", onchange: () => ((playback.rate = Number(rates.value)), playback.changed()) },
    ...RATES.map((rate) => el("option", { value: rate }, `${rate}×`)),
  );
  const { run } = views[0];
  const told = views.length === 1 && run.times.length > 0;
  playback.onChange(() => {
    const face = playback.playing ? "❚❚" : "▶";
    if (play.textContent !== face) play.textContent = face;
    time.textContent = `${clock(playback.elapsed)} / ${clock(playback.end)}`;
    if (told) speed.textContent = kmh(run.speedAt(views[0].time));
    if (rates.value !== String(playback.rate)) rates.value = String(playback.rate);
  });
  const row = el(
    "div",
    { class: "buttons" },
    button("Start", "Back to the start (Home)", () => playback.seek(0)),
    button("◂", "A frame back (left arrow)", () => playback.nudge(-STEP)),
    play,
    button("▸", "A frame on (right arrow)", () => playback.nudge(STEP)),
    rates,
    time,
    speed,
    el("span", { class: "axis" }, "Safe of each estimate, from 0 (bottom) to 1"),
  );
  return [row, ...views.map((view) => new Timeline(view).element), strip(playback)];
}

export const kmh = (speed: number): string => `${(speed * 3.6).toFixed(0)} km/h`;

export function button(face: string, title: string, act: () => void): HTMLButtonElement {
  return el("button", { type: "button", title, "aria-label": title, onclick: act }, face);
}
