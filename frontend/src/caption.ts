/** One line over the scene: what the car is doing, and what has just happened. */

import { badge, el, metres } from "./elements";
import { blamed, kindOf } from "./judged";
import { planColour } from "./palette";
import { ACTIONS } from "./plan";
import { kmh } from "./transport";
import type { View } from "./view";

const FRESH = 6000; // [ms] for which an event is told

export function caption(view: View, place: HTMLElement): void {
  let shown = "";
  const numbers = el("span", { class: "numbers" });
  view.onChange(() => {
    if (view.name !== null) numbers.replaceChildren(measured(view), ...(view.ghost ? [ghostly(view.ghost)] : []));
    const [words, number] = told(view);
    if (words === shown) return;
    shown = words;
    const plan = view.run.doc.plans[number];
    const name = view.name === null ? [] : [el("span", { class: "who" }, view.name)];
    place.replaceChildren(...name, ...(plan ? [badge(plan.name, planColour(number))] : []), words, ...(name.length ? [numbers] : []));
  });
}

/** How far a run is, beside another. */
function measured({ run, time }: View): string {
  const unsafe = run.doc.judged.filter((event) => event.time <= time + 0.5).length;
  return `${metres(run.distanceAt(time))} driven, ${kmh(run.speedAt(time))}, unsafe: ${unsafe}`;
}

function ghostly(ghost: View): HTMLElement {
  const { run, time, name } = ghost;
  const ended = run.doc.finished && time >= run.doc.finished.time - 0.5 ? `, ${run.doc.finished.status}` : "";
  return el("span", { class: "ghostly" }, `${name} (ghost): ${measured(ghost)}${ended}`);
}

/** The words of a moment, and the number of the plan they are about. */
function told({ run, time }: View): [string, number] {
  const { doc } = run;
  const number = run.planAt(time);
  const plan = doc.plans[number];
  const fresh = (then: number) => time - then >= -0.5 && time - then < FRESH;
  const judged = doc.judged.find((event) => fresh(event.time));
  if (doc.finished && time >= doc.finished.time - 0.5) return [`the end: ${doc.finished.status}`, number];
  if (judged) return [`judged: ${kindOf(judged)}, ${blamed(judged)}`, number];
  if (!plan) return ["no plan", number];
  const change = doc.changes.find((one) => one.plan === number);
  if (change && fresh(plan.time)) return [`takes the place of plan ${doc.plans[number - 1].name}: ${change.headline}`, number];
  const [now, next] = plan.steps.slice(run.drivenOf(plan, time)).map((step) => doc.steps[step][0]);
  if (!now) return ["driven to its end", number];
  return [`now ${ACTIONS[now] ?? now}${next ? `, then ${ACTIONS[next] ?? next}` : ", then there"}`, number];
}
