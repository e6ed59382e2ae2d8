/** The whole drive in one strip: which plan was in force, Safe of each estimate, changes of plan, what was unsafe. */

import { el, svg } from "./elements";
import { planColour } from "./palette";
import { clock, type Playback } from "./playback";
import type { View } from "./view";

const TOP = 22; // [px] room for the flags
const PLOT = 44; // [px] Safe from 0 to 1
const BAND = 12; // [px] the plans' colours
const HEIGHT = TOP + PLOT + BAND + 4;

export class Timeline {
  readonly element = el("div", { class: "timeline" });
  private readonly head = svg("line", { y1: TOP - 4, y2: HEIGHT, class: "head" });

  constructor(private readonly view: View) {
    const name = view.name === null ? [] : [el("div", { class: "who" }, view.name)];
    this.element.append(...name, el("div", { class: "lane" }, this.plot(), ...this.flags()));
    view.onChange(() => this.update());
    this.update();
  }

  private update(): void {
    const x = `${(100 * this.view.playback.elapsed) / this.view.playback.end}%`;
    this.head.setAttribute("x1", x);
    this.head.setAttribute("x2", x);
  }

  /** Where a moment lies along the strip [%]. */
  private share(time: number): number {
    return (100 * (time - this.view.run.begin)) / this.view.playback.end;
  }

  private plot(): SVGElement {
    const { run } = this.view;
    const level = (safe: number) => TOP + (1 - safe) * PLOT;
    const chart = svg("svg", { class: "plot", height: HEIGHT, width: "100%" });
    for (const safe of [0, 0.5, 1]) {
      chart.append(svg("line", { x1: 0, x2: "100%", y1: level(safe), y2: level(safe), class: "grid" }));
    }
    run.doc.plans.forEach((plan, number) => {
      const until = run.doc.plans[number + 1]?.time ?? run.end;
      const width = this.share(until) - this.share(plan.time);
      const band = { x: `${this.share(plan.time)}%`, y: TOP + PLOT + 3, width: `${width}%`, height: BAND };
      chart.append(svg("rect", { ...band, fill: planColour(number) }, svg("title", {}, `plan ${plan.name}`)));
      if (width > 3) {
        const at = { x: `${this.share(plan.time) + width / 2}%`, y: TOP + PLOT + BAND, class: "band" };
        chart.append(svg("text", at, `plan ${plan.name}`));
      }
    });
    for (const estimate of run.doc.estimates) {
      const [x, y] = [`${this.share(estimate.time)}%`, level(estimate.safe)];
      const low = estimate.safe < 0.995;
      const said = `${run.clock(estimate.time)}: Safe(${run.doc.steps[estimate.step][0]}) = ${estimate.safe.toFixed(2)}`;
      const stem = svg("line", { x1: x, x2: x, y1: level(1), y2: y, class: "stem" });
      const dot = svg("circle", { cx: x, cy: y, r: low ? 5 : 3, class: low ? "dot low" : "dot" }, svg("title", {}, said));
      chart.append(...(low ? [stem] : []), dot);
    }
    const over = this.share(run.end);
    if (over < 90) {
      const words = `${run.doc.finished?.status ?? "the record ends"} at ${run.clock(run.end)}`;
      chart.append(svg("text", { x: `${over + 0.5}%`, y: TOP + PLOT + BAND + 1, class: "over" }, words));
    }
    chart.append(this.head);
    return chart;
  }

  /** Buttons above the plot, those that would overlap pushed to the right. */
  private flags(): HTMLElement[] {
    const { view } = this;
    const { run } = view;
    const changes = run.doc.changes.map((change, number) => {
      const plan = run.doc.plans[change.plan];
      const names = `${run.doc.plans[change.plan - 1].name} → ${plan.name}`;
      const label = `Plan changed ${names} at ${run.clock(plan.time)}: why?`;
      return { time: plan.time, text: names, label, kind: "replan", open: () => view.explain(number) };
    });
    const judged = run.doc.judged.map((event) => {
      const label = `${event.kind} at ${run.clock(event.time)}: go there`;
      return { time: event.time, text: "✕", label, kind: "unsafe", open: () => view.goTo(event.time) };
    });
    return [...changes, ...judged].map(({ time, text, label, kind, open }) => {
      const flag = el("button", { class: `flag ${kind}`, title: label, "aria-label": label, onclick: open }, text);
      flag.style.left = `${this.share(time)}%`;
      if (this.share(time) > 90) flag.style.transform = "translateX(-100%)";
      return flag;
    });
  }
}

/** The slider below the strips. */
export function strip(playback: Playback): HTMLElement {
  const range = el("input", {
    type: "range",
    class: "scrub",
    min: 0,
    max: Math.max(playback.end, 1),
    step: 100,
    "aria-label": "Time in the drive",
    oninput: () => playback.seek(Number(range.value)),
  });
  playback.onChange(() => {
    range.value = String(Math.round(playback.elapsed));
    range.setAttribute("aria-valuetext", clock(playback.elapsed));
  });
  return range;
}
