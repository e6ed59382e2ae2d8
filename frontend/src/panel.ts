/** The side panel: what happened, why a plan was changed, the plan in force, and how the run is repeated. */

import { badge, el, metres } from "./elements";
import { why } from "./explanation";
import { blamed, kindOf } from "./judged";
import { planColour } from "./palette";
import { keys, legend, planInForce, repeat } from "./plan";
import { safety } from "./safety";
import type { View } from "./view";

const ENDINGS = new Map([
  ["SUCCESS", "and arrived"],
  ["COLLISION", "and collided"],
  ["STOPPED_BLOCKED", "and then stood too long"],
  ["NO_PLAN", "and then had no plan left"],
  ["TIME_LIMIT", "and ran out of time"],
]);

export function panel(view: View): HTMLElement[] {
  const { doc } = view.run;
  const missing = doc.missing.map((text) => el("li", {}, text));
  return [
    summary(view),
    missing.length ? el("section", { id: "missing", class: "notice" }, el("h2", {}, "Not shown"), el("ul", {}, ...missing)) : null,
    changes(view),
    unsafe(view),
    planInForce(view),
    safety(view),
    legend(view),
    keys(),
    repeat(view),
  ].filter((part) => part !== null);
}

/** A place of a mission with the name of its street, where it has one. */
export function named({ ground }: View, place: string): string {
  const street = ground.streets.get(place);
  return street ? `${street} (${place})` : place;
}

function summary(view: View): HTMLElement {
  const { run } = view;
  const { finished, changes, judged } = run.doc;
  const times = changes.length === 1 ? "once" : changes.length === 2 ? "twice" : `${changes.length} times`;
  const drive = finished
    ? `The car drove ${metres(finished.distance)} in ${run.clock(finished.time)} ${ENDINGS.get(finished.status) ?? `(${finished.status})`}.`
    : "The record has no end.";
  const safety = judged.length ? `Unsafe moments judged: ${judged.length}.` : "Nothing unsafe was judged.";
  const said = changes.length ? `It changed its plan ${times}.` : run.doc.plans.length ? "It kept its first plan." : "";
  const words = [drive, finished?.message ? `${finished.message}.` : "", said, safety].filter((text) => text).join(" ");
  const heading = view.name === null ? el("h1", {}, run.route((place) => named(view, place))) : null;
  return el("section", { id: "summary" }, heading, el("p", {}, words));
}

function changes(view: View): HTMLElement {
  const { run } = view;
  const list = el("ol", { class: "changes" });
  run.doc.changes.forEach((change, number) => {
    const [before, plan] = [run.doc.plans[change.plan - 1], run.doc.plans[change.plan]];
    const head = el(
      "button",
      { type: "button", class: "change", "aria-expanded": "false", onclick: () => view.explain(number) },
      el("span", { class: "when" }, run.clock(plan.time)),
      badge(before.name, planColour(change.plan - 1)),
      "→",
      badge(plan.name, planColour(change.plan)),
      el("span", { class: "headline" }, change.headline),
      el("span", { class: "more" }, "why?"),
    );
    const body = el("div", { class: "why", hidden: true });
    list.append(el("li", {}, head, body));
    view.onChange(() => {
      const open = view.change === number;
      head.setAttribute("aria-expanded", String(open));
      if (open && !body.childElementCount) body.append(...why(view, change));
      if (open === body.hidden) {
        body.hidden = !open;
        if (open) head.scrollIntoView({ block: "nearest" });
      }
    });
  });
  const how = "Before each action the car estimates how safe it would be, as Safe from 0 to 1, and looks for the cheapest plan anew: metres of road and a penalty for what is not safe.";
  const none = el("p", {}, run.doc.changes.length ? how : unchanged(view));
  return el("section", { id: "changes" }, el("h2", {}, "Why the plan changed"), none, list);
}

function unchanged({ run }: View): string {
  const { finished, plans } = run.doc;
  if (!plans.length) return "There was no plan.";
  return finished?.status === "SUCCESS" ? "It did not: the first plan was driven to its end." : "It did not: the first plan was in force to the last.";
}

function unsafe(view: View): HTMLElement | null {
  const { judged } = view.run.doc;
  if (!judged.length) return null;
  const rows = judged.map((event) => {
    const who = [kindOf(event), event.vehicle ?? "", `(${blamed(event)}, rule: ${event.rule})`].join(" ");
    const open = () => view.goTo(event.time);
    return el(
      "li",
      {},
      el("button", { type: "button", class: "change", onclick: open }, el("span", { class: "when" }, view.run.clock(event.time)), who),
      el("p", { class: "detail" }, event.detail),
    );
  });
  return el("section", { id: "unsafe" }, el("h2", {}, "Unsafe moments"), el("ol", { class: "changes" }, ...rows));
}
