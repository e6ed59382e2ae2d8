/** The plan in force, action by action; what the colours mean; how the run is repeated. */

import { badge, el, metres } from "./elements";
import { KEYS } from "./input";
import { planColour } from "./palette";
import type { View } from "./view";

export const ACTIONS: Record<string, string> = {
  mergeleft: "merge left",
  mergeright: "merge right",
  forward: "straight on",
  turnleft: "turn left",
  turnright: "turn right",
};

export const ARROWS: Record<string, string> = {
  mergeleft: "↖",
  mergeright: "↗",
  forward: "↑",
  turnleft: "↰",
  turnright: "↱",
};

const LEGEND: [string, string][] = [
  ["ego", "our car, and the way it drove"],
  ["car", "other vehicles"],
  ["ahead", "the plan ahead, in its plan's colour"],
  ["given-up", "a plan given up, or one pointed at"],
  ["risk", "the vehicle that limits Safe, or what was judged unsafe"],
  ["dots", "how an estimate expects our car and that vehicle to move"],
  ["red", "red light"],
  ["yellow", "yellow light"],
  ["green", "green light"],
];

export function planInForce(view: View): HTMLElement {
  const section = el("section", { id: "plan" });
  let shown = "";
  view.onChange(() => {
    const number = view.run.planAt(view.time);
    const plan = view.run.doc.plans[number];
    const driven = plan ? view.run.drivenOf(plan, view.time) : 0;
    if (shown === `${number}/${driven}`) return;
    shown = `${number}/${driven}`;
    section.replaceChildren(...rows(view, number, driven));
  });
  return section;
}

/** The street of a segment, where it has a name, and its lane. */
export function where({ ground }: View, segment: string): (HTMLElement | string)[] {
  const lane = segment.replace(/\/\d+$/, "");
  const street = ground.streets.get(lane);
  return street ? [street, " ", el("small", {}, lane)] : [lane];
}

function rows(view: View, number: number, driven: number): HTMLElement[] {
  const { run } = view;
  const plan = run.doc.plans[number];
  if (!plan) return [el("h2", {}, "No plan")];
  const sum = (values: (number | null)[]) => values.reduce<number>((total, value) => total + (value ?? 0), 0);
  const body = plan.steps.map((step, i) => {
    const [action, from] = run.doc.steps[step];
    const state = i < driven ? "done" : i === driven ? "now" : "";
    const mark = i < driven ? "✓" : i === driven ? "▶" : "";
    return el(
      "tr",
      { class: state },
      el("td", {}, mark),
      el("td", {}, `${ARROWS[action] ?? ""} ${ACTIONS[action] ?? action}`),
      el("td", { class: "where" }, ...where(view, from)),
      el("td", { class: "number" }, metres(plan.cost[i])),
      el("td", { class: "number" }, metres(plan.penalty[i])),
    );
  });
  const heads = ["", "action", "on lane", "length", "safety penalty"].map((text, i) =>
    el("th", { class: i > 2 ? "number" : "" }, text),
  );
  return [
    el("h2", {}, "The plan now: ", badge(plan.name, planColour(number))),
    el("p", {}, `${metres(sum(plan.cost))} of road + ${metres(sum(plan.penalty))} of safety penalty, made at ${run.clock(plan.time)}.`),
    el("table", {}, el("thead", {}, el("tr", {}, ...heads)), el("tbody", {}, ...body)),
  ];
}

export function legend({ name }: View): HTMLElement {
  const ghost: [string, string][] = name === null ? [] : [["ghost", "overlaid: the other run's car, and the way it drove; the traffic is that of the run looked at"]];
  const items = [...LEGEND, ...ghost].map(([kind, text]) => el("li", {}, el("span", { class: `key ${kind}` }), text));
  return el("section", { id: "legend" }, el("h2", {}, "On the map"), el("ul", {}, ...items));
}

export function keys(): HTMLElement {
  const items = KEYS.flatMap(([key, what]) => [el("dt", {}, key), el("dd", {}, what)]);
  return el("details", {}, el("summary", {}, "Keys"), el("dl", {}, ...items));
}

export function repeat({ run }: View): HTMLElement {
  const { mission, versions } = run.doc;
  const weighed = (key: string) => key !== "beta" || mission.algorithm === "threshold"; // nothing else looks at it
  const told = Object.entries(mission).filter(([key, value]) => weighed(key) && value !== null && String(value) !== "");
  const items = [...told, ...Object.entries(versions)].flatMap(([key, value]) => [
    el("dt", {}, key),
    el("dd", {}, String(value)),
  ]);
  const began = `The clock counts from ${(run.begin / 1000).toFixed(2)} s of simulated time in the log.`;
  return el("details", {}, el("summary", {}, "This run"), el("dl", {}, ...items), el("p", {}, began));
}
