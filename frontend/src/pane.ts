/** One scene on the page, with its caption. */

import { caption } from "./caption";
import { el } from "./elements";
import { hovering, pointers } from "./input";
import { Scene } from "./scene";
import type { Stage } from "./stage";
import type { View } from "./view";

export interface Pane {
  element: HTMLElement;
  draw: () => void; // unless it is hidden
  resize: () => void;
}

export function pane(stage: Stage, view: View): Pane {
  const number = stage.views.indexOf(view) ? "-2" : "";
  const whose = view.name === null ? "" : ` of ${view.name}`;
  const canvas = el("canvas", { id: `scene${number}`, class: "scene", tabindex: 0, "aria-label": `The town from above${whose}: roads, traffic, the car and its plan` });
  const moment = el("div", { id: `moment${number}`, class: view.name === null ? "moment" : "moment two", role: "status" });
  const tip = el("div", { class: "tip", hidden: true });
  const element = el("div", { class: "pane" }, canvas, moment, tip);
  const scene = new Scene(canvas, view);
  caption(view, moment);
  pointers(canvas, view);
  hovering(canvas, view, tip);
  stage.playback.onChange(() => (element.hidden = stage.overlaid && stage.shown !== view));
  return { element, draw: () => void (element.hidden || scene.draw()), resize: () => void (element.hidden || scene.resize()) };
}
