/** What was judged unsafe, in words. */

import type { Judged } from "./document";

export const kindOf = ({ kind }: Judged): string => kind.replace("_", " ");

export const blamed = ({ blame }: Judged): string => `blame: ${blame === "ego" ? "our car" : blame}`;
