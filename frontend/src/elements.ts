/** Makes elements; text is always text. */

type Child = Node | string | null;
type Attributes = Record<string, string | number | boolean | ((event: Event) => void)>;

export function el<K extends keyof HTMLElementTagNameMap>(
  name: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(name);
  fill(made, attributes, children);
  return made;
}

const SVG = "http://www.w3.org/2000/svg";

export function svg(name: string, attributes: Attributes = {}, ...children: Child[]): SVGElement {
  const made = document.createElementNS(SVG, name);
  fill(made, attributes, children);
  return made;
}

function fill(made: Element, attributes: Attributes, children: Child[]): void {
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === "function") made.addEventListener(key.slice(2), value);
    else if (value === true) made.setAttribute(key, "");
    else if (value !== false) made.setAttribute(key, String(value));
  }
  made.append(...children.filter((child): child is Node | string => child !== null));
}

/** A letter in its plan's colour. */
export function badge(name: string, colour: string): HTMLElement {
  const made = el("span", { class: "badge" }, name);
  made.style.background = colour;
  return made;
}

export function metres(value: number | null): string {
  if (value === null) return "–";
  return `${value.toLocaleString("en", { maximumFractionDigits: Math.abs(value) < 10 && value % 1 > 0.05 ? 1 : 0 })} m`;
}
