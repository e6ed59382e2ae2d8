/** The panel of a page with two runs: how they differ, where they parted, and all that is told of either. */

import type { Comparison, Document, Side } from "./document";
import { badge, el, metres } from "./elements";
import { blamed, kindOf } from "./judged";
import { planColour } from "./palette";
import { named, panel } from "./panel";
import { ACTIONS, where } from "./plan";
import type { Stage } from "./stage";
import type { View } from "./view";

const NARROW = "(max-width: 620px)"; // as in style.css: two scenes would lie one below the other

export function comparison(stage: Stage, two: Comparison): HTMLElement[] {
  const [one] = stage.views;
  const notices = two.notices.map((text) => el("li", {}, text));
  return [
    el("section", { id: "compared" }, el("h1", {}, `${two.names[0]} and ${two.names[1]}`), el("p", {}, one.run.route((place) => named(one, place)))),
    notices.length ? el("section", { id: "notices", class: "notice" }, el("h2", {}, "Not the same but for the algorithm"), el("ul", {}, ...notices)) : null,
    choices(stage),
    results(stage.views),
    parting(stage, two),
    ...closer(stage),
  ].filter((part) => part !== null);
}

/** Side by side or overlaid, and whether the cameras move together. */
function choices(stage: Stage): HTMLElement {
  const beside = el("button", { type: "button", onclick: () => stage.overlay(false) }, "Side by side");
  const over = el("button", { type: "button", onclick: () => stage.overlay(true) }, "Overlaid");
  const linked = el("input", { type: "checkbox", onchange: () => stage.link(linked.checked) });
  const together = el("label", { class: "field" }, linked, "move both views together");
  if (matchMedia(NARROW).matches) stage.overlay(true);
  stage.playback.onChange(() => {
    beside.setAttribute("aria-pressed", String(!stage.overlaid));
    over.setAttribute("aria-pressed", String(stage.overlaid));
    linked.checked = stage.linked;
    together.hidden = stage.overlaid;
    document.documentElement.dataset.layout = stage.overlaid ? "over" : "beside";
  });
  return el("div", { id: "layout", class: "buttons", role: "group", "aria-label": "How the runs are shown" }, beside, over, together);
}

function results(views: View[]): HTMLElement {
  const unsafe = ({ judged }: Document) =>
    judged.length ? `${judged.length}: ${judged.map((event) => `${kindOf(event)} (${blamed(event)})`).join(", ")}` : "none";
  const rows: [string, (view: View) => string][] = [
    ["how it ended", ({ run }) => run.doc.finished?.status ?? "no end is recorded"],
    ["unsafe", ({ run }) => unsafe(run.doc)],
    ["distance", ({ run }) => metres(run.distanceAt(run.end))],
    ["time", ({ run }) => run.clock(run.end)],
    ["plan changed", ({ run }) => times(run.doc.changes.length)],
  ];
  const body = rows.map(([name, tell]) => el("tr", {}, el("th", { scope: "row" }, name), ...views.map((view) => el("td", {}, tell(view)))));
  return el("section", { id: "results" }, el("table", { class: "two" }, heads(views), el("tbody", {}, ...body)));
}

const times = (count: number): string => (count === 0 ? "never" : count === 1 ? "once" : count === 2 ? "twice" : `${count} times`);

function heads(views: View[]): HTMLElement {
  return el("thead", {}, el("tr", {}, el("th"), ...views.map((view) => el("th", { scope: "col" }, view.name))));
}

function parting(stage: Stage, { parted }: Comparison): HTMLElement {
  const heading = el("h2", {}, "Where they parted");
  if (!parted) return el("section", { id: "parting" }, heading, el("p", {}, "Nowhere: both drove the same actions."));
  const sides = parted.sides.map((side, i) => ({ side, view: stage.views[i] }));
  const there = sides.find(({ side }) => side);
  const go = () => there?.side && there.view.goTo(there.side.time, 0);
  return el(
    "section",
    { id: "parting" },
    heading,
    el("p", {}, said(parted.alike, sides)),
    el("table", { class: "two" }, heads(stage.views), el("tbody", {}, ...terms(sides))),
    el("div", { class: "buttons" }, el("button", { type: "button", class: "go", onclick: go }, "Go there"), ...sides.map(explained)),
  );
}

type Sided = { side: Side | null; view: View };

function said(alike: number, sides: Sided[]): string {
  const first = alike === 0 ? "Already the first action differs" : alike === 1 ? "The first action was the same" : `The first ${alike} actions were the same`;
  const did = sides.map(({ side, view }) => `${view.name} ${side ? `chose to ${side.action === "forward" ? "go straight on" : action(side)}` : "did nothing more"}`);
  return `${first}. ${alike ? "Then " : ""}${did.join(", ")}.`;
}

const action = (side: Side): string => ACTIONS[side.action] ?? side.action;

/** What either did, by which plan, and what it knew of both actions. */
function terms(sides: Sided[]): HTMLElement[] {
  const row = (name: string, tell: (side: Side, view: View) => (Node | string)[]) =>
    el("tr", {}, el("th", { scope: "row" }, name), ...sides.map(({ side, view }) => el("td", {}, ...(side ? tell(side, view) : ["–"]))));
  const known = sides.flatMap(({ side }) => side ?? []);
  const estimates = known.map((of, i) =>
    row(`Safe of ${action(of)}`, ({ safe }) => [estimated(safe[i])]),
  );
  return [
    row("at", (side, view) => [view.run.clock(side.time)]),
    row("action", (side) => [el("b", {}, action(side))]),
    row("on", (side, view) => where(view, side.from)),
    ...estimates,
    row("by plan", (side) => [badge(side.plan, planColour(side.number))]),
    row("road ahead", (side) => [metres(side.road)]),
    row("safety penalty", (side) => [metres(side.penalty)]),
  ];
}

function estimated(found: Side["safe"][0] | undefined): string {
  if (!found) return "not estimated";
  const [safe, adds] = found;
  return `${safe.toFixed(2)}${adds === null ? "" : `, counts as ${metres(adds)}`}`;
}

/** Leads to the explanation of the change of plan that made a run go its own way. */
function explained({ side, view }: Sided): HTMLElement | null {
  const number = view.run.doc.changes.findIndex((change) => change.plan === side?.number && view.run.doc.plans[change.plan].time >= side.time);
  if (number < 0) return null;
  return el("button", { type: "button", class: "go", onclick: () => view.explain(number) }, `Why did ${view.name} change its plan?`);
}

/** All that is told of one run, and a choice which. */
function closer(stage: Stage): HTMLElement[] {
  const panels = stage.views.map((view) => el("div", {}, ...panel(view)));
  const choose = stage.views.map((view) => el("button", { type: "button", onclick: () => stage.show(view) }, view.name));
  const inside = el("div", { class: "closer" });
  stage.playback.onChange(() => {
    const number = stage.views.indexOf(stage.shown);
    choose.forEach((one, i) => one.setAttribute("aria-pressed", String(i === number)));
    if (inside.firstChild !== panels[number]) inside.replaceChildren(panels[number]);
  });
  return [el("div", { id: "which", class: "buttons", role: "group", "aria-label": "Which run is told of" }, "Closer look at", ...choose), inside];
}
