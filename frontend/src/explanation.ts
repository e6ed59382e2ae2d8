/** Why a plan was changed: words, the plans to choose from, what would have kept the old one, and Safe over time. */

import type { Candidate, Change, Estimate } from "./document";
import { badge, el, metres, svg } from "./elements";
import { planColour } from "./palette";
import { ACTIONS, ARROWS } from "./plan";
import type { View } from "./view";

const WIDTH = 320; // [px] of the chart
const HEIGHT = 90;

export function why(view: View, change: Change): HTMLElement[] {
  const { run } = view;
  const before = run.doc.plans[change.plan - 1].name;
  const keep = change.keep.length
    ? [el("p", { class: "keep" }, `It would have kept plan ${before} if`), el("ul", { class: "keep" }, ...change.keep.map((text) => el("li", {}, text)))]
    : [];
  const estimate = run.estimateBehind(change);
  return [
    ...change.words.map((text) => el("p", {}, text)),
    ...keep,
    ...(change.rows.length ? [table(view, change)] : []),
    ...(estimate?.ids.length ? [chart(estimate)] : []),
  ];
}

function table(view: View, change: Change): HTMLElement {
  const turns = change.rows.some((row) => row.turns > 0);
  const heads = ["plan", "actions", "road", ...(turns ? ["turns"] : []), "penalty before", "penalty after", "total"];
  const body = change.rows.map((row) => {
    const name = nameOf(view, change, row);
    const show = (steps: number[] | null) => () => {
      view.hovered = steps;
      view.changed();
    };
    const rise = (row.after ?? Infinity) - (row.before ?? 0) > 0.5;
    return el(
      "tr",
      { class: row.role.replace(" ", "-"), tabindex: 0, onmouseenter: show(row.steps), onfocus: show(row.steps), onmouseleave: show(null), onblur: show(null) },
      el("td", {}, name, row.role ? el("small", {}, row.role) : null),
      el("td", { class: "arrows", title: actions(view, row) }, arrows(view, row)),
      el("td", { class: "number" }, metres(row.length)),
      ...(turns ? [el("td", { class: "number" }, metres(row.turns))] : []),
      el("td", { class: "number" }, metres(row.before)),
      el("td", { class: rise ? "number risen" : "number" }, row.after === null ? "barred" : metres(row.after)),
      el("td", { class: "number" }, el("b", {}, metres(row.total))),
    );
  });
  const head = el("tr", {}, ...heads.map((text, i) => el("th", { class: i > 1 ? "number" : "" }, text)));
  const caption = "The plans it could choose from, the cheapest first, before and after the estimate (point at a row to see it on the map)";
  return el("div", { class: "wide" }, el("table", {}, el("caption", {}, caption), el("thead", {}, head), el("tbody", {}, ...body)));
}

function nameOf(view: View, change: Change, row: Candidate): HTMLElement | string {
  const number = row.role === "chosen" ? change.plan : change.plan - 1;
  return row.role ? badge(view.run.doc.plans[number].name, planColour(number)) : "";
}

/** A plan's actions as arrows, repetitions counted. */
function arrows(view: View, row: Candidate): string {
  const found: [string, number][] = [];
  for (const step of row.steps) {
    const arrow = ARROWS[view.run.doc.steps[step][0]] ?? "?";
    const last = found[found.length - 1];
    if (last?.[0] === arrow) last[1]++;
    else found.push([arrow, 1]);
  }
  return found.map(([arrow, count]) => (count > 1 ? `${arrow}×${count}` : arrow)).join(" ");
}

function actions(view: View, row: Candidate): string {
  return row.steps.map((step) => ACTIONS[view.run.doc.steps[step][0]] ?? "?").join(", ");
}

/** o_i(t): how much of its freedom each vehicle leaves the car in the course of the action. */
function chart(estimate: Estimate): HTMLElement {
  const last = estimate.instants[estimate.instants.length - 1] || 1;
  const at = (i: number, value: number) =>
    `${(30 + (estimate.instants[i] / last) * (WIDTH - 40)).toFixed(1)},${(8 + (1 - value) * (HEIGHT - 28)).toFixed(1)}`;
  const lines = estimate.ids.map((id, i) =>
    svg(
      "polyline",
      { points: estimate.o[i].map((value, t) => at(t, value)).join(" "), class: id === estimate.worst ? "o worst" : "o" },
      svg("title", {}, id),
    ),
  );
  const text = (x: number, y: number, words: string, anchor: string) => svg("text", { x, y, "text-anchor": anchor }, words);
  const axes = [
    svg("line", { x1: 30, x2: WIDTH - 10, y1: HEIGHT - 20, y2: HEIGHT - 20, class: "grid" }),
    svg("line", { x1: 30, x2: WIDTH - 10, y1: 8, y2: 8, class: "grid" }),
    text(26, 12, "1", "end"),
    text(26, HEIGHT - 17, "0", "end"),
    text(30, HEIGHT - 5, "now", "middle"),
    text(WIDTH - 10, HEIGHT - 5, `+${(last / 1000).toFixed(0)} s`, "end"),
  ];
  const words = `The share of controls that stay safe beside each vehicle during the action; the thick line is ${estimate.worst ?? "none"}.`;
  return el(
    "figure",
    {},
    svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: "chart", role: "img", "aria-label": words }, ...axes, ...lines),
    el("figcaption", {}, words),
  );
}
