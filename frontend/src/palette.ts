/** Colours that the colour-blind tell apart (Okabe and Ito), in light and dark. */

export const PLANS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];

export const planColour = (number: number): string => PLANS[number % PLANS.length];

export interface Theme {
  land: string;
  road: string;
  junction: string;
  marking: string;
  car: string;
  glass: string;
  ego: string;
  egoEdge: string;
  driven: string;
  risk: string;
  ink: string;
  soft: string;
  ghost: string;
  paper: string;
}

const LIGHT: Theme = {
  land: "#eef1ec",
  road: "#c3c7cd",
  junction: "#b9bec5",
  marking: "#ffffff",
  car: "#5d6673",
  glass: "#dfe5ec",
  ego: "#111111",
  egoEdge: "#ffffff",
  driven: "#111111",
  risk: "#b00020",
  ink: "#15181d",
  soft: "#59616d",
  ghost: "#7a2f9d",
  paper: "#ffffff",
};

const DARK: Theme = {
  land: "#14171b",
  road: "#343a43",
  junction: "#3b424c",
  marking: "#7b8592",
  car: "#9aa4b2",
  glass: "#23282f",
  ego: "#ffffff",
  egoEdge: "#000000",
  driven: "#f2f2f2",
  risk: "#ff6b81",
  ink: "#eceff3",
  soft: "#a3adba",
  ghost: "#d3a4f0",
  paper: "#1d2126",
};

const isDark = (): boolean => document.documentElement.dataset.theme === "dark";

export const theme = (): Theme => (isDark() ? DARK : LIGHT);

export function setDark(dark = !isDark()): void {
  document.documentElement.dataset.theme = dark ? "dark" : "light";
}
