/** Why a plan was changed: words, the plans to choose from, what would have kept the old one. */

import type { Candidate, Change } from "./document";
import { badge, el, metres } from "./elements";
import { planColour } from "./palette";
import { ACTIONS, ARROWS } from "./plan";
import type { View } from "./view";

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
    ...(estimate?.ids.length ? [toSafety()] : []),
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
      cell("road", metres(row.length)),
      ...(turns ? [cell("turns", metres(row.turns))] : []),
      cell("penalty before", metres(row.before)),
      cell("penalty after", row.after === null ? "barred" : metres(row.after), rise ? "risen" : ""),
      cell("total", el("b", {}, metres(row.total))),
    );
  });
  const head = el("tr", {}, ...heads.map((text, i) => el("th", { class: i > 1 ? "number" : "" }, text)));
  const caption = "The plans it could choose from, the cheapest first, before and after the estimate (point at a row to see it on the map)";
  return el("div", { class: "wide" }, el("table", { class: "plans" }, el("caption", {}, caption), el("thead", {}, head), el("tbody", {}, ...body)));
}

/** A number; where the window is narrow it stands below its name instead of in a column. */
function cell(name: string, value: HTMLElement | string, kind = ""): HTMLElement {
  return el("td", { class: `number ${kind}`, "data-name": name }, value);
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

/** Leads to the panel that shows the estimate behind the change. */
function toSafety(): HTMLElement {
  const go = () => {
    document.getElementById("safety")?.scrollIntoView({ block: "start" });
    document.getElementById("vehicle")?.focus({ preventScroll: true });
  };
  return el("button", { type: "button", class: "to-safety", onclick: go }, "Which controls would have been safe?");
}
