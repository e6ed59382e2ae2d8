/** What of the estimates is looked at: one of them, one of its vehicles, one instant. */

import type { Estimate } from "./document";
import { SHOWN_FOR } from "./labels";
import type { Run } from "./run";

export interface Look {
  estimate: Estimate;
  vehicle: number; // which of its ids
  instant: number; // which of its instants
}

/** The vehicle that sets Safe, at the instant at which it leaves the car least. */
export function worstOf(estimate: Estimate): Look {
  const vehicle = Math.max(estimate.ids.indexOf(estimate.worst ?? ""), 0);
  return { estimate, vehicle, instant: leastOf(estimate, vehicle) };
}

/** The instant at which a vehicle leaves the car least. */
export function leastOf(estimate: Estimate, vehicle: number): number {
  const o = estimate.o[vehicle] ?? [];
  return o.reduce((least, value, t) => (value < o[least] ? t : least), 0);
}

/** The estimates that looked at a vehicle. */
export function telling(run: Run): Estimate[] {
  return run.doc.estimates.filter((estimate) => estimate.ids.length && estimate.instants.length);
}

/** What was chosen, as long as the moment is near it or has brought no newer estimate; else the latest estimate. */
export function lookAt(run: Run, time: number, chosen: Look | null): Look | null {
  const before = telling(run).filter((estimate) => estimate.time <= time + 0.5);
  const latest = before[before.length - 1];
  const stays = chosen && (chosen.estimate === latest || Math.abs(chosen.estimate.time - time) < SHOWN_FOR);
  return stays ? chosen : latest ? worstOf(latest) : null;
}
