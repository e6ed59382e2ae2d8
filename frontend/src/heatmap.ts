/** Draws Delta x Theta: what of it is safe at one instant, and at how many instants each control is safe. */

import type { Controls, Plane } from "./document";
import { svg } from "./elements";
import { type Control, safePart, timesSafe } from "./sets";

const [WIDTH, HEIGHT] = [230, 190]; // [px]
const [LEFT, RIGHT, TOP, BOTTOM] = [34, 212, 22, 150];
const [COLUMNS, ROWS] = [31, 27]; // cells of the heat map

type Place = (control: Control) => [number, number];

/** Where a control lies in the picture; left is left. */
function placing({ turning: [low, high], acceleration: [least, most] }: Controls): Place {
  return ([turn, acceleration]) => [
    RIGHT - ((turn - low) / (high - low)) * (RIGHT - LEFT),
    BOTTOM - ((acceleration - least) / (most - least)) * (BOTTOM - TOP),
  ];
}

/** The safe controls of one instant, shaded, and the line that cuts them off. */
export function instantMap(controls: Controls, plane: Plane, said: string): SVGElement {
  const place = placing(controls);
  const { part, cut } = safePart(plane, controls);
  const shape = svg("polygon", { points: points(part, place), class: "safe" });
  const [safe, unsafe] = [spot(plane, controls, true), spot(plane, controls, false)];
  const name = (at: Control, text: string) => {
    const [x, y] = place(at);
    return svg("text", { x, y: y + 4, class: "region" }, text);
  };
  return frame(controls, said, shape, line(cut, place), safe && name(safe, "safe"), unsafe && name(unsafe, "not safe"));
}

/** At how many of the instants each control is safe, as shades, with the line of one instant. */
export function horizonMap(controls: Controls, planes: Plane[], instant: number, said: string): SVGElement {
  const place = placing(controls);
  const [x0, x1, y0, y1] = [LEFT, RIGHT, TOP, BOTTOM];
  const [wide, high] = [(x1 - x0) / COLUMNS, (y1 - y0) / ROWS];
  const cells: SVGElement[] = [];
  for (let row = 0; row < ROWS; row++) {
    const counts = middles(controls, row).map((control) => timesSafe(planes, controls, control));
    for (let from = 0; from < COLUMNS; ) {
      let to = from;
      while (to < COLUMNS && counts[to] === counts[from]) to++;
      const shade = counts[from] / planes.length;
      const box = { x: x0 + from * wide, y: y0 + row * high, width: (to - from) * wide, height: high };
      cells.push(svg("rect", { ...box, class: "cell", "fill-opacity": shade.toFixed(3) }));
      from = to;
    }
  }
  return frame(controls, said, ...cells, line(safePart(planes[instant] ?? null, controls).cut, place));
}

/** The controls in the middle of a row's cells, from left to right in the picture. */
function middles({ turning: [low, high], acceleration: [least, most] }: Controls, row: number): Control[] {
  const acceleration = most - ((row + 0.5) / ROWS) * (most - least);
  return Array.from({ length: COLUMNS }, (_, i) => [high - ((i + 0.5) / COLUMNS) * (high - low), acceleration]);
}

/** The middle of the controls that are safe, or of those that are not; null where they are too few for a word. */
function spot(plane: Plane, controls: Controls, safe: boolean): Control | null {
  const cells = Array.from({ length: ROWS }, (_, row) => middles(controls, row)).flat();
  const found = cells.filter((control) => timesSafe([plane], controls, control) === (safe ? 1 : 0));
  if (found.length < 0.12 * cells.length) return null;
  const mean = (of: 0 | 1) => found.reduce((sum, control) => sum + control[of], 0) / found.length;
  return [mean(0), mean(1)];
}

function frame(controls: Controls, said: string, ...inside: (SVGElement | null)[]): SVGElement {
  const place = placing(controls);
  const { turning, acceleration, steering } = controls;
  const zero = (ends: [number, number]) => (ends[0] < 0 && ends[1] > 0 ? [ends[0], 0, ends[1]] : ends);
  const text = (x: number, y: number, words: string, anchor: string) => svg("text", { x, y, "text-anchor": anchor }, words);
  const [low, least] = [turning[0], acceleration[0]];
  const ticks = [
    ...zero(acceleration).map((a) => text(LEFT - 5, place([low, a])[1] + 4, signed(a), "end")),
    ...zero(turning).map((x) => text(place([x, least])[0], BOTTOM + 14, signed(x), "middle")),
  ];
  const box = { x: LEFT, y: TOP, width: RIGHT - LEFT, height: BOTTOM - TOP };
  return svg(
    "svg",
    { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: "chart map", role: "img", "aria-label": said },
    svg("rect", { ...box, class: "controls" }),
    ...inside,
    svg("rect", { ...box, class: "border" }),
    ...ticks,
    text(2, 12, "acceleration [m/s²]", "start"),
    text((LEFT + RIGHT) / 2, BOTTOM + 31, `← left  ${steering ? "steering [rad]" : "yaw rate [rad/s]"}  right →`, "middle"),
  );
}

function line(cut: Control[], place: Place): SVGElement | null {
  return cut.length ? svg("polyline", { points: points(cut, place), class: "cut" }) : null;
}

const points = (controls: Control[], place: Place): string =>
  controls.map((control) => place(control).map((value) => value.toFixed(1)).join(",")).join(" ");

const signed = (value: number): string => `${value > 0 ? "+" : value < 0 ? "−" : ""}${Math.abs(value)}`;
