/** How safe is it: the controls that an estimate found to be safe beside a vehicle, at an instant and over all of them. */

import { curve } from "./curve";
import type { Estimate } from "./document";
import { el } from "./elements";
import { horizonMap, instantMap } from "./heatmap";
import { leastOf, type Look, telling } from "./look";
import { ACTIONS } from "./plan";
import type { Run } from "./run";
import { button } from "./transport";
import type { View } from "./view";

export function safety(view: View): HTMLElement | null {
  const { run } = view;
  if (!telling(run).length) return null;
  const choose = (vehicle: number, instant: number) => {
    const look = view.look();
    if (look) view.choose({ ...look, vehicle, instant });
  };
  const vehicles = el("select", { id: "vehicle", onchange: () => choose(Number(vehicles.value), least(view, Number(vehicles.value))) });
  const instants = el("input", {
    type: "range",
    id: "instant",
    class: "instant",
    min: 0,
    step: 1,
    oninput: () => choose(view.look()?.vehicle ?? 0, Number(instants.value)),
  });
  const heading = el("p", { class: "estimate" });
  const why = el("p", { id: "because" });
  const graph = el("div");
  const maps = el("div", { class: "maps" });
  const share = el("p", { id: "share" });
  const inside = el(
    "div",
    {},
    why,
    el("label", { class: "field" }, "Beside ", vehicles),
    el("figure", {}, graph, el("figcaption", {}, "o(t): the share of its controls that the car may choose at each instant (click one); thin: the other vehicles.")),
    el("label", { class: "field" }, "At ", instants),
    share,
    maps,
  );
  const turn = (by: number) => () => step(view, by);
  const steps = el("div", { class: "buttons" }, button("◂ earlier", "The estimate before", turn(-1)), button("later ▸", "The next estimate", turn(1)), heading);
  let shown: Look | null = null;
  view.onChange(() => {
    const look = view.look();
    heading.textContent = look ? told(run, look.estimate) : "No vehicle was near yet.";
    inside.hidden = !look;
    if (!look || same(look, shown)) return;
    if (look.estimate !== shown?.estimate) vehicles.replaceChildren(...options(run, look.estimate));
    shown = look;
    vehicles.value = String(look.vehicle);
    instants.max = String(look.estimate.instants.length - 1);
    instants.value = String(look.instant);
    instants.setAttribute("aria-valuetext", after(look));
    why.replaceChildren(...because(run, look));
    share.replaceChildren(...shares(look));
    graph.replaceChildren(curve(look, (instant) => choose(look.vehicle, instant)));
    maps.replaceChildren(...pictures(run, look));
  });
  return el("section", { id: "safety" }, el("h2", {}, "How safe is it?"), steps, inside);
}

function least(view: View, vehicle: number): number {
  const look = view.look();
  return look ? leastOf(look.estimate, vehicle) : 0;
}

function same(one: Look, other: Look | null): boolean {
  return one.estimate === other?.estimate && one.vehicle === other.vehicle && one.instant === other.instant;
}

/** Go to the estimate before or after the one that is looked at. */
function step(view: View, by: number): void {
  const all = telling(view.run);
  const look = view.look();
  const next = all[look ? all.indexOf(look.estimate) + by : 0];
  if (next) view.judge(next);
}

function told(run: Run, { time, step: number, safe }: Estimate): string {
  const action = run.doc.steps[number][0];
  return `${run.clock(time)}: ${ACTIONS[action] ?? action}, Safe = ${safe.toFixed(2)}`;
}

function options(run: Run, estimate: Estimate): HTMLElement[] {
  const order = estimate.ids.map((_, i) => i).sort((a, b) => ofVehicle(run, estimate, a).value - ofVehicle(run, estimate, b).value);
  return order.map((i) => {
    const worst = estimate.ids[i] === estimate.worst ? " (sets Safe)" : "";
    return el("option", { value: i }, `${estimate.ids[i]}: ${ofVehicle(run, estimate, i).value.toFixed(2)}${worst}`);
  });
}

/** What a vehicle's o(t) comes to over the horizon (Algorithm 1, line 7). */
function ofVehicle(run: Run, estimate: Estimate, vehicle: number): { value: number; mean: number; extreme: number; best: boolean } {
  const o = estimate.o[vehicle];
  const best = run.doc.controls?.aggregate === "max+mean";
  const mean = o.reduce((sum, value) => sum + value, 0) / o.length;
  const extreme = best ? Math.max(...o) : Math.min(...o);
  return { value: (mean + extreme) / 2, mean, extreme, best };
}

/** Why Safe is what it is, or what it would be beside another vehicle. */
function because(run: Run, { estimate, vehicle }: Look): (HTMLElement | string)[] {
  const { value, mean, extreme, best } = ofVehicle(run, estimate, vehicle);
  const id = estimate.ids[vehicle];
  const worst = id === estimate.worst;
  const last = (estimate.instants[estimate.instants.length - 1] / 1000).toFixed(1);
  const means = `(${mean.toFixed(3)} + ${extreme.toFixed(3)}) / 2 = ${value.toFixed(3)}`;
  const name = worst ? `Safe is set by ${id}, the worst of ${estimate.ids.length}` : `${id} does not set Safe, ${estimate.worst} does`;
  const words = `${name}: over the ${last} s of the action ${percent(mean)} of the controls stay safe beside ${id} on average and ${percent(extreme)} at the ${best ? "best" : "worst"} instant, which makes `;
  return [words, el("span", { class: "sum" }, `${means}.`)];
}

function shares(look: Look): (HTMLElement | string)[] {
  const o = look.estimate.o[look.vehicle][look.instant];
  return [`${after(look)} after the estimate ${percent(o)} of the controls are safe: `, el("b", {}, `o = ${o.toFixed(3)}`)];
}

function pictures(run: Run, { estimate, vehicle, instant }: Look): HTMLElement[] {
  const { controls } = run.doc;
  const planes = estimate.planes[vehicle];
  if (!controls || !planes) return [el("p", {}, "This log does not tell which controls were safe: it is of schema 1.")];
  const id = estimate.ids[vehicle];
  const o = percent(estimate.o[vehicle][instant]);
  const now = `Each point is a control the car could choose; the shaded ones, ${o}, do not bring it into danger beside ${id}.`;
  const all = `At how many of the ${planes.length} instants each control is safe: the deeper the blue, the more; the line is that of the chosen instant.`;
  return [
    el("figure", {}, instantMap(controls, planes[instant], now), el("figcaption", {}, now)),
    el("figure", {}, horizonMap(controls, planes, instant, all), scale(planes.length), el("figcaption", {}, all)),
  ];
}

/** What the shades mean. */
function scale(count: number): HTMLElement {
  const shades = [0, 0.25, 0.5, 0.75, 1].map((share) => {
    const shade = el("span", { class: "shade" });
    shade.style.opacity = String(share);
    return el("span", { class: "swatch" }, shade);
  });
  return el("p", { class: "scale" }, "never", ...shades, `at all ${count}`);
}

const percent = (share: number): string => `${(100 * share).toFixed(share > 0 && share < 0.1 ? 1 : 0)} %`;

const after = ({ estimate, instant }: Look): string => `${((estimate.instants[instant] ?? 0) / 1000).toFixed(2)} s`;
