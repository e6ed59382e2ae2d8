/** Draws o_i(t): which share of the controls each vehicle leaves safe in the course of an action. */

import { svg } from "./elements";
import type { Look } from "./look";

const [WIDTH, HEIGHT] = [320, 104]; // [px]
const [LEFT, RIGHT, TOP, BOTTOM] = [30, 310, 10, 84];

/** The curves of all vehicles, that of the chosen one thick, its chosen instant marked; a click chooses an instant. */
export function curve({ estimate, vehicle, instant }: Look, choose: (instant: number) => void): SVGElement {
  const last = estimate.instants[estimate.instants.length - 1] || 1;
  const x = (t: number) => LEFT + (estimate.instants[t] / last) * (RIGHT - LEFT);
  const y = (value: number) => BOTTOM - value * (BOTTOM - TOP);
  const points = (o: number[]) => o.map((value, t) => `${x(t).toFixed(1)},${y(value).toFixed(1)}`).join(" ");
  const line = (o: number[], i: number) =>
    svg("polyline", { points: points(o), class: i === vehicle ? "o chosen" : "o" }, svg("title", {}, estimate.ids[i]));
  const others = estimate.o.map((o, i) => (i === vehicle ? null : line(o, i)));
  const text = (at: number, below: number, words: string, anchor: string) =>
    svg("text", { x: at, y: below, "text-anchor": anchor }, words);
  const made = svg(
    "svg",
    {
      viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
      class: "chart curve",
      role: "img",
      "aria-label": `The share of controls that stay safe beside ${estimate.ids[vehicle]}, from now to ${(last / 1000).toFixed(1)} s on`,
      onclick: (event) => choose(nearest(made, event as MouseEvent, estimate.instants.map((_, t) => x(t)))),
    },
    ...[0, 1].map((value) => svg("line", { x1: LEFT, x2: RIGHT, y1: y(value), y2: y(value), class: "grid" })),
    text(LEFT - 5, y(1) + 4, "1", "end"),
    text(LEFT - 5, y(0) + 4, "0", "end"),
    text(LEFT, HEIGHT - 4, "now", "middle"),
    text(RIGHT, HEIGHT - 4, `+${(last / 1000).toFixed(0)} s`, "end"),
    svg("line", { x1: x(instant), x2: x(instant), y1: TOP, y2: BOTTOM, class: "instant-line" }),
    ...others,
    line(estimate.o[vehicle], vehicle),
    svg("circle", { cx: x(instant), cy: y(estimate.o[vehicle][instant] ?? 0), r: 5, class: "instant-dot" }),
  );
  return made;
}

/** The instant nearest to where the curve was clicked. */
function nearest(drawn: SVGElement, event: MouseEvent, places: number[]): number {
  const box = drawn.getBoundingClientRect();
  const at = ((event.clientX - box.left) / box.width) * WIDTH;
  return places.reduce((best, place, t) => (Math.abs(place - at) < Math.abs(places[best] - at) ? t : best), 0);
}
